"""A level while it is driven: what is drawn of the others' drives."""

from __future__ import annotations

import datetime
from pathlib import Path

import pytest
from textual.pilot import Pilot

from kit.controllers import prepare_workspace
from kit.school.game.daily import daily_level
from kit.school.game.ghosts import load_reference_ghost
from kit.school.progress import EventKind, ProgressJournal
from kit.tui.screens.level_drive import LevelDrive
from tests.tui.lesson_stage import stage, until

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
