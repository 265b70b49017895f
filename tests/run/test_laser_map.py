"""The map that a robot draws with its laser: what lesson 40 teaches, what the drawing knows of a world, and its files."""

from __future__ import annotations

import math
import runpy
from pathlib import Path

import numpy as np
import pytest
import yaml
from PIL import Image

from kit.fields.occupancy_grid import occupancy_grid_of
from kit.geometry import Pose
from kit.kernels.lidar_index import make_beams
from kit.render.scene import CellState, SceneBounds, SceneCells
from kit.run.episode import run_until
from kit.run.laser_map import LaserMap, LaserMapper, save_laser_map
from kit.run.scenario import find_scenario
from kit.run.session import Session
from kit.sim.state import LatestScan
from tests.world.picture_walls import walls_from_image

LESSON = Path(__file__).parents[2] / "lessons/40-where-am-i/grid/reference.py"


def scan(ranges: list[float], directions: list[float], pose: Pose = Pose(0.02, 0.02, 0.0)) -> LatestScan:
    return LatestScan(
        "robot", "laser", pose, make_beams(tuple(directions)), np.array(ranges, np.float32), 0.5
    )


def test_one_ray_changes_the_cells_as_lesson_40_says() -> None:
    lesson = runpy.run_path(str(LESSON))
    drawn = LaserMap(SceneBounds(0.2, 0.2, 0.8, 0.2))  # from 0 to 1 m, from 0 to 0.4 m
    rows, columns = drawn.log_odds.shape
    taught = [[0.0] * columns for _ in range(rows)]
    for _ in range(6):  # until the limit holds
        drawn.add(scan([0.3], [0.0]))
        taught = lesson["updated"](taught, [[0, column] for column in range(8)], [0, 8])
        assert np.allclose(drawn.log_odds, taught)
    assert drawn.probabilities[0, 8] == pytest.approx(lesson["probability"](taught[0][8]))


def test_a_ray_that_meets_nothing_only_frees_cells() -> None:
    drawn = LaserMap(SceneBounds(0.2, 0.2, 0.8, 0.2))
    drawn.add(scan([math.nan], [0.0]))
    assert drawn.log_odds.max() == 0.0
    assert np.flatnonzero(drawn.log_odds[0]).tolist() == list(
        range(14)
    )  # its range is 0.5 m: cells of 0.04 m


def test_what_moved_away_is_forgotten() -> None:
    drawn = LaserMap(SceneBounds(0.2, 0.2, 0.8, 0.2))
    for _ in range(50):
        drawn.add(scan([0.3], [0.0]))
    assert drawn.cells.states[0, 8] == CellState.OCCUPIED
    for _ in range(20):
        drawn.add(scan([0.45], [0.0]))
    assert drawn.cells.states[0, 8] == CellState.FREE


def drive(seconds: float, place: str = "simple") -> tuple[Session, list[SceneCells]]:
    scenario = find_scenario(place)
    session, seen = Session(scenario, always_scan=True), []
    session.runner.observers.append(LaserMapper(scenario.world, scenario.partners, seen.append))
    with session:
        run_until(session.runner, limit_s=seconds)
    return session, seen


def test_a_robot_draws_the_walls_that_it_sees_and_no_others(tmp_path: Path) -> None:
    session, seen = drive(1.0)
    assert 5 <= len(seen) <= 21  # at most every 50 ms, however often the laser scans
    cells, truth = seen[-1], occupancy_grid_of(session.scenario.world)
    rows, columns = np.nonzero(cells.states == CellState.OCCUPIED)
    assert len(rows) > 50
    x, y = (
        cells.origin[0] + (columns + 0.5) * cells.cell_size,
        cells.origin[1] + (rows + 0.5) * cells.cell_size,
    )
    away = [truth.clearance[truth.cell_at(*place)] for place in zip(x.tolist(), y.tolist(), strict=True)]
    assert np.quantile(away, 0.9) < 2 * cells.cell_size
    assert (cells.states == CellState.UNKNOWN).any()
    assert (cells.states == CellState.FREE).sum() > len(rows)

    saved = save_laser_map(cells, tmp_path / "cards", "simple")
    about = yaml.safe_load(saved.layer.read_text())
    levels = np.array(Image.open(saved.image))
    assert (levels[::-1] == 0).sum() == len(rows)
    assert set(np.unique(levels)) == {0, 205, 254}
    assert about["origin"] == pytest.approx([*cells.origin, 0])
    walls = walls_from_image(
        saved.image,
        resolution=about["resolution"],
        occupied_thresh=about["occupied_thresh"],
    )
    assert len(walls)  # as a layer of a world it has walls, where it was drawn


def test_a_world_that_begins_again_is_drawn_again() -> None:
    scenario = find_scenario("simple")
    session, seen = Session(scenario, always_scan=True), []
    session.runner.observers.append(LaserMapper(scenario.world, scenario.partners, seen.append))
    with session:
        run_until(session.runner, limit_s=0.3)
        fresh, count = seen[0].states, len(seen)
        assert (seen[-1].states != fresh).any()  # noise is drawn too
        session.reset()
        run_until(session.runner, limit_s=0.1)
    assert (seen[count].states == fresh).all()
