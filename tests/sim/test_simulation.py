"""The services around a step: time, reset, move, spawn, delete; and that a run repeats to the bit."""

from __future__ import annotations

import hashlib
import math
import struct
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest

from kit.geometry import Pose
from kit.sim.plugin import OutgoingMessage
from kit.sim.simulation import Simulation, SimulationError
from kit.world.records import World
from tests.sim.workshop import OURS, Workshop, command

BOX = [[-2, -2, 2, -2], [2, -2, 2, 2], [2, 2, -2, 2], [-2, 2, -2, -2]]


def fingerprint(simulation: Simulation, sent: Iterable[OutgoingMessage] = ()) -> str:
    """Everything that can be seen of a run, to the bit."""
    digest = hashlib.sha256()
    state = simulation.state()
    for body in state.bodies:
        digest.update(struct.pack("6d", *body.pose, *body.velocity))
    for contact in state.contacts:
        digest.update(repr(contact).encode())
    for out in sent:
        digest.update(out.topic.encode() + repr(out.message).encode())
    return digest.hexdigest()


# Time


def test_time_does_not_drift(workshop: Workshop) -> None:
    simulation = Simulation(workshop.world({}), step_size=0.001)
    simulation.step(3)
    assert (simulation.tick, simulation.time_ns) == (3, 3_000_000)
    simulation = Simulation(workshop.world({}), step_size=1 / 3)
    simulation.step(30_000)
    assert simulation.time_ns == 10_000 * 1_000_000_000
    assert simulation.state().time_ns == simulation.time_ns


@pytest.mark.parametrize("step_size", [0.0, -1.0, math.inf, math.nan])
def test_a_step_takes_time(workshop: Workshop, step_size: float) -> None:
    with pytest.raises(SimulationError):
        Simulation(workshop.world({}), step_size=step_size)


def test_a_step_is_before_advance_and_after(workshop: Workshop) -> None:
    whole, parts = (Simulation(workshop.serp(BOX)) for _ in range(2))
    sent = whole.step(20)
    pieces = []
    for _ in range(20):
        pieces += parts.before_step()
        parts.advance()
        pieces += parts.after_step()
    assert fingerprint(whole, sent) == fingerprint(parts, pieces)


# The same run


@pytest.fixture
def crowd(workshop: Workshop) -> World:
    """Five noisy robots and some boxes in a small room: they bump into everything all the time."""
    drive = {
        "type": "DiffDrive",
        "name": "drive",
        "body": "base",
        "pub_rate": 10,
        "odometry": "encoders",
        "odom_pose_noise": [0.01, 0.01, 0.1],
    }
    angle = {"min": -3, "max": 3, "increment": 0.1}
    laser = {
        "type": "Laser",
        "name": "laser",
        "body": "base",
        "range": 5,
        "angle": angle,
        "noise_std_dev": 0.1,
        "update_rate": 10,
    }
    robot = workshop.model(
        workshop.rectangle(-0.2, 0.2, -0.1, 0.1, friction=0.5, restitution=0.3),
        plugins=[drive, laser, {"type": "Bumper", "name": "bumper"}],
    )
    box = workshop.model(workshop.circle(0.2, friction=0.3), linear_damping=1)
    models = {f"robot{i}": robot for i in range(5)} | {f"box{i}": box for i in range(6)}
    poses = {name: (math.cos(2.4 * i) * i / 8, math.sin(2.4 * i) * i / 8, i) for i, name in enumerate(models)}
    return workshop.world(models, {"walls": BOX}, poses=poses, namespaces={name: name for name in models})


def drive_around(simulation: Simulation, steps: int) -> str:
    """A run whose commands depend on what the robots see."""
    digest = hashlib.sha256()
    for step in range(steps):
        sent = simulation.step()
        for out in sent:
            digest.update(out.topic.encode() + repr(out.message).encode())
            if out.topic.endswith("/scan"):
                near = np.nanmin(np.array(out.message.ranges))
                topic = out.topic.replace("scan", "cmd_vel")
                simulation.accept(topic, command(1.0, 3.0 * math.sin(float(near) + step)))
        digest.update(fingerprint(simulation).encode())
    return digest.hexdigest()


@pytest.mark.long
def test_the_same_seed_is_the_same_run_to_the_bit(crowd: World) -> None:
    first, second, other = (Simulation(crowd, seed=seed) for seed in (1, 1, 2))
    runs = [drive_around(simulation, 3000) for simulation in (first, second)]
    assert runs[0] == runs[1]
    assert first.state() == second.state()
    assert len(first.state().contacts) > 0
    assert runs[0] != drive_around(other, 300)


@pytest.mark.long
def test_a_reset_run_is_a_new_run(crowd: World) -> None:
    simulation = Simulation(crowd, seed=1)
    fresh = drive_around(simulation, 300)
    simulation.delete_model("box1")
    simulation.reset()
    assert drive_around(simulation, 300) == fresh
    simulation.reset(seed=2)
    assert simulation.seed == 2
    assert drive_around(simulation, 300) == drive_around(Simulation(crowd, seed=2), 300) != fresh


def test_what_is_wanted_changes_nothing(crowd: World) -> None:
    """With fixed commands: whether anybody looks does not move anything."""
    watched, unwatched = (
        Simulation(crowd, seed=1),
        Simulation(crowd, seed=1, has_subscribers=lambda topic: False),
    )
    for simulation in (watched, unwatched):
        for i in range(5):
            simulation.accept(f"/robot{i}/cmd_vel", command(0.7, 0.5 * i))
    assert watched.step(300)
    assert unwatched.step(300) == []
    assert fingerprint(watched) == fingerprint(unwatched)


# Reset


def test_reset_is_of_everything(workshop: Workshop) -> None:
    simulation = Simulation(workshop.serp(BOX, pose=(1, 0, 0)))
    start = simulation.state()
    simulation.accept("/cmd_vel", command(0.5))
    simulation.step(300)
    assert simulation.state().contacts
    simulation.spawn_model(OURS / "serp.model.yaml", "second", "second", Pose(-1, 0, 0))
    simulation.delete_model("serp")
    simulation.reset()
    assert simulation.state() == start
    simulation.step(10)
    assert simulation.pose("serp") == Pose(1, 0, 0)  # the last command is forgotten too
    assert simulation.model_names == ("serp",)
    assert {endpoint.topic for endpoint in simulation.endpoints} >= {
        "/cmd_vel",
        "/odom",
        "/static_laser",
        "/tf",
    }


# Move


def test_move(workshop: Workshop) -> None:
    simulation = Simulation(workshop.serp())
    simulation.step(3)
    simulation.move_model("serp", Pose(5.5, 9.9, 0.77))
    assert simulation.pose("serp") == pytest.approx((5.5, 9.9, 0.77))


def test_a_model_moves_as_it_stands(workshop: Workshop) -> None:
    pair = {
        "bodies": [
            {"name": "a", "pose": [1, 0, 0.5], "footprints": [workshop.circle(0.1)]},
            {"name": "b", "pose": [1, 2, 1.5], "footprints": [workshop.circle(0.1)]},
        ]
    }
    simulation = Simulation(workshop.world({"pair": pair}))
    before = [body.pose for body in simulation.state().bodies]
    simulation.move_model("pair", Pose(-3, 4, -1))
    after = [body.pose for body in simulation.state().bodies]
    assert after[0] == pytest.approx((-3, 4, -1))
    assert after[0].relative(after[1]) == pytest.approx(before[0].relative(before[1]))


def test_a_move_keeps_velocities_unless_told_otherwise(workshop: Workshop) -> None:
    simulation = Simulation(workshop.world({"ball": workshop.model(workshop.circle(0.1))}))
    simulation.set_velocity("ball", (1, 2, 3))
    simulation.move_model("ball", Pose(5, 5, 0))
    assert simulation.state().bodies[0].velocity == pytest.approx((1, 2, 3))
    simulation.move_model("ball", Pose(5, 5, 0), at_rest=True)
    assert simulation.state().bodies[0].velocity == (0, 0, 0)


def test_a_static_model_can_be_moved_into_the_way(workshop: Workshop) -> None:
    models = {
        "ball": workshop.model(workshop.circle(0.1)),
        "post": workshop.model(workshop.circle(0.1), type="static"),
    }
    simulation = Simulation(workshop.world(models, poses={"post": (0, 5, 0)}))
    simulation.set_velocity("ball", (1, 0, 0))
    simulation.step(10)
    simulation.move_model("post", Pose(1, 0, 0))
    simulation.step(100)
    assert simulation.pose("ball").x == pytest.approx(0.8, abs=0.01)


# Spawn and delete


def test_spawn(workshop: Workshop) -> None:
    simulation = Simulation(workshop.serp())
    simulation.spawn_model(OURS / "serp.model.yaml", "second", "robot2", Pose(101.1, 102.1, 0.23))
    assert simulation.model_names == ("serp", "second")
    assert simulation.pose("second") == pytest.approx((101.1, 102.1, 0.23))
    assert "/robot2/cmd_vel" in {endpoint.topic for endpoint in simulation.endpoints}
    simulation.accept("/robot2/cmd_vel", command(1))
    simulation.step(10)
    assert simulation.pose("serp") == (0, 0, 0)
    assert simulation.pose("second").x > 101.15
    assert any(out.topic == "/robot2/odom" for out in simulation.step(10))


def test_delete(workshop: Workshop) -> None:
    simulation = Simulation(workshop.serp(BOX))
    simulation.step(1)
    assert simulation.latest_scans()
    simulation.delete_model("serp")
    assert simulation.model_names == ()
    assert simulation.state().bodies == ()
    assert list(simulation.endpoints) == []
    assert simulation.step(3) == []
    assert simulation.latest_scans() == ()
    assert simulation.outlines() == ()
    simulation.accept("/cmd_vel", command(1))  # nobody listens any more


def test_deleting_what_touches(workshop: Workshop) -> None:
    models = {name: workshop.model(workshop.circle(0.3)) for name in "ab"}
    simulation = Simulation(workshop.world(models, {"walls": [[0.2, -1, 0.2, 1]]}, poses={"b": (0.1, 0, 0)}))
    simulation.step(1)
    assert len(simulation.state().contacts) == 3
    simulation.delete_model("a")
    assert [c.entity_a for c in simulation.state().contacts] == ["b"]
    simulation.step(10)


def test_refusals_change_nothing(workshop: Workshop, tmp_path: Path) -> None:
    simulation = Simulation(workshop.serp())
    before = simulation.state()
    bad = workshop.file("bad.yaml", {"bodies": []})
    refusals = [
        (
            lambda: simulation.move_model("not_a_robot", Pose()),
            'failed to move model, model with name "not_a_robot" does not exist',
        ),
        (
            lambda: simulation.delete_model("random_model"),
            'failed to delete model, model with name "random_model" does not exist',
        ),
        (
            lambda: simulation.spawn_model(OURS / "serp.model.yaml", "serp"),
            'model with name "serp" already exists',
        ),
        (lambda: simulation.spawn_model(tmp_path / "nowhere.yaml", "x"), "nowhere.yaml"),
        (lambda: simulation.spawn_model(bad, "x"), "bodies"),
        (lambda: simulation.move_model("serp", Pose(math.nan, 0, 0)), "no place"),
        (lambda: simulation.set_velocity("serp", (0, math.nan, 0)), "no place"),
        (lambda: simulation.set_velocity("nobody", (0, 0, 0)), "nobody"),
        (
            lambda: simulation.spawn_model(OURS / "serp.model.yaml", "x", "", Pose(0, math.inf, 0)),
            "no place",
        ),
    ]
    for attempt, words in refusals:
        with pytest.raises(SimulationError, match=f"^Flatland World: .*{words}"):
            attempt()
    assert simulation.state() == before


# Looking


def test_outlines(workshop: Workshop) -> None:
    body = workshop.model(workshop.circle(0.5, center=[1, 0], sensor=True), workshop.rectangle(0, 1, 0, 1))
    simulation = Simulation(workshop.world({"thing": body}))
    simulation.move_model("thing", Pose(10, 0, math.pi / 2))
    disc, square = simulation.outlines()
    assert (disc.model, disc.body, disc.sensor, square.sensor) == ("thing", "base", True, False)
    assert (disc.radius, square.radius) == (0.5, 0)
    assert np.array(disc.points) == pytest.approx(np.array([[10, 1], [10, 1.5]]))
    assert np.array(square.points) == pytest.approx(np.array([[10, 0], [10, 1], [9, 1], [9, 0]]))


def test_names_are_the_models_own(workshop: Workshop) -> None:
    """Two robots from one file: in Flatland's ROS 2 port they would share their topics."""
    simulation = Simulation(workshop.serp())
    for name in ("one", "two"):
        simulation.spawn_model(OURS / "serp.model.yaml", name, name, Pose(0, 5, 0))
    topics = [endpoint.topic for endpoint in simulation.endpoints if endpoint.topic != "/tf"]
    assert len(topics) == len(set(topics)) == 3 * 6
    assert {"/cmd_vel", "/one/cmd_vel", "/two/cmd_vel", "/two/static_laser", "/one/collisions"} <= set(topics)
