"""The map that a robot draws itself: an occupancy grid in log odds, from its laser's scans (Moravec and Elfes 1985).

Every scan is laid into the grid where the laser truly was: this is mapping with known poses, as in lesson 40.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Final

import numpy as np
from PIL import Image

from kit.arrays import Float32Array, FloatArray
from kit.fields.occupancy_grid import MAX_CELLS
from kit.render import raster
from kit.render.scene import CellState, SceneBounds, SceneCells
from kit.run.lockstep import Observer
from kit.sim.simulation import Simulation
from kit.sim.state import LatestScan
from kit.workspace import write_atomically
from kit.world.records import World

HIT: Final = 0.9
"""Log odds that a cell gains where a ray ends."""
PASSED: Final = -0.4
"""Log odds that a cell gains where rays only pass."""
LIMIT: Final = 4.0
"""Log odds go no further than this on either side, so that what moved away is forgotten."""

OCCUPIED: Final = 0.65
"""Probability from which on a cell is occupied, as ROS's map_saver has it."""
FREE: Final = 0.45
"""Probability up to which it is free; one scan is enough."""

CELL: Final = 0.04
"""Side of a cell [m], on maps that are not too large for it."""
MARGIN: Final = 0.2
"""Margin of the grid around the walls [m]."""
SCAN_INTERVAL: Final = 0.05
"""Seconds of simulated time between two scans that are laid into the grid; a laser may scan far more often."""


class LaserMap:
    """Square cells with the log odds that something is there, (rows, columns), row 0 at the bottom; 0 is unknown."""

    def __init__(self, bounds: SceneBounds) -> None:
        """Covers ``bounds`` [m] and a margin around it."""
        width, height = bounds.width + 2 * MARGIN, bounds.height + 2 * MARGIN
        self.cell_size = max(CELL, math.sqrt(width * height / MAX_CELLS))
        self.origin = bounds.left - MARGIN, bounds.bottom - MARGIN
        shape = math.ceil(height / self.cell_size), math.ceil(width / self.cell_size)
        self.log_odds: FloatArray = np.zeros(shape)

    def add(self, scan: LatestScan) -> None:
        """Lays a scan into the grid. A cell counts once in a scan: as occupied where a ray ends in it, else as passed."""
        angles = scan.pose.theta + np.arctan2(scan.beams.sin, scan.beams.cos)
        has_hit = ~np.isnan(scan.ranges)
        ranges = np.where(has_hit, scan.ranges, scan.max_range).astype(np.float64)
        ends = np.column_stack((np.cos(angles), np.sin(angles))) * ranges[:, None] + scan.pose[:2]
        rows, columns = self.log_odds.shape
        end_dots = (ends - self.origin) / self.cell_size
        start_dots = (np.array(scan.pose[:2]) - self.origin) / self.cell_size
        passed, hit = (np.zeros(self.log_odds.shape, dtype=np.bool_) for _ in range(2))
        rays = np.column_stack((np.broadcast_to(start_dots, end_dots.shape), end_dots))
        passed[raster.line_dots(rays, columns, rows)] = True
        hit[raster.point_dots(end_dots[has_hit], columns, rows)] = True
        self.log_odds += np.where(hit, HIT, np.where(passed, PASSED, 0.0))
        np.clip(self.log_odds, -LIMIT, LIMIT, out=self.log_odds)

    def clear(self) -> None:
        """Forgets everything."""
        self.log_odds[:] = 0.0

    @property
    def probabilities(self) -> FloatArray:
        """(rows, columns): how likely each cell is occupied; 0.5 is unknown."""
        return 1.0 / (1.0 + np.exp(-self.log_odds))

    @property
    def cells(self) -> SceneCells:
        """What is known by now, to draw; later scans do not change it."""
        states = np.full(self.log_odds.shape, np.uint8(CellState.UNKNOWN))
        states[self.log_odds <= math.log(FREE / (1.0 - FREE))] = CellState.FREE
        states[self.log_odds >= math.log(OCCUPIED / (1.0 - OCCUPIED))] = CellState.OCCUPIED
        return SceneCells(states, self.origin, self.cell_size)


class LaserMapper(Observer):
    """Draws one map from the scans of some robots, in the world's thread; a world that begins again, a new one."""

    def __init__(
        self, world: World, models: Sequence[str], on_change: Callable[[SceneCells], object]
    ) -> None:
        """``models``: whose lasers draw. ``on_change``: called with what is known after every scan."""
        self._map = LaserMap(world_bounds(world))
        self._models = frozenset(models)
        self._on_change = on_change
        self._known: dict[tuple[str, str], Float32Array] = {}
        self._last_tick = 0
        self._next_ns = 0

    def on_step(self, simulation: Simulation) -> None:
        if simulation.tick < self._last_tick:  # it was reset
            self._map.clear()
            self._next_ns = 0
        self._last_tick = simulation.tick
        if simulation.time_ns < self._next_ns:
            return
        self._next_ns = simulation.time_ns + round(SCAN_INTERVAL * 1e9)
        has_news = False
        for scan in simulation.latest_scans():
            laser = scan.model, scan.plugin
            if scan.model in self._models and self._known.get(laser) is not scan.ranges:
                self._known[laser] = scan.ranges
                self._map.add(scan)
                has_news = True
        if has_news:
            self._on_change(self._map.cells)


def world_bounds(world: World) -> SceneBounds:
    """The rectangle around a world's walls; where it has none, 10 m around its models."""
    walls = world.wall_segments
    if len(walls):
        points = walls.reshape(-1, 2)
        around = 0.0
    else:
        points, around = np.array([model.pose[:2] for model in world.models] or [(0.0, 0.0)]), 10.0
    (left, bottom), (right, top) = points.min(axis=0) - around, points.max(axis=0) + around
    return SceneBounds(float(left), float(bottom), float(right), float(top))


@dataclass(frozen=True, slots=True)
class SavedLaserMap:
    """The files of a map that was saved."""

    image: Path
    layer: Path
    """The YAML file that a world's layer names; ROS's map_server reads it too."""


def save_laser_map(cells: SceneCells, folder: Path, name: str) -> SavedLaserMap:
    """Writes a map as ROS's map_saver does: free white, unknown grey, occupied black. Raises OSError."""
    folder.mkdir(parents=True, exist_ok=True)
    image, layer = folder / f"{name}.map.png", folder / f"{name}.map.yaml"
    levels = np.array([205, 254, 0], dtype=np.uint8)[cells.states[::-1]]
    data = BytesIO()
    Image.fromarray(levels).save(data, "PNG")
    write_atomically(image, data.getvalue())
    x, y = cells.origin
    text = (
        f"image: {image.name}\nmode: trinary\nresolution: {cells.cell_size:.6g}\norigin: [{x:.6g}, {y:.6g}, 0]\n"
        f"negate: 0\noccupied_thresh: {OCCUPIED}\nfree_thresh: 0.196\n"
    )
    write_atomically(layer, text.encode())
    return SavedLaserMap(image, layer)
