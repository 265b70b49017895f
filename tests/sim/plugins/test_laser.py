"""Lasers see what they should, where it is, and nothing else."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from kit.geometry import Pose
from kit.msg.sensor_msgs import LaserScan
from kit.sim.plugins.laser import MAX_RAYS
from kit.sim.simulation import Simulation
from kit.world.problems import WorldError
from tests.sim.workshop import Workshop

NAN = math.nan
PI = math.pi


def scans(simulation: Simulation, steps: int = 1) -> dict[str, LaserScan]:
    """The last scan on each topic."""
    sent = simulation.step(steps)
    return {out.topic: out.message for out in sent if isinstance(out.message, LaserScan)}


RANGES = {
    "/r/scan": [4.5, 4.4, 4.3],
    "/scan_center": [4.8, 4.7, 4.6, 4.9, 4.8],
    "/r/scan_back": [NAN, 3.2, 3.5, NAN, NAN],
}


@pytest.mark.parametrize(
    "name", ["laser/world.yaml", "flatland:flatland_plugins/test/laser_tests/range_test/world.yaml"]
)
def test_ranges(workshop: Workshop, name: str) -> None:
    seen = scans(Simulation(workshop.find(name), step_size=1.0), 10)
    assert seen.keys() == RANGES.keys()
    for topic, expected in RANGES.items():
        scan = seen[topic]
        assert list(scan.ranges) == pytest.approx(expected, abs=1e-5, nan_ok=True)
        assert (scan.range_min, scan.time_increment, scan.scan_time) == (0, 0, 0)
        assert scan.intensities == array("f")
    assert seen["/r/scan"].header.frame_id == "r_laser_front"
    assert seen["/scan_center"].header.frame_id == "r_center_laser"
    assert seen["/r/scan_back"].header.frame_id == "r_laser_back"
    assert (seen["/r/scan"].range_max, seen["/r/scan_back"].range_max) == (5, 4)


@pytest.mark.parametrize(
    "name",
    ["laser/shining.world.yaml", "flatland:flatland_plugins/test/laser_tests/intensity_test/world.yaml"],
)
def test_what_reflects_shines(workshop: Workshop, name: str) -> None:
    seen = scans(Simulation(workshop.find(name), step_size=1.0), 10)
    for topic, expected in RANGES.items():
        assert list(seen[topic].ranges) == pytest.approx(expected, abs=1e-5, nan_ok=True)
    assert list(seen["/r/scan"].intensities) == [0, 0, 0]
    assert list(seen["/scan_center"].intensities) == [0, 255, 0, 0, 0]
    assert list(seen["/r/scan_back"].intensities) == [0, 0, 0, 0, 0]


def laser(**keys: Any) -> dict[str, Any]:
    return {
        "type": "Laser",
        "name": "laser",
        "body": "base",
        "range": 10,
        "angle": {"min": 0, "max": 0, "increment": 1},
        **keys,
    }


def test_no_mirror_shines_through_a_wall(workshop: Workshop) -> None:
    """Flatland's bug: anything reflecting along the ray counted."""
    model = workshop.model(workshop.circle(0.1), plugins=[laser()])
    walls = {"walls": [[2, -1, 2, 1]], "reflectance": [[3, -1, 3, 1]]}
    scan = scans(Simulation(workshop.world({"robot": model}, walls)))["/scan"]
    assert (list(scan.ranges), list(scan.intensities)) == ([2], [0])


def test_ray_order_upside_down(workshop: Workshop) -> None:
    name = "flatland:flatland_plugins/test/laser_tests/range_test/world.cw.yaml"
    seen = scans(Simulation(workshop.find(name), step_size=1.0))
    assert list(seen["/r/scan"].ranges) == pytest.approx([4.3, 4.4, 4.5], abs=1e-5)


def test_upside_down_mirrors_and_flipped_reverses(workshop: Workshop) -> None:
    angle = {"min": 0, "max": 0.21, "increment": 0.1}
    lasers = [
        laser(name="plain", topic="plain", angle=angle),
        laser(name="mirrored", topic="mirrored", angle=angle, upside_down=True),
        laser(name="reversed", topic="reversed", angle=angle, flipped=True),
    ]
    robot = workshop.model(workshop.circle(0.1), plugins=lasers)
    world = workshop.world({"robot": robot}, {"walls": [[9.4, 0, 9.4, 10]]}, poses={"robot": (5, 5, 0.2)})
    seen = {topic: list(scan.ranges) for topic, scan in scans(Simulation(world)).items()}
    assert seen["/plain"] == pytest.approx([4.489490, 4.605707, 4.777099], abs=1e-5)
    assert seen["/mirrored"] == pytest.approx([4.489490, 4.422091, 4.400000], abs=1e-5)
    assert seen["/reversed"] == seen["/plain"][::-1]


def test_91_rays_of_the_dissertation(workshop: Workshop) -> None:
    """From straight back round to straight back; index 45 is ahead."""
    box = [[-1, -2, 3, -2], [3, -2, 3, 4], [3, 4, -1, 4], [-1, 4, -1, -2]]
    scan = scans(Simulation(workshop.serp(box)))["/static_laser"]
    assert len(scan.ranges) == 91
    assert scan.ranges[45] == pytest.approx(3, abs=1e-5)
    assert [scan.ranges[0], scan.ranges[90]] == pytest.approx([1, 1], abs=1e-5)
    for i, seen in enumerate(scan.ranges):  # by hand: the nearest of four lines
        angle = -PI + i * 0.06981317007
        c, s = math.cos(angle), math.sin(angle)
        ways = [d / v for v, d in ((c, 3), (c, -1), (s, 4), (s, -2)) if d / v > 0]
        assert seen == pytest.approx(min(ways), abs=1e-5)


def test_nothing_in_range_is_nan_and_a_hit_beyond_it_too(workshop: Workshop) -> None:
    model = workshop.model(workshop.circle(0.1), plugins=[laser(range=1.5)])
    for distance, expected in ((1.4, 1.4), (1.6, NAN)):
        world = workshop.world({"robot": model}, {"walls": [[distance, -1, distance, 1]]})
        assert list(scans(Simulation(world))["/scan"].ranges) == pytest.approx([expected], nan_ok=True)


def test_own_wheels_are_seen_where_a_layer_says_so(workshop: Workshop) -> None:
    """The laser sits inside the base, which it does not see, and looks at the wheels beside it."""
    sideways = {"min": -PI / 2, "max": PI / 2, "increment": PI}
    for layers, expected in ((["solid"], [0.06, 0.06]), (["lidar"], [NAN, NAN])):
        world = workshop.serp(lidar={"angle": sideways, "layers": layers})
        seen = scans(Simulation(world))["/static_laser"].ranges
        assert list(seen) == pytest.approx(expected, nan_ok=True)


def test_what_it_sees_of_others(workshop: Workshop) -> None:
    """Shapes around the laser, sensors and other layers are not seen; what does not collide is."""
    others = {
        "around": workshop.circle(1.0),
        "sensor": workshop.circle(0.1, sensor=True),
        "elsewhere": workshop.circle(0.1, layers=["b"]),
        "nowhere": workshop.circle(0.1, layers=[]),
        "ghost": workshop.circle(0.1, collision=False, layers=["a"]),
        "solid": workshop.circle(0.1, layers=["a"]),
    }
    places = {name: (x, 0, 0) for name, x in zip(others, (0, 2, 3, 4, 5, 6), strict=True)}
    models = {name: workshop.model(footprint, type="static") for name, footprint in others.items()}
    models["robot"] = workshop.model(workshop.circle(0.1, layers=[]), plugins=[laser(layers=["a"])])
    world = workshop.world(models, {"a": (), "b": ()}, poses=places)
    simulation = Simulation(world)
    assert list(scans(simulation)["/scan"].ranges) == pytest.approx([4.9])
    simulation.delete_model("ghost")
    assert list(scans(simulation)["/scan"].ranges) == pytest.approx([5.9])


def test_a_beacon_measures_to_the_hull(workshop: Workshop) -> None:
    """Not to the robot's origin: the nose is 0.048 m ahead of it, the tail 0.117 m behind."""
    angle = {"min": -PI, "max": PI, "increment": 0.001}
    beacon = workshop.model(workshop.circle(0.1, layers=[]), type="static", plugins=[laser(angle=angle)])
    simulation = Simulation(workshop.serp())
    simulation.spawn_model(workshop.file("beacon.yaml", beacon), "beacon", "", Pose(1, 0, 0))
    for theta, distance in ((0, 0.952), (PI, 0.883), (PI / 2, 1 - 0.085)):
        simulation.move_model("serp", Pose(0, 0, theta))
        assert np.nanmin(scans(simulation)["/scan"].ranges) == pytest.approx(distance, abs=1e-4)
        assert simulation.hull_distance("serp", (1, 0)) == pytest.approx(distance)


def test_it_looks_before_the_step_and_stamps_that_time(workshop: Workshop) -> None:
    model = workshop.model(workshop.circle(0.1), plugins=[laser()])
    simulation = Simulation(workshop.world({"robot": model}, {"walls": [[5, -1, 5, 1]]}))
    simulation.set_velocity("robot", (1.0, 0.0, 0.0))
    messages = [out.message for out in simulation.step(3) if isinstance(out.message, LaserScan)]
    assert [m.ranges[0] for m in messages] == pytest.approx([5, 4.99, 4.98])
    assert [m.header.stamp.nanosec for m in messages] == [0, 10_000_000, 20_000_000]


def test_noise_has_its_deviation_and_hits_only(workshop: Workshop) -> None:
    angle = {"min": 0, "max": 6, "increment": 0.001}
    model = workshop.model(workshop.circle(0.1), plugins=[laser(noise_std_dev=0.015, angle=angle)])
    simulation = Simulation(
        workshop.world(
            {"robot": model, "post": workshop.model(workshop.circle(1.0), type="static")},
            poses={"post": (3, 0, 0)},
        )
    )
    first, second = (np.array(scans(simulation)["/scan"].ranges) for _ in range(2))
    view = simulation.latest_scans()[0]
    assert np.array_equal(view.ranges, second.astype(np.float32), equal_nan=True)
    hit = ~np.isnan(first)
    assert 0.05 < hit.mean() < 0.2  # 2 asin(1/3) of 6 rad
    assert np.std(first[hit] - second[hit]) == pytest.approx(0.015 * math.sqrt(2), rel=0.1)


def test_noise_comes_from_the_seed_and_from_nothing_else(workshop: Workshop) -> None:
    def ranges(seed: int, has_subscribers: Callable[[str], bool] | None = None) -> list[float]:
        simulation = Simulation(world, seed=seed, has_subscribers=has_subscribers)
        return [list(s.message.ranges) for s in simulation.step(30) if s.topic == "/scan"][-1]

    lasers = [laser(noise_std_dev=0.1), laser(name="other", topic="other", noise_std_dev=0.1)]
    model = workshop.model(workshop.circle(0.1), plugins=lasers)
    world = workshop.world({"robot": model}, {"walls": [[5, -1, 5, 1]]})
    assert ranges(1) == ranges(1) != ranges(2)
    assert ranges(1) == ranges(
        1, has_subscribers=lambda topic: topic == "/scan"
    )  # the other laser does not matter
    simulation = Simulation(world, seed=1)
    last = simulation.step(1)
    by_topic = {s.topic: list(s.message.ranges) for s in last if isinstance(s.message, LaserScan)}
    assert by_topic["/scan"] != by_topic["/other"]


def test_an_unwanted_laser_does_not_look(workshop: Workshop) -> None:
    simulation = Simulation(
        workshop.find("laser/world.yaml"), has_subscribers=lambda topic: topic == "/r/scan"
    )
    assert {out.topic for out in simulation.step(2)} == {"/r/scan"}
    assert [view.plugin for view in simulation.latest_scans()] == ["laser_front"]


def test_scan_views_are_the_hits_in_the_world(workshop: Workshop) -> None:
    simulation = Simulation(workshop.find("laser/world.yaml"))
    simulation.step()
    views = {view.plugin: view for view in simulation.latest_scans()}
    assert views["laser_back"].pose == pytest.approx((4, 4, PI / 2))
    assert views["laser_back"].hits == pytest.approx(np.array([[0.8, 4], [4, 0.5]]), abs=1e-5)


def test_moving_the_robot_moves_the_scan(workshop: Workshop) -> None:
    simulation = Simulation(workshop.serp([[2, -1, 2, 1]]))
    assert scans(simulation)["/static_laser"].ranges[45] == pytest.approx(2)
    simulation.move_model("serp", simulation.state().pose("serp")._replace(x=0.5))
    assert scans(simulation, 10)["/static_laser"].ranges[45] == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"range": None}, "range"),
        ({"angle": {"min": 1, "max": 0, "increment": 0.1}}, "max"),
        ({"angle": {"min": 0, "max": 1, "increment": 0}}, "increment"),
        ({"angle": {"min": 0, "max": 6, "increment": 1e-9}}, "too many"),
        ({"angle": {"min": -90, "max": 90, "increment": 1}}, "90 degrees are 1.571"),
        ({"angle": {"min": 0, "max": 1, "increment": 1, "step": 1}}, "step"),
        ({"topic": "a b"}, "topic name"),
        ({"layers": ["nope"]}, "nope"),
        ({"body": "nope"}, "nope"),
    ],
)
def test_mistakes(workshop: Workshop, keys: dict[str, Any], words: str) -> None:
    plugin = {key: value for key, value in laser(**keys).items() if value is not None}
    with pytest.raises(WorldError, match=words):
        workshop.world({"robot": workshop.model(workshop.circle(0.1), plugins=[plugin])}, {"walls": ()})


def test_a_laser_has_as_many_rays_as_are_allowed(workshop: Workshop) -> None:
    def rays(count: int) -> int:
        angle = {"min": 0, "max": 0.0001 * (count - 1), "increment": 0.0001}
        model = workshop.model(workshop.circle(0.1), plugins=[laser(angle=angle)])
        (scan,) = scans(Simulation(workshop.world({"robot": model}, {"walls": [[2, -1, 2, 1]]}))).values()
        return len(scan.ranges)

    assert rays(MAX_RAYS) == MAX_RAYS
    with pytest.raises(WorldError, match=f"{MAX_RAYS + 1} rays are too many: at most {MAX_RAYS}"):
        rays(MAX_RAYS + 1)
