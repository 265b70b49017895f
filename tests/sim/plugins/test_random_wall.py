"""Walls that the seed chooses."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from kit.sim.simulation import Simulation
from kit.world.problems import WorldError
from tests.sim.workshop import Workshop

ROOM = [[-4, -3, 4, -3], [4, -3, 4, 3], [4, 3, -4, 3], [-4, 3, -4, -3]]


def around(workshop: Workshop, seed: int = 0, **keys: Any) -> Simulation:
    """A robot in a room, that looks in the four directions in which its walls are."""
    angle = {"min": 0, "max": 4.713, "increment": 1.5707963}
    laser = {
        "type": "Laser",
        "name": "laser",
        "body": "base",
        "range": 10,
        "angle": angle,
        "layers": ["seen"],
    }
    plugin = {"type": "RandomWall", "name": "thick", "layer": "seen", "robot_name": "robot", **keys}
    robot = workshop.model(workshop.circle(0.1), plugins=[laser])
    return Simulation(workshop.world({"robot": robot}, {"walls seen": ROOM}, plugins=[plugin]), seed=seed)


def look(simulation: Simulation) -> tuple[float, ...]:
    [scan] = [out.message for out in simulation.step() if out.topic == "/scan"]
    return tuple(round(distance, 3) for distance in scan.ranges)


def test_the_seed_chooses_which_walls_come_nearer(workshop: Workshop) -> None:
    views = {look(around(workshop, seed, num_of_walls=1, wall_wall_dist=0.5)) for seed in range(30)}
    assert views == {(3.5, 3, 4, 3), (4, 2.5, 4, 3), (4, 3, 3.5, 3), (4, 3, 4, 2.5)}
    assert look(around(workshop, 5, num_of_walls=2)) == look(around(workshop, 5, num_of_walls=2))
    assert look(around(workshop, num_of_walls=4)) == (3, 2, 3, 2)
    assert look(around(workshop)) == (4, 3, 4, 3)


def test_a_reset_chooses_again(workshop: Workshop) -> None:
    simulation = around(workshop, 0, num_of_walls=1)
    first = look(simulation)
    seen = set()
    for seed in range(20):
        simulation.reset(seed)
        seen.add(look(simulation))
    assert len(seen) == 4
    simulation.reset(0)
    assert look(simulation) == first


def test_they_stop_a_robot_on_both_sides_if_asked(workshop: Workshop) -> None:
    for both, outermost in ((False, 4.0), (True, 5.0)):
        simulation = around(workshop, num_of_walls=4, double_wall=both)
        simulation.move_model("robot", simulation.pose("robot")._replace(x=6.0))
        simulation.set_velocity("robot", (-1, 0, 0))
        simulation.step(300)
        assert simulation.pose("robot").x == pytest.approx(outermost + 0.1, abs=0.01)
        assert {(c.entity_b, c.body_b) for c in simulation.state().contacts} <= {("walls", "walls")}


def test_ends_are_closed(workshop: Workshop) -> None:
    simulation = around(workshop, num_of_walls=4)
    walls = np.concatenate([wall.ends for wall in simulation._instance.physics.walls])
    assert len(walls) == 4 + 4 * 3


@pytest.mark.parametrize(
    ("keys", "words"),
    [({"num_of_walls": 5}, "4 wall segments"), ({"layer": "nope"}, "nope"), ({"robot_name": "nope"}, "nope")],
)
def test_mistakes(workshop: Workshop, keys: dict[str, Any], words: str) -> None:
    with pytest.raises(WorldError, match=words):
        around(workshop, **keys)
