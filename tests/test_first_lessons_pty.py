"""A scripted student goes through the first lessons: on the full screen in a real terminal of 80x24, and line by
line. Both ways lead to the same progress."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from kit.school.lessons.exercise_files import exercise_folder, install_exercise
from kit.school.lessons.lesson_progress import LessonProgress, lesson_progress_from_events
from kit.school.lessons.reading import lesson_names, lessons_folder, read_lesson, solutions_folder
from kit.school.lessons.records import Exercise, Lesson, LessonStep
from kit.school.progress import EventKind, ProgressJournal
from kit.workspace import Workspace, open_workspace
from tests.tui.test_play_pty import KIT, User

FIRST = lesson_names()[:4]
ONE_BY_ONE = [
    pytest.param(name, marks=[pytest.mark.long] if name != FIRST[0] else [], id=name) for name in FIRST
]
PATIENCE_S = 120.0


@pytest.fixture
def workspace() -> Workspace:
    return open_workspace()


@pytest.fixture
def user() -> Iterator[Callable[..., User]]:
    made: list[User] = []

    def run(*arguments: str) -> User:
        made.append(User(KIT, *arguments))
        return made[-1]

    yield run
    for each in made:
        each.close()


def solve(workspace: Workspace, lesson: Lesson, exercise: Exercise) -> None:
    """Writes what the reference solution says over the student's files."""
    install_exercise(workspace, lesson, exercise)
    folder = exercise_folder(workspace, lesson, exercise)
    found = solutions_folder() / lesson.name / exercise.name
    single = found / f"solution{Path(exercise.file).suffix}"
    files = {exercise.file: single} if single.is_file() else _below(found / "solution")
    for name, file in files.items():
        (folder / name).write_bytes(file.read_bytes())


def _below(folder: Path) -> dict[str, Path]:
    return {each.relative_to(folder).as_posix(): each for each in folder.rglob("*") if each.is_file()}


def right(step: LessonStep) -> int:
    return 1 + next(number for number, option in enumerate(step.options) if option.is_right)


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
        {step.number: right(step) - 1 for step in lesson.steps if step.options},
        frozenset(exercise.name for exercise in lesson.exercises),
        {exercise.name: 1.0 for exercise in lesson.exercises},
        True,
    )


def wait_for(condition: Callable[[], bool], user: User, what: str) -> None:
    end = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < end, f"waited in vain for {what}:\n{user.text}"
        user.pump(0.1)


@pytest.mark.parametrize("name", ONE_BY_ONE)
def test_on_the_screen(workspace: Workspace, user: Callable[..., User], name: str) -> None:
    lesson = read_lesson(lessons_folder() / name)
    screen = user("lesson", name)
    count = len(lesson.steps)
    for step in lesson.steps:
        wait_for(
            lambda step=step: f"step {step.number} of {count}" in screen.text, screen, f"step {step.number}"
        )  # type: ignore[misc]  # mypy on lambdas
        if step.options:
            screen.send(str(right(step)).encode())
            wait_for(
                lambda step=step: step.number in stand(workspace, lesson).predictions,
                screen,
                "the prediction",
            )  # type: ignore[misc]  # mypy on lambdas
        if step.exercise is not None:
            solve(workspace, lesson, step.exercise)
            screen.send(b"c")
            wait_for(
                lambda step=step: step.exercise.name in stand(workspace, lesson).passed_exercises,  # type: ignore[misc]  # mypy on lambdas
                screen,
                f"{step.exercise.name} to pass",
            )
        if step.number < count:
            screen.send(b"n")
    if lesson.steps[-1].exercise is None:
        screen.send(b"n")
        wait_for(lambda: stand(workspace, lesson).is_completed, screen, "the end")
    screen.send(b"\x03")
    assert screen.wait() == 0
    screen.assert_sane()
    assert reached(stand(workspace, lesson)) == expected(lesson)


@pytest.mark.parametrize("name", ONE_BY_ONE)
def test_line_by_line(workspace: Workspace, name: str) -> None:
    lesson = read_lesson(lessons_folder() / name)
    lines = []
    for step in lesson.steps:
        if step.options:
            lines.append(str(right(step)))
        if step.exercise is not None:
            solve(workspace, lesson, step.exercise)
            lines.append("c")
        lines.append("n")
    done = subprocess.run(
        [sys.executable, "-m", "kit", "lesson", name, "--plain"],
        input="\n".join(lines) + "\n",
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stdout + done.stderr
    assert "is done" in done.stdout
    assert reached(stand(workspace, lesson)) == expected(lesson)


def test_a_step_is_not_gone_through_before_its_prediction(workspace: Workspace) -> None:
    lesson = read_lesson(lessons_folder() / FIRST[0])
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
