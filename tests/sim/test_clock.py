"""Rates: Flatland's own table, and what is due when."""

from __future__ import annotations

import math

import pytest

from kit.sim.clock_and_noise import Clock, UpdateTimer


def fired(rate: float, step_size: float, duration: float) -> list[int]:
    """The steps in which a timer was due."""
    clock = Clock(step_size)
    timer = UpdateTimer(rate, clock)
    ticks = []
    while clock.time_ns < round(duration * 1e9):
        if timer.is_due():
            ticks.append(clock.tick)
        clock.tick += 1
    return ticks


@pytest.mark.parametrize(
    ("rate", "step_size", "duration", "expected"),
    [
        (141.56, 1 / 333, 2, 141.56),
        (564.56, 1 / 1234, 1, 564.56),
        (47.4, 0.01, 2, 47.4),
        (math.inf, 0.01, 2, 100),
        (0, 0.01, 2, 0),
    ],
)
def test_measured_rates(rate: float, step_size: float, duration: float, expected: float) -> None:
    assert len(fired(rate, step_size, duration)) / duration == pytest.approx(expected, abs=1)


def test_the_first_time_is_at_the_start() -> None:
    assert fired(10, 0.01, 0.35) == [0, 10, 20, 30]
    assert fired(0, 0.01, 5) == [0]
    assert fired(5000, 0.01, 0.03) == [0, 1, 2]  # no more than once a step


def test_rounding_loses_no_update() -> None:
    """0.1 s is not a whole number of any binary fraction; a day has 864000 of them all the same."""
    ticks = fired(10, 0.01, 1000)
    assert ticks == list(range(0, 100_000, 10))


def test_stamps() -> None:
    clock = Clock(0.3)
    clock.tick = 5
    assert (clock.stamp.sec, clock.stamp.nanosec) == (1, 500_000_000)
