"""Who collides with whom, which laser sees whom, and why."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from kit.geometry import Pose
from kit.world.collision_rules import CollisionRules, ContactKind, RuleReason
from kit.world.loading import load_world
from kit.world.plugin_reader import PluginReader
from kit.world.records import (
    ALL_LAYERS,
    Body,
    BodyKind,
    Circle,
    Footprint,
    Joint,
    JointAnchor,
    LaserMount,
    Model,
    PluginSpec,
    Polygon,
    SourceLocation,
    World,
)

WriteFiles = Callable[[Mapping[str, str | bytes]], Path]

HERE = SourceLocation(Path("here.yaml"))
BITS = {"solid": 1, "seen": 2, "ghosts": 4}


def footprint(
    category: int, *, sensor: bool = False, collision: bool = True, shape: Circle | Polygon | None = None
) -> Footprint:
    return Footprint(shape or Circle((0, 0), 0.1), 1, 0, 0, sensor, collision, (), category, HERE)


def body(name: str, *footprints: Footprint, kind: BodyKind = "dynamic") -> Body:
    return Body(name, Pose(), kind, (1, 1, 1, 1), 0, 0, footprints, HERE)


class Looker:
    """Parameters of a plugin that sees."""

    def __init__(self, mount: LaserMount) -> None:
        self.mount = mount


def model(
    name: str, *bodies: Body, joints: tuple[Joint, ...] = (), mounts: tuple[LaserMount, ...] = ()
) -> Model:
    plugins = tuple(PluginSpec(f"eye{i}", "Laser", Looker(mount), HERE) for i, mount in enumerate(mounts))
    return Model(name, "", Pose(), HERE.file, bodies, joints, plugins, HERE)


def joint(a: str, b: str, *, collide_connected: bool = False) -> Joint:
    anchors = (JointAnchor(a, (0, 0)), JointAnchor(b, (0, 0)))
    return Joint("axle", "weld", anchors, (1, 1, 1, 1), collide_connected, None, 0, 0, 0, HERE)


def touching(*models: Model) -> CollisionRules:
    return CollisionRules(World(HERE.file, models=models, layer_bits=BITS))


def verdict(one: Body, other: Body) -> tuple[ContactKind, RuleReason, tuple[str, ...]]:
    """What the bodies of two models do, the same from either side."""
    found = touching(model("a", one), model("b", other))
    a, b = found.bodies
    assert found.contact_rule(a, b) == found.contact_rule(b, a)
    answer = found.contact_rule(a, b)
    return answer.kind, answer.reason, answer.names


def test_bodies_that_share_a_layer_collide() -> None:
    assert verdict(body("x", footprint(0b011)), body("y", footprint(0b101))) == (
        ContactKind.COLLIDES,
        RuleReason.SHARED_LAYER,
        ("solid",),
    )


def test_any_two_footprints_are_enough() -> None:
    one = body("x", footprint(0b100), footprint(0b010))
    other = body("y", footprint(0b001), footprint(0b010))
    assert verdict(one, other) == (ContactKind.COLLIDES, RuleReason.SHARED_LAYER, ("seen",))


def test_all_layers_meet_all_layers() -> None:
    both = body("x", footprint(ALL_LAYERS)), body("y", footprint(ALL_LAYERS))
    assert verdict(*both)[:2] == (ContactKind.COLLIDES, RuleReason.SHARED_LAYER)


def test_no_layer_in_common_is_no_collision() -> None:
    for one, other in ((0b001, 0b010), (0, ALL_LAYERS), (0, 0)):
        found = verdict(body("x", footprint(one)), body("y", footprint(other)))
        assert found == (ContactKind.PASSES, RuleReason.NO_SHARED_LAYER, ())


def test_collision_false_passes_but_names_the_layer() -> None:
    ghost = body("x", footprint(0b011, collision=False))
    assert verdict(ghost, body("y", footprint(0b001))) == (
        ContactKind.PASSES,
        RuleReason.COLLISION_OFF,
        ("solid",),
    )


def test_another_footprint_still_collides() -> None:
    half = body("x", footprint(0b001, collision=False), footprint(0b010))
    assert verdict(half, body("y", footprint(0b011))) == (
        ContactKind.COLLIDES,
        RuleReason.SHARED_LAYER,
        ("seen",),
    )


def test_a_sensor_notices_and_lets_through() -> None:
    sensor = body("x", footprint(0b001, sensor=True))
    assert verdict(sensor, body("y", footprint(0b001))) == (ContactKind.SENSES, RuleReason.SENSOR, ("solid",))
    assert verdict(sensor, body("y", footprint(0b001, collision=False)))[0] is ContactKind.PASSES


def test_a_solid_footprint_beside_a_sensor_collides() -> None:
    both = body("x", footprint(0b001, sensor=True), footprint(0b001))
    assert verdict(both, body("y", footprint(0b001)))[0] is ContactKind.COLLIDES


@pytest.mark.parametrize("one", ["static", "kinematic"])
@pytest.mark.parametrize("other", ["static", "kinematic", "dynamic"])
def test_one_of_the_two_must_be_dynamic(one: BodyKind, other: BodyKind) -> None:
    found = verdict(body("x", footprint(1), kind=one), body("y", footprint(1), kind=other))
    assert (found[0] is ContactKind.COLLIDES) == (other == "dynamic")
    assert (found[1] is RuleReason.NEITHER_MOVES) == (other != "dynamic")


def test_a_body_without_footprints_meets_nothing() -> None:
    assert verdict(body("x"), body("y", footprint(1)))[:2] == (ContactKind.PASSES, RuleReason.NO_FOOTPRINT)


@pytest.mark.parametrize("collide_connected", [True, False])
def test_bodies_of_one_model_collide_unless_a_joint_says_no(collide_connected: bool) -> None:
    bodies = [body(name, footprint(1)) for name in ("base", "wheel", "free")]
    found = touching(
        model("a", *bodies, joints=(joint("wheel", "base", collide_connected=collide_connected),))
    )
    base, wheel, free = found.bodies
    assert found.contact_rule(base, free).kind is ContactKind.COLLIDES
    assert (found.contact_rule(base, wheel).kind is ContactKind.COLLIDES) == collide_connected
    if not collide_connected:
        assert "axle" in found.contact_rule(base, wheel).explanation


def test_a_joint_binds_the_bodies_of_its_own_model_only() -> None:
    parts = (body("base", footprint(1)), body("wheel", footprint(1)))
    found = touching(model("a", *parts, joints=(joint("base", "wheel"),)), model("b", *parts))
    base_of_a, wheel_of_a, base_of_b, wheel_of_b = found.bodies
    assert found.contact_rule(base_of_a, wheel_of_a).reason is RuleReason.JOINED
    assert found.contact_rule(base_of_a, wheel_of_b).kind is ContactKind.COLLIDES
    assert found.contact_rule(base_of_b, wheel_of_b).kind is ContactKind.COLLIDES


def test_a_body_does_not_collide_with_itself() -> None:
    found = touching(model("a", body("base", footprint(1), footprint(1))))
    assert found.contact_rule(found.bodies[0], found.bodies[0]).reason is RuleReason.SAME_BODY


def test_every_pair_once() -> None:
    found = touching(*(model(name, body("x", footprint(1)), body("y", footprint(1))) for name in "abc"))
    assert len(list(found.contact_rules())) == 6 * 5 // 2


WALLS = {
    "world.yaml": """\
properties: {}
layers:
  - {name: [solid, seen], map: map.yaml}
  - {name: ghosts, map: map.yaml}
  - {name: empty}
models:
  - {name: robot, model: robot.model.yaml}
"""
}


def test_the_walls_of_a_layer_are_one_static_body(write: WriteFiles) -> None:
    world = write(WALLS)
    model_file = world.parent / "robot.model.yaml"
    model_file.write_text(model_file.read_text().replace("density: 1", "density: 1, layers: [seen]"))
    found = CollisionRules(load_world(world))
    solid, ghosts, robot = found.bodies
    assert (solid.model, solid.body, ghosts.body, robot.body) == (None, "solid", "ghosts", "base")
    assert found.contact_rule(solid, ghosts).reason is RuleReason.NEITHER_MOVES
    assert found.contact_rule(robot, solid).names == ("seen",)
    assert found.contact_rule(robot, ghosts).reason is RuleReason.NO_SHARED_LAYER


SQUARE = Polygon(((-1, -1), (1, -1), (1, 1), (-1, 1)))


def visibilities(mount: LaserMount, *bodies: Body) -> list[tuple[bool, RuleReason]]:
    """What a laser of the first body says of each."""
    found = touching(
        model("a", bodies[0], mounts=(mount,)), *(model(f"m{i}", b) for i, b in enumerate(bodies[1:]))
    )
    return [(visibility.is_visible, visibility.reason) for _, _, visibility in found.visibilities()]


def test_a_laser_sees_what_is_in_one_of_its_layers() -> None:
    own = body("own")
    seen = [footprint(2), footprint(3, collision=False), footprint(ALL_LAYERS)]
    unseen = [footprint(1), footprint(0)]
    others = [body("x", one) for one in (*seen, *unseen)]
    assert visibilities(LaserMount("own", 2), own, *others) == [
        (False, RuleReason.NO_FOOTPRINT),
        *[(True, RuleReason.SEEN)] * 3,
        *[(False, RuleReason.NO_SHARED_LAYER)] * 2,
    ]


def test_static_bodies_are_seen_too() -> None:
    assert visibilities(LaserMount("own", 1), body("own"), body("x", footprint(1), kind="static"))[1] == (
        True,
        RuleReason.SEEN,
    )


def test_no_laser_sees_a_sensor() -> None:
    sensor = body("x", footprint(1, sensor=True))
    assert visibilities(LaserMount("own", 1), body("own"), sensor)[1] == (False, RuleReason.SENSORS_UNSEEN)
    solid_too = body("x", footprint(1, sensor=True), footprint(1))
    assert visibilities(LaserMount("own", 1), body("own"), solid_too)[1] == (True, RuleReason.SEEN)


@pytest.mark.parametrize(
    ("origin", "inside"),
    [(Pose(0, 0), True), (Pose(0.9, -0.9), True), (Pose(1.1, 0), False), (Pose(0, -1.01), False)],
)
def test_a_laser_inside_its_own_box_does_not_see_that_box(origin: Pose, inside: bool) -> None:
    box = body("own", footprint(1, shape=SQUARE))
    expected = (False, RuleReason.INSIDE) if inside else (True, RuleReason.SEEN)
    assert visibilities(LaserMount("own", 1, origin), box) == [expected]


@pytest.mark.parametrize(("x", "inside"), [(0.99, True), (1.01, False)])
def test_a_laser_inside_its_own_disc_does_not_see_that_disc(x: float, inside: bool) -> None:
    disc = body("own", footprint(1, shape=Circle((0.5, 0), 0.5)))
    assert visibilities(LaserMount("own", 1, Pose(x, 0)), disc) == [
        (not inside, RuleReason.INSIDE if inside else RuleReason.SEEN)
    ]


def test_a_laser_sees_the_other_footprints_of_its_own_body() -> None:
    wheels = footprint(1, shape=Circle((2, 0), 0.1))
    robot = body("own", footprint(1, shape=SQUARE), wheels)
    assert visibilities(LaserMount("own", 1), robot) == [(True, RuleReason.SEEN_BUT_FOR_ITS_OWN)]


def test_a_box_of_another_body_around_the_laser_is_seen() -> None:
    assert visibilities(LaserMount("own", 1), body("own"), body("x", footprint(1, shape=SQUARE)))[1] == (
        True,
        RuleReason.SEEN,
    )


def test_reasons_are_said_in_words() -> None:
    found = touching(
        model("a", body("own", footprint(3)), mounts=(LaserMount("own", 2),)),
        model("b", body("x", footprint(1))),
    )
    assert "solid" in found.contact_rule(*found.bodies).explanation
    assert found.lasers[0].name == "a/eye0"
    assert [thing.name for thing in found.bodies] == ["a/own", "b/x"]
    assert "seen" in found.visibility(found.lasers[0], found.bodies[0]).explanation


def test_plugins_that_were_not_read_are_no_lasers(
    write: WriteFiles, devices: Mapping[str, PluginReader]
) -> None:
    world = write({})
    with (world.parent / "robot.model.yaml").open("a") as file:
        file.write("plugins: [{type: Laser, name: eye, body: base, range: 1}]\n")
    assert CollisionRules(load_world(world)).lasers == ()
    assert len(CollisionRules(load_world(world, plugin_readers=devices)).lasers) == 1


def test_fifty_models_are_quick() -> None:
    shapes = [footprint(1 << i % 3, shape=Circle((math.cos(i), 0), 0.1)) for i in range(6)]
    robots = [
        model(f"robot{i}", *(body(f"b{j}", *shapes) for j in range(4)), mounts=(LaserMount("b0", 3),))
        for i in range(50)
    ]
    found = touching(*robots)
    start = time.process_time()
    assert len(list(found.contact_rules())) == 200 * 199 // 2
    assert len(list(found.visibilities())) == 50 * 200
    assert time.process_time() - start < 2.0
