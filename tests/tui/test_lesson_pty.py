"""A student in a real terminal of 80x24: from the start screen into a lesson, through it, away and back again."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from kit.school.progress import EventKind, ProgressJournal
from tests.tui.lesson_folder import write_lessons, write_solutions
from tests.tui.test_play_pty import KIT, ROBOT, User
from tests.tui.widgets.test_world_view_pty import assert_rests, until_quiet

PROGRAM = str(Path(__file__).parent / "programs" / "lesson_app.py")
PATIENCE = 20.0

Open = Callable[..., User]


@pytest.fixture
def opened() -> Iterator[Open]:
    made: list[User] = []

    def run(*arguments: str) -> User:
        user = User(*arguments)
        made.append(user)
        return user

    yield run
    for user in made:
        user.close()


@pytest.fixture
def lesson(opened: Open, tmp_path: Path) -> Callable[[], User]:
    """Opens the lesson of the tests, always with the same workspace."""
    folders = write_lessons(tmp_path / "lessons"), write_solutions(tmp_path / "solutions"), tmp_path / "home"
    return lambda: opened(PROGRAM, *map(str, folders))


def sees(user: User, wanted: str) -> None:
    user.until(lambda: wanted in user.text, wanted, PATIENCE)


@pytest.mark.long
def test_a_student_goes_through_a_lesson_leaves_and_comes_back(
    lesson: Callable[[], User], tmp_path: Path
) -> None:
    user = lesson()
    sees(user, "waiting for your prediction")
    user.until(lambda: ROBOT.search(user.text), "the robot", PATIENCE)
    user.send(b"2")
    sees(user, "Only a wall makes it turn.")
    user.send(b"n")
    sees(user, "step 2 of 5")
    user.send(b"o")
    sees(user, "arrows choose, Enter confirm")
    user.send(b"\r")
    sees(user, "lines 1 to")  # more than the terminal shows: page by page, from the top
    user.send(b"\x1b[F")
    sees(user, "warehouse")
    user.send(b"q")
    sees(user, "step 2 of 5")
    user.send(b"n")
    sees(user, "It goes round.")
    user.send(b"n")
    file = tmp_path / "home" / "lessons" / "01-colours" / "colour" / "answers.yaml"
    sees(user, "Save the file")
    user.until(lambda: str(file) in "".join(line.strip() for line in user.text.splitlines()), "its path")
    file.write_text("colour: red\n")
    sees(user, "That one means stop.")
    user.send(b"h")
    sees(user, "Hint 1 of 3: Look up.")
    file.write_text("colour: green\n")
    sees(user, "Passed:")
    user.until(lambda: "step 4 of 5" in user.text, "step 4 of 5")
    user.send(b"s")
    sees(user, "# go")
    user.send(b"q")
    sees(user, "Passed:")
    user.send(b"n")
    sees(user, "step 5 of 5")
    user.send(b"\x03")
    assert user.wait() == 0
    user.assert_sane()
    again = lesson()
    sees(again, "step 5 of 5 ■■■■□")
    again.send(b"c")
    sees(again, "Checking ...")
    again.send(b"\x03")
    assert again.wait() == 0
    again.assert_sane()
    with ProgressJournal(tmp_path / "home") as progress:
        kinds = [event.kind for event in progress.events()]
        attempts = [event.content["verdict"] for event in progress.events(EventKind.ATTEMPT)]
    assert kinds.count(EventKind.PREDICTION) == 1
    assert kinds.count(EventKind.STEP) == 3
    assert attempts == ["fail", "pass"]
    assert kinds.count(EventKind.HINT) == kinds.count(EventKind.SOLUTION) == 1


@pytest.mark.long
def test_an_editor_opens_in_place_and_what_it_saved_is_checked(
    lesson: Callable[[], User], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    editor = tmp_path / "editor"
    editor.write_text('#!/bin/sh\necho "editing $1"\nread answer\necho "colour: $answer" > "$1"\n')
    editor.chmod(0o755)
    monkeypatch.setenv("VISUAL", str(editor))
    user = lesson()
    sees(user, "waiting for your prediction")
    user.send(b"2")
    sees(user, "Only a wall makes it turn.")
    for _ in range(3):
        user.send(b"n")
    sees(user, "step 4 of 5")
    user.send(b"e")
    sees(user, "editing")
    user.send(b"green\r")
    sees(user, "Passed:")
    user.until(lambda: "step 4 of 5" in user.text, "step 4 of 5")


def test_a_screen_that_a_command_opens_comes_back_with_ctrl_c(lesson: Callable[[], User]) -> None:
    user = lesson()
    sees(user, "waiting for your prediction")
    user.send(b"1n")
    sees(user, "It goes ahead")
    user.send(b"n")
    sees(user, "step 2 of 5")
    user.send(b"o")
    sees(user, "arrows choose, Enter confirm")
    user.send(b"\x1b[B\r")
    sees(user, "$ kit keys")
    user.until(lambda: "$ kit keys" not in user.text and user.modes.alternate, "the key test", PATIENCE)
    until_quiet(user)
    user.send(b"\x03")
    sees(user, "step 2 of 5")
    user.send(b"\x03")
    assert user.wait() == 0
    user.assert_sane()


def test_a_step_that_is_read_costs_nothing(lesson: Callable[[], User]) -> None:
    user = lesson()
    sees(user, "waiting for your prediction")
    user.send(b"1n")
    sees(user, "It goes ahead")
    user.send(b"nn")
    sees(user, "It goes round.")
    user.until(lambda: ROBOT.search(user.text), "the world that stands still beside it", PATIENCE)
    assert_rests(user, 0.075)


def test_a_new_student_drives_with_an_arrow_key_and_is_in_a_lesson_with_enter(opened: Open) -> None:
    user = opened(KIT)
    sees(user, "Lessons")
    user.until(lambda: ROBOT.search(user.text), "the robot", PATIENCE)
    user.send(b"w")
    sees(user, "you drive")
    user.send(b"\r")
    user.until(lambda: "1-9 open" not in user.text, "the lesson in place of the menu", PATIENCE)
    sees(user, "step 1 of")
    user.send(b"\x1b")
    sees(user, "1-9 open")
    user.send(b"9")
    sees(user, "kit progress export FILE")
    user.send(b"\x1b[6~")  # page down: the game comes first
    sees(user, "exercises passed")
    user.send(b"\x03")
    assert user.wait() == 0
    user.assert_sane()
