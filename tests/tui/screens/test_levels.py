"""The map of levels and a drive on one: what is open, what a drive earns, which ghosts drive along."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterator
from pathlib import Path

import pytest
from textual.app import App
from textual.pilot import Pilot

from kit.controllers import prepare_workspace
from kit.school.game import leaderboard
from kit.school.game.levels import all_levels
from kit.school.progress import EventKind, ProgressJournal
from kit.tui.app import KitApp
from kit.tui.rows import level_rows
from kit.tui.screens.level_drive import DriveResultDialog, LevelDrive
from kit.tui.screens.levels import LevelsScreen
from kit.tui.screens.message_dialog import MessageDialog
from kit.tui.terminal import TerminalFacts, TerminalOptions, decide
from tests.waiting import wait_until_shown

Scene = Callable[[LevelsScreen, Pilot[None]], Awaitable[None]]
LEVELS = all_levels()


@pytest.fixture
def progress(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[ProgressJournal]:
    monkeypatch.setenv(leaderboard.FOLDER_VARIABLE, str(tmp_path / "hall"))
    with ProgressJournal(tmp_path) as opened:
        yield opened


def play(scene: Scene, progress: ProgressJournal, folder: Path) -> None:
    async def run() -> None:
        terminal = decide(
            {"TERM": "xterm-256color", "LANG": "C.UTF-8"}, TerminalFacts.here(), TerminalOptions()
        )
        app: App[None] = KitApp(terminal)
        async with app.run_test(size=(80, 24)) as pilot:
            assert isinstance(app, KitApp)
            screen = LevelsScreen(app.kit_theme, progress, prepare_workspace(folder))
            await app.push_screen(screen)
            await pilot.pause()
            await scene(screen, pilot)

    asyncio.run(run())


def flat(app: App[None]) -> str:
    rows = ("".join(segment.text for segment in strip) for strip in app.screen._compositor.render_strips())
    return " ".join(" ".join(rows).split())


@pytest.mark.long
def test_every_level_is_on_the_map_and_the_shut_ones_say_what_opens_them(
    progress: ProgressJournal, tmp_path: Path
) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        grid = level_rows.grid(screen._found)
        assert sorted(number for row in grid for number in row) == list(range(len(LEVELS)))
        assert 2 * len(grid) - 1 <= 24 - 7  # with the heading, what is told below, and the keys
        assert max(map(len, grid)) * level_rows.CELL[0] <= level_rows.WIDTH
        await pilot.press("down")
        assert not screen.chosen.is_open
        assert LEVELS[0].title in flat(pilot.app) or LEVELS[0].id in flat(pilot.app)
        await pilot.press("enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, MessageDialog)

    play(scene, progress, tmp_path / "desk")


@pytest.mark.long
def test_a_drive_earns_stars_and_leaves_a_ghost(progress: ProgressJournal, tmp_path: Path) -> None:
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
            return isinstance(pilot.app.screen, DriveResultDialog)

        await wait_until_shown(pilot, drives)
        (event,) = progress.events(EventKind.FINISH)
        assert event.content["reached"]
        assert event.content["bumps"] == 0
        await pilot.press("up")
        assert isinstance(pilot.app.screen, DriveResultDialog)
        await pilot.press("enter")
        await pilot.pause()
        await pilot.press("escape")
        await wait_until_shown(pilot, lambda: pilot.app.screen is screen)
        assert screen._found[0].star_count >= 2
        assert screen._found[2].is_open

    play(scene, progress, tmp_path / "desk")


@pytest.mark.long
def test_a_program_races(progress: ProgressJournal, tmp_path: Path) -> None:
    async def scene(screen: LevelsScreen, pilot: Pilot[None]) -> None:
        await pilot.press("g")
        await pilot.pause()
        for key in "abreast":
            await pilot.press(key)
        await pilot.press("enter")
        await wait_until_shown(pilot, lambda: isinstance(pilot.app.screen, MessageDialog))
        assert progress.events(EventKind.FINISH)[0].content["driver"] == "controller"

    play(scene, progress, tmp_path / "desk")
