"""What a transition tells of itself."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kit.geometry import wrap_angle
from kit.learning.tasks.actions import Move
from kit.learning.tasks.transition import (
    TRANSITION_FIELDS,
    EpisodeState,
    Transition,
    bearing_of_target,
    distance_to_target,
)
from tests.cases import every_case
from tests.learning.worlds import COMMON_FIELDS, TASKS, sampled


def pair(left: tuple[float, float, float], right: tuple[float, float, float]) -> Transition:
    """Two robots at these poses, 0.3 m from whatever their rays look at."""
    flags, numbers = np.zeros(2, dtype=np.bool_), np.zeros(2)
    state = EpisodeState(
        case=np.int64(0),
        step=np.int64(1),
        pose=np.array([left, right]),
        hit=flags,
        in_target=flags,
        to_go=numbers,
        rotation=numbers,
        ranges=np.full((2, 91), 0.3),
        move=np.full(2, Move.FORWARD),
        twist=np.zeros((2, 2)),
        forward_steps=numbers,
        target=np.array([1.0, 1.0]),
        target_heading=np.float64(0.0),
        obstacle_distance=numbers,
        count=np.float64(0.0),
        achieved=np.float64(0.0),
    )
    return Transition(state, state, max_steps=300)


def test_facts_are_what_a_reward_may_ask_for() -> None:
    assert {"collided", "reached", "front", "bearing", "pose", "step", "adjacent"} <= set(TRANSITION_FIELDS)
    assert not {name for name in TRANSITION_FIELDS if name.startswith("_")}
    for task in TASKS:
        transition = sampled(task)
        assert all(getattr(transition, name) is not None for name in TRANSITION_FIELDS)


@every_case("task", TASKS)
@every_case("fact", TRANSITION_FIELDS)
def test_a_fact_is_the_same_of_one_world_and_of_many(task: str, fact: str) -> None:
    many = sampled(task)
    of_all = getattr(many, fact)
    for i in (0, 7, len(many.step) - 1):
        of_one = getattr(many.select(i), fact)
        expected = of_all if fact in COMMON_FIELDS else of_all[i]
        assert np.array_equal(np.asarray(of_one), np.asarray(expected))


@pytest.mark.parametrize(
    ("right", "how_well"),
    [
        ((0.0, -0.4, 0.0), 1.0),
        ((0.16, -0.4, 0.0), math.exp(-4.0)),
        ((-0.16, -0.4, 0.0), math.exp(-4.0)),
        ((0.0, -0.4, math.tau), 1.0),
    ],
)
def test_abreast(right: tuple[float, float, float], how_well: float) -> None:
    assert float(pair((0.0, 0.0, 0.0), right).abreast) == pytest.approx(how_well)


def test_facing_apart_is_not_abreast() -> None:
    assert float(pair((0.0, 0.0, 0.0), (0.0, -0.4, math.pi)).abreast) < 1e-6


def test_adjacent_takes_four_short_and_like_readings() -> None:
    beside = pair((0.0, 0.0, 0.0), (0.0, -0.4, 0.0))
    assert bool(beside.adjacent)
    for robot, ray in ((0, 24), (0, 20), (1, 66), (1, 70)):
        for reading in (0.36, 0.41):
            beside.ranges[robot, ray] = reading
            again = beside.select(...)
            assert not bool(again.adjacent)
            beside.ranges[robot, ray] = 0.3


def test_directions_and_distances() -> None:
    poses = np.array([[[0.0, 0.0, 0.0]], [[2.0, 1.0, math.pi / 2]], [[1.0, 2.0, 3.0]]])
    target = np.array([[1.0, 1.0]] * 3)
    assert distance_to_target(poses, target)[:, 0] == pytest.approx([math.sqrt(2), 1.0, 1.0])
    assert bearing_of_target(poses, target)[:, 0] == pytest.approx(
        [math.pi / 4, math.pi / 2, math.tau - 3 - math.pi / 2]
    )
    assert wrap_angle(np.array([math.pi, -math.pi, 7.0])) == pytest.approx(
        [-math.pi, -math.pi, 7.0 - math.tau]
    )
