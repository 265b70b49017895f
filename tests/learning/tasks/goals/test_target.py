"""The goal to be in the target, with its heading."""

from __future__ import annotations

import numpy as np
import pytest

from tests.learning.tasks.tasks_for_tests import HALL, STILL, one_world


@pytest.mark.parametrize(("heading", "reached"), [(1.5708, True), (0.0, False)])
def test_parking_takes_the_targets_heading(heading: float, reached: bool) -> None:
    batch = one_world(
        HALL
        + f"target: [0.625, 0.7], target_heading: {heading}}}\ngoal: {{kind: target, heading_tolerance: 0.2}}\n"
        "target: {radius: 0.3}"
    )
    step = batch.step(np.array([STILL]))
    assert (bool(step.transition.reached[0]), bool(step.transition.in_target[0, 0])) == (reached, reached)
    assert float(step.transition.misalignment[0, 0]) == pytest.approx(abs(heading - 1.5708), abs=1e-4)
