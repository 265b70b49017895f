"""What forces do, found out from charges."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from kit.fields import adjacency
from kit.fields.charges import ChargeField, LineCharge, PointCharge, TensionPoint
from kit.geometry import wrap_angle
from kit.school.quiz.items import QuizItem
from tests.school.quiz.derived.finding import Derivation, Finding, nearest

RATIOS = {"A quarter of it": 0.25, "Half of it": 0.5, "The same as before": 1.0, "Twice as much": 2.0}


def _ratio(item: QuizItem, charge: PointCharge | TensionPoint) -> Finding:
    near, far = (float(np.hypot(*charge.force((r, 0.0)))) for r in (0.7, 1.4))
    means = {option.text: RATIOS[option.text] for option in item.options}
    return Finding(round(far / near, 9), means)


def coulomb_ratio(item: QuizItem, folder: Path) -> Finding:
    return _ratio(item, PointCharge(0, 0, 2.0))


def hooke_ratio(item: QuizItem, folder: Path) -> Finding:
    return _ratio(item, TensionPoint(0, 0, 3.0))


def line_strip(item: QuizItem, folder: Path) -> Finding:
    here = (2.0, 1.0)

    def as_of(x: float) -> tuple[float, ...]:
        return tuple(np.round(PointCharge(x, 0, -1.0).force(here), 9).tolist())

    found = tuple(np.round(LineCharge(0, 0, 1, 0, -1.0).force(here), 9).tolist())
    return Finding(
        found,
        {
            "As of a charge at (1, 0)": as_of(1.0),
            "None, the line misses it": (0.0, 0.0),
            "As of a charge at (2, 0)": as_of(2.0),
        },
    )


def wall_or_target(item: QuizItem, folder: Path) -> Finding:
    force = PointCharge(3, 0, 15.0).force((0.0, 0.0)) + LineCharge(0.5, -1, 0.5, 1, -1.0).force((0.0, 0.0))
    return Finding(
        int(np.sign(np.round(force[0], 9))),
        {
            "Forward, since 15 is more than 1": 1,
            "Back, since the wall is near": -1,
            "Nowhere, since they cancel": 0,
        },
    )


def stuck_before_a_wall(item: QuizItem, folder: Path) -> Finding:
    """Where the sum on the way to the target changes its sign, and what the target's pull is there: some, and the
    same with the wall as without it."""
    target, wall = PointCharge(4, 0, 15.0), LineCharge(2, -1, 2, 1, -1.0)
    way = np.stack((np.linspace(0.0, 1.99, 2000), np.zeros(2000)), axis=1)
    both = ChargeField.from_charges([target, wall]).forces(way)[:, 0]
    (stop,) = np.flatnonzero((both[:-1] > 0) & (both[1:] <= 0))
    pull = float(target.force(way[stop])[0])
    hidden = not np.isclose(both[stop] - wall.force(way[stop])[0], pull)
    found = "hidden" if hidden else "too weak" if pull < 0.1 else "cancel"
    return Finding(
        found,
        {
            "The target is too far away to pull": "too weak",
            "The forces cancel at this place": "cancel",
            "The wall hides the target's charge": "hidden",
        },
    )


def arctangent(item: QuizItem, folder: Path) -> Finding:
    dx, dy = -1.0, -1.0
    assert math.degrees(math.atan2(dy, dx)) == -135.0
    try:
        found: object = round(math.degrees(math.atan(dy / dx)), 9)
    except ArithmeticError:
        found = "error"
    return Finding(
        found,
        {
            "-135 degrees, as it should be": -135.0,
            "45 degrees, the opposite way": 45.0,
            "An error, since both are negative": "error",
        },
    )


def wrapped_difference(item: QuizItem, folder: Path) -> Finding:
    return nearest(item, abs(math.degrees(wrap_angle(math.radians(179) - math.radians(-179)))), 1e-6)


def side_by_side(item: QuizItem, folder: Path) -> Finding:
    """Near and facing the same way in both cases; abeam in one of them."""
    behind = bool(adjacency.is_adjacent_by_poses((0, 0, 0), (0.4, 0, 0)))
    abeam = bool(adjacency.is_adjacent_by_poses((0, 0, 0), (0, -0.4, 0)))
    reason = "abeam counts" if abeam and not behind else "near or facing is enough"
    return Finding(
        reason,
        {
            "Yes: they are near each other": "near or facing is enough",
            "Yes: they face the same way": "near or facing is enough",
            "No: one is ahead of the other": "abeam counts",
        },
    )


FIELDS: dict[str, Derivation] = {
    "coulomb-ratio": coulomb_ratio,
    "hooke-ratio": hooke_ratio,
    "line-strip": line_strip,
    "wall-or-target": wall_or_target,
    "stuck-before-a-wall": stuck_before_a_wall,
    "arctangent": arctangent,
    "wrapped-difference": wrapped_difference,
    "side-by-side": side_by_side,
}
