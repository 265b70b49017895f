"""The map that the robot draws, on the screens where it drives: switched with its key, saved with the share key, drawn in fog."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from textual.pilot import Pilot

from kit.controllers import prepare_workspace
from kit.render.scene import CellState
from kit.school.game.ghosts import Ghost
from kit.school.game.race import DriverKind
from kit.school.progress import ProgressJournal
from kit.tui.screens.level_drive import LevelDrive
from kit.tui.screens.play import PlayScreen
from tests.kit_content import kit_levels
from tests.tui.lesson_stage import seen, stage, until


@pytest.mark.long
def test_a_key_shows_the_robots_map_and_another_saves_it(tmp_path: Path) -> None:
    folder = tmp_path / "home/controllers"

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, PlayScreen)
        await until(pilot, lambda: screen.view is not None, "the world")
        await pilot.press("y")
        await seen(pilot, "There is no map yet")
        await pilot.press("escape", "u")
        await until(pilot, lambda: screen.laser_cells is not None, "a first scan")
        shown = screen._newest_scene()
        assert shown.cells is not None
        assert not len(shown.walls)
        assert all(body.is_robot for body in shown.bodies)
        await pilot.press("y")
        await seen(pilot, "simple.map.png")
        assert (folder.parent / "cards/simple.map.yaml").exists()
        await pilot.press("escape", "u")
        assert screen._newest_scene().cells is None
        assert len(screen._newest_scene().walls)

    stage(lambda theme: PlayScreen(theme, "simple", "circle", folder=folder, runs=tmp_path / "runs"), scene)


@pytest.mark.long
def test_fog_shows_what_the_laser_has_seen_and_no_more(tmp_path: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    level = next(each for each in kit_levels() if each.conditions.fog)
    start = level.find_scenario().starts[0]
    ghosts = [
        Ghost(name, 1.0, (np.array([[x, y, 0.0]]),), 0.01)
        for name, (x, y) in (("reference", level.targets[0]), ("hand", (start.x + 0.3, start.y)))
    ]

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, LevelDrive)
        await until(pilot, lambda: screen.view is not None, "the world")
        before = screen._newest_scene()
        assert before.cells is not None
        assert not before.cells.states.any()
        assert not len(before.walls)
        await pilot.press("w")
        await until(pilot, lambda: screen.laser_cells is not None, "a first scan")
        cells = screen._newest_scene().cells
        assert cells is not None
        known = np.bincount(cells.states.ravel(), minlength=3) / cells.states.size
        assert known[CellState.OCCUPIED] > 0.0
        assert known[CellState.UNKNOWN] > 0.3
        assert [mark.label for mark in screen._newest_scene().marks] == ["K"], "no ghost on unseen floor"

    with ProgressJournal(workspace.folder) as journal:
        stage(
            lambda theme: LevelDrive(theme, level, ghosts, journal, workspace, driver=DriverKind.HAND), scene
        )
