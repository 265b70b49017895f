"""The goal to follow a leader: which seconds count."""

from __future__ import annotations

import numpy as np
import pytest

from tests.learning.tasks.tasks_for_tests import CROSSING, STILL, achieved, drive, one_world


@pytest.mark.long
def test_a_leader_is_a_target_that_moves() -> None:
    batch = one_world(
        CROSSING + "target_model: slow_cart}\ngoal: {kind: follow, nearest: 0.3, farthest: 1.0, time: 2}\n"
        "step: {limit: 100}"
    )
    aims, steps = [batch.state.target[0].tolist()], drive(batch, STILL)
    aims += [step.transition.target[0].tolist() for step in steps]
    assert aims[0] == [1.6, 0.5]
    assert all(x == 1.6 for x, _ in aims)
    heights = np.array([y for _, y in aims])
    duration, time = 8.0, np.arange(len(aims)) * 0.2
    share = time / duration
    assert heights == pytest.approx(
        0.5 + 3.0 * np.where(share < 0.5, 2 * share**2, 1 - (2 - 2 * share) ** 2 / 2), abs=1e-3
    )
    distances = [float(step.transition.distance[0, 0]) for step in steps]
    near = [0.3 <= distance <= 1.0 for distance in distances]
    met = [bool(step.transition.hit[0, 0]) for step in steps]
    counted = np.cumsum([0.2 * (one and not other) for one, other in zip(near, met, strict=True)])
    assert [achieved(step) * 2.0 for step in steps] == pytest.approx(counted.tolist())
    assert met[-1]  # it stands in the cart's way
