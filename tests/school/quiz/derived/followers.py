"""What wall followers do, found out with the lesson's reference."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from types import ModuleType

from kit.school.quiz.items import QuizItem
from tests.kit_content import lesson_reference
from tests.school.quiz.derived.finding import Derivation, Finding, nearest


def reference() -> ModuleType:
    return lesson_reference("34-wall-follower", "steering")


def error_zero_and_askew(item: QuizItem, folder: Path) -> Finding:
    """A P controller is the reference without a change of the error."""
    turn = reference().rate(0.0, 0.0, "right")
    return Finding(
        "none" if turn == 0.0 else "away",
        {
            "No turn at all, so it drives on to the wall": "none",
            "A turn away, since it faces the wall": "away",
            "A stop, since the error is zero there": "stop",
        },
    )


def derivative_on_the_way(item: QuizItem, folder: Path) -> Finding:
    turn = reference().rate(-0.16, -0.20, "right")
    return Finding(
        "left" if turn > 1e-9 else "right" if turn < -1e-9 else "none",
        {
            "To the right, for it is still too far away": "right",
            "To the left, though it is still too far away": "left",
            "Not at all, for both terms cancel each other": "none",
        },
    )


def limit_the_sum(item: QuizItem, folder: Path) -> Finding:
    """An error and a change of such sizes."""
    error, change = -3.0 / 4.0, 2.5 / 4.0
    return nearest(item, reference().rate(error, error - change * 0.1, "right"), 0.01)


def first_scan_no_change(item: QuizItem, folder: Path) -> Finding:
    return Finding(
        round((-0.3 - 0.0) / 0.1, 6),
        {
            "0 m/s, as nothing has changed": 0.0,
            "-3 m/s, which never happened": -3.0,
            "-0.3 m/s, as the error says": -0.3,
        },
    )


def ray_through_a_door(item: QuizItem, folder: Path) -> Finding:
    """A wall 0.4 m to the right ends at x = 0; the next one is 2 m behind it. The rays have no noise."""

    def ranges(x: float) -> list[float]:
        found = []
        for ray in range(91):
            angle = math.radians(4 * ray - 180)
            if math.sin(angle) > -1e-9:
                found.append(math.nan)
                continue
            near, far = 0.4 / -math.sin(angle), 2.4 / -math.sin(angle)
            found.append(near if x + near * math.cos(angle) <= 0.0 else far)
        return found

    scans = [ranges(0.03 * step - 0.3) for step in range(30)]
    one = [scan[22] for scan in scans]
    many = [reference().distance(scan, "right") for scan in scans]
    jump = [max(abs(b - a) for a, b in pairwise(each)) for each in (one, many)]
    assert jump[0] > 1.9
    assert jump[1] < 0.1
    return Finding(
        "frame",
        {
            "Another ray still sees the frame": "frame",
            "The mean of many rays is smooth": "mean",
            "Many rays have less noise than one": "noise",
        },
    )


def mirrored_turn(item: QuizItem, folder: Path) -> Finding:
    """Too near a wall on the left: what is asked for, and what would be right."""
    asked, right = reference().rate(0.1, 0.1, "right"), reference().rate(0.1, 0.1, "left")
    assert asked > 0 > right
    return Finding(
        "into",
        {
            "It follows the left wall all the same": "follows",
            "It turns away to the right for ever": "away",
            "It steers into the wall when too near": "into",
        },
    )


FOLLOWERS: dict[str, Derivation] = {
    "error-zero-and-askew": error_zero_and_askew,
    "derivative-on-the-way": derivative_on_the_way,
    "limit-the-sum": limit_the_sum,
    "first-scan-no-change": first_scan_no_change,
    "ray-through-a-door": ray_through_a_door,
    "mirrored-turn": mirrored_turn,
}
