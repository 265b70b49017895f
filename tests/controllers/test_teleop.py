"""The kit's teleop: which of the keys that are down count."""

from __future__ import annotations

import math

from kit.controllers import find_controller
from kit.run.episode import run_until
from kit.run.scenario import find_scenario
from kit.run.session import Session


def test_a_key_that_is_pressed_before_space_is_let_go_drives() -> None:
    with Session(find_scenario("simple")) as session:
        session.drive_with(find_controller("teleop"))
        session.wait_until_driven()
        for message in ("p_up", "p_space", "p_left", "r_space"):
            session.keys.publish((message,), 1.0)
            run_until(session.runner, ticks=20)
        robot = session.scenario.partners[0]
        before = session.runner.simulation.pose(robot)
        run_until(session.runner, ticks=50)
        after = session.runner.simulation.pose(robot)
    assert after.theta - before.theta > 0.3
    assert math.dist(after[:2], before[:2]) < 0.05  # space has let go of the way ahead


def test_walls_at_the_sides_of_a_gap_slow_nobody_down_who_drives_through_it() -> None:
    with Session(find_scenario("hall_center_door"), always_scan=True) as session:
        session.drive_with(find_controller("teleop"))
        session.wait_until_driven()
        robot = session.scenario.partners[0]
        session.keys.publish(("p_up",), 1.0)
        run_until(session.runner, ticks=50)
        speeds, before = [], session.runner.simulation.pose(robot)
        for _ in range(20):
            run_until(session.runner, ticks=10)
            now = session.runner.simulation.pose(robot)
            speeds.append(math.dist(now[:2], before[:2]) / 0.1)
            before = now
    assert min(speeds) > 0.45
