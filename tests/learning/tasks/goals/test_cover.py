"""The goal to cover floor: each place counts once."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.learning.tasks.tasks_for_tests import AHEAD, HALL, achieved, drive, one_world


def test_floor_is_covered_once() -> None:
    batch = one_world(
        HALL + "start_shift: [0, 0]}\ngoal: {kind: cover, share: 0.4, radius: 0.2}\nstep: {limit: 60}"
    )
    steps = drive(batch, AHEAD, 20)
    shares = np.array([achieved(step) for step in steps])
    gains = np.diff(shares)
    assert (gains[1:] > 0).all()
    metres = 20 * 0.4 * 0.2
    floor = (1.05 - 0.165) * (2.8 - 0.165)  # where the robot's middle may be
    assert shares[-1] * 0.4 == pytest.approx((metres * 0.4 + math.pi * 0.04) / floor, rel=0.1)
    back = drive(batch, [-1.0, 0.0], 15)
    assert achieved(back[-1]) == shares[-1]
    assert not np.array([step.terms["achieving"][0] for step in back]).any()
