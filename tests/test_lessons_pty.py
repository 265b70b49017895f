"""A newcomer finishes every lesson of the first four units: on the full screen in a real terminal of 80x24, and line by
line. Both ways lead to the same progress."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.school.lessons.catalogue import LessonProgress, lesson_progress_from_events
from kit.school.lessons.reading import lesson_names, lessons_folder, read_lesson, read_units
from kit.school.lessons.records import Lesson, LessonCommand
from kit.school.progress import EventKind, ProgressJournal
from kit.workspace import Workspace, open_workspace
from tests.lesson_newcomer import LineNewcomer, Newcomer, ScreenNewcomer, right_number
from tests.test_newcomer_pty import end_trainings
from tests.tui.test_play_pty import User, terminals

FIRST = lesson_names()[0]
UNITS = "ABCD"
NAMES = [name for unit in read_units() if unit.letter in UNITS for name in unit.lessons]
ONE_BY_ONE = [
    pytest.param(name, marks=[pytest.mark.long] if name != FIRST else [], id=name) for name in NAMES
]


@pytest.fixture
def workspace() -> Workspace:
    return open_workspace()


@pytest.fixture
def user(workspace: Workspace) -> Iterator[Callable[..., User]]:
    with terminals() as run:
        yield run
    end_trainings(workspace.folder / "runs")


def shown_first(lesson: Lesson) -> list[LessonCommand]:
    """The commands that no lesson before shows."""
    names = lesson_names()
    before = {
        (command.line, command.map_name)
        for name in names[: names.index(lesson.name)]
        for step in read_lesson(lessons_folder() / name).steps
        for command in step.commands
    }
    made = {
        (command.line, command.map_name): command
        for step in reversed(lesson.steps)
        for command in step.commands
    }
    return [command for key, command in made.items() if key not in before]


def stand(workspace: Workspace, lesson: Lesson) -> LessonProgress:
    with ProgressJournal(workspace.folder) as progress:
        return lesson_progress_from_events(lesson, progress.events())


def reached(found: LessonProgress) -> tuple[object, ...]:
    """What both ways must agree on; how often one checked is nobody's business."""
    return (
        found.completed_steps,
        found.predictions,
        found.passed_exercises,
        found.best_shares,
        found.is_completed,
    )


def expected(lesson: Lesson) -> tuple[object, ...]:
    return (
        frozenset(step.number for step in lesson.steps if step.exercise is None),
        {step.number: right_number(step) - 1 for step in lesson.steps if step.options},
        frozenset(exercise.name for exercise in lesson.exercises),
        {exercise.name: 1.0 for exercise in lesson.exercises},
        True,
    )


def is_listed_as_done(lesson: Lesson) -> bool:
    """Whether ``kit lesson`` says so."""
    listed = CliRunner().invoke(main, ["lesson", "--plain"], catch_exceptions=False).output
    return any(line.startswith(lesson.number) and line.endswith("  done") for line in listed.splitlines())


def finish(newcomer: Newcomer, workspace: Workspace) -> None:
    lesson = newcomer.lesson
    assert not is_listed_as_done(lesson)
    newcomer.walk()
    assert reached(stand(workspace, lesson)) == expected(lesson)
    assert is_listed_as_done(lesson)


@pytest.mark.daily(8)
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("name", ONE_BY_ONE)
def test_on_the_screen(
    workspace: Workspace,
    user: Callable[..., User],
    name: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    lesson = read_lesson(lessons_folder() / name)
    finish(ScreenNewcomer(user, workspace, lesson, shown_first(lesson)), workspace)


@pytest.mark.daily(3)
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("name", ONE_BY_ONE)
def test_line_by_line(workspace: Workspace, user: Callable[..., User], name: str) -> None:
    finish(LineNewcomer(user, workspace, read_lesson(lessons_folder() / name)), workspace)


def test_a_step_is_not_gone_through_before_its_prediction(workspace: Workspace) -> None:
    lesson = read_lesson(lessons_folder() / FIRST)
    done = subprocess.run(
        [sys.executable, "-m", "kit", "lesson", "1", "--plain"],
        input="n\nnonsense\n9\nl 99\nb\n?\nq\n",
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0
    assert "Traceback" not in done.stdout + done.stderr
    with ProgressJournal(workspace.folder) as progress:
        assert progress.events(EventKind.STEP) == progress.events(EventKind.PREDICTION) == []
    assert not stand(workspace, lesson).has_started
