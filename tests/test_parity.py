"""The contract between the two engines, over every map: one world with contacts, many worlds as arrays.

Free driving is equal to rounding, lidar scans are bit-equal for equal poses, the same bodies are blocked, and a
collision comes in the same tick or the next. A world that the batch engine cannot represent is refused by the name
of the feature.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import cast

import numpy as np
import pytest

from kit.arrays import Float32Array, FloatArray
from kit.geometry import Pose
from kit.kernels import kernels, world_kernels
from kit.learning.maps.batch_map import (
    BatchMap,
    UnsupportedWorld,
    axle_twists,
    batch_geometry,
    batch_map_of_world,
)
from kit.learning.maps.obstacles import ObstacleMotions, make_obstacle_parts
from kit.msg.geometry_msgs import Twist, Vector3
from kit.sim.plugins.laser import LaserParams
from kit.sim.simulation import Simulation, load_world
from kit.world.records import Model, PluginSpec, World
from tests.kit_content import kit_maps

CARDS = {card.name: card for card in kit_maps()}
TICK = 0.01
FASTEST = 0.5, 0.6
"""m/s, rad/s"""
BLOCKED_WITHIN = 2 * TICK * (FASTEST[0] + FASTEST[1] * 0.13) + 0.001
"""Where the two engines leave a robot that meets something, they differ by no more [m]: two ticks' way, and the depth
to which things in contact may overlap."""

TRICYCLES = "depot"
"""The map whose robot has joints, which give way by some thousandths of a millimetre, and is represented all the same."""

every_map = pytest.mark.parametrize("name", CARDS)


def quiet(world: World) -> World:
    """The same world, whose lasers look at every tick and without noise."""

    def plugin(spec: PluginSpec) -> PluginSpec:
        if not isinstance(spec.params, LaserParams):
            return spec
        return replace(spec, params=replace(spec.params, noise=0.0, rate=math.inf))

    def model(each: Model) -> Model:
        return replace(each, plugins=tuple(map(plugin, each.plugins)))

    return replace(world, models=tuple(map(model, world.models)))


@dataclass(frozen=True)
class Both:
    """One map in both engines."""

    world: World
    ground: BatchMap
    fleet: kernels.BatchGeometry
    robots: tuple[str, ...]
    lasers: tuple[str, ...]

    def simulation(self, poses: list[Pose], *, looking: bool) -> Simulation:
        simulation = Simulation(self.world, step_size=TICK, has_subscribers=lambda topic: looking)
        for robot, pose in zip(self.robots, poses, strict=True):
            simulation.move_model(robot, pose)
        return simulation

    def command(self, simulation: Simulation, twists: FloatArray) -> None:
        """``twists``: (robots, 2) forward [m/s] and turn [rad/s]."""
        for robot, (forward, turn) in zip(self.robots, twists.tolist(), strict=True):
            model = next(each for each in self.world.models if each.name == robot)
            message = Twist(linear=Vector3(x=forward), angular=Vector3(z=turn))
            simulation.accept(model.topic("cmd_vel"), message)


@cache
def both(name: str) -> Both:
    """Skips where the batch engine refuses the map: that has a test of its own."""
    card = CARDS[name]
    robots = tuple(each for each in (card.robot, card.partner) if each)
    world = quiet(load_world(card.world_file, root=card.root))
    try:
        ground = batch_map_of_world(world, name, robots)
    except UnsupportedWorld as refusal:
        pytest.skip(f"the batch engine refuses {name}: {refusal}")
    lasers = tuple(
        plugin.name
        for robot in robots
        for model in world.models
        if model.name == robot
        for plugin in model.plugins
        if isinstance(plugin.params, LaserParams)
    )
    return Both(world, ground, batch_geometry([ground]), robots, lasers)


def drives(name: str, count: int) -> Iterator[tuple[list[Pose], FloatArray]]:
    """Starts on the map, turned any way, and twists (robots, 2) to keep."""
    chance = np.random.default_rng(sum(map(ord, name)))
    engines = both(name)
    for _ in range(count):
        poses = [
            Pose(start.x, start.y, start.theta + chance.uniform(-math.pi, math.pi))
            for start in engines.ground.starts
        ]
        forward = chance.choice([-0.3, 0.3, FASTEST[0]], size=len(poses))
        twists = np.stack([forward, chance.uniform(-FASTEST[1], FASTEST[1], len(poses))], axis=1)
        limits = engines.ground.robot.max_speed, engines.ground.robot.max_turn_rate
        yield poses, np.clip(twists, np.negative(limits), limits)  # as tasks for such motors are held to


class Batch:
    """One world of the batch engine, moved tick by tick."""

    def __init__(self, engines: Both, poses: list[Pose]) -> None:
        self._fleet = engines.fleet
        self._obstacles = make_obstacle_parts([engines.ground.obstacles])
        self._motions, self._ticks = ObstacleMotions([engines.ground.obstacles]), 0
        self.poses = np.array([poses])
        self._free = np.zeros((1, len(poses)))

    def tick(self, twists: FloatArray) -> list[bool]:
        """Who met something."""
        hit = np.zeros(self._free.shape, dtype=np.bool_)
        here = np.zeros(1, dtype=np.int64)
        before = self.poses.copy()
        driven = axle_twists(twists[None], self._fleet.axle)
        world_kernels.step_worlds(self._fleet, here, driven, np.array([TICK]), self.poses, self._free, hit)
        self._ticks += 1
        corners = np.empty((len(self._obstacles.corners), 2))
        world_kernels.stop_at_obstacles(
            corners, self._fleet, self._obstacles, here, self._bodies(), before, self.poses, self._free, hit
        )
        return cast("list[bool]", hit[0].tolist())

    def _bodies(self) -> FloatArray:
        """(1, k, 3) where carts and the like are by now."""
        return self._motions.poses(np.zeros(1, dtype=np.int64), np.array([self._ticks * TICK]), np.zeros(1))

    def scan(self) -> Float32Array:
        """(robots, rays), noise and all; the reach where nothing is seen."""
        ranges = np.empty((1, self.poses.shape[1], 96), dtype=np.float32)
        nothing = np.zeros(1, dtype=np.int64)
        robots, single = len(self.poses[0]), np.zeros((len(self.poses[0]), 0), dtype=np.int64)
        sectors, sensed = np.zeros((0, 3), dtype=np.int64), np.zeros((1, robots, 0), dtype=np.float32)
        noise, dropped = np.array([self._fleet.noise_std]), np.zeros(1)
        most = kernels.most_corners(self._fleet.hulls.starts)
        world_kernels.scan_worlds(
            kernels.allocate_scan_buffers(self._fleet.beams.lines, most),
            world_kernels.allocate_hulls(self._fleet, self._fleet.lidar_bits),
            self._fleet,
            nothing,
            self.poses,
            nothing,
            nothing,
            noise,
            dropped,
            self._obstacles,
            self._bodies(),
            1e9,
            1.0,
            single,
            sectors,
            ranges,
            sensed,
        )
        return ranges[0]


def differences(simulation: Simulation, engines: Both, batch: Batch) -> FloatArray:
    """(robots, 3): how far apart the two engines' robots are."""
    return np.abs(np.array([simulation.pose(robot) for robot in engines.robots]) - batch.poses[0])


@every_map
def test_the_batch_engine_represents_a_map_or_names_what_it_cannot(name: str) -> None:
    card = CARDS[name]
    world = load_world(card.world_file, root=card.root)
    plain = all(
        body.kind != "dynamic" or model.name in (card.robot, card.partner)
        for model in world.models
        for body in model.bodies
    ) and not any(model.joints for model in world.models)
    if plain or name == TRICYCLES:
        assert batch_map_of_world(world, name, (card.robot, card.partner)).name == name
    else:
        with pytest.raises(UnsupportedWorld, match=r"\.yaml:\d+:\d+: .*training "):
            batch_map_of_world(world, name, (card.robot, card.partner))


@pytest.mark.long_cases("office", "racetrack")
@every_map
def test_free_driving_is_equal_and_collisions_come_together(name: str) -> None:
    engines = both(name)
    for poses, twists in drives(name, 6):
        simulation, batch = engines.simulation(poses, looking=False), Batch(engines, poses)
        if name == TRICYCLES:  # which are steered a tick before they turn
            engines.command(simulation, twists * (0.0, 1.0))
            simulation.step()
        engines.command(simulation, twists)
        for _ in range(400):
            simulation.step()
            hit = batch.tick(twists)
            if any(hit):
                break
            assert not any(simulation.is_touching(robot) for robot in engines.robots)
            assert differences(simulation, engines, batch).max() < (1e-5 if name == TRICYCLES else 1e-9)
        else:
            continue
        touching = [simulation.is_touching(robot) for robot in engines.robots]
        if touching != hit:
            simulation.step()
            touching = [simulation.is_touching(robot) for robot in engines.robots]
        assert touching == hit
        for away, blocked in zip(differences(simulation, engines, batch), hit, strict=True):
            assert not blocked or away[:2].max() < BLOCKED_WITHIN


@every_map
def test_a_blocked_robot_stays_where_it_is(name: str) -> None:
    engines = both(name)
    for poses, twists in drives(name, 2):
        batch, ahead = Batch(engines, poses), np.abs(twists) * (1.0, 0.0)
        hit = next((hit for hit in (batch.tick(ahead) for _ in range(3000)) if any(hit)), None)
        assert hit is not None
        there = batch.poses.copy()
        for _ in range(50):
            again = batch.tick(ahead)
        assert [one and other for one, other in zip(hit, again, strict=True)] == hit
        assert np.array_equal(batch.poses[0, hit], there[0, hit])


@every_map
def test_scans_are_bit_equal(name: str) -> None:
    engines = both(name)
    for poses, twists in drives(name, 3):
        simulation = engines.simulation(poses, looking=True)
        engines.command(simulation, twists)
        for _ in range(5):
            simulation.step(7)
            views = {(view.model, view.plugin): view for view in simulation.latest_scans()}
            seen = [views[key] for key in zip(engines.robots, engines.lasers, strict=True)]
            batch = Batch(engines, [view.pose for view in seen])
            angles = np.array(engines.ground.robot.ray_angles)
            for view, ranges in zip(seen, batch.scan(), strict=True):
                theirs = view.ranges
                if len(theirs) != len(angles):  # of many rays agents see some
                    apart = angles[:, None] - np.arctan2(view.beams.sin, view.beams.cos)
                    theirs = theirs[np.abs(np.angle(np.exp(1j * apart))).argmin(axis=1)]
                inside = ~np.isnan(theirs)
                ours = ranges[: len(theirs)]
                assert ours[inside].tobytes() == theirs[inside].tobytes()
                assert ours[~inside] == pytest.approx(engines.fleet.max_range)
