"""Update rates (Flatland's own table) and random streams."""

from __future__ import annotations

import math

import pytest

from kit.sim.plugin_clock import RandomStream, UpdateTimer, WorldClock, stream_key
from tests.cases import every_case


def fired(rate: float, step_size: float, duration: float) -> list[int]:
    """The steps in which a timer was due."""
    clock = WorldClock(step_size)
    timer = UpdateTimer(rate, clock)
    ticks = []
    while clock.time_ns < round(duration * 1e9):
        if timer.is_due():
            ticks.append(clock.tick)
        clock.advance()
    return ticks


@every_case(
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
    clock = WorldClock(0.3)
    for _ in range(5):
        clock.advance()
    assert (clock.stamp.sec, clock.stamp.nanosec) == (1, 500_000_000)


def test_every_device_has_its_own_stream() -> None:
    streams = [stream_key(seed, model, plugin) for seed in range(5) for model in "ab" for plugin in "ab"]
    assert len(set(streams)) == 20
    assert stream_key(1, "ab", "c") != stream_key(1, "a", "bc")
    assert all(0 <= stream < 2**63 for stream in streams)


def test_a_stream_is_the_same_everywhere() -> None:
    """Names are hashed by what they say, not by Python's hash, which differs from process to process."""
    assert stream_key(0, "serp", "lidar") == 765590480410567935


def test_no_deviation_is_no_noise() -> None:
    assert RandomStream(1).normal(3, 0.0) == 0.0
    assert RandomStream(1).normal(3, 2.0) == 2.0 * RandomStream(1).normal(3)
    assert 0.0 <= RandomStream(1).uniform(3) < 1.0
