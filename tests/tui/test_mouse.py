"""The mouse, where KIT_MOUSE gives it to the kit: a click on a key presses it, on a line opens it, on the floor drives there."""

from __future__ import annotations

import threading
from pathlib import Path

import numpy as np
import pytest
from textual import events
from textual.pilot import Pilot
from textual.widgets import OptionList

from kit.controllers import ControllerFile, prepare_workspace
from kit.document.rows import Row, row
from kit.run.session import Session
from kit.school.lessons.lesson_dialogue import LessonDialogue
from kit.school.progress import ProgressJournal
from kit.school.quiz.quiz_dialogue import QuizDialogue
from kit.tui.rows.key_rows import footer, key_row
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.dialogue import screen_actions_of
from kit.tui.screens.levels import LevelsScreen
from kit.tui.screens.picker import Picker
from kit.tui.screens.play import PlayScreen
from kit.tui.screens.start import StartScreen
from kit.tui.widgets.text_rows import key_at
from tests.cases import every_case
from tests.tui.lesson_stage import rows, seen, stage, text, until
from tests.tui.test_play_pty import KIT, User

KEYS = key_row(("n", "next"), ("Enter", "open"), ("arrows", "choose"), ("?", "help"), ("^C", "quit"))
#  n next Enter open arrows choose ? help ^C quit


@every_case(
    ("parts", "column", "key"),
    [
        (KEYS, 0, "n"),
        (KEYS, 3, "n"),
        (KEYS, 7, "enter"),
        (KEYS, 15, "enter"),
        (KEYS, 20, ""),  # which of the arrows?
        (KEYS, 32, "question_mark"),
        (KEYS, 42, "ctrl+c"),
        (KEYS, 60, ""),
        (row(">", (" 2  ", "press"), "Lessons"), 6, "2"),
        (row((">", "bold"), (" 2  ", "chosen"), ("Lessons", "chosen")), 6, "enter"),
        (row(("bold", "bold"), " words"), 2, ""),
        (row(), 0, ""),
    ],
)
def test_the_key_under_a_column(parts: Row, column: int, key: str) -> None:
    assert key_at(parts, column) == key


def test_every_footer_can_be_clicked() -> None:
    kinds = (StartScreen, LevelsScreen, PlayScreen)
    for actions in (
        *(each.screen_actions for each in kinds),
        *map(screen_actions_of, (LessonDialogue, QuizDialogue)),
    ):
        pressed = {key_at(footer(actions, 200), column) for column in range(200)}
        assert len(pressed) > 3


def place_of(pilot: Pilot[None], words: str) -> tuple[int, int]:
    """Column and row of words on the screen."""
    for number, line in enumerate(rows(pilot)):
        if words in line:
            return line.index(words), number
    raise AssertionError(f"{words} is not on the screen:\n{text(pilot)}")


@pytest.mark.long
def test_a_click_presses_keys_and_drives_the_robot_there(tmp_path: Path) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, PlayScreen)
        await until(pilot, lambda: screen.view is not None, "the world")
        await pilot.click(offset=place_of(pilot, "? help"))
        await until(pilot, lambda: isinstance(pilot.app.screen, MessageDialog), "the help page")
        await pilot.press(*["pagedown"] * 5)
        await seen(pilot, "KIT_MOUSE=1")
        await pilot.click(offset=(5, 5))
        await until(pilot, lambda: pilot.app.screen is screen, "the screen again")
        await pilot.click(offset=place_of(pilot, "pause"))
        await until(pilot, lambda: screen.view is not None and screen.view.paused, "the pause")
        await pilot.click(offset=place_of(pilot, "p pause"))
        await until(pilot, lambda: screen.view is not None and not screen.view.paused, "the world to go on")
        camera = screen.world.camera
        assert camera is not None
        column, line = camera.project(np.array((2.0, 1.5))).tolist()
        await pilot.click(screen.world, offset=(int(column), int(line)))
        await seen(pilot, "to where you clicked")
        await until(pilot, lambda: screen.view is not None and screen.view.speed[0] > 0.1, "it drives")
        await pilot.press("w")
        await until(pilot, lambda: screen.view is not None and screen.view.controller == "teleop", "by hand")
        driver = screen._place_driver
        assert driver is not None
        await until(pilot, lambda: driver.is_done, "it yields")
        before = screen.world.camera
        wheel = events.MouseScrollUp(screen.world, 5, 5, 0, 0, 0, False, False, False)
        screen.world.on_mouse_scroll_up(wheel)
        after = screen.world.camera
        assert before is not None
        assert after is not None
        assert after.cell_width < before.cell_width

    stage(lambda theme: PlayScreen(theme, "simple", "teleop", folder=tmp_path, runs=tmp_path / "runs"), scene)


@pytest.mark.long
def test_a_click_chooses_a_level_and_another_opens_it(tmp_path: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, LevelsScreen)
        await seen(pilot, "First drive")
        await pilot.click(offset=place_of(pilot, "Two doors"))
        await until(pilot, lambda: screen.chosen.level.id == "two-doors", "the choice")
        await pilot.click(offset=place_of(pilot, "First drive"))
        await until(pilot, lambda: screen.chosen.level.id == "first-drive", "the choice")
        await pilot.pause()
        await pilot.click(offset=place_of(pilot, "First drive"))
        await seen(pilot, "The clock starts with your first key")

    with ProgressJournal(workspace.folder) as journal:
        stage(lambda theme: LevelsScreen(theme, journal, workspace), scene)


@pytest.mark.long
def test_a_click_on_the_floor_changes_the_world_in_its_own_thread(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In any other one the world may stand still for good."""
    threads: list[threading.Thread] = []
    drive_with = Session.drive_with

    def noted(session: Session, controller: ControllerFile | None) -> None:
        threads.append(threading.current_thread())
        drive_with(session, controller)

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, PlayScreen)
        await until(pilot, lambda: screen.view is not None and screen.world.camera is not None, "the world")
        monkeypatch.setattr(Session, "drive_with", noted)
        assert screen.world.camera is not None
        column, line = screen.world.camera.project(np.array((2.0, 1.5))).tolist()
        await pilot.click(screen.world, offset=(int(column), int(line)))
        await until(pilot, lambda: threads, "the program to be stopped")
        live = screen.host._live
        assert live is not None
        assert threads == [live._thread]

    stage(lambda theme: PlayScreen(theme, "simple", "teleop", folder=tmp_path, runs=tmp_path / "runs"), scene)


async def turn(pilot: Pilot[None], words: str, *, down: bool) -> None:
    """Turns the wheel by one step above these words."""
    x, y = place_of(pilot, words)
    kind = events.MouseScrollDown if down else events.MouseScrollUp
    pilot.app.post_message(kind(None, x, y, 0, 1 if down else -1, 0, False, False, False, x, y))
    await pilot.pause()


@pytest.mark.long
def test_the_wheel_chooses_in_lists_and_a_click_beside_a_box_closes_it(tmp_path: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, LevelsScreen)
        await seen(pilot, "First drive")
        await turn(pilot, "Two doors", down=True)
        await until(pilot, lambda: screen.chosen.level.id != "first-drive", "another level")
        await turn(pilot, "Two doors", down=False)
        await until(pilot, lambda: screen.chosen.level.id == "first-drive", "the level before")
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(pilot.app.screen, Picker), "the palette")
        options = pilot.app.screen.query_one(OptionList)
        await until(pilot, lambda: options.option_count > 5, "the commands")
        await turn(pilot, "Leaderboard", down=True)
        await until(pilot, lambda: options.highlighted == 1, "the second command")
        await pilot.click(offset=(0, 0))
        await until(pilot, lambda: pilot.app.screen is screen, "the list of levels")

    with ProgressJournal(workspace.folder) as journal:
        stage(lambda theme: LevelsScreen(theme, journal, workspace), scene)


@pytest.mark.long
def test_a_click_on_a_picture_of_the_map_chooses_its_level(tmp_path: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, LevelsScreen)
        await seen(pilot, "First drive")
        await until(pilot, screen._map_places, "a map")
        above = next(i for i, line in enumerate(rows(pilot)) if "Every tile" in line) + 2
        gate = next(place for place in screen._map_places() if place.level == "the-gate")
        last_row = above + gate.y + gate.rows
        await pilot.click(offset=(gate.x + gate.columns, last_row))  # beside it
        await pilot.pause()
        assert screen.chosen.level.id == "first-drive"
        await pilot.click(offset=(gate.x + gate.columns - 1, last_row))
        await until(pilot, lambda: screen.chosen.level.id == "the-gate", "the choice")

    with ProgressJournal(workspace.folder) as journal:
        stage(lambda theme: LevelsScreen(theme, journal, workspace), scene, size=(200, 50))


@pytest.mark.pty
@pytest.mark.long
@pytest.mark.parametrize(("setting", "is_read"), [("", False), ("0", False), ("1", True)])
def test_the_mouse_is_the_terminals_unless_it_is_asked_for(
    setting: str, is_read: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("KIT_MOUSE", setting)
    monkeypatch.setenv("KIT_WORKSPACE", str(tmp_path))
    user = User(KIT, "start")
    try:
        user.until(lambda: "Lessons" in user.text, "the menu")
        assert (1000 in user.modes.on, 1006 in user.modes.on) == (is_read, is_read)
        assert 1003 not in user.modes.on  # no motion without a button
        if is_read:
            line = next(number for number, each in enumerate(user.text.splitlines(), 1) if "Lessons" in each)
            column = user.text.splitlines()[line - 1].index("Lessons") + 2
            user.send(f"\x1b[<0;{column};{line}M\x1b[<0;{column};{line}m".encode())
            user.until(
                lambda: "0 of" in user.text and "done" in user.text and "Enter open" in user.text, "lessons"
            )
        user.send(b"\x10")
        user.until(lambda: "Commands" in user.text, "the palette")
        user.send(b"mouse for\r")
        user.until(lambda: (1000 in user.modes.on) is not is_read, "the mouse to change hands")
        user.send(b"\x03")
        assert user.wait() == 0
        user.assert_sane()
        assert not {1000, 1002, 1006} & user.modes.on
    finally:
        user.close()
