"""What the batch engine takes of a world, and how it names what it cannot take."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kit.learning.maps.batch_map import (
    BatchMap,
    UnsupportedWorld,
    batch_geometry,
    batch_map_of_world,
    geometry_for_scans,
)
from kit.learning.maps.obstacles import SEEN, TOUCHED, make_obstacle_parts
from tests.sim.workshop import Workshop

Mapped = Mapping[str, Any]
SQUARE = [[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]]
BESIDE = [[0.3, 0.1], [0.1, 0.1], [0.1, -0.1], [0.3, -0.1]]
"""Not around the lidar."""
LASER = {"type": "Laser", "name": "lidar", "body": "base", "range": 10, "layers": ["seen"]} | {
    "angle": {"min": -1, "max": 1, "increment": 0.5}
}
DRIVE = {"type": "DiffDrive", "name": "drive", "body": "base"}
TRICYCLE = {"type": "TricycleDrive", "name": "drive", "body": "base", "front_wheel_joint": "steering"} | {
    "rear_left_wheel_joint": "left",
    "rear_right_wheel_joint": "right",
}
TRIGGERED = {"type": "Tween", "name": "to_and_fro", "body": "cart", "mode": "trigger", "trigger_topic": "go"}
ROUND = {"type": "circle", "radius": 0.1, "density": 1, "layers": ["wall"]}
ROOM = {"wall seen": [(-2, -2, 2, -2), (2, -2, 2, 2), (2, 2, -2, 2), (-2, 2, -2, -2)]}


def footprint(**changes: Any) -> dict[str, Any]:
    return {"type": "polygon", "points": SQUARE, "density": 1, "layers": ["wall"]} | changes


def body(name: str = "base", **changes: Any) -> dict[str, Any]:
    return {"name": name, "footprints": [footprint()]} | changes


def robot(**changes: Any) -> dict[str, Any]:
    return {"bodies": [body()], "plugins": [DRIVE, LASER]} | changes


TRICYCLE_BODIES = [body(), *(body(name) for name in ("front", "rear_left", "rear_right"))]
AXLES = [
    {
        "name": joint,
        "type": kind,
        "bodies": [{"name": "base", "anchor": place}, {"name": wheel, "anchor": [0, 0]}],
    }
    for joint, kind, wheel, place in (
        ("steering", "revolute", "front", [0, 0]),
        ("left", "weld", "rear_left", [-0.3, 0.1]),
        ("right", "weld", "rear_right", [-0.3, -0.1]),
    )
]


@pytest.fixture
def workshop(tmp_path: Path) -> Workshop:
    return Workshop(tmp_path)


def batch_map(workshop: Workshop, models: Mapped, **changes: Any) -> BatchMap:
    drivers = [name for name in models if name.startswith("robot")]
    layers = changes.pop("layers", ROOM)
    return batch_map_of_world(workshop.world(models, layers, **changes), "test", drivers)


def test_a_plain_robot_in_a_room(workshop: Workshop) -> None:
    post = {"bodies": [{"name": "post", "type": "static", "footprints": [footprint(layers=[])]}]}
    taken = batch_map(workshop, {"robot": robot(), "post": post})
    assert len(taken.walls) == 4
    assert len(taken.robot.ray_angles) == 5
    assert (taken.robot.reach, taken.robot.noise) == (10.0, 0.0)
    around = robot(plugins=[DRIVE, LASER | {"layers": ["all"]}])
    assert len(batch_map(workshop, {"robot": around, "post": post}).walls) == 4  # it stands inside its hull
    (hull,) = taken.robot.hull
    assert sorted(hull) == sorted((x, y) for x in (-0.1, 0.1) for y in (-0.1, 0.1))


def test_parts_that_the_lidar_sees_hide_what_is_behind_them(workshop: Workshop) -> None:
    """One of them walls stop, the other passes through them and is no part of the hull."""
    stopped = footprint(layers=["wall", "seen"], points=BESIDE)
    passing = footprint(layers=["wheels"], points=[[-0.1, 0.2], [-0.3, 0.2], [-0.3, -0.2], [-0.1, -0.2]])
    taken = batch_map(workshop, {"robot": robot(bodies=[body(footprints=[footprint(), stopped])])}).robot
    assert taken.own_ranges == pytest.approx(
        [math.inf, 0.1 / math.cos(0.5), 0.1, 0.1 / math.cos(0.5), math.inf]
    )
    assert len(taken.hull) == 2
    round_about = LASER | {
        "layers": ["seen", "wheels"],
        "angle": {"min": -math.pi, "max": math.pi, "increment": math.pi / 2},
    }
    models = {"robot": robot(bodies=[body(footprints=[footprint(), passing])], plugins=[DRIVE, round_about])}
    taken = batch_map(workshop, models, layers={**ROOM, "wheels": []}).robot
    assert taken.own_ranges == pytest.approx([0.1, math.inf, math.inf, math.inf, 0.1])
    assert len(taken.hull) == 1


@pytest.mark.parametrize(
    ("models", "reason"),
    [
        ({"robot": robot(bodies=[body(), body("arm")])}, "joints"),
        ({"robot": robot(bodies=[body(pose=[1, 0, 0])])}, "at the origin"),
        ({"robot": robot(bodies=[body(type="kinematic")])}, "dynamic"),
        ({"robot": robot(bodies=[body(footprints=[footprint(sensor=True)])])}, "to collide"),
        ({"robot": robot(plugins=[DRIVE])}, "one Laser, not 0"),
        ({"robot": robot(plugins=[DRIVE, LASER, LASER | {"name": "second"}])}, "one Laser, not 2"),
        ({"robot": robot(plugins=[LASER])}, "one DiffDrive or TricycleDrive, not 0"),
        (
            {"robot": robot(plugins=[TRICYCLE, LASER], bodies=TRICYCLE_BODIES, joints=AXLES)},
            "a tricycle's wheels touch nothing",
        ),
        ({"robot": robot(plugins=[DRIVE, LASER, {"type": "Gps", "name": "gps", "body": "base"}])}, "no Gps"),
        (
            {"robot": robot(plugins=[DRIVE | {"linear_dynamics": {"acceleration_limit": 1}}, LASER])},
            "no acceleration limits",
        ),
        ({"robot": robot(plugins=[DRIVE | {"veer": 0.1}, LASER])}, "do not veer"),
        ({"robot": robot(), "cart": {"bodies": [body("cart")]}}, "in training only robots can be pushed"),
        (
            {"robot": robot(), "cart": {"bodies": [body("cart", type="kinematic")], "plugins": [TRIGGERED]}},
            "trigger",
        ),
        (
            {"robot": robot(), "cart": {"bodies": [body("cart")], "plugins": [TRIGGERED | {"mode": "yoyo"}]}},
            'lacks the line "type: kinematic"',
        ),
        ({"robot_1": robot(), "robot_2": robot()}, "does not see robot_2, .* looks at wall"),
        ({f"robot_{number}": robot() for number in range(5)}, "not 5"),
    ],
)
def test_what_it_cannot_represent_it_names(workshop: Workshop, models: Mapped, reason: str) -> None:
    with pytest.raises(UnsupportedWorld, match=reason) as refusal:
        batch_map(workshop, models)
    assert "training" in str(refusal.value)


def test_a_round_robot_with_a_lidar_off_its_origin(workshop: Workshop) -> None:
    all_round = LASER | {
        "origin": [0.05, 0, 0],
        "angle": {"min": 0, "max": 6.2744, "increment": math.tau / 720},
    }
    limited = DRIVE | {"linear_dynamics": {"velocity_limit": 0.2}}
    taken = batch_map(
        workshop, {"robot": robot(bodies=[body(footprints=[ROUND])], plugins=[limited, all_round])}
    )
    (hull,) = taken.robot.hull
    corners = np.array(hull)
    middles = (corners + np.roll(corners, 1, axis=0)) / 2
    assert np.hypot(*middles.T) == pytest.approx(0.1)  # around the circle
    assert np.hypot(*corners.T).max() < 0.101
    assert (taken.robot.lidar.x, taken.robot.max_speed, taken.robot.max_turn_rate) == (0.05, 0.2, math.inf)
    assert taken.robot.ray_angles == pytest.approx(np.radians(np.arange(-180, 181, 4)))
    fleet = batch_geometry([taken])
    seen = geometry_for_scans(fleet, taken.robot, 1)
    assert seen.hulls.corners[:, 0] == pytest.approx(fleet.hulls.corners[:, 0] - 0.05)
    assert seen.hull_radius == pytest.approx(0.15, rel=0.02)


def test_walls_must_be_both_touched_and_seen(workshop: Workshop) -> None:
    glass = ROOM | {"glass": [(-1, 0, 1, 0)]}
    seeing = robot(plugins=[DRIVE, LASER | {"layers": ["seen", "glass"]}])
    with pytest.raises(UnsupportedWorld, match="touches and sees"):
        batch_map(workshop, {"robot": seeing}, layers=glass)


def test_a_plugin_of_the_world_is_refused(workshop: Workshop) -> None:
    walls = {"type": "RandomWall", "name": "walls", "layer": "wall", "num_of_walls": 1, "wall_wall_dist": 1}
    with pytest.raises(UnsupportedWorld, match="no RandomWall of the whole world"):
        batch_map(
            workshop, {"robot": robot()}, plugins=[walls | {"double_wall": False, "robot_name": "robot"}]
        )


def test_maps_stand_one_after_the_other(workshop: Workshop) -> None:
    small = batch_map(workshop, {"robot": robot()})
    many = BatchMap("many", np.random.default_rng(0).uniform(-1, 1, (200, 4)), small.robot, small.starts)
    fleet = batch_geometry([small, many, small])
    for number, each in enumerate((small, many, small)):
        first, end = fleet.walls.starts[fleet.map_blocks[number : number + 2]]
        ours = {tuple(wall) for wall in fleet.walls.ends[first:end].tolist()}
        assert ours == {tuple(wall) for wall in each.walls.tolist()}
    assert fleet.map_blocks.tolist()[0] == 0
    assert fleet.hull_radius == pytest.approx(np.hypot(0.1, 0.1))
    assert len(fleet.beams.cos) == len(small.robot.ray_angles)
    assert fleet.visibility.map_grids[:, 2].astype(bool).tolist() == [True, False, True]


def test_robots_of_one_batch_are_alike(workshop: Workshop) -> None:
    one = batch_map(workshop, {"robot": robot()})
    other = batch_map(workshop, {"robot": robot(plugins=[DRIVE, LASER | {"range": 5}])})
    with pytest.raises(UnsupportedWorld, match="identical robots"):
        batch_geometry([one, other])
    assert batch_geometry([one], noise=0.1).noise_std == 0.1


def test_things_that_stand_or_move_are_obstacles(workshop: Workshop) -> None:
    tween = {"type": "Tween", "name": "to_and_fro", "body": "cart", "duration": 2, "delta": [1, 0, 0]}
    cart = {"bodies": [body("cart", type="kinematic", footprints=[ROUND])], "plugins": [tween]}
    post = {"bodies": [body("post", type="static", footprints=[footprint(layers=["wall", "seen"])])]}
    taken = batch_map(workshop, {"robot": robot(), "cart": cart, "post": post})
    assert [(each.name, each.parts[0].bits) for each in taken.obstacles] == [
        ("cart", TOUCHED),
        ("post", TOUCHED | SEEN),
    ]
    assert taken.obstacles[0].period == 4.0
    parts = make_obstacle_parts([taken.obstacles, taken.obstacles])
    assert parts.map_parts.tolist() == [0, 2, 4]
    assert parts.body.tolist() == [0, 1, 0, 1]
