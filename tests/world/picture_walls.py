"""The walls of a picture alone, without a map file."""

from __future__ import annotations

from pathlib import Path

from kit.arrays import FloatArray
from kit.world.layer_reader import dark_pixels, read_image, trace_edges


def walls_from_image(file: Path, *, resolution: float, occupied_thresh: float) -> FloatArray:
    """The walls (n, 4) ``x1 y1 x2 y2`` [m] of a picture whose lower left corner is the origin.

    ``resolution``: metres per pixel; ``occupied_thresh``: a pixel is dark below this share of white. Raises UnusableFile.
    """
    return trace_edges(dark_pixels(read_image(file)[0], occupied_thresh), resolution)
