"""The goal to keep clear of what moves: which seconds count."""

from __future__ import annotations

import pytest

from tests.learning.tasks.tasks_for_tests import CROSSING, STILL, achieved, drive, one_world


def test_a_cart_is_kept_away_from() -> None:
    batch = one_world(
        CROSSING + "target: [5.5, 2]}\ngoal: {kind: avoid, distance: 0.5, time: 3}\nstep: {limit: 100}"
    )
    steps = drive(batch, STILL)
    nearest = [float(step.transition.obstacle_distance[0, 0]) for step in steps]
    assert min(nearest) < 0.4
    assert achieved(steps[-1]) * 3.0 == pytest.approx(0.2 * sum(each > 0.5 for each in nearest))
