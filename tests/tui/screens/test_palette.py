"""The palette of all commands: what it lists, and that it does what is chosen."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from textual.pilot import Pilot
from textual.widgets import OptionList

from kit.controllers import prepare_workspace
from kit.render.palettes import COLOR_SCHEMES
from kit.render.roles import Role
from kit.school.game.levels import find_level
from kit.school.lessons.glossary import read_glossary
from kit.school.progress import ProgressJournal
from kit.tui.app import KitApp
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.glossary import GlossaryScreen
from kit.tui.screens.leaderboard import LeaderboardScreen
from kit.tui.screens.lesson import LessonScreen
from kit.tui.screens.lessons import LessonsScreen
from kit.tui.screens.level_drive import LevelDrive
from kit.tui.screens.levels import LevelsScreen
from kit.tui.screens.new_training import NewTrainingScreen
from kit.tui.screens.picker import Picker
from kit.tui.screens.play import PlayScreen
from kit.tui.screens.puzzle import PuzzleScreen
from kit.tui.screens.start import StartScreen
from kit.tui.screens.text_screen import TextScreen
from kit.tui.terminal import TerminalFacts, TerminalOptions, decide_terminal
from tests.tui.lesson_stage import seen, stage, text, until
from tests.tui.screens.test_start import House
from tests.tui.screens.test_start import house as house  # the fixture


@pytest.mark.long
def test_it_lists_lessons_levels_and_maps_and_opens_one_over_whatever_is_open(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("2")
        await until(pilot, lambda: isinstance(pilot.app.screen, LessonsScreen), "the lessons")
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(pilot.app.screen, Picker), "the palette")
        await pilot.press(*"map warehouse", "enter")
        await until(pilot, lambda: type(pilot.app.screen) is PlayScreen, "the map")
        await seen(pilot, "warehouse")
        assert len(pilot.app.screen_stack) == 3
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(pilot.app.screen, Picker), "the palette")
        await pilot.press(*"lesson 1", "enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, LessonScreen), "the lesson")
        assert len(pilot.app.screen_stack) == 3

    house.play(scene)


@pytest.mark.long
@pytest.mark.parametrize(("name", "opens"), [("eyes for the ward", True), ("the night convoy", False)])
def test_it_finds_puzzles_and_opens_those_without_a_clock(house: House, name: str, opens: bool) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await until(pilot, lambda: "Lessons" in text(pilot), "the menu")
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(pilot.app.screen, Picker), "the palette")
        await pilot.press(*f"puzzle {name}", "enter")
        await seen(pilot, "Mount as few" if opens else "Repair convoy.launch.py")
        await pilot.pause(0.5)
        assert type(pilot.app.screen) is (PuzzleScreen if opens else LevelsScreen)

    house.play(scene)


@pytest.mark.long
@pytest.mark.parametrize(
    ("typed", "found"),
    [
        ("tag", "Two players"),
        ("two players", "Two players"),
        ("daily", "Today's maze"),
        ("maze", "Today's maze"),
        ("race", "Game"),
        ("league", "League"),
        ("settings", "Key test"),
        ("puzzles", "Game"),
        ("scores", "Quiz"),
    ],
)
def test_it_finds_screens_by_the_words_that_people_type(house: House, typed: str, found: str) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await until(pilot, lambda: "Lessons" in text(pilot), "the menu")
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(pilot.app.screen, Picker), "the palette")
        options = pilot.app.screen.query_one(OptionList)
        await until(pilot, lambda: options.option_count > 50, "lessons, levels and maps")
        await pilot.press(*typed)
        await pilot.pause()
        assert any(str(option.prompt)[2:].startswith(found) for option in options.options)

    house.play(scene)


@pytest.mark.long
def test_it_opens_a_part_of_the_game(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await until(pilot, lambda: "Lessons" in text(pilot), "the menu")
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(pilot.app.screen, Picker), "the palette")
        await pilot.press(*"leaderboard", "enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, LeaderboardScreen), "the leaderboard")
        assert isinstance(pilot.app.screen_stack[-2], LevelsScreen)

    house.play(scene)


@pytest.mark.parametrize("spelling", [0, -1])
def test_it_finds_terms_of_the_glossary_by_each_of_their_spellings(house: House, spelling: int) -> None:
    term = max(read_glossary(), key=lambda each: len("".join(each.also)))

    async def scene(pilot: Pilot[None]) -> None:
        await until(pilot, lambda: "Lessons" in text(pilot), "the menu")
        await pilot.press("ctrl+p", *f"term {term.spellings[spelling]}", "enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, GlossaryScreen), "the term")
        await seen(pilot, " ".join(term.meaning.split()[:4]))

    house.play(scene)


def test_it_does_what_a_key_of_the_screen_does(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await until(pilot, lambda: "Lessons" in text(pilot), "the menu")
        await pilot.press("ctrl+p", *"the keys that work", "enter")
        await seen(pilot, "The start screen")

    house.play(scene)


def test_over_a_message_it_opens_for_the_screen_below(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await until(pilot, lambda: "Lessons" in text(pilot), "the menu")
        below = pilot.app.screen
        pilot.app.push_screen(MessageDialog("That did not work", "For a reason."))
        await seen(pilot, "For a reason")
        await pilot.press("ctrl+p", *"the keys that work", "enter")
        await seen(pilot, "The start screen")
        assert pilot.app.screen_stack[-2] is below

    house.play(scene)


def test_it_lists_the_actions_of_the_screen_and_no_others(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await until(pilot, lambda: "Lessons" in text(pilot), "the menu")
        await pilot.press("2")
        await until(pilot, lambda: isinstance(pilot.app.screen, LessonsScreen), "the lessons")
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(pilot.app.screen, Picker), "the palette")
        options = pilot.app.screen.query_one(OptionList)
        await until(pilot, lambda: options.option_count > 50, "lessons, levels and maps")
        found = [str(option.prompt) for option in options.options]
        assert sum("open the selected item (Enter)" in each for each in found) == 1
        for action in NewTrainingScreen.screen_actions.own + TextScreen.screen_actions.records:
            if action.id in ("change", "close"):  # call what actions of this screen call
                assert not any(action.help in each for each in found)

    house.play(scene)


def test_escape_leaves_everything_as_it_was(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        before = pilot.app.screen
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(pilot.app.screen, Picker), "the palette")
        options = pilot.app.screen.query_one(OptionList)
        await until(pilot, lambda: options.option_count > 50, "lessons, levels and maps")
        await pilot.press("ctrl+p", "escape")
        assert pilot.app.screen is before

    house.play(scene)


def test_themes_can_be_switched_while_it_runs() -> None:
    terminal = decide_terminal(
        {"TERM": "xterm-256color", "COLORTERM": "truecolor"}, TerminalFacts(), TerminalOptions()
    )
    app = KitApp(terminal)
    palette = app.kit_theme.palette
    assert palette[Role.FLOOR].color == COLOR_SCHEMES["dark"].roles[Role.FLOOR]
    app.switch_theme("light")
    assert app.kit_theme.palette is palette
    assert palette[Role.FLOOR].color == COLOR_SCHEMES["light"].roles[Role.FLOOR]
    assert app.theme == "kit-light"


@pytest.mark.long
def test_below_another_first_screen_it_finds_the_same_places_and_asks_before_a_drive_is_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    monkeypatch.setenv("KIT_WORKSPACE", str(workspace.folder))

    async def choose(pilot: Pilot[None], name: str) -> None:
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(pilot.app.screen, Picker), "the palette")
        options = pilot.app.screen.query_one(OptionList)
        await until(pilot, lambda: options.option_count > 50, "lessons, levels and maps")
        await pilot.press(*name, "enter")

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "forward")
        drive = pilot.app.screen
        await pilot.press("w")
        await choose(pilot, "map warehouse")
        await seen(pilot, "The drive is not over")
        await pilot.press("enter")
        await until(pilot, lambda: pilot.app.screen is drive, "the drive goes on")
        await choose(pilot, "map warehouse")
        await seen(pilot, "The drive is not over")
        await pilot.press("down", "enter")
        await until(pilot, lambda: type(pilot.app.screen) is PlayScreen, "the map")
        await pilot.press("escape")
        await until(pilot, lambda: isinstance(pilot.app.screen, StartScreen), "the first screen")

    with ProgressJournal(workspace.folder) as journal:
        level = replace(
            find_level("first-drive"), time_limit=3600.0
        )  # or it would run out behind the palette
        stage(lambda theme: LevelDrive(theme, level, [], journal, workspace), scene)


def test_it_leaves_out_what_does_nothing_now(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await until(pilot, lambda: "Lessons" in text(pilot), "the menu")
        await pilot.press("1")
        await until(pilot, lambda: isinstance(pilot.app.screen, LessonScreen), "the lesson")
        lesson = pilot.app.screen
        assert isinstance(lesson, LessonScreen)
        idle = [each for each in lesson.dialogue.actions if each.id in lesson.unavailable_actions]
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(pilot.app.screen, Picker), "the palette")
        found = [str(each.prompt) for each in pilot.app.screen.query_one(OptionList).options]
        assert idle
        for each in idle:
            assert not any(each.keys.help in line for line in found)

    house.play(scene)
