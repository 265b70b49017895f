"""A level while it is driven: what is drawn of the others' drives."""

from __future__ import annotations

import datetime
from pathlib import Path

import pytest
from textual.pilot import Pilot

from kit.controllers import prepare_workspace
from kit.document.rows import row
from kit.school.game.daily import daily_level
from kit.school.game.ghosts import load_reference_ghost
from kit.school.game.levels import find_level
from kit.school.game.medal import RUNGS
from kit.school.game.player_progress import ExtraRule
from kit.school.progress import EventKind, ProgressJournal
from kit.tui.app import KitApp
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.level_drive import LevelDrive
from kit.tui.textual_patches import FITTING_S
from tests.tui.lesson_stage import seen, stage, text, until
from tests.tui.screens.test_dialog import row_of, shown_cells

DAYS = (datetime.date(2026, 3, day) for day in range(1, 29))
CLEAR = next(level for level in map(daily_level, DAYS) if not level.conditions.fog)


@pytest.mark.parametrize("has_run", [False, True])
def test_the_way_through_a_days_maze_is_drawn_after_the_first_run(tmp_path: Path, has_run: bool) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    reference = load_reference_ghost(CLEAR)
    assert reference is not None

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, LevelDrive)
        await until(pilot, lambda: screen.view is not None, "the world")
        shown = screen._newest_scene()
        assert bool(shown.paths) is has_run
        assert [each.label for each in shown.marks] == ["R"]

    with ProgressJournal(workspace.folder) as journal:
        if has_run:
            content = {"driver": "keys", "reached": False, "seconds": 60.0, "bumps": 0, "medal": 0}
            journal.add(EventKind.FINISH, CLEAR.id, content)
        stage(lambda theme: LevelDrive(theme, CLEAR, [reference], journal, workspace), scene)


@pytest.mark.parametrize("size", [(120, 35), (200, 50)])
def test_the_card_of_a_level_has_room_for_all_its_parts_beside_the_picture(
    tmp_path: Path, size: tuple[int, int]
) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    level = find_level("first-drive")

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, level.skill)
        page = text(pilot)
        assert "── robot" in page
        for told in (level.story, level.hint, level.skill, *(each.title for each in RUNGS)):
            assert told in page
        for rule in ExtraRule:
            assert rule.description(level) in page

    with ProgressJournal(workspace.folder) as journal:
        stage(lambda theme: LevelDrive(theme, level, [], journal, workspace), scene, size=size)


def test_a_drive_behind_a_dialog_is_fitted_to_a_terminal_that_is_resized(tmp_path: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    level = find_level("first-drive")

    async def scene(pilot: Pilot[None]) -> None:
        app = pilot.app
        assert isinstance(app, KitApp)
        await seen(pilot, "front")
        await pilot.pause(2.0 * FITTING_S)
        app.push_screen(MessageDialog("Title", [row("what is asked")]))
        await seen(pilot, "what is asked")
        await pilot.resize_terminal(120, 35)
        await until(pilot, lambda: any("── robot" in row_of(line) for line in shown_cells(app)), "the panel")

    with ProgressJournal(workspace.folder) as journal:
        stage(lambda theme: LevelDrive(theme, level, [], journal, workspace), scene, size=(80, 24))
