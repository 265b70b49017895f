"""The goal to drive along a wall: which metres count."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.learning.authoring.task_check import check_task
from kit.learning.tasks.task_reader import read_task
from kit.world.problems import WorldError
from tests.learning.tasks.tasks_for_tests import AHEAD, HALL, PLAIN, STILL, achieved, drive, one_world


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


@pytest.mark.parametrize(("distance", "is_seen"), [(1.8, True), (1.95, False), (4.0, False)])
def test_a_wall_that_no_agent_sees_is_refused(distance: float, is_seen: bool, tmp_path: Path) -> None:
    goal = f"goal: {{kind: wall, distance: {distance}, tolerance: 0.1, length: 1.0}}"
    file = tmp_path / "mine.yaml"
    file.write_text(f"{HALL}target: [0.625, 2.5]}}\n{goal}\nstep: {{limit: 300}}\n{PLAIN}")
    if is_seen:
        check_task(read_task(file))
        return
    with pytest.raises(WorldError, match="on hall_straight sees 2 m") as caught:
        check_task(read_task(file))
    assert caught.value.problems[0].location.line > 1
