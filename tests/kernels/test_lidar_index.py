"""What makes a lidar fast: it may change nothing of what is seen."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kit.kernels import kernels
from kit.kernels.arrays import LANES
from kit.kernels.lidar_index import CELL_SIZE, make_beams, make_visibility_cells, make_wall_blocks
from kit.learning.maps.batch_map import FEW_WALLS, load_batch_map
from kit.world.catalogue import find_map
from tests.cases import every_case
from tests.kernels import scans

AUTHORS = [-3.14159265359 + i * 0.06981317007 for i in range(91)]
"""As the dissertation's robot has them: not quite opposite."""


@every_case(
    ("directions", "lines"),
    [
        (AUTHORS, 45),
        (np.linspace(-math.pi, math.pi, 360, endpoint=False), 180),
        (np.linspace(-2.0, 2.0, 33), 33),
        ([0.3] * 5, 1),
        ([1.0, 1.0 + math.pi, 1.0 - math.pi, 4 * math.pi + 1.0], 1),
        ([0.0], 1),
    ],
)
def test_opposite_rays_share_a_line(directions: list[float], lines: int) -> None:
    made = make_beams(directions)
    assert np.isfinite(made.lines[0]).sum() == lines
    assert made.lines.shape[1] % LANES == 0
    told = np.full((2, len(directions)), np.nan)
    for first, end, against, line in made.ray_runs:
        told[:, first:end] = (-1) ** against * made.lines[:, line : line + end - first]
    angles = np.array(directions)
    assert told == pytest.approx(np.array([np.cos(angles), np.sin(angles)]), abs=1e-7)
    assert np.array([made.cos, made.sin]) == pytest.approx(
        np.array([np.cos(angles), np.sin(angles)]), abs=1e-7
    )


def test_a_lidar_without_rays_has_no_lines() -> None:
    assert make_beams([]).lines.shape == (2, 0)


@pytest.mark.parametrize("name", ["slalom", "hall_curve_180", "hall_two_doors", "turn", "maze"])
def test_what_a_view_leaves_out_cannot_be_seen(name: str) -> None:
    walls = load_batch_map(find_map(name)).walls if name != "maze" else _maze()
    made, rays = (
        make_visibility_cells([None, walls]),
        make_beams(np.linspace(-math.pi, math.pi, 720, endpoint=False)),
    )
    nothing = kernels.Shapes(
        *(np.zeros((0, 3)), np.zeros(0, dtype=np.int64), np.zeros((0, 2))),
        *(np.zeros(1, dtype=np.int64), np.zeros(0, dtype=np.int64)),
    )
    points, chance, fewer = walls.reshape(-1, 2), np.random.default_rng(1), 0
    for x, y in chance.uniform(points.min(axis=0), points.max(axis=0), (150, 2)):
        column, row = (int(v) for v in ((x, y) - made.map_corners[1]) // CELL_SIZE)
        view = made.view_of_cell[made.map_grids[1, 0] + row * made.map_grids[1, 1] + column]
        some = made.ends[made.starts[view] : made.starts[view + 1]]
        fewer += len(walls) - len(some)
        seen = []
        for each in (walls, some):
            ranges = np.empty(720, dtype=np.float32)
            scans.scan((x, y, 0.1), rays, 50.0, make_wall_blocks(each, FEW_WALLS), nothing, 1, ranges)
            seen.append(ranges)
        assert seen[0].tobytes() == seen[1].tobytes()
    assert fewer > 0


def _maze() -> np.ndarray:
    """Many short walls that meet at corners, on a grid."""
    chance = np.random.default_rng(3)
    walls = [(x, y, x + 1, y) for x in range(7) for y in range(7) if chance.random() < 0.5]
    walls += [(x, y, x, y + 1) for x in range(7) for y in range(7) if chance.random() < 0.5]
    return np.array(walls, dtype=np.float64)


def test_a_map_may_have_no_views() -> None:
    made = make_visibility_cells([None, np.zeros((0, 4)), np.array([(0.0, 0.0, 1.0, 0.0)])])
    assert made.map_grids[:, 2].tolist() == [0, 0, 1]
    assert made.map_grids[2].tolist() == [0, 5, 1]
    assert made.ends.tolist() == [[0.0, 0.0, 1.0, 0.0]]
