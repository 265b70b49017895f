"""The goal to drive along a wall: which metres count."""

from __future__ import annotations

import pytest

from tests.learning.tasks.tasks_for_tests import AHEAD, STILL, achieved, drive, one_world


@pytest.mark.parametrize(
    ("x", "side", "counts"), [(0.85, "right", True), (0.85, "left", False), (0.4, "left", True)]
)
def test_metres_along_a_wall(x: float, side: str, counts: bool) -> None:
    batch = one_world(
        f"maps: [hall_straight]\ncases: [{{start: [{x}, 0.5, 1.5708]}}]\n"
        f"goal: {{kind: wall, side: {side}, distance: 0.3, tolerance: 0.05, length: 1.0}}"
    )
    steps = drive(batch, AHEAD, 10)
    assert achieved(steps[-1]) == pytest.approx(0.8 * counts)
    if counts:
        assert drive(batch, AHEAD, 3)[-1].transition.reached[0]
    else:
        assert not drive(batch, STILL, 3)[-1].ended[0]
