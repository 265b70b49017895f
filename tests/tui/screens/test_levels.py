"""The map of levels and a drive on one: what is open, what a drive earns, which ghosts drive along."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Awaitable, Callable, Iterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from textual.app import App
from textual.pilot import Pilot

from kit.controllers import prepare_workspace
from kit.document.rows import row_text, row_width
from kit.learning.authoring.new_task import new_task_file
from kit.learning.tasks.goals.target import REACH_TARGET
from kit.mapmaking.map_drawing import read_drawing
from kit.mapmaking.new_map import write_map
from kit.run.recording import Recording
from kit.school.game import ghosts, leaderboard, references
from kit.school.game.challenges import all_challenges
from kit.school.game.daily import DAILY_PREFIX, daily_level, today
from kit.school.game.drive_records import DriveRecord, record_drive, save_film
from kit.school.game.levels import GameLevel, all_worlds
from kit.school.game.medal import RUNGS, Medal, medal_time
from kit.school.game.player_progress import ExtraRule, offered_rules
from kit.school.game.race import DriverKind
from kit.school.game.task_levels import task_level
from kit.school.progress import EventKind, ProgressJournal
from kit.tui import flourish
from kit.tui.app import KitApp
from kit.tui.rows import level_rows
from kit.tui.rows.drive_end_page import (
    LADDER_COLUMNS,
    LEAST_BESIDE_ROWS,
    LEFT,
    ROWS_AROUND,
    VAST,
    WIDE,
)
from kit.tui.rows.drive_end_rows import LEAST_CURVE_ROWS
from kit.tui.rows.ladder_rows import ladder_of_drive
from kit.tui.rows.level_rows import THUMBNAIL
from kit.tui.rows.medal_rows import CORNER, medal_drawing
from kit.tui.screens import level_result
from kit.tui.screens import levels as levels_module
from kit.tui.screens.dialogs import HelpDialog, MessageDialog
from kit.tui.screens.leaderboard import LeaderboardScreen
from kit.tui.screens.level_drive import LevelDrive
from kit.tui.screens.level_result import (
    DriveResult,
    DriveResultScreen,
    gain_color,
    scene_of_drive,
    speeds_along,
    speeds_of,
)
from kit.tui.screens.levels import LevelsScreen
from kit.tui.terminal import LEAST_SIZE, TerminalFacts, TerminalOptions, decide_terminal
from kit.tui.widgets.text_rows import TextRows
from kit.workspace import Workspace
from tests.kit_content import kit_levels
from tests.school.game.measured_drivers import best_keys_drive, keys_drive
from tests.tui.lesson_stage import rows
from tests.waiting import wait_until_shown

Scene = Callable[[LevelsScreen, Pilot[None]], Awaitable[None]]
LEVELS = kit_levels()
ONE_WAY = replace(LEVELS[0], goal=REACH_TARGET, targets=())
"""The first level without the way back, which one held key finishes."""


@pytest.fixture
def progress(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[ProgressJournal]:
    monkeypatch.setenv(leaderboard.FOLDER_VARIABLE, str(tmp_path / "hall"))
    with ProgressJournal(tmp_path) as opened:
        yield opened


def play(
    scene: Scene,
    progress: ProgressJournal,
    folder: Path,
    size: tuple[int, int] = (80, 24),
    level: GameLevel | None = None,
) -> None:
    """``level``: the screen is opened for it."""

    async def run() -> None:
        terminal = decide_terminal(
            {"TERM": "xterm-256color", "LANG": "C.UTF-8"}, TerminalFacts.here(), TerminalOptions()
        )
        app: App[None] = KitApp(terminal)
        async with app.run_test(size=size, notifications=True) as pilot:
            assert isinstance(app, KitApp)
            screen = LevelsScreen(app.kit_theme, progress, prepare_workspace(folder), level)
            screen._levels = (ONE_WAY, *LEVELS[1:])
            await app.push_screen(screen)
            await pilot.pause()
            await scene(screen, pilot)

    asyncio.run(run())


def screen_lines(app: App[None]) -> list[str]:
    return ["".join(segment.text for segment in strip) for strip in app.screen._compositor.render_strips()]


def flat(app: App[None]) -> str:
    return " ".join(" ".join(screen_lines(app)).split())


def test_a_small_terminal_shows_the_chosen_level_and_one_that_is_too_small_says_so(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        for level in (each for each in LEVELS if each.world == "hall"):
            await wait_until_shown(pilot, lambda title=level.title: f"> {title}" in flat(pilot.app))
            await pilot.press("down")
        await pilot.resize_terminal(40, 12)
        await wait_until_shown(pilot, lambda: "40x12 is too small" in flat(pilot.app))
        await pilot.resize_terminal(*LEAST_SIZE)
        await wait_until_shown(pilot, lambda: "too small" not in flat(pilot.app))

    play(scene, progress, tmp_path / "desk", LEAST_SIZE)


@pytest.mark.long
def test_every_world_fits_and_the_shut_levels_say_what_opens_them(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        seen = set()
        for world in all_worlds():
            shown = flat(pilot.app)
            assert world.title in shown
            titles = {level.title for level in LEVELS if level.world == world.id}
            assert all(title in shown for title in titles)
            seen |= titles
            await pilot.press("right")
            await pilot.pause()
        assert seen == {level.title for level in LEVELS}
        missing = {each.title for each in all_challenges()}
        for _ in all_challenges():  # the list goes on below where it does not fit
            missing -= {title for title in missing if title in flat(pilot.app)}
            await pilot.press("down")
            await pilot.pause()
        assert missing == set()
        await pilot.press("right")
        await pilot.pause()
        assert all_worlds()[0].title in flat(pilot.app)
        await pilot.press("down", "down")
        assert not screen.chosen.is_open
        await pilot.press("enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, MessageDialog)

    play(scene, progress, tmp_path / "desk")


@pytest.mark.long
@pytest.mark.long
def test_the_stars_of_a_level_stand_below_the_list_of_every_world(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        for level in LEVELS:
            drive = {"driver": "hand", "reached": True, "seconds": 900.0, "bumps": 0}
            progress.add(EventKind.FINISH, level.id, drive)
        screen._read()
        for number, level in enumerate(LEVELS):
            if number and LEVELS[number - 1].world == level.world:
                continue
            screen._at = number
            screen._show()
            await wait_until_shown(pilot, lambda title=level.title: f"> {title}" in flat(pilot.app))
            names = ExtraRule.CLEAN.description(level), ExtraRule.CLEAN.short_name(level)
            assert any(each in flat(pilot.app) for each in names), level.world
            assert all(word in flat(pilot.app) for word in level.story.split())

    play(scene, progress, tmp_path)


def test_on_a_small_screen_the_map_of_the_chosen_level_stands_beside_what_is_said_of_it(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        about = screen.query_one("#about", TextRows)
        seen = set()
        for _ in range(2):
            title = screen.chosen.level.title
            await wait_until_shown(pilot, lambda title=title: title in row_text(about._rows[0]))
            await wait_until_shown(pilot, lambda: "◎" in "".join(map(row_text, about._rows)))
            seen.add(tuple(row_text(each)[-THUMBNAIL[0] :] for each in about._rows))
            await pilot.press("right")
        assert len(seen) == 2

    play(scene, progress, tmp_path / "desk", (80, 24))


def test_esc_gives_up_a_drive_that_is_being_prepared_and_stays_in_the_list(
    progress: ProgressJournal, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    may_go_on = threading.Event()

    def held(*_: object) -> tuple[()]:
        may_go_on.wait(60.0)
        return ()

    monkeypatch.setattr(levels_module, "level_ghosts", held)

    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await wait_until_shown(pilot, lambda: "Preparing the ghosts" in flat(pilot.app))
        await pilot.press("escape")
        await wait_until_shown(pilot, lambda: level_rows.NOT_BEGUN[True] in flat(pilot.app))
        assert "Preparing" not in flat(pilot.app)
        assert pilot.app.screen is screen
        may_go_on.set()
        assert progress.events(subject=daily_level(today()).id) == []

    play(scene, progress, tmp_path / "desk", level=daily_level(today()))


def test_on_a_wide_screen_the_chosen_level_is_shown(progress: ProgressJournal, tmp_path: Path) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        pictures = set()
        for _ in range(2):
            await wait_until_shown(pilot, lambda: screen.chosen.level.id in screen._scenes)
            await wait_until_shown(pilot, lambda: screen._preview.frame is not None)
            await pilot.pause()
            frame = screen._preview.frame
            assert frame is not None
            assert "◎" in "".join(frame.rows())
            pictures.add(tuple(frame.rows()))
            await pilot.press("down", "down")
        await wait_until_shown(pilot, lambda: screen.chosen.level.id in screen._scenes)
        assert len(pictures) == 2

    play(scene, progress, tmp_path / "desk", (160, 48))


def test_a_locked_level_is_shown_dim_beside_its_rungs_and_stars(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        for is_open in (True, False):
            screen._at = next(at for at, each in enumerate(screen._found) if each.is_open is is_open)
            screen._load_ghosts()
            level = screen.chosen.level
            await wait_until_shown(pilot, lambda level=level: level.id in screen._scenes)
            await wait_until_shown(pilot, lambda is_open=is_open: screen._preview.is_dim is not is_open)
            card = " ".join(row_text(each) for each in screen._card_beside())
            gold = medal_time(Medal.GOLD, screen._references[level.id], DriverKind.HAND)
            assert f"{gold:.2f} s" in card
            assert ExtraRule.CLEAN.description(level) in card

    play(scene, progress, tmp_path, (200, 50))


@pytest.mark.long
def test_on_a_large_screen_a_world_is_a_map_with_a_picture_of_each_level(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        in_world = [each.id for each in LEVELS if each.world == screen.chosen.level.world]
        await wait_until_shown(pilot, lambda: set(screen._pictures) == set(in_world), "all pictures")
        await pilot.pause()
        shown = flat(screen.app)
        assert "▶" in shown
        assert shown.count("Every tile") > 1  # in the list and on the map
        await pilot.resize_terminal(80, 24)
        await wait_until_shown(pilot, lambda: "▶" not in flat(screen.app), "the list alone")

    play(scene, progress, tmp_path, (200, 50))


def test_it_is_shown_how_far_the_ghosts_are_and_they_are_prepared_once(
    progress: ProgressJournal, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    half, go_on = threading.Event(), threading.Event()
    calls: list[str] = []

    def prepare(level: GameLevel, on_progress: Callable[[float], None]) -> None:
        calls.append(level.id)
        on_progress(0.5)
        half.set()
        go_on.wait(20)

    monkeypatch.setattr(ghosts, "load_reference_ghost", prepare)

    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await pilot.press("enter")
        try:
            await wait_until_shown(pilot, lambda: half.is_set() and "█░" in flat(pilot.app))
            assert " 50%" in flat(pilot.app)
            await pilot.press("w", "enter", "d")  # by someone who does not wait
        finally:
            go_on.set()
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, LevelDrive))
        assert calls == ["first-drive"]

    play(scene, progress, tmp_path / "desk")


def test_who_has_no_agent_is_told_how_to_train_one_for_the_level(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await wait_until_shown(pilot, lambda: "First drive" in flat(pilot.app))
        await pilot.press("a")
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, MessageDialog))
        assert "kit task new mine --level first-drive" in flat(pilot.app)

    play(scene, progress, tmp_path / "desk")


@pytest.mark.long
def test_a_task_of_ones_own_is_driven_by_hand_as_a_level(progress: ProgressJournal, tmp_path: Path) -> None:
    folder = tmp_path / "desk" / "worlds" / "hall"
    write_map(folder, read_drawing("########\n#S    T#\n########"), title="Hall", source="drawn")
    level = task_level(new_task_file("dash", str(folder), tmp_path))

    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, LevelDrive))
        drive = pilot.app.screen
        assert isinstance(drive, LevelDrive)
        await wait_until_shown(pilot, lambda: drive.view is not None and "first key" in flat(pilot.app))

        def drives() -> bool:
            if drive._referee is None:
                drive.drive_keys_changed(("p_up",), drive.drive.state)
            return isinstance(pilot.app.screen, DriveResultScreen)

        await wait_until_shown(pilot, drives)
        await wait_until_shown(pilot, lambda: "your best time" in flat(pilot.app))
        assert "medal" not in flat(pilot.app)
        (event,) = progress.events(EventKind.FINISH)
        assert (event.subject, event.content["reached"]) == (level.id, True)
        await pilot.press("escape")
        await wait_until_shown(pilot, lambda: pilot.app.screen is screen)

    play(scene, progress, tmp_path / "desk", level=level)


@pytest.mark.long
def test_a_drive_is_followed_by_its_result_and_the_next_level(
    progress: ProgressJournal, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        assert screen.chosen.level.id == "first-drive"
        await pilot.press("enter")
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, LevelDrive))
        drive = pilot.app.screen
        assert isinstance(drive, LevelDrive)
        await wait_until_shown(pilot, lambda: drive.view is not None and "first key" in flat(pilot.app))
        assert {each.name for each in drive._ghosts} == {"reference"}
        view = drive.view
        assert view is not None
        assert view.time_s == 0.0

        def drives() -> bool:
            if drive._referee is None:
                drive.drive_keys_changed(("p_up",), drive.drive.state)
            return isinstance(pilot.app.screen, DriveResultScreen)

        await wait_until_shown(pilot, drives)
        (event,) = progress.events(EventKind.FINISH)
        assert event.content["reached"]
        assert event.content["bumps"] == 0
        assert event.content["medal"] >= 1
        await pilot.press("up")
        assert isinstance(pilot.app.screen, DriveResultScreen)
        await pilot.press("enter")  # everything at once
        await wait_until_shown(pilot, lambda: "opened: Left turn" in flat(pilot.app))
        await pilot.press("y")
        await wait_until_shown(pilot, lambda: "A card to share" in flat(pilot.app))
        assert (tmp_path / "desk" / "cards" / "first-drive.hand.txt").read_text().startswith("First drive")
        await pilot.press("escape")
        await pilot.pause()
        may_write = threading.Event()

        def held(*given: object) -> Path:
            may_write.wait(60.0)
            return save_film(*given)  # type: ignore[arg-type]  # what it is called with

        monkeypatch.setattr(level_result, "save_film", held)
        await pilot.press("y", "question_mark")  # what is above it then is not covered by the card
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, HelpDialog))
        result = pilot.app.screen_stack[-2]
        assert isinstance(result, DriveResultScreen)
        may_write.set()
        await wait_until_shown(pilot, lambda: "picture:" in row_text(result._note))
        assert isinstance(pilot.app.screen, HelpDialog)
        await pilot.press("escape")
        await wait_until_shown(pilot, lambda: "moving picture:" in flat(pilot.app), lambda: flat(pilot.app))
        await pilot.press("enter")

        def is_next() -> bool:
            shown = pilot.app.screen
            return isinstance(shown, LevelDrive) and shown is not drive

        await wait_until_shown(pilot, is_next)
        await pilot.press("escape")
        await wait_until_shown(pilot, lambda: pilot.app.screen is screen)
        assert screen._found[0].medals
        assert screen._found[2].is_open
        assert screen.chosen.level.id == "the-door"

    play(scene, progress, tmp_path / "desk")


async def first_key(pilot: Pilot[None]) -> LevelDrive:
    """Presses a drive's first key once it is shown, and waits until the world moves. Returns its screen."""
    await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, LevelDrive))
    drive = pilot.app.screen
    assert isinstance(drive, LevelDrive)
    await wait_until_shown(pilot, lambda: drive.view is not None and "first key" in flat(pilot.app))
    assert drive.view is not None
    shown_s = drive.view.time_s
    drive.drive_keys_changed(("p_up",), drive.drive.state)
    await wait_until_shown(pilot, lambda: drive.view is not None and drive.view.time_s > shown_s + 0.3)
    return drive


@pytest.mark.long
def test_a_drive_that_is_cut_short_goes_on_where_it_was(progress: ProgressJournal, tmp_path: Path) -> None:
    """As when the connection is lost: the kit ends, and nobody has left the drive."""

    async def cut_short(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await pilot.press("enter")
        await first_key(pilot)

    async def go_on(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await wait_until_shown(pilot, lambda: "was cut short" in flat(pilot.app))
        await pilot.press("enter")
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, LevelDrive))
        await wait_until_shown(pilot, lambda: "cut short after" in flat(pilot.app))
        await pilot.press("escape")  # nothing is lost yet
        await wait_until_shown(pilot, lambda: pilot.app.screen is screen)
        await pilot.press("enter")
        drive = await first_key(pilot)
        assert drive.view is not None
        assert drive.view.time_s > load_unfinished_s
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, DriveResultScreen))

    play(cut_short, progress, tmp_path / "desk")
    workspace = prepare_workspace(tmp_path / "desk")
    recording = ghosts.load_unfinished(workspace)
    assert recording is not None
    load_unfinished_s = recording.ticks * recording.step_size
    assert load_unfinished_s >= 0.3
    assert progress.events(EventKind.FINISH) == []
    play(go_on, progress, tmp_path / "desk")
    (event,) = progress.events(EventKind.FINISH)
    assert event.content["reached"]
    assert ghosts.load_unfinished(workspace) is None
    whole = ghosts.load_ghost(workspace, LEVELS[0], DriverKind.HAND)
    assert whole is not None
    assert whole.seconds > load_unfinished_s
    assert np.array_equal(whole.tracks[0][: recording.ticks], recording.track("serp"))


@pytest.mark.long
def test_a_drive_that_is_left_or_started_anew_is_not_kept(progress: ProgressJournal, tmp_path: Path) -> None:
    async def leave(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        for key in ("r", "escape"):
            await pilot.press("enter")
            await first_key(pilot)
            await pilot.press(key)
            if key == "r":
                await wait_until_shown(pilot, lambda: "The clock starts" in flat(pilot.app))
                await pilot.press("escape")
            await wait_until_shown(pilot, lambda: pilot.app.screen is screen)

    play(leave, progress, tmp_path / "desk")
    assert ghosts.load_unfinished(prepare_workspace(tmp_path / "desk")) is None


@pytest.mark.long
def test_leaving_the_run_of_the_day_is_asked_twice_and_uses_it_up(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await wait_until_shown(pilot, lambda: "> First drive" in flat(pilot.app))
        await pilot.press("d")
        drive = await first_key(pilot)
        await pilot.press("r")
        await wait_until_shown(pilot, lambda: "This run counts for today" in flat(pilot.app))
        assert pilot.app.screen is drive
        assert drive.has_started
        await pilot.press("r")
        await wait_until_shown(pilot, lambda: "Practice: today's run has counted" in flat(pilot.app))
        await first_key(pilot)
        await pilot.press("escape")  # practice is left at once
        await wait_until_shown(pilot, lambda: pilot.app.screen is screen)

    play(scene, progress, tmp_path / "desk")
    assert [event.subject for event in progress.events(EventKind.START)] == [daily_level(today()).id]
    assert ghosts.load_unfinished(prepare_workspace(tmp_path / "desk")) is None


def test_who_gives_up_the_run_of_the_day_is_told_what_became_of_it(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await wait_until_shown(pilot, lambda: "> First drive" in flat(pilot.app))
        await pilot.press("d")
        await first_key(pilot)
        await pilot.press("escape")
        await wait_until_shown(pilot, lambda: "This run counts for today" in flat(pilot.app))
        await pilot.press("escape")
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, MessageDialog))
        assert "has counted" in flat(pilot.app)
        await pilot.press("escape")
        await wait_until_shown(pilot, lambda: pilot.app.screen is screen)

    play(scene, progress, tmp_path / "desk")


@pytest.mark.long
def test_the_panel_speaks_of_the_target_that_is_next_and_of_all_bumps(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    level = replace(LEVELS[0], id="two-in-a-row", targets=((0.625, 1.5), (0.625, 2.5)))

    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, LevelDrive))
        drive = pilot.app.screen
        assert isinstance(drive, LevelDrive)
        await wait_until_shown(pilot, lambda: drive.view is not None and "first key" in flat(pilot.app))
        assert drive.view is not None
        assert drive.view.scene.targets == drive._preview.objective.discs
        (first,) = drive._preview.objective.discs
        second = first._replace(y=2.5)
        between = []

        def drives() -> bool:
            if drive._referee is None:
                drive.drive_keys_changed(("p_up",), drive.drive.state)
            elif drive.view is not None and drive.view.scene.targets == (second,):
                between.append(drive.view.metrics)
            return isinstance(pilot.app.screen, DriveResultScreen)

        await wait_until_shown(pilot, drives)
        assert between
        assert all(each.reached_s is None for each in between)
        # Driven straight on, what is left to the second target shrinks by what was driven, whenever it is looked at. One view,
        # that of the tick in which the first was reached, may still measure to that one.
        ways = {each.distance_m: each.distance_m + (each.target_m or 0.0) for each in between}
        assert sum(way != pytest.approx(1.947, abs=0.01) for way in ways.values()) <= 1
        assert ways[between[-1].distance_m] == pytest.approx(1.947, abs=0.01)

    play(scene, progress, tmp_path / "desk", level=level)


@pytest.mark.parametrize("width", [80, 120])
def test_medals_and_the_streak_have_room_in_the_heading(
    progress: ProgressJournal, tmp_path: Path, width: int
) -> None:
    content = {"driver": "hand", "reached": True, "seconds": 6.5, "bumps": 0, "medal": 3}
    for level in LEVELS[:12]:
        for driver in DriverKind:
            progress.add(
                EventKind.FINISH, level.id, {**content, "driver": driver.value, "rules": list(ExtraRule)}
            )
    progress.add(EventKind.FINISH, daily_level(today()).id, content)

    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        heading = screen.query_one("#heading", TextRows)
        await wait_until_shown(pilot, lambda: "gold 36" in text_of(heading))
        assert len(text_of(heading)) <= width
        assert "stars 60" in text_of(heading)
        assert "1 day" in text_of(heading)
        assert "in a row" in text_of(heading)

    play(scene, progress, tmp_path / "desk", (width, 24))


def text_of(rows: TextRows) -> str:
    """The first row."""
    return "".join(segment.text for segment in rows.render_line(0)).rstrip()


@pytest.mark.parametrize("width", [120, 200])
def test_a_puzzle_is_pictured_beside_the_list_of_all(
    progress: ProgressJournal, tmp_path: Path, width: int
) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await pilot.press("left")
        await wait_until_shown(pilot, lambda: screen.chosen_challenge is not None)
        await wait_until_shown(pilot, lambda: "█" in flat(pilot.app))

    play(scene, progress, tmp_path / "desk", (width, 40))


@pytest.mark.parametrize("size", [(120, 35), (200, 50)])
def test_a_large_leaderboard_tells_what_todays_level_asks_for(
    progress: ProgressJournal, tmp_path: Path, size: tuple[int, int]
) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await pilot.press("f")
        level = daily_level(today())
        await wait_until_shown(pilot, lambda: level.hint in flat(pilot.app))
        assert "◎" in flat(pilot.app), "on its map"
        assert all(each.title in flat(pilot.app) for each in RUNGS)
        if size[1] > 40:
            assert all(each.description(level) in flat(pilot.app) for each in offered_rules(level))

    play(scene, progress, tmp_path / "desk", size)


def test_one_key_joins_the_leaderboard_and_leaves_it(progress: ProgressJournal, tmp_path: Path) -> None:
    forged = {"driver": "hand", "reached": True, "seconds": 1.5, "bumps": 0, "medal": 5}
    progress.add(EventKind.FINISH, LEVELS[1].id, forged)  # nothing was driven
    workspace = prepare_workspace(tmp_path / "desk")
    finish, recording = keys_drive(LEVELS[0])
    record_drive(progress, workspace, LEVELS[0], DriverKind.HAND, [(finish, recording)])
    shown = f"{finish.seconds:.2f} s"
    progress.add(EventKind.ABOUT, "name", {"value": "Ada"})
    board = leaderboard.leaderboard_folder()

    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await pilot.press("f")
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, LeaderboardScreen))
        assert not leaderboard.read_entries(board)
        await wait_until_shown(pilot, lambda: shown in flat(pilot.app))  # what is to be beaten
        await pilot.press("j")
        await wait_until_shown(pilot, lambda: "quickest on" in flat(pilot.app) and shown in flat(pilot.app))
        (entry,) = leaderboard.read_entries(board)
        assert (entry.name, entry.seconds, entry.is_mine) == ("Ada", finish.seconds, True)
        await pilot.press("j")
        await wait_until_shown(pilot, lambda: "quickest on" not in flat(pilot.app))
        assert not leaderboard.read_entries(board)
        await pilot.press("escape")
        await wait_until_shown(pilot, lambda: pilot.app.screen is screen)

    play(scene, progress, tmp_path / "desk")


@pytest.mark.parametrize("shift_s", [0.0, 1.0])
@pytest.mark.parametrize("size", [(80, 24), (120, 36), (200, 50)])
def test_a_result_with_all_that_can_be_won_fits_on_the_screen(
    progress: ProgressJournal, tmp_path: Path, size: tuple[int, int], shift_s: float
) -> None:
    level = LEVELS[0]
    finish, recording = references.drive_reference(level)
    reference = ghosts.load_reference_ghost(level)
    assert reference is not None
    others = [replace(reference, name=name) for name in ("hand", "program", "agent", "Ada", "Ben", "Cleo")]
    record = DriveRecord(
        2,
        Medal.SILVER,
        tuple(ExtraRule)[:4],
        (),
        False,
        False,
        True,
        False,
        9.0,
        Medal.BRONZE,
        LEVELS[1:4],
        LEVELS[1],
        "yellow",
        2,
        None,
    )
    splits = (ghosts.Split(2.0, 2.0, 0.1),) * 3
    result = DriveResult(
        level,
        DriverKind.PROGRAM,
        finish,
        record,
        recording,
        [reference, *others],
        6.0,
        splits,
        [replace(finish, seconds=finish.seconds + shift_s), *[finish] * 4],
    )

    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        dialog = DriveResultScreen(screen._theme, result, prepare_workspace(tmp_path / "desk"))
        await screen.app.push_screen(dialog)
        await pilot.pause()
        await pilot.press("enter")
        await pilot.pause()
        await wait_until_shown(pilot, lambda: dialog._shown >= len(dialog._page.revealed))
        shown_rows = dialog._page.room_above + len(dialog._page.revealed) + ROWS_AROUND
        assert shown_rows <= size[1]
        assert dialog.has_class("-wide") is (WIDE <= size[0] < VAST)
        await wait_until_shown(pilot, lambda: dialog._world._scene is not None)
        assert dialog._world.size.height >= LEAST_BESIDE_ROWS
        assert all(row_width(each) <= LEFT for each in dialog._page.beside) or size[0] >= WIDE
        shown = flat(screen.app)
        assert all(each.title in shown for each in record.unlocked)
        assert "yellow belt" in shown
        assert "Esc" in shown
        has_room = size[1] > 36 or (size[1] > 24 and not shift_s)
        assert (dialog._told.photo_finish[0] in dialog._page.revealed) is has_room
        assert (level.ending.split()[-1] in shown) is (size[1] > 24)

    play(scene, progress, tmp_path / "desk", size)


def result_of(workspace: Workspace, progress: ProgressJournal) -> DriveResult:
    """A drive of the bend by an ordinary hand, which is gold."""
    level = next(each for each in LEVELS if each.id == "left-turn")
    finish, recording = best_keys_drive(level)
    record = record_drive(progress, workspace, level, DriverKind.HAND, [(finish, recording)])
    ghost = ghosts.load_reference_ghost(level)
    assert ghost is not None
    return DriveResult(level, DriverKind.HAND, finish, record, recording, [ghost], ghost.seconds, ())


def test_a_medal_is_drawn_in_the_corner_of_a_small_screen_and_the_map_stays(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    workspace = prepare_workspace(tmp_path / "desk")
    result = result_of(workspace, progress)
    assert result.record.medal > result.record.previous_medal
    drawn = [row_text(each).strip() for each in medal_drawing(result.record.medal, CORNER)]

    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        dialog = DriveResultScreen(screen._theme, result, workspace)
        await screen.app.push_screen(dialog)
        await wait_until_shown(pilot, lambda: dialog._world._scene is not None)
        await pilot.press("enter")
        await wait_until_shown(pilot, lambda: dialog._shown >= len(dialog._page.revealed))
        dialog._flourish.end()
        dialog._show()
        await pilot.pause()
        lines = screen_lines(screen.app)
        assert all(sign in line for sign, line in zip(drawn, lines, strict=False))
        assert len(drawn) <= dialog._world.region.y, "above the map"
        assert not any("…" in line for line in lines)
        assert result.level.ending.split()[-1] in flat(screen.app)

    play(scene, progress, tmp_path / "desk")


def test_the_way_is_coloured_by_what_it_gained(progress: ProgressJournal, tmp_path: Path) -> None:
    result = result_of(prepare_workspace(tmp_path / "desk"), progress)
    scene = scene_of_drive(result)
    parts = ghosts.gains_along(
        result.recording.track(result.level.find_scenario().partners[0]),
        result.recording.step_size,
        result.ghosts[0],
    )
    assert len(scene.strokes) == len(parts) > 10
    known = parts[~np.isnan(parts[:, 4])]
    assert known[:, 4].sum() == pytest.approx(result.ghosts[0].seconds - result.finish.seconds, abs=0.3)
    assert {each.color for each in scene.strokes} >= {gain_color(-1.0), gain_color(0.0)}
    assert len({gain_color(gain) for gain in (-1.0, 0.0, 1.0, float("nan"))}) == 4
    assert scene.paths, "the ghost's way is beside it"


def test_a_lost_drive_has_its_map_whole_once_all_is_shown(progress: ProgressJournal, tmp_path: Path) -> None:
    workspace = prepare_workspace(tmp_path / "desk")
    won = result_of(workspace, progress)
    lost = replace(won, finish=replace(won.finish, reached=False))

    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        dialog = DriveResultScreen(screen._theme, lost, workspace)
        await screen.app.push_screen(dialog)
        await wait_until_shown(pilot, lambda: bool(dialog._told.leads))
        await pilot.press("enter")
        await wait_until_shown(pilot, lambda: dialog._shown >= len(dialog._page.revealed))
        await pilot.pause()
        assert dialog._page.room_above + len(dialog._page.revealed) + 1 <= dialog._world.region.y
        assert dialog._world.region.bottom <= 23

    play(scene, progress, tmp_path / "desk")


def test_a_robot_that_is_put_back_to_its_start_has_no_speed_from_there(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    result = result_of(prepare_workspace(tmp_path / "desk"), progress)
    recording = SimpleNamespace(
        step_size=result.recording.step_size,
        track=lambda robot: np.concatenate([result.recording.track(robot)[:100]] * 3),
    )
    speeds = speeds_of(replace(result, recording=recording))  # type: ignore[arg-type]  # all that it needs
    assert max(speeds) <= 1.05 * max(speeds_of(result))


def test_driving_backwards_is_a_speed_below_zero_in_any_direction() -> None:
    for heading in (0.0, 2.0):
        ahead = np.arange(21.0) * 0.01
        there = np.stack([ahead * np.cos(heading), ahead * np.sin(heading), np.full(21, heading)], 1)
        track = np.concatenate([there, there[::-1]])
        speeds = speeds_along(track, 0.02)
        assert speeds[:4] == pytest.approx([0.5] * 4)
        assert speeds[-3:] == pytest.approx([-0.5] * 3)


@pytest.mark.long
def test_sharing_writes_a_card_and_a_moving_picture_and_copies_the_card(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    workspace = prepare_workspace(tmp_path / "desk")
    result = result_of(workspace, progress)

    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        copied: list[str] = []
        screen.app.copy_to_clipboard = copied.append  # type: ignore[method-assign]  # a pilot has no terminal
        await screen.app.push_screen(DriveResultScreen(screen._theme, result, workspace))
        await pilot.press("y")
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, MessageDialog))
        assert "gold" in copied[0]
        (film,) = (workspace.folder / "cards").glob("*.gif")
        assert film.read_bytes().startswith(b"GIF8")
        assert film.with_suffix(".txt").read_text().strip() == copied[0].strip()

    play(scene, progress, tmp_path / "desk")


def test_a_result_that_is_left_while_its_film_is_written_is_gone_and_the_film_is_whole(
    progress: ProgressJournal, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace = prepare_workspace(tmp_path / "desk")
    result = result_of(workspace, progress)
    begun, may_end = threading.Event(), threading.Event()

    def write_slowly(card: Path, level: GameLevel, recording: Recording) -> Path:
        begun.set()
        assert may_end.wait(30.0)
        return card.rename(card.with_suffix(".whole"))

    monkeypatch.setattr(level_result, "save_film", write_slowly)

    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await screen.app.push_screen(DriveResultScreen(screen._theme, result, workspace))
        await pilot.press("y")
        await wait_until_shown(pilot, begun.is_set)
        await pilot.press("escape")
        await wait_until_shown(pilot, lambda: pilot.app.screen is screen)
        may_end.set()
        await wait_until_shown(pilot, lambda: bool(list((workspace.folder / "cards").glob("*.whole"))))
        await pilot.press("right")
        await pilot.pause()
        assert pilot.app.screen is screen

    play(scene, progress, tmp_path / "desk")


@pytest.mark.parametrize("still", [False, True])
@pytest.mark.parametrize("size", [(80, 24), (120, 36)])
def test_a_new_medal_has_a_flourish_that_any_key_ends_unless_motion_is_reduced(
    progress: ProgressJournal,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    still: bool,
    size: tuple[int, int],
) -> None:
    monkeypatch.setattr(flourish, "SPARK_INTERVAL", 3600.0)
    workspace = prepare_workspace(tmp_path / "desk")
    result = result_of(workspace, progress)
    won = replace(result, record=replace(result.record, medal=Medal.BRONZE))

    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        facts = screen._theme.terminal
        theme = replace(
            screen._theme, terminal=replace(facts, reduce_motion=replace(facts.reduce_motion, value=still))
        )
        again = replace(won, record=replace(won.record, previous_medal=Medal.BRONZE))
        await screen.app.push_screen(repeated := DriveResultScreen(theme, again, workspace))
        assert repeated._flourish.number == 0, "only once"
        dialog = DriveResultScreen(theme, won, workspace)
        await screen.app.push_screen(dialog)
        await pilot.press("w")  # still held from driving
        assert (dialog._flourish.number > 0) is not still
        foot = {80: "▀▀████▀▀", 120: "▀██████████▀"}[size[0]]
        assert foot in flat(screen.app), "the medal's disc"
        await pilot.press("x")
        assert dialog._flourish.number == 0
        assert dialog._world.visible

    play(scene, progress, tmp_path / "desk", size)


@pytest.mark.parametrize("rules", [(), tuple(ExtraRule)])
def test_rows_beside_a_small_map_show_the_speed_or_the_rungs_and_nothing_twice(
    progress: ProgressJournal, tmp_path: Path, rules: tuple[ExtraRule, ...]
) -> None:
    workspace = prepare_workspace(tmp_path / "desk")
    result = result_of(workspace, progress)
    plain = replace(result.record, rules=rules, new_rules=(), unlocked=(), belt="", following=None)

    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        dialog = DriveResultScreen(screen._theme, replace(result, record=plain), workspace)
        await screen.app.push_screen(dialog)
        await pilot.press("enter")
        await wait_until_shown(pilot, lambda: dialog._shown >= len(dialog._page.revealed))
        blank = [each for each in dialog._page.beside if not row_text(each)]
        assert len(blank) < LEAST_CURVE_ROWS
        assert flat(screen.app).count("m/s") <= 1
        assert flat(screen.app).count(" master ") == 1

    play(scene, progress, tmp_path / "desk")


def test_on_80_columns_no_key_of_the_levels_is_missing_and_the_stars_are_seen(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await wait_until_shown(pilot, lambda: "> First drive" in flat(pilot.app))
        keys = flat(pilot.app)
        keys = keys[keys.rindex("Enter") :]
        assert [word for word in ("g ", "a ", "f ", "2 ", "Esc ") if f" {word}" not in keys] == []
        assert "w replay" not in keys, "nothing was driven"
        assert all(rule.short_name(LEVELS[0]) in flat(pilot.app) for rule in ExtraRule)
        record_drive(
            progress,
            prepare_workspace(tmp_path / "desk"),
            LEVELS[0],
            DriverKind.HAND,
            [keys_drive(LEVELS[0])],
        )
        screen._refresh_after_drive(LEVELS[0])
        await wait_until_shown(pilot, lambda: "w replay" in flat(pilot.app))

    play(scene, progress, tmp_path / "desk")


@pytest.mark.parametrize("key", ["", "left"], ids=["a level", "a challenge"])
def test_an_empty_row_is_above_the_keys(progress: ProgressJournal, tmp_path: Path, key: str) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await wait_until_shown(pilot, lambda: "> First drive" in flat(pilot.app))
        await pilot.press(*([key] if key else []))
        await wait_until_shown(pilot, lambda: not key or "A free lunch" in flat(pilot.app))
        *_, last, keys = rows(pilot)
        assert not last
        assert "Esc" in keys

    play(scene, progress, tmp_path / "desk")


def test_the_day_offers_no_star_that_nobody_can_earn() -> None:
    offered = offered_rules(daily_level(today()))
    assert ExtraRule.FEW_STEPS not in offered
    assert offered_rules(LEVELS[0]) == tuple(ExtraRule)


@pytest.mark.parametrize("size", [(120, 36), (200, 50)])
def test_the_end_of_a_drive_shows_all_rungs_and_the_next_level(
    progress: ProgressJournal, tmp_path: Path, size: tuple[int, int]
) -> None:
    workspace = prepare_workspace(tmp_path / "desk")
    result = result_of(workspace, progress)
    following = result.record.following
    assert following is not None

    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        dialog = DriveResultScreen(screen._theme, result, workspace)
        await screen.app.push_screen(dialog)
        await pilot.press("enter")
        await wait_until_shown(pilot, lambda: bool(dialog._told.next_picture and dialog._told.leads))
        shown = flat(screen.app)
        assert "ahead of" in shown
        assert following.title in shown
        order = [shown.index(f" {each} ") for each in ("record", "master", "you", "silver", "bronze")]
        assert order == sorted(order), "the time stands among the rungs"
        slow = ladder_of_drive(
            result.level,
            replace(result.finish, seconds=1.0),
            result.record,
            DriverKind.HAND,
            99.0,
            is_tall=True,
        )
        assert max(map(row_width, slow)) < LADDER_COLUMNS, "nothing of it is cut"
        assert ("m/s" in shown) is (size[1] == 50)
        assert (following.hint[:20] in shown) is (size[1] == 50), "what the next level is about"

    play(scene, progress, tmp_path / "desk", size)


@pytest.mark.long
def test_a_race_of_a_program_is_seen_and_a_controller_of_the_kit_earns_nothing(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await pilot.press("right")  # the old house: shut
        await pilot.press("left", "down")
        await pilot.press("g")
        await pilot.pause()
        for key in "random_walk":
            await pilot.press(key if key != "_" else "underscore")
        await pilot.press("enter")
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, LevelDrive))
        await wait_until_shown(pilot, lambda: "random_walk drives" in flat(pilot.app))
        await pilot.press("3")
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, DriveResultScreen))
        (event,) = progress.events(EventKind.FINISH)
        assert event.content["driver"] == "program"
        assert event.content["shipped"]
        assert event.content["medal"] == 0
        await pilot.press("escape")
        await wait_until_shown(pilot, lambda: pilot.app.screen is screen)
        assert not screen._found[1].medals

    play(scene, progress, tmp_path / "desk")


@pytest.mark.long
def test_the_run_of_the_day_leads_to_its_board(
    progress: ProgressJournal, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(levels_module, "daily_level", lambda day: replace(ONE_WAY, id=f"{DAILY_PREFIX}{day}"))

    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await pilot.press("d")
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, LevelDrive))
        drive = pilot.app.screen
        assert isinstance(drive, LevelDrive)
        await wait_until_shown(pilot, lambda: drive.view is not None)
        drive.wish = "next"
        drive.dismiss()
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, LeaderboardScreen))

    play(scene, progress, tmp_path / "desk")
