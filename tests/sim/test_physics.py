"""Bodies against walls, each other and their own joints."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from kit.geometry import Pose
from kit.sim.physics import CONTACT_SLOP
from kit.sim.simulation import Simulation
from kit.sim.state import Contact
from tests.sim.workshop import Workshop, command

WALL = [[1, -5, 1, 5]]
NOSE = 0.048
"""How far the dissertation's robot reaches forward."""


def driven(workshop: Workshop, *footprints: dict, **more: object) -> dict:
    return workshop.model(
        *footprints, plugins=[{"type": "DiffDrive", "name": "drive", "body": "base"}], **more
    )


# Walls


@pytest.mark.parametrize("speed", [0.1, 0.5, 1, 3, 12, 50, 199, 1e3, 1e9, 1e308, math.inf])
@pytest.mark.parametrize("step_size", [0.01, 0.1])
def test_nothing_drives_through_a_wall(workshop: Workshop, speed: float, step_size: float) -> None:
    """Not even a plate of a centimetre, broadside on, at any commanded speed."""
    plate = workshop.rectangle(-0.005, 0.005, -0.3, 0.3)
    world = workshop.world({"plate": driven(workshop, plate)}, {"walls": WALL})
    simulation = Simulation(world, step_size=step_size)
    simulation.accept("/cmd_vel", command(speed))
    farthest = 0.0
    for _ in range(60):
        simulation.step()
        farthest = max(farthest, simulation.pose("plate").x)
    assert farthest < 1.0
    if speed >= 3 and math.isfinite(speed):
        assert farthest > 0.98


@pytest.mark.parametrize("turn", [5.0, 100.0, 1e9])
def test_nothing_turns_through_a_wall(workshop: Workshop, turn: float) -> None:
    """A bar of two centimetres, whose tip is faster than anything drives."""
    bar = workshop.rectangle(-0.02, 1.2, -0.01, 0.01)
    world = workshop.world({"bar": driven(workshop, bar)}, {"walls": [[-9, 0.4, 9, 0.4]]})
    simulation = Simulation(world)
    simulation.accept("/cmd_vel", command(0, turn))
    for _ in range(50):
        simulation.step()
        [outline] = simulation.outlines()
        assert max(y for _, y in outline.points) < 0.42


def test_what_flies_does_not_pass_either(workshop: Workshop) -> None:
    world = workshop.world({"ball": workshop.model(workshop.circle(0.02))}, {"walls": WALL})
    simulation = Simulation(world)
    simulation.set_velocity("ball", (150.0, 0.0, 0.0))
    simulation.step(10)
    assert 0.95 < simulation.pose("ball").x < 1.0


def test_the_robot_stops_with_its_nose_at_the_wall(workshop: Workshop) -> None:
    simulation = Simulation(workshop.serp(WALL))
    simulation.accept("/cmd_vel", command(0.5))
    bumped = []
    for _ in range(400):
        bumped += [out for out in simulation.step() if out.topic == "/collisions" and out.message.collisions]
        assert simulation.pose("serp").x + NOSE < 1.006  # a step's way, until it is noticed
    assert simulation.pose("serp").x + NOSE == pytest.approx(1, abs=2 * CONTACT_SLOP)
    assert simulation.pose("serp")[1:] == pytest.approx((0, 0), abs=1e-6)
    assert bumped
    assert simulation.is_touching("serp")
    simulation.accept("/cmd_vel", command(-0.5))
    simulation.step(10)
    assert simulation.pose("serp").x + NOSE == pytest.approx(0.95, abs=2 * CONTACT_SLOP)  # it does not stick
    assert not simulation.is_touching("serp")


def test_sliding_along_a_wall_of_many_pieces_does_not_catch(workshop: Workshop) -> None:
    pieces = [[i / 10, 0.2, (i + 1) / 10, 0.2] for i in range(-5, 30)]
    simulation = Simulation(workshop.serp(pieces))
    simulation.move_model("serp", Pose(0, 0.2 - 0.085 - 0.001, 0.02))
    simulation.accept("/cmd_vel", command(0.5))
    simulation.step(300)
    assert simulation.pose("serp").x == pytest.approx(1.5, abs=0.03)


def test_layers_decide_what_touches(workshop: Workshop) -> None:
    bodies = {
        "same": workshop.circle(0.1, layers=["a"]),
        "other": workshop.circle(0.1, layers=["b"]),
        "both": workshop.circle(0.1, layers=["b", "a"]),
        "all": workshop.circle(0.1),
        "none": workshop.circle(0.1, layers=[]),
        "ghost": workshop.circle(0.1, layers=["a"], collision=False),
        "sensor": workshop.circle(0.1, layers=["a"], sensor=True),
    }
    models = {name: workshop.model(footprint) for name, footprint in bodies.items()}
    poses = {name: (0, 2 * i, 0) for i, name in enumerate(models)}
    world = workshop.world(models, {"a": [[0.5, -5, 0.5, 50]], "b": ()}, poses=poses)
    simulation = Simulation(world)
    for name in models:
        simulation.set_velocity(name, (1, 0, 0))
    simulation.step(100)
    stopped = {name for name in models if simulation.pose(name).x < 0.9}
    assert stopped == {"same", "both", "all"}


# Free motion


def test_distance_and_angle_are_exact(workshop: Workshop) -> None:
    """With its welded wheels: 0.5 m/s for a second, then a quarter turn in another, about the axle."""
    simulation = Simulation(workshop.serp())
    simulation.accept("/cmd_vel", command(0.5))
    simulation.step(100)
    assert simulation.pose("serp") == pytest.approx((0.5, 0, 0), abs=1e-12)
    simulation.accept("/cmd_vel", command(0, math.pi / 2))
    for _ in range(100):
        simulation.step()
        assert simulation.pose("serp")[:2] == pytest.approx((0.5, 0), abs=1e-12)
    assert simulation.pose("serp").theta == pytest.approx(math.pi / 2, abs=1e-12)


def test_a_command_acts_in_its_own_step(workshop: Workshop) -> None:
    simulation = Simulation(workshop.serp())
    simulation.accept("/cmd_vel", command(0.5, 1.0))
    simulation.step()
    assert simulation.pose("serp") == pytest.approx((0.005, 0.000025, 0.01), abs=1e-7)


def test_where_it_gets_to_does_not_depend_on_the_step(workshop: Workshop) -> None:
    ends = []
    for steps, size in ((100, 0.01), (10, 0.1), (1000, 0.001)):
        simulation = Simulation(workshop.serp(), step_size=size)
        simulation.accept("/cmd_vel", command(0.4, 1.0))
        simulation.step(steps)
        ends.append(simulation.pose("serp"))
    assert ends[0] == pytest.approx(ends[1], abs=1e-12)
    assert ends[0] == pytest.approx(ends[2], abs=1e-12)
    assert ends[0] == pytest.approx((0.4 * math.sin(1), 0.4 * (1 - math.cos(1)), 1), abs=1e-12)


def test_velocities_are_those_of_the_origin(workshop: Workshop) -> None:
    """The centre of mass of this body is 1 m from its origin."""
    world = workshop.world({"bar": workshop.model(workshop.rectangle(0, 2, -0.1, 0.1))})
    simulation = Simulation(world)
    simulation.move_model("bar", Pose(0, 0, math.pi / 2))
    simulation.set_velocity("bar", (0.3, 0.0, 2.0))
    assert simulation.state().bodies[0].velocity == pytest.approx((0.3, 0, 2))
    simulation.step()
    assert simulation.pose("bar") == pytest.approx((0.003, 0, math.pi / 2 + 0.02), abs=1e-3)


def test_damping(workshop: Workshop) -> None:
    """Box2D's: each step divides by 1 + damping * dt."""
    body = workshop.model(workshop.circle(0.1), linear_damping=2, angular_damping=5)
    simulation = Simulation(workshop.world({"ball": body}))
    simulation.set_velocity("ball", (1.0, 0.0, 1.0))
    simulation.step(100)
    velocity = simulation.state().bodies[0].velocity
    assert velocity == pytest.approx((1.02**-100, 0, 1.05**-100))


def test_the_box2d_limits(workshop: Workshop) -> None:
    """At most 2 m and 90 degrees in a step."""
    world = workshop.world({"ghost": driven(workshop, workshop.circle(0.1, layers=[]))})
    simulation = Simulation(world)
    simulation.accept("/cmd_vel", command(1e9))
    simulation.step()
    assert simulation.pose("ghost").x == pytest.approx(2)
    simulation.accept("/cmd_vel", command(0, -1e9))
    simulation.step()
    assert simulation.pose("ghost").theta == pytest.approx(-math.pi / 2)


# Bodies and each other


def test_a_push(workshop: Workshop) -> None:
    """A driven robot pushes a box in front of it."""
    box = workshop.model(workshop.rectangle(-0.1, 0.1, -0.1, 0.1))
    world = workshop.world(
        {"robot": driven(workshop, workshop.rectangle(-0.1, 0.1, -0.1, 0.1)), "box": box},
        poses={"box": (0.5, 0, 0)},
    )
    simulation = Simulation(world)
    simulation.accept("/cmd_vel", command(0.5))
    simulation.step(200)
    assert simulation.pose("box").x - simulation.pose("robot").x == pytest.approx(0.2, abs=0.01)
    assert simulation.pose("box").x == pytest.approx(1.2, abs=0.02)
    [contact] = simulation.state().contacts
    assert (contact.entity_a, contact.entity_b) == ("robot", "box")
    assert contact.normal == pytest.approx((1, 0))


def test_a_static_body_is_a_wall_and_a_kinematic_one_a_train(workshop: Workshop) -> None:
    disc = workshop.circle(0.1)
    models = {
        "ball": workshop.model(disc),
        "post": workshop.model(disc, type="static"),
        "train": workshop.model(disc, type="kinematic"),
    }
    simulation = Simulation(workshop.world(models, poses={"post": (1, 0, 0), "train": (0, 1, 0)}))
    simulation.set_velocity("ball", (1, 0, 0))
    simulation.set_velocity("train", (0, -1, 0))
    simulation.set_velocity("post", (5, 5, 5))
    simulation.step(50)
    assert simulation.pose("post") == (1, 0, 0)
    assert simulation.pose("train") == pytest.approx((0, 0.5, 0))
    simulation.step(100)
    assert simulation.pose("train") == pytest.approx((0, -0.5, 0))  # pushed by nobody
    assert simulation.pose("ball").x < 0.81


def test_what_cannot_be_pushed_touches_nothing(workshop: Workshop) -> None:
    models = {kind: workshop.model(workshop.circle(0.3), type=kind) for kind in ("static", "kinematic")}
    simulation = Simulation(workshop.world(models, {"walls": [[-1, 0, 1, 0]]}))
    simulation.step(3)
    assert simulation.state().contacts == ()


def test_without_density_a_body_weighs_a_kilo_and_is_not_turned(workshop: Workshop) -> None:
    box = {**workshop.rectangle(-0.1, 0.1, -0.1, 0.1), "density": 0}
    ball = {**workshop.circle(0.1), "density": 1 / (math.pi * 0.01)}
    models = {"box": workshop.model(box), "ball": workshop.model(ball)}
    simulation = Simulation(workshop.world(models, poses={"ball": (-0.5, 0.08, 0)}))
    simulation.set_velocity("ball", (1, 0, 0))
    simulation.step(100)
    box_state, ball_state = simulation.state().bodies
    assert box_state.velocity[0] + ball_state.velocity[0] == pytest.approx(1, abs=1e-6)
    assert box_state.velocity[0] > 0.4
    assert box_state.velocity[2] == 0


@pytest.mark.parametrize(("speed", "back"), [(4.0, True), (0.9, False)])
def test_restitution_is_the_larger_one_and_slow_impacts_do_not_bounce(
    workshop: Workshop, speed: float, back: bool
) -> None:
    world = workshop.world({"ball": workshop.model(workshop.circle(0.1, restitution=0.5))}, {"walls": WALL})
    simulation = Simulation(world)
    simulation.set_velocity("ball", (speed, 0, 0))
    simulation.step(150)
    assert simulation.state().bodies[0].velocity[0] == pytest.approx(-speed / 2 if back else 0, abs=0.01)


def test_friction_is_the_root_of_the_product(workshop: Workshop) -> None:
    """A box pressed to a wall (friction 0.2) with friction 0.8 is slowed by 0.4 times the force."""

    def speed_left(friction: float) -> float:
        box = workshop.model(workshop.rectangle(-0.5, 0.5, -0.1, 0.1, friction=friction))
        simulation = Simulation(workshop.world({"box": box}, {"walls": [[-9, 0.1, 9, 0.1]]}))
        simulation.set_velocity("box", (2, 1, 0))
        simulation.step(30)
        return simulation.state().bodies[0].velocity[0]

    assert speed_left(0) == pytest.approx(2)
    assert speed_left(0.8) == pytest.approx(2 - 0.4, abs=0.05)


# Joints


def joined(workshop: Workshop, joint: dict, *, offset: float = 0.3, **second: object) -> dict:
    """A driven disc and a second one beside it."""
    return {
        "bodies": [
            {"name": "first", "footprints": [workshop.circle(0.1)]},
            {"name": "second", "pose": [offset, 0, 0], "footprints": [workshop.circle(0.1)], **second},
        ],
        "joints": [
            {
                "name": "joint",
                "bodies": [{"name": "first", "anchor": [0.3, 0]}, {"name": "second", "anchor": [0, 0]}],
                **joint,
            }
        ],
        "plugins": [{"type": "DiffDrive", "name": "drive", "body": "first"}],
    }


def test_a_stiff_weld_is_one_body_from_the_start(workshop: Workshop) -> None:
    """Wherever the file puts the second body: it sits at its anchor, turned by the joint's angle."""
    pair = joined(workshop, {"type": "weld", "angle": 0.5}, offset=5)
    simulation = Simulation(workshop.world({"pair": pair}))
    simulation.accept("/cmd_vel", command(0.5, 1.0))
    for _ in range(100):
        first, second = simulation.state().bodies
        assert first.pose.relative(second.pose) == pytest.approx((0.3, 0, 0.5), abs=1e-12)
        simulation.step()
    assert simulation.pose("pair") == pytest.approx(
        (0.5 * math.sin(1), 0.5 * (1 - math.cos(1)), 1), abs=1e-12
    )


def test_a_hinge_turns_and_a_limited_one_to_its_limit(workshop: Workshop) -> None:
    """The free one keeps its direction, the limited one is dragged along."""
    for limits in (None, [-0.25, 0.25]):
        joint = {"type": "revolute"} | ({"limits": limits} if limits else {})
        simulation = Simulation(workshop.world({"pair": joined(workshop, joint)}))
        simulation.accept("/cmd_vel", command(0, 1.0))
        simulation.step(100)
        first, second = simulation.state().bodies
        relative = first.pose.relative(second.pose)
        assert first.pose.theta > 0.5
        assert relative[:2] == pytest.approx((0.3, 0), abs=0.01)
        assert relative.theta == pytest.approx(-first.pose.theta if limits is None else -0.25, abs=0.02)


def test_bodies_are_pulled_to_their_anchors(workshop: Workshop) -> None:
    """Also at the angle of a weld between bodies that cannot become one."""
    pair = joined(workshop, {"type": "weld", "angle": 0.5}, offset=0.5, linear_damping=1)
    simulation = Simulation(workshop.world({"pair": pair}))
    simulation.step(100)
    first, second = simulation.state().bodies
    assert first.pose.relative(second.pose) == pytest.approx((0.3, 0, 0.5), abs=0.005)


def test_a_soft_weld_swings_with_its_frequency(workshop: Workshop) -> None:
    """About a post, so that its own moment of inertia alone counts."""
    pair = joined(workshop, {"type": "weld", "frequency": 1, "damping": 0})
    pair["bodies"][0]["type"] = "static"
    simulation = Simulation(workshop.world({"pair": pair}))
    simulation.set_velocity("pair", (0, 0, 0))
    disc = simulation._instance.physics.bodies[1]
    disc.set_velocity(0, 0, 1.0)
    angles = []
    for _ in range(300):
        simulation.step()
        angles.append(simulation.state().bodies[1].pose.theta)
    crossings = [i for i in range(1, 300) if angles[i - 1] < 0 <= angles[i]]
    assert [b - a for a, b in pairwise(crossings)] == pytest.approx([100, 100], abs=3)
    assert max(angles) == pytest.approx(1 / math.tau, rel=0.1)


@pytest.mark.parametrize(("collide", "count"), [(False, 0), (True, 1)])
def test_joined_bodies_collide_only_where_the_joint_says_so(
    workshop: Workshop, collide: bool, count: int
) -> None:
    for kind in ("revolute", "weld"):
        pair = joined(workshop, {"type": kind, "collide_connected": collide})
        pair["joints"][0]["bodies"][0]["anchor"] = [0.05, 0]
        simulation = Simulation(workshop.world({"pair": pair}))
        simulation.step(3)
        assert len(simulation.state().contacts) == count


def test_unconnected_bodies_of_one_model_do_collide(workshop: Workshop) -> None:
    """Two wheels, each welded to the base but not to each other, that overlap: they are in each other's way."""
    parts = ("base", "left", "right")
    car = {
        "bodies": [{"name": name, "footprints": [workshop.circle(0.1)]} for name in parts],
        "joints": [
            {
                "name": name,
                "type": "weld",
                "bodies": [{"name": "base", "anchor": [0, y]}, {"name": name, "anchor": [0, 0]}],
            }
            for name, y in (("left", 0.05), ("right", -0.05))
        ],
    }
    simulation = Simulation(workshop.world({"car": car}))
    simulation.step(5)
    assert {(c.body_a, c.body_b) for c in simulation.state().contacts} == {("left", "right")}
    for joint, y in zip(car["joints"], (0.11, -0.11), strict=True):
        joint["bodies"][0]["anchor"][1] = y
    simulation = Simulation(workshop.world({"car": car}))
    simulation.step(5)
    assert simulation.state().contacts == ()


def test_footprints_of_one_body_never_collide(workshop: Workshop) -> None:
    simulation = Simulation(
        workshop.world({"body": workshop.model(workshop.circle(0.1), workshop.circle(0.2))})
    )
    simulation.step(3)
    assert simulation.state().contacts == ()


# What is reported


def test_a_contact(workshop: Workshop) -> None:
    world = workshop.world(
        {"robot": driven(workshop, workshop.rectangle(-0.1, 0.1, -0.1, 0.1))}, {"a b": WALL}
    )
    simulation = Simulation(world)
    simulation.accept("/cmd_vel", command(1))
    simulation.step(150)
    [contact] = simulation.state().contacts
    assert (contact.entity_a, contact.body_a, contact.entity_b, contact.body_b) == ("robot", "base", "a", "a")
    assert contact.normal == pytest.approx((1, 0))
    assert len(contact.points) == 2
    assert {round(y, 2) for _, y in contact.points} == {-0.1, 0.1}
    assert all(x == pytest.approx(1, abs=0.002) for x, _ in contact.points)
    assert contact.force == pytest.approx(0.04 * 1 / 0.01, rel=0.1)  # 40 g at 1 m/s, stopped every 10 ms
    assert contact.reversed.reversed == contact
    assert contact.reversed.normal == pytest.approx((-1, 0))


def test_a_sensor_notices_without_being_stopped(workshop: Workshop) -> None:
    """Flatland's sequence: on an edge, away from it, to another model, away, then solid on the edge."""
    models = {name: workshop.model({**workshop.circle(0.4, sensor=True), "density": 0}) for name in "ab"}
    world = workshop.world(models, {"walls": [[0, -5, 0, 5]]}, poses={"b": (-3, 0, 0)})
    simulation = Simulation(world, step_size=1.0)

    def touching() -> list[tuple[str, str]]:
        simulation.step(2)
        contacts = simulation.state().contacts
        assert all(c.points == () and c.force == 0 and c.normal == (0, 0) for c in contacts)
        return [(c.entity_a, c.entity_b) for c in contacts]

    assert touching() == [("a", "walls")]
    simulation.set_velocity("a", (-1, 0, 0))
    assert touching() == []
    simulation.set_velocity("a", (0, 0, 0))
    simulation.move_model("b", Pose(-2.5, 0, 0))
    assert touching() == [("a", "b")]
    simulation.move_model("b", Pose(-5, 0, 0))
    assert touching() == []


def test_a_solid_body_on_an_edge_has_points_and_force(workshop: Workshop) -> None:
    world = workshop.world({"disc": workshop.model(workshop.circle(0.4))}, {"walls": [[0.3, -5, 0.3, 5]]})
    simulation = Simulation(world)
    simulation.step()
    [contact] = simulation.state().contacts
    assert isinstance(contact, Contact)
    assert len(contact.points) == 1
    simulation.step(100)
    assert simulation.pose("disc").x == pytest.approx(-0.1, abs=2 * CONTACT_SLOP)  # pushed out


def test_a_move_forgets_contacts(workshop: Workshop) -> None:
    simulation = Simulation(workshop.serp(WALL))
    simulation.accept("/cmd_vel", command(0.5))
    simulation.step(300)
    assert simulation.state().contacts
    simulation.move_model("serp", Pose(-2, 0, 0))
    assert simulation.state().contacts == ()
    simulation.step()
    assert simulation.state().contacts == ()
    simulation.move_model("serp", Pose(0.98, 0, 0))
    simulation.step()
    assert simulation.state().contacts
