"""The compiled loops over a batch's worlds, with what is the same for all worlds."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kit.geometry import Pose
from kit.kernels import grids, world_kernels
from kit.learning.environment.batch_map import hulls_in_lidar_frame
from kit.learning.environment.case_arrays import CELL, CaseArrays
from kit.learning.environment.observations import RAY_COUNT
from kit.learning.environment.tasks import LearningTask
from kit.learning.environment.world_threads import LoopCall, WorldLoop

FloatArray = NDArray[np.float64]
SingleArray = NDArray[np.float32]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

SCAN_LENGTH = -(-RAY_COUNT // 32) * 32
"""A scan's room: whole vectors of numbers are faster. What follows the last ray is the reach."""


class BatchScan(NamedTuple):
    """What the lidars of m worlds read."""

    ranges: SingleArray
    """(m, robots, SCAN_LENGTH) as far as agents see."""
    frame: SingleArray
    """(m, robots, frame size) the numbers of an observation; those that are of rays come first, the others are not written."""


class BatchLoops:
    """Makes the calls of the loops for a task's cases; the arrays that they fill are of m worlds."""

    def __init__(self, task: LearningTask, case_arrays: CaseArrays) -> None:
        self._fleet, self._obstacles = case_arrays.fleet, case_arrays.obstacles
        self._lidar = np.array(case_arrays.lidar)
        self._has_lidars_off = case_arrays.lidar != Pose()
        self._seen_fleet = (
            hulls_in_lidar_frame(self._fleet, case_arrays.lidar) if self._has_lidars_off else self._fleet
        )
        self._ways, self._ways_corners = case_arrays.ways, case_arrays.ways_corners
        self._radius, self._is_by_hull = task.target_radius, task.measured_to == "hull"
        self._clip, self._scale, self._robots = task.observation.clip, task.observation.scale, task.robots
        self._frame_size = task.observation.frame_size
        self._single_rays, self._sectors = task.observation.ray_tables(task.robots)
        self._step = WorldLoop(world_kernels.step_worlds, shared=(0,))
        self._stop = WorldLoop(world_kernels.stop_at_obstacles, shared=(0, 1))
        self._arrive = WorldLoop(world_kernels.find_arrivals, shared=(0, 3, 4))
        self._interpolate = WorldLoop(grids.interpolate_tables, shared=(0, 1, 2))
        self._advance = WorldLoop(world_kernels.advance_worlds, shared=range(8))
        self._carry = WorldLoop(world_kernels.carry_lidars, shared=(0,))
        self._scan = WorldLoop(world_kernels.scan_worlds, shared=(0, 7, 9, 10, 11, 12))

    def move(
        self,
        maps: IntArray,
        twists: FloatArray,
        seconds: FloatArray,
        poses: FloatArray,
        clearance: FloatArray,
        hit: BoolArray,
    ) -> LoopCall:
        """Moves the robots in place by ``twists`` for ``seconds`` (m,); see ``world_kernels.step_worlds``."""
        return self._step.with_arguments(self._fleet, maps, twists, seconds, poses, clearance, hit)

    def stop_at_obstacles(
        self,
        maps: IntArray,
        bodies: FloatArray,
        before: FloatArray,
        poses: FloatArray,
        clearance: FloatArray,
        hit: BoolArray,
    ) -> LoopCall:
        """Puts robots back that meet an obstacle; see ``world_kernels.stop_at_obstacles``."""
        return self._stop.with_arguments(
            self._fleet, self._obstacles, maps, bodies, before, poses, clearance, hit
        )

    def find_arrivals(self, poses: FloatArray, targets: FloatArray, inside: BoolArray) -> LoopCall:
        """Fills ``inside`` (m, robots): who is in the target, whatever its heading."""
        return self._arrive.with_arguments(
            self._fleet, poses, targets, self._radius, self._is_by_hull, inside
        )

    def measure_ways(self, rows: IntArray, poses: FloatArray, found: FloatArray) -> LoopCall:
        """Fills ``found`` (m, robots): the ways to the usual places of the targets ``rows`` (m), as the tables have them."""
        return self._interpolate.with_arguments(self._ways, self._ways_corners, CELL, rows, poses, found)

    def advance(
        self,
        moves: int,
        has_ways: bool,
        maps: IntArray,
        twists: FloatArray,
        seconds: FloatArray,
        target_rows: IntArray,
        targets: FloatArray,
        turn: FloatArray,
        rotation_before: FloatArray,
        poses: FloatArray,
        clearance: FloatArray,
        hit: BoolArray,
        to_go: FloatArray,
        inside: BoolArray,
        rotation: FloatArray,
        full_turns: IntArray,
    ) -> LoopCall:
        """Moves the robots in place and fills what follows from their poses; see ``world_kernels.advance_worlds``."""
        return self._advance.with_arguments(
            self._fleet,
            self._ways,
            self._ways_corners,
            CELL,
            self._radius,
            self._is_by_hull,
            moves,
            has_ways,
            maps,
            twists,
            seconds,
            target_rows,
            targets,
            turn,
            rotation_before,
            poses,
            clearance,
            hit,
            to_go,
            inside,
            rotation,
            full_turns,
        )

    def allocate_scan(self, m: int) -> BatchScan:
        """Arrays for the scans of ``m`` worlds."""
        return BatchScan(
            np.empty((m, self._robots, SCAN_LENGTH), dtype=np.float32),
            np.empty((m, self._robots, self._frame_size), dtype=np.float32),
        )

    def scan(
        self,
        maps: IntArray,
        poses: FloatArray,
        keys: IntArray,
        numbers: IntArray,
        noise: FloatArray,
        dropped: FloatArray,
        bodies: FloatArray,
        scan: BatchScan,
    ) -> list[LoopCall]:
        """Fills ``scan`` from robots at ``poses``; see ``world_kernels.scan_worlds``."""
        calls, lidars = [], poses
        if self._has_lidars_off:
            lidars = np.empty_like(poses)
            calls.append(self._carry.with_arguments(self._lidar, poses, lidars))
        scanning = self._scan.with_arguments(
            self._seen_fleet,
            maps,
            lidars,
            keys,
            numbers,
            noise,
            dropped,
            self._obstacles,
            bodies,
            self._clip,
            self._scale,
            self._single_rays,
            self._sectors,
            scan.ranges,
            scan.frame,
        )
        return [*calls, scanning]
