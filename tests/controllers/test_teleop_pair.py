"""Two robots driven by the arrow keys as one."""

from __future__ import annotations

import math

import pytest

from kit.controllers import find_controller
from kit.run.scenario import find_scenario
from kit.run.session import Session


@pytest.mark.parametrize("turn", ["left", "right"])
def test_a_pair_stays_side_by_side_round_a_bend(turn: str) -> None:
    with Session(find_scenario("pair_straight", None)) as session:
        session.drive_with(find_controller("teleop_pair"))
        session.wait_until_driven()
        simulation = session.runner.simulation

        def ticks(count: int) -> None:
            for _ in range(count):
                session.runner.tick()

        def apart() -> tuple[float, float, float]:
            """How far apart the two are across and along their heading, and by how much their headings differ."""
            left, right = simulation.pose("left"), simulation.pose("right")
            dx, dy = left.x - right.x, left.y - right.y
            cos, sin = math.cos(left.theta), math.sin(left.theta)
            return -sin * dx + cos * dy, cos * dx + sin * dy, left.theta - right.theta

        ticks(20)
        first = apart()
        session.keys.publish(("p_up",), 1.0)
        ticks(100)
        start = simulation.pose("left").theta
        session.keys.publish((f"p_{turn}",), 1.0)
        ticks(60)
        session.keys.publish((f"r_{turn}", "r_up"), 1.0)
        ticks(20)
        assert session.failure is None
        turned = simulation.pose("left").theta - start
        assert abs(turned) > 0.3
        assert (turned > 0) is (turn == "left")
        across, along, heading = apart()
        assert across == pytest.approx(first[0], abs=0.03)
        assert along == pytest.approx(0.0, abs=0.03)
        assert heading == pytest.approx(0.0, abs=0.02)
        assert not simulation.is_touching("left")
        ticks(100)
        assert simulation.pose("left").theta == pytest.approx(start + turned, abs=0.02)
