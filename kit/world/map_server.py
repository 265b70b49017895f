"""How ROS's map_server reads a map's picture, and in how many pixels that differs from Flatland's reading, the kit's.

Flatland knows ``occupied_thresh`` alone, as a brightness: a pixel is a wall below this share of white. map_server compares
an occupancy with it, and knows ``free_thresh``, ``negate`` and ``mode`` besides: the same file may mean other walls to it.
Source: nav2_map_server, ``map_io.cpp`` (loadMapYaml, loadMapFromFile).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Literal

import numpy as np

from kit.arrays import BoolArray, IntArray, Uint8Array

OCCUPIED: Final = 100
FREE: Final = 0
UNKNOWN: Final = -1

MapMode = Literal["trinary", "scale", "raw"]
MODES: Final[Mapping[str, MapMode]] = MappingProxyType({"trinary": "trinary", "scale": "scale", "raw": "raw"})


FREE_THRESH: Final = 0.25
"""Where the YAML has none: what nav2's map saver writes."""


@dataclass(frozen=True, slots=True)
class MapServerKeys:
    """What a map's YAML says to map_server."""

    occupied_thresh: float
    free_thresh: float = FREE_THRESH
    """A cell is free below this occupancy."""
    negate: bool = False
    """Whether light pixels are occupied."""
    mode: MapMode = "trinary"


def occupancy(grey: Uint8Array, alpha: Uint8Array | None, keys: MapServerKeys) -> IntArray:
    """The cells that map_server publishes, of the shape of ``grey``: 0 free to 100 occupied, -1 unknown.

    ``grey``: a pixel's brightness, for which map_server takes the mean of its colours; ``alpha``: its opacity, if the
    picture has any. In the mode "trinary" opacity counts as a fourth colour, so that nothing in such a picture is quite black.
    """
    levels = grey.astype(np.float64)
    if keys.mode == "raw":
        return np.where(levels <= OCCUPIED, levels, UNKNOWN).astype(np.int64)
    if keys.mode == "trinary" and alpha is not None:
        levels = (3 * levels + alpha) / 4
    shade = levels / 255
    occupied = shade if keys.negate else 1 - shade
    if keys.mode == "scale":
        between = np.rint(
            (occupied - keys.free_thresh) / max(1e-9, keys.occupied_thresh - keys.free_thresh) * OCCUPIED
        )
    else:
        between = np.full(occupied.shape, UNKNOWN)
    cells = np.where(occupied < keys.free_thresh, FREE, between)
    cells = np.where(occupied > keys.occupied_thresh, OCCUPIED, cells)
    if keys.mode == "scale" and alpha is not None:
        cells = np.where(alpha < 255, UNKNOWN, cells)
    return cells.astype(np.int64)


def count_read_otherwise(
    is_wall: BoolArray, grey: Uint8Array, alpha: Uint8Array | None, keys: MapServerKeys
) -> int:
    """The number of pixels that are a wall here and free to map_server, or none here and occupied to it."""
    levels, opacities = np.arange(256, dtype=np.uint8), np.arange(1 if alpha is None else 256, dtype=np.uint8)
    shades, clear = np.meshgrid(levels, opacities)
    # What each pair of brightness and opacity means: pictures have millions of pixels.
    cells = occupancy(shades, None if alpha is None else clear, keys).astype(np.int8)[
        0 if alpha is None else alpha, grey
    ]
    return int(np.count_nonzero(np.where(is_wall, cells == FREE, cells == OCCUPIED)))
