"""Every command of every lesson, as it stands on a screen of 80 columns, pasted into a shell: it does what the lesson says.

So do those of hints and of the quiz. What a command prints is compared with what its lesson says that it shows.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

from grader.reading import read_assignment
from kit.learning.training.run_folders import list_runs
from kit.learning.training.runs import TrainingRun
from kit.school.lessons.reading import lesson_names, lessons_folder, read_lesson
from kit.school.lessons.records import CommandKind, Lesson, LessonCommand, LessonStep
from kit.school.lessons.shell_lines import fill_in_paths
from kit.school.quiz.answers import AnswerChoice
from tests.kit_content import kit_bank
from tests.pasted_commands import COLUMNS, LIMIT_S, SCREEN_S, Home, ShownCommand, shown_commands
from tests.school.quiz.item_builders import told_rows
from tests.waiting import wait_until

NEEDS_NO_WORLD = ("bag", "interface", "pkg")
"""Words after ``kit ros`` that ask no running world."""
SHORTENED = {
    "kit train turn --algo dqn --algorithm-reward progress --steps 60000": 3000,
    "kit train turn --algorithm-reward progress --steps 200000": 4000,
    "kit train hallway --on turn_right_90 --mirrored --steps 300000": 4000,
}
"""Trainings of a network, which take minutes, and the steps of the tests'; all other flags are the lesson's."""
PATIENCE_S = 1500
"""For all commands of a lesson on a machine that is busy with other tests [s]."""
UP = b"\x1b[A"
IN_MARKS = re.compile(r"`((?:kit|grader) [^`]+)`")
TRY = re.compile(r"Try: (.+)$")


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Home]:
    made = Home(tmp_path / "home", monkeypatch)
    yield made
    for training in list_runs(made.workspace.runs):  # it goes on when its screen is left
        if training.is_active:
            training.send_command("stop")
            wait_until(partial(_has_ended, training), "the end of the training")


def _has_ended(training: TrainingRun) -> bool:
    return not training.is_active


@pytest.mark.daily(6)
@pytest.mark.timeout(PATIENCE_S)
@pytest.mark.long_cases(*lesson_names()[1:])
@pytest.mark.parametrize("name", lesson_names())
def test_every_command_of_a_lesson(home: Home, name: str) -> None:
    """One after the other, in one home, with the exercises before and the step's own solved."""
    lesson = read_lesson(lessons_folder() / name)
    for step in lesson.steps:
        home.solve(lesson, step)
        shown = shown_commands(step, home.file_of(lesson, step))
        beside = [each for each in shown if each.command.kind is CommandKind.BESIDE]
        for each in shown:
            if each not in beside:
                _paste(home, each)
        if beside:
            _ask_all(home, lesson, step, beside)


def test_what_is_shortened_stands_in_a_lesson() -> None:
    lessons = (read_lesson(lessons_folder() / name) for name in lesson_names())
    assert set(SHORTENED) <= {
        each.line for lesson in lessons for step in lesson.steps for each in step.commands
    }


@pytest.mark.daily(5)
@pytest.mark.long
@pytest.mark.timeout(PATIENCE_S)
@pytest.mark.parametrize("name", lesson_names())
def test_every_command_of_a_hint(home: Home, name: str) -> None:
    """Those in marks; a hint names no other command."""
    lesson = read_lesson(lessons_folder() / name)
    for step in lesson.steps:
        # What a hint says of a launch that runs is not asked: no step of its lesson asks one either.
        lines = [line for line in _hinted(step) if _has_world(lesson) or not _needs_world(line)]
        if not lines:
            continue
        home.solve(lesson, step)
        for each in shown_commands(step, home.file_of(lesson, step)):
            if each.command.kind is CommandKind.ALONE:  # a hint may be about what these have made
                _paste(home, each)
        asked = [_asked(lesson, line) for line in lines if _needs_world(line)]
        for line in lines:
            if not _needs_world(line):
                _paste(home, ShownCommand(LessonCommand(line, _kind_of(line), "maze"), line))
        if asked:
            _ask_all(home, lesson, step, asked)


TRIED = tuple(dict.fromkeys(item.command_to_try for item in kit_bank().items if item.command_to_try))


@pytest.mark.daily(5)
@pytest.mark.long
@pytest.mark.parametrize("line", TRIED)
def test_every_command_of_the_quiz(home: Home, line: str) -> None:
    item = next(each for each in kit_bank().items if each.command_to_try == line)
    rows = ["".join(text for text, _ in each) for each in told_rows(item, AnswerChoice(0, None), COLUMNS)]
    assert max(map(len, rows)) <= COLUMNS
    (shown,) = (found[1] for row in rows if (found := TRY.search(row)))
    _paste(home, ShownCommand(LessonCommand(line, _kind_of(line), "maze"), shown))


def _hinted(step: LessonStep) -> Iterator[str]:
    if step.exercise is None:
        return
    for criterion in read_assignment(step.exercise.folder).criteria:
        for hint in criterion.hints:
            prose = IN_MARKS.sub("", hint)
            assert re.search(r"\bkit (ros|run|play|fields|glossary|train|launch) ", prose) is None, hint
            yield from (line for line in IN_MARKS.findall(hint) if len(line.split()) > 2 or " -" in line)


def _needs_world(line: str) -> bool:
    words = line.split()
    return words[1] == "ros" and words[2] not in NEEDS_NO_WORLD and "--help" not in words


def _kind_of(line: str) -> CommandKind:
    """A hint and a quiz do not say it."""
    words = line.split()
    is_screen = words[1] == "drive" or words[1:3] == ["fields", "show"]
    return CommandKind.SCREEN if is_screen else CommandKind.ALONE


def _worlds(lesson: Lesson) -> list[str]:
    """The places that the lesson asks questions of."""
    commands = (command for step in lesson.steps for command in step.commands)
    return [command.map_name for command in commands if command.kind is CommandKind.BESIDE]


def _has_world(lesson: Lesson) -> bool:
    return bool(_worlds(lesson))


def _asked(lesson: Lesson, line: str) -> ShownCommand:
    """Of a world that the lesson asks too."""
    return ShownCommand(LessonCommand(line, CommandKind.BESIDE, _worlds(lesson)[0]), line)


def _paste(home: Home, each: ShownCommand) -> None:
    lines = each.lines
    if (steps := SHORTENED.get(each.command.line)) is not None:
        lines, count = re.subn(r"--steps[\s\\]+\d+", f"--steps {steps}", lines)
        assert count == 1
    with home.paste(lines) as pasted:
        if each.command.kind is CommandKind.ALONE:
            pasted.until_end(LIMIT_S)
            _assert_shows(each, pasted.printed)
            return
        pasted.until_screen()
        pasted.user.until(
            lambda: (
                pasted.has_ended
                or (pasted.is_under_way and all(words in pasted.user.text for words in each.command.shows))
            ),
            f"what {each.lines} shows: {each.command.shows}",
            SCREEN_S,
        )
        assert not pasted.has_ended, pasted.printed
        pasted.leave()
        pasted.assert_ended_well(LIMIT_S)


def _ask_all(home: Home, lesson: Lesson, step: LessonStep, questions: list[ShownCommand]) -> None:
    """While the world that the step is about runs in another terminal: as the step opens it, where it does."""
    (place,) = {each.command.map_name for each in questions}
    file = home.file_of(lesson, step)
    opened = [
        each.lines
        for each in shown_commands(step, file)
        if each.command.kind is CommandKind.SCREEN and each.command.line.startswith("kit drive ")
    ]
    if not opened:
        opened = [fill_in_paths(f"kit drive {place}", file)]
    with home.open_world(opened[0]) as world:
        for each in questions:
            keys = UP if "/teleopkeys" in shlex.split(each.lines.replace("\\\n", "")) else b""
            _assert_shows(each, home.ask(each.lines, world, partial(_is_shown, each), keys))


def _is_shown(each: ShownCommand, printed: str) -> bool:
    text = " ".join(printed.split())
    return all(words in text for words in each.command.shows)


def _assert_shows(each: ShownCommand, printed: str) -> None:
    """Compared with its blanks as one, for a terminal breaks lines."""
    missing = [words for words in each.command.shows if words not in " ".join(printed.split())]
    assert missing == [], f"{each.lines}\n{printed[-3000:]}"
