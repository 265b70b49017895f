"""What the questions on photographs ask, worked out by the references of the lesson's exercises and by the kit's own map."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np

from kit.fields.occupancy_grid import OccupancyGrid
from kit.mapmaking.route import widest_route
from kit.school.lessons.reading import lessons_folder
from kit.school.quiz.items import QuizItem
from tests.kit_content import lesson_reference
from tests.school.quiz.derived.finding import Derivation, Finding, nearest

LESSON = lessons_folder() / "35-photo-to-map"


photo_reference = partial(lesson_reference, LESSON.name)


def wall_of_pixels(item: QuizItem, folder: Path) -> Finding:
    return nearest(item, 150 * photo_reference("strokes").resolution(4.0, 1000), 0.001)


def below_one_limit(item: QuizItem, folder: Path) -> Finding:
    light = {"paper": 220, "stroke": 110, "shadow": 110, "stroke in the shadow": 55}
    walls = frozenset(name for name, value in light.items() if value < 128)
    strokes = frozenset({"stroke", "stroke in the shadow"})
    return Finding(
        walls,
        {
            "The strokes alone": strokes,
            "Strokes and shadow": strokes | {"shadow"},
            "The shadow alone": frozenset({"shadow"}),
        },
    )


def joined_runs(item: QuizItem, folder: Path) -> Finding:
    joined = photo_reference("strokes").joined([each == "#" for each in "##.##...##"], 2)
    text = "".join("#" if each else "." for each in joined)
    return Finding(text, {option.text: option.text for option in item.options})


def least_scale(item: QuizItem, folder: Path) -> Finding:
    """All lengths of a drawing are in proportion to its width."""
    resolution = photo_reference("strokes").resolution
    passage_pixels = 0.2 / resolution(3.0, 1000)
    width = next(each / 10 for each in range(30, 100) if passage_pixels * resolution(each / 10, 1000) >= 0.3)
    return nearest(item, width, 0.05)


def widest_way(item: QuizItem, folder: Path) -> Finding:
    """Of a straight way with a narrow door and one round the wall with a wide one."""
    walls = np.array(
        [
            (0, 0, 6, 0), (6, 0, 6, 4), (6, 4, 0, 4), (0, 4, 0, 0),
            (3, 0, 3, 0.6), (3, 0.9, 3, 3.5),
        ],
        dtype=float,
    )  # fmt: skip
    start, target = (1.0, 0.75), (5.0, 0.75)
    route = widest_route(OccupancyGrid.from_walls(walls, [start]), start, target)
    taken = "The longer one" if route.length > 5 and route.width > 0.4 else "The shorter one"
    return Finding(taken, {option.text: option.text for option in item.options})


PHOTOGRAPHS: dict[str, Derivation] = {
    "wall-of-pixels": wall_of_pixels,
    "below-one-limit": below_one_limit,
    "joined-runs": joined_runs,
    "least-scale": least_scale,
    "widest-way": widest_way,
}
