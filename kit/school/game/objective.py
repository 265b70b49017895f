"""Measures in the simulator, tick by tick, how much of a level's goal is achieved: the same count as in training."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np

from kit.arrays import FloatArray
from kit.fields.adjacency import adjacency_score
from kit.learning.maps.ray_directions import RAY_COUNT, ranges_in_directions, ray_direction
from kit.learning.tasks.goals.goal import KNOWN_IN_RACE, GoalCase
from kit.learning.tasks.transition import FAR, EpisodeState, Transition
from kit.render.scene import Disc
from kit.run.metrics import is_in_target
from kit.run.scenario import BEACON, Scenario
from kit.school.game.levels import GameLevel
from kit.sim.simulation import Simulation

USUAL_RADIUS = 0.25
"""Of targets on levels whose map has no case [m]."""
ABREAST = 0.5
"""From this score on two robots stand side by side: as far as 6 cm ahead of each other, or 19 degrees apart."""
DIRECTIONS = np.array([ray_direction(ray) for ray in range(RAY_COUNT)])


class Objective:
    """The goal of one drive. ``on_step`` is called after every tick until it is achieved."""

    def __init__(self, level: GameLevel, scenario: Scenario, step_size: float) -> None:
        """``scenario``: the level's own, as it was loaded; ``step_size``: of its ticks [s]."""
        self._goal, self._any_order, self._leader = level.goal, level.any_order, level.leader
        self._is_by_axle = level.measured_to == "axle"
        self._target_heading = np.array([scenario.target_heading or 0.0])
        self._robots = scenario.partners
        self._least_abreast = level.abreast
        self._ticks = self._ticks_abreast = 0
        self._obstacles = [
            model.name
            for model in scenario.world.models
            if model.name not in (*self._robots, BEACON) and any(body.footprints for body in model.bodies)
        ]
        case = scenario.case
        places = self._goal.route(level.targets or (() if case is None else (case.target,)))
        radius = USUAL_RADIUS if case is None else case.target_radius
        self._all = tuple(Disc(x, y, radius) for x, y in places)
        self._has_moving_disc = bool(self._leader) and self._goal.has_standing_targets
        start = scenario.starts[0]
        goal_case = GoalCase(level.map_card, self._robots, (start.x, start.y), len(level.targets))
        self._count = self._goal.make_count([goal_case], 1, step_size)
        self._needed = float(self._count.needed[0])
        self._begin(np.array([scenario.starts], dtype=np.float64))

    def _begin(self, poses: FloatArray) -> None:
        """Sets the count to nothing achieved; ``poses`` (1, robots, 3)."""
        self.reached_s: float | None = None
        """When it was achieved [simulated s]."""
        self.splits: tuple[float, ...] = ()
        """When each target of a route was reached [simulated s]."""
        self.target_m: float | None = None
        """From the hull of the robot that is farthest to the nearest target that is left [m]; None where there is none."""
        self._left = list(self._all)
        world = np.zeros(1, dtype=np.int64)
        self._state = _first_state(poses, self._target_heading, self._count.begin(world, world, poses))

    def on_step(self, simulation: Simulation) -> None:
        """Counts one tick."""
        if self._has_moving_disc:
            x, y, _ = simulation.pose(self._leader)
            self._left = [Disc(x, y, disc.radius) for disc in self._left]
        poses = np.array([[simulation.pose(name) for name in self._robots]], dtype=np.float64)
        self._ticks += 1
        if self._least_abreast:
            self._ticks_abreast += bool(adjacency_score(poses[0, 0], poses[0, 1]) >= ABREAST)
        arrived = next((disc for disc in self.discs if self._is_inside(simulation, disc, poses)), None)
        if self.discs:
            self.target_m = min(
                max(simulation.hull_distance(name, (disc.x, disc.y)) for name in self._robots)
                for disc in self.discs
            )
        before = self._state
        after = replace(
            before,
            step=before.step + 1,
            pose=poses,
            in_target=np.full((1, len(self._robots)), arrived is not None),
            target=self._target(simulation),
        )
        if self._goal.reads_lidar:
            after = replace(after, ranges=self._ranges(simulation, poses))
        if self._obstacles:
            after = replace(after, obstacle_distance=self._nearest_obstacles(simulation, after.pose))
        counts = self._count.count(Transition(before, after, max_steps=0))
        self._state = replace(after, count=counts, achieved=counts / self._needed)
        is_counted = np.floor(counts[0]) > np.floor(before.count[0])
        if arrived is not None and self._goal.is_route and is_counted:
            self._left.remove(arrived)
            self.splits = (*self.splits, simulation.time_ns / 1e9)
        if self._state.achieved[0] >= 1.0:
            self.reached_s = simulation.time_ns / 1e9

    def put_back(self) -> None:
        """A robot has bumped and was put back to its start: on a route that would be the shortest way home."""
        if self._goal.is_lost_at_start:
            self._begin(self._state.pose)

    @property
    def progress(self) -> str:
        """How much of it is achieved, in a few words; empty where there is nothing to count."""
        counted = self._goal.progress(float(self._state.count[0]), self._needed)
        abreast = f"side by side {self.share_abreast:.0%}" if self._least_abreast else ""
        return "  ".join(filter(None, (counted, abreast)))

    @property
    def shortfall(self) -> str:
        """How much of it is achieved, and how far the next target is, in words."""
        distance = "" if self.target_m is None else f"{self.target_m:.2f} m from the next target"
        return ", ".join(filter(None, (self.progress.replace("  ", ", "), distance)))

    @property
    def is_apart(self) -> bool:
        """Whether two robots have been side by side for less of the drive than the level asks."""
        return self.share_abreast < self._least_abreast

    @property
    def share_abreast(self) -> float:
        """The share of the drive so far in which two robots were side by side; 1 where the level does not ask for it."""
        return self._ticks_abreast / self._ticks if self._least_abreast and self._ticks else 1.0

    @property
    def discs(self) -> tuple[Disc, ...]:
        """The targets that may be reached next."""
        return tuple(self._left) if self._any_order else tuple(self._left[:1])

    def _is_inside(self, simulation: Simulation, disc: Disc, poses: FloatArray) -> bool:
        """Whether all robots have arrived; ``poses`` (1, robots, 3)."""
        place = disc.x, disc.y
        if self._is_by_axle:
            inside = np.hypot(poses[:, :, 0] - disc.x, poses[:, :, 1] - disc.y) <= disc.radius
        else:
            inside = np.array([[is_in_target(simulation, name, place, disc.radius) for name in self._robots]])
        return bool(self._goal.is_arrived(inside, poses, self._target_heading).all())

    def _ranges(self, simulation: Simulation, poses: FloatArray) -> FloatArray:
        """(1, robots, 91) [m] what the robots' lidars measured last, in the directions in which agents look."""
        found = np.full((1, len(self._robots), RAY_COUNT), FAR)
        scans = {scan.model: scan for scan in simulation.latest_scans()}
        for number, (name, pose) in enumerate(zip(self._robots, poses[0], strict=True)):
            if name in scans:
                scan = scans[name]
                angles = np.arctan2(scan.beams.sin, scan.beams.cos) + scan.pose.theta - pose[2]
                found[0, number] = ranges_in_directions(DIRECTIONS, scan.ranges, angles, FAR)
        return found

    def _target(self, simulation: Simulation) -> FloatArray:
        """(1, 2)"""
        if self._leader:
            return np.array([simulation.pose(self._leader)[:2]])
        return np.array([(disc.x, disc.y) for disc in self.discs[:1]] or [(0.0, 0.0)])

    def _nearest_obstacles(self, simulation: Simulation, poses: FloatArray) -> FloatArray:
        """(1, robots) [m]"""
        places = np.array([simulation.pose(name)[:2] for name in self._obstacles])
        nearest: FloatArray = np.hypot(*np.moveaxis(poses[:, :, None, :2] - places, -1, 0)).min(axis=-1)
        return nearest


def _first_state(poses: FloatArray, target_heading: FloatArray, count: FloatArray) -> EpisodeState:
    """The state of one world with robots at ``poses`` (1, robots, 3), of which a race knows what is ``KNOWN_IN_RACE``."""
    shape = poses.shape[:2]
    known: dict[str, Any] = {
        "case": np.zeros(1, dtype=np.int64),
        "step": np.zeros(1, dtype=np.int64),
        "pose": poses,
        "hit": np.zeros(shape, dtype=np.bool_),
        "in_target": np.zeros(shape, dtype=np.bool_),
        "target": np.zeros((1, 2)),
        "target_heading": target_heading,
        "obstacle_distance": np.full(shape, FAR),
        "count": count,
        "achieved": np.zeros(1),
    }
    assert known.keys() == KNOWN_IN_RACE
    unknown = np.full(shape, np.nan)
    return EpisodeState(**{each.name: known.get(each.name, unknown) for each in fields(EpisodeState)})
