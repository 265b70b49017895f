"""How many students a machine carries, and what many need: compared with oracles that do it event by event."""

from __future__ import annotations

import heapq
import math

import numpy as np
import pytest

from kit.school.capacity import (
    HOUR_S,
    Habits,
    MachineSize,
    UseCost,
    class_capacity,
    fewest_cores,
    hand_in_times,
    most_at_once,
    server_need,
    waits,
)

COST = UseCost(0.16, 132e6, 1.8, 7.0, 119e6)


def waits_by_events(times: list[float], cores: int, service: float) -> list[float]:
    """A queue with a heap of the times at which cores become free."""
    free = [-math.inf] * cores
    found = []
    for time in times:
        begin = max(time, heapq.heappop(free))
        heapq.heappush(free, begin + service)
        found.append(begin - time)
    return found


@pytest.mark.parametrize("cores", [1, 2, 7])
def test_waits_are_those_of_a_queue_that_is_played_event_by_event(cores: int) -> None:
    times = np.sort(np.random.default_rng(1).uniform(0.0, 300.0, 400))
    assert waits(times, cores, 3.3) == pytest.approx(waits_by_events(times.tolist(), cores, 3.3))


def test_the_cores_are_enough_and_one_less_is_not() -> None:
    times = hand_in_times(60_000, Habits())
    cores = fewest_cores(times, 20.0, 60.0)
    assert cores > 2
    assert np.quantile(waits_by_events(times.tolist(), cores, 20.0), 0.95) <= 60.0
    assert np.quantile(waits_by_events(times.tolist(), cores - 1, 20.0), 0.95) > 60.0


def test_hand_ins_grow_towards_the_deadline_as_assumed() -> None:
    habits = Habits(days=3.0, mean_hours_left=24.0)
    times = hand_in_times(200_000, habits)
    assert times.min() >= -72 * HOUR_S
    assert times.max() <= 0.0
    assert (np.diff(times) >= 0.0).all()
    last_day = -math.expm1(-1.0) / -math.expm1(-3.0)
    assert (times > -24 * HOUR_S).mean() == pytest.approx(last_day, abs=0.005)


def test_most_at_once_is_what_counting_every_moment_gives() -> None:
    begins = np.sort(np.random.default_rng(2).uniform(0.0, 100.0, 200))
    counted = max(sum(other <= begin < other + 7.0 for other in begins) for begin in begins)
    assert most_at_once(begins, 7.0) == counted
    assert most_at_once(np.empty(0), 7.0) == 0


def test_what_is_scarce_decides() -> None:
    wide = class_capacity(MachineSize(64, 2e9), COST, Habits())
    assert (wide.scarce, wide.students) == ("memory", wide.by_memory)
    tall = class_capacity(MachineSize(2, 1e12), COST, Habits())
    assert (tall.scarce, tall.students) == ("cores", tall.by_cores)
    assert class_capacity(MachineSize(4, 1e12), COST, Habits()).students >= 2 * tall.students


def test_a_hundred_times_the_learners_need_more_and_the_same_seed_says_the_same() -> None:
    few, many = (server_need(learners, COST, Habits()) for learners in (1_000, 20_000))
    assert many.check_cores >= few.check_cores
    assert many.last_hour == pytest.approx(20 * few.last_hour, rel=0.2)
    assert many.most_at_work > 10 * few.most_at_work
    assert many == server_need(20_000, COST, Habits())
