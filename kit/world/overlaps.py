"""Refuses a world of which so much lies on top of itself that the physics engine would take minutes to build it or to step it.

The engine keeps walls and footprints in trees of bounding boxes. Where thousands of boxes overlap, a tree is no more than a
list, and every pair of footprints is a contact.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from kit.arrays import FloatArray
from kit.world.records import Circle, Layer, Model
from kit.world.yaml_section import Section

MAX_BODIES: Final = 10_000
"""Bodies of a world's models."""
MAX_WALL_PAIRS: Final = 20_000_000
"""Pairs of walls whose boxes overlap. With as many it takes about a second to build the engine's tree; a checkerboard of as
many pixels as a picture may have is one of them."""
MAX_TOUCHED_WALLS: Final = 100_000
"""Pairs of a footprint and a wall whose boxes overlap."""
MAX_FOOTPRINT_PAIRS: Final = 20_000
"""Pairs of footprints whose boxes overlap. With as many contacts a step takes about 50 ms."""
SAMPLE: Final = 256
"""Boxes that are compared with all others: of more, as many are drawn."""


def note_overlaps(section: Section, layers: Sequence[Layer], models: Sequence[Model]) -> None:
    """Notes, in a world's own section, what overlaps too often. The world need not be complete."""
    walls = _boxes_of_segments(layers)
    if (pairs := _pairs(walls, walls, MAX_WALL_PAIRS)) > MAX_WALL_PAIRS:
        section.error(
            f"about {pairs:,} pairs of walls overlap, but at most {MAX_WALL_PAIRS:,} may: is a line written many times?",
            "layers",
        )
    if (count := sum(len(model.bodies) for model in models)) > MAX_BODIES:
        section.error(f"its models have {count:,} bodies, but at most {MAX_BODIES:,} are simulated", "models")
        return
    footprints = np.array(list(_boxes_of_footprints(models)), dtype=float).reshape(-1, 4)
    if (pairs := _pairs(footprints, footprints, MAX_FOOTPRINT_PAIRS)) > MAX_FOOTPRINT_PAIRS:
        section.error(
            f"about {pairs:,} pairs of footprints overlap at the start, but at most {MAX_FOOTPRINT_PAIRS:,} may: give each "
            "model a place of its own",
            "models",
        )
    if (pairs := _pairs(footprints, walls, MAX_TOUCHED_WALLS)) > MAX_TOUCHED_WALLS:
        section.error(
            f"about {pairs:,} pairs of a footprint and a wall overlap at the start, but at most {MAX_TOUCHED_WALLS:,} may",
            "models",
        )


def _pairs(first: FloatArray, second: FloatArray, limit: int) -> int:
    """About how many boxes of ``first`` overlap one of ``second``, each pair of two different boxes once; 0 where there cannot be
    more than ``limit``.

    Which boxes are looked at depends on all of them, so that no world can be made whose looked-at boxes are others than it has.
    """
    all_pairs = len(first) * len(second)
    if all_pairs <= limit:
        return 0
    seed = zlib.crc32(first.tobytes())
    drawn = (
        first if len(first) <= SAMPLE else np.random.default_rng(seed).choice(first, SAMPLE, replace=False)
    )
    left, bottom, right, top = second.T
    count = sum(
        np.count_nonzero((left <= each[2]) & (right >= each[0]) & (bottom <= each[3]) & (top >= each[1]))
        for each in drawn
    )
    found = round(count * len(first) / len(drawn))
    return (found - len(first)) // 2 if first is second else found


def _boxes_of_segments(layers: Sequence[Layer]) -> FloatArray:
    """(n, 4) ``left bottom right top`` [m] of all walls."""
    segments = [layer.walls.segments for layer in layers if layer.walls is not None]
    ends = np.concatenate(segments or [np.empty((0, 4))]).reshape(-1, 2, 2)
    return np.concatenate((ends.min(axis=1), ends.max(axis=1)), axis=1)


def _boxes_of_footprints(models: Sequence[Model]) -> Iterator[tuple[float, float, float, float]]:
    for model in models:
        for body in model.bodies:
            pose = model.pose.compose(body.pose)
            for shape in (footprint.shape for footprint in body.footprints):
                points, radius = (
                    ((shape.center,), shape.radius) if isinstance(shape, Circle) else (shape.points, 0.0)
                )
                if points:  # a footprint that is refused has none
                    x, y = zip(*(pose.transform_point(*point) for point in points), strict=True)
                    yield min(x) - radius, min(y) - radius, max(x) + radius, max(y) + radius
