"""Bumper and BoolSensor: what touches."""

from __future__ import annotations

from typing import Any

import pytest

from kit.geometry import Pose
from kit.msg.flatland_msgs import Collision, Collisions
from kit.msg.geometry_msgs import Twist, Vector3
from kit.sim.simulation import Simulation
from tests.sim.workshop import Workshop, last_messages

WALL = [[1, -5, 1, 5]]


def bodies(message: Collisions) -> list[tuple[str, str, str, str]]:
    return [(c.entity_a, c.body_a, c.entity_b, c.body_b) for c in message.collisions]


def assert_hit(collision: Collision, normal: tuple[float, float]) -> None:
    assert len(collision.contact_positions) == len(collision.contact_normals) == 1
    assert [force > 0 for force in collision.magnitude_forces] == [True]
    [found] = collision.contact_normals
    assert (found.x, found.y) == pytest.approx(normal, abs=1e-3)


@pytest.mark.parametrize(
    "name", ["bumper/world.yaml", "flatland:flatland_plugins/test/bumper_tests/collision_test/world.yaml"]
)
def test_the_sequence_of_flatlands_own_test(workshop: Workshop, name: str) -> None:
    simulation = Simulation(workshop.find(name))
    seen = last_messages(simulation, 100)
    assert seen.keys() == {"/collisions", "/collisions_B"}
    a, b = seen["/collisions"], seen["/collisions_B"]
    assert (a.header.frame_id, b.header.frame_id) == ("map", "world")
    assert a.header.stamp.sec == 1
    assert b.header.stamp.sec + b.header.stamp.nanosec > 0
    assert (bodies(a), bodies(b)) == ([], [])

    simulation.set_velocity("robot1", (1, 0, 0))
    seen = last_messages(simulation, 150)
    assert bodies(seen["/collisions"]) == [("robot1", "base_link_1", "layer_1", "layer_1")]
    [touch] = seen["/collisions"].collisions
    assert (touch.contact_positions, touch.contact_normals, list(touch.magnitude_forces)) == ([], [], [])
    assert bodies(seen["/collisions_B"]) == []

    wall = ("robot1", "base_link_2", "layer_1", "layer_1")
    hits = [
        seen for _ in range(50) if bodies((seen := last_messages(simulation, 1))["/collisions"])[1:] == [wall]
    ]
    assert_hit(hits[0]["/collisions"].collisions[1], (1, 0))

    simulation.set_velocity("robot1", (-1, 0, 0))
    seen = last_messages(simulation, 300)
    assert (bodies(seen["/collisions"]), bodies(seen["/collisions_B"])) == ([], [])

    simulation.move_model("robot1", Pose(4, 0, 0))
    simulation.set_velocity("robot1", (-1, 0, 0))
    hits = [
        seen
        for _ in range(300)
        if bodies((seen := last_messages(simulation, 1))["/collisions"])[1:] == [wall]
    ]
    assert_hit(hits[0]["/collisions"].collisions[1], (-1, 0))


def test_pressing_on(workshop: Workshop) -> None:
    """While a drive presses against the wall, both kinds of bumper report it, with what they exclude left out."""
    plugins = [
        {"type": "DiffDrive", "name": "drive", "body": "base"},
        {"type": "Bumper", "name": "all", "topic": "all", "update_rate": 10},
        {
            "type": "Bumper",
            "name": "some",
            "topic": "some",
            "update_rate": 10,
            "publish_all_collisions": False,
        },
        {"type": "Bumper", "name": "none", "topic": "none", "exclude": ["base"]},
    ]
    robot = workshop.model(workshop.circle(0.2), plugins=plugins)
    simulation = Simulation(workshop.world({"robot": robot}, {"walls": WALL}, namespaces={"robot": "ns"}))
    simulation.accept("/ns/cmd_vel", Twist(linear=Vector3(x=1.0)))
    simulation.step(100)
    counts: dict[str, list[int]] = {}
    for out in simulation.step(100):
        if isinstance(out.message, Collisions):
            counts.setdefault(out.topic, []).append(len(out.message.collisions))
    assert counts == {"/ns/all": [1] * 100, "/ns/some": [1] * 10, "/ns/none": [0] * 100}


def test_both_models_report_a_contact_as_their_own(workshop: Workshop) -> None:
    robot = workshop.model(workshop.circle(0.2), plugins=[{"type": "Bumper", "name": "bumper"}])
    names = {"one": "one", "two": "two"}
    world = workshop.world({"one": robot, "two": robot}, poses={"two": (0.3, 0, 0)}, namespaces=names)
    simulation = Simulation(world)
    simulation.set_velocity("two", (-1, 0, 0))
    seen = last_messages(simulation, 1)
    assert bodies(seen["/one/collisions"]) == [("one", "base", "two", "base")]
    assert bodies(seen["/two/collisions"]) == [("two", "base", "one", "base")]
    assert_hit(seen["/one/collisions"].collisions[0], (1, 0))
    assert_hit(seen["/two/collisions"].collisions[0], (-1, 0))


def test_a_bool_sensor_remembers_until_it_has_spoken(workshop: Workshop) -> None:
    feeler = {"type": "BoolSensor", "name": "feeler", "update_rate": 2}
    gate = workshop.model(workshop.circle(0.2, sensor=True), type="static", plugins=[feeler])
    ball = workshop.model(workshop.circle(0.05))
    world = workshop.world(
        {"gate": gate, "ball": ball}, poses={"ball": (-1, 0, 0)}, namespaces={"gate": "ns"}
    )
    simulation = Simulation(world)
    simulation.set_velocity("ball", (2.0, 0, 0))  # inside from 0.375 s to 0.625 s
    said = [out for out in simulation.step(200) if out.topic == "/ns/bool_sensor"]
    assert [out.message.data for out in said] == [True, True, False, False]


def test_a_bool_sensor_feels_its_own_body_only(workshop: Workshop) -> None:
    def model(**keys: Any) -> dict[str, Any]:
        return {
            "bodies": [
                {"name": "here", "footprints": [workshop.circle(0.1)]},
                {"name": "there", "pose": [1, 0, 0], "footprints": [workshop.circle(0.1)]},
            ],
            "plugins": [{"type": "BoolSensor", "name": "feeler", **keys}],
        }

    for keys, expected in (({}, False), ({"body": "there"}, True)):
        world = workshop.world({"model": model(**keys)}, {"walls": WALL})
        assert [out.message.data for out in Simulation(world).step(2)] == [expected] * 2
