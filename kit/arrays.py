"""Arrays that belong together, under one name: what the compiled loops of ``kit.kernels`` take."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]


class Segments(NamedTuple):
    """Walls, sorted into blocks of neighbours, each within a disc; made by ``kit.blocks.in_blocks``."""

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
    """The directions of a lidar's rays in its own frame, ``(rays,)`` each."""

    cos: Singles
    sin: Singles


class Fleet(NamedTuple):
    """What the worlds of a batch share: the walls of their maps, and the robots' hulls and lidars."""

    walls: Segments
    """Of all maps, one after the other."""
    blocks: Integers
    """(maps + 1): map m has the blocks ``blocks[m]:blocks[m + 1]``."""
    hulls: Shapes
    """Polygons in their robots' own frames; those of robot k are on layer bit ``1 << k``."""
    sight: Integers
    """(polygons): the same bits, 0 for a polygon that no lidar sees."""
    robot_of: Integers
    """(corners): whose corner it is."""
    radius: float
    """No hull reaches farther from its robot's origin [m]."""
    beams: Beams
    """Whole vectors of rays are faster: those after the lidar's own point nowhere, and meet nothing."""
    reach: float
    """The lidars' [m]."""
    noise: float
    """Standard deviation of the noise on every range [m]."""
