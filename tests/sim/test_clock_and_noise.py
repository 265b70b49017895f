"""Streams of randomness."""

from __future__ import annotations

from kit.sim.clock_and_noise import RandomStream, stream_key


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
