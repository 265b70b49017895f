"""Arrays that belong together, under one name: what the compiled loops of ``kit.kernels.kernels`` take."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]


class Segments(NamedTuple):
    """Walls, sorted into blocks of neighbours, each within a disc; made by ``kit.kernels.lidar_index.in_blocks``."""

    ends: Floats
    """(n, 4) ``x1 y1 x2 y2`` in world coordinates."""
    starts: Integers
    """(blocks + 1): block k is ``ends[starts[k]:starts[k + 1]]``."""
    discs: Floats
    """(blocks, 3) ``x y radius``, each containing its block."""


class Shapes(NamedTuple):
    """Circles and convex polygons, in world coordinates or in those of their bodies, and their layer bits."""

    circles: Floats
    """(circles, 3) ``x y radius``."""
    circle_bits: Integers
    corners: Floats
    """(corners, 2), polygon after polygon, counter-clockwise."""
    starts: Integers
    """(polygons + 1): polygon k is ``corners[starts[k]:starts[k + 1]]``."""
    polygon_bits: Integers


class Beams(NamedTuple):
    """The directions of a lidar's rays in its own frame; made by ``kit.kernels.lidar_index.beams``.

    Rays in opposite directions lie on one line, and what a wall does to one of them is known from the other.
    """

    cos: Singles
    """(rays,)"""
    sin: Singles
    """(rays,)"""
    lines: Singles
    """(2, lines): cos and sin of the lines. Whole vectors are faster: the last lines may point nowhere."""
    runs: Integers
    """(runs, 4): rays from ``first`` to before ``end`` lie along (0) or against (1) the lines from ``line`` on."""


class Gaze(NamedTuple):
    """A scan in the making."""

    lines: Singles
    """(2, lines): cos and sin of the lines, in the world."""
    near: Singles
    """(2, lines): 1 / distance of the nearest thing so far along them, and, below 0, against them."""
    room: Singles
    """As large, to work in."""
    aimed: Singles
    """(5, AIMED): segments as they are seen from the sensor, and their scales."""


class Views(NamedTuple):
    """Which walls can be seen from where: maps in square cells; made by ``kit.kernels.lidar_index.views``."""

    ends: Floats
    """(n, 4) ``x1 y1 x2 y2``: the walls of each view, view after view."""
    starts: Integers
    """(views + 1): view k is ``ends[starts[k]:starts[k + 1]]``."""
    of_cell: Integers
    """(cells): the view that holds all that can be seen from anywhere in a cell."""
    corners: Floats
    """(maps, 2) ``x y`` of the first cell's lower left corner."""
    grids: Integers
    """(maps, 3): number of the first cell, columns, rows; cells go row by row. No rows: there is no view."""
    cell: float
    """Its side [m]."""


class Fleet(NamedTuple):
    """What the worlds of a batch share: the walls of their maps, and the robots' hulls and lidars."""

    walls: Segments
    """Of all maps, one after the other."""
    blocks: Integers
    """(maps + 1): map m has the blocks ``blocks[m]:blocks[m + 1]``."""
    views: Views
    hulls: Shapes
    """Polygons in their robots' own frames; those of robot k are on layer bit ``1 << k``."""
    sight: Integers
    """(polygons): the same bits, 0 for a polygon that no lidar sees."""
    robot_of: Integers
    """(corners): whose corner it is."""
    radius: float
    """No hull reaches farther from its robot's origin [m]."""
    beams: Beams
    reach: float
    """The lidars' [m]."""
    noise: float
    """Standard deviation of the noise on every range [m]."""
