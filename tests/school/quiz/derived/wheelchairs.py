"""What two robots see of each other, and how an agent decides for both."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path

from kit.fields.adjacency import is_adjacent_by_poses, is_adjacent_by_rays
from kit.school.quiz.items import QuizItem
from tests.kit_content import lesson_reference
from tests.school.quiz.derived.finding import Derivation, Finding

LESSON = "37-two-wheelchairs"


wheelchair_reference = partial(lesson_reference, LESSON)


def rays_between_walls(gap: float) -> tuple[bool, bool]:
    """Two robots far apart, each so far from a wall between them [m]: by rays, and by poses."""
    by_rays = bool(is_adjacent_by_rays([gap, gap], [gap, gap]))
    return by_rays, bool(is_adjacent_by_poses([0.0, 2.0, 0.0], [0.0, 0.0, 0.0]))


def walls_look_like_neighbours(item: QuizItem, folder: Path) -> Finding:
    by_rays, by_poses = rays_between_walls(0.3)
    return Finding(
        "walls" if by_rays and not by_poses else "never",
        {
            "When each of them drives beside a wall": "walls",
            "When both of them drive at the same speed": "speed",
            "When the laser publishes ten times a second": "rate",
        },
    )


def quotient_or_two(item: QuizItem, folder: Path) -> Finding:
    return Finding(
        round(math.degrees(math.atan(-1 / -1))),
        {
            "45 degrees, the opposite of what is right": 45,
            "-135 degrees, which is what is right": round(math.degrees(math.atan2(-1, -1))),
            "Nothing, since it cannot be worked out": "nothing",
        },
    )


def pairs_of_four(item: QuizItem, folder: Path) -> Finding:
    split = wheelchair_reference("pair").split
    pairs = {tuple(split(number, 4)) for number in range(16)}
    left = [pair for pair in pairs if max(pair) < 2]
    return Finding(len(left), {option.text: int(option.text.split(",")[0]) for option in item.options})


def which_pair_is_six(item: QuizItem, folder: Path) -> Finding:
    left, right = wheelchair_reference("pair").split(6, 4)
    return Finding(f"({left}, {right})", {option.text: option.text for option in item.options})


def one_drives_off(item: QuizItem, folder: Path) -> Finding:
    """The better one's progress, and what the lesson's reward pays instead."""
    before = [2.0, 2.0]
    ways = [[1.8, 2.0], [1.8, 1.8], [2.0, 2.0]]
    alone, both, none = (max(a - b for a, b in zip(before, after, strict=True)) for after in ways)
    paid = [wheelchair_reference("pair").paid(before, after, False, [False, False]) for after in ways]
    assert paid[0] < paid[1]
    return Finding(
        "one" if alone == both > none else "both" if both > alone else "none",
        {
            "That both should drive together": "both",
            "That it is enough if one of them drives": "one",
            "That neither of them should drive at all": "none",
        },
    )


WHEELCHAIRS: dict[str, Derivation] = {
    "walls-look-like-neighbours": walls_look_like_neighbours,
    "quotient-or-two": quotient_or_two,
    "pairs-of-four": pairs_of_four,
    "which-pair-is-six": which_pair_is_six,
    "one-drives-off": one_drives_off,
}
