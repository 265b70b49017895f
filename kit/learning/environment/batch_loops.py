"""The compiled loops over a batch's worlds, with what is the same for all worlds."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kit.arrays import BoolArray, Float32Array, FloatArray, IntArray
from kit.geometry import Pose
from kit.kernels import batch_step, compilation, grids, world_kernels
from kit.kernels.arrays import RobotStates, ScanDraws, StepInputs, StepRules
from kit.learning.environment.case_arrays import CaseArrays
from kit.learning.environment.distance_field import CELL
from kit.learning.maps.batch_map import geometry_for_scans
from kit.learning.maps.ray_directions import RAY_COUNT
from kit.learning.tasks.learning_task import LearningTask

SCAN_LENGTH = -(-RAY_COUNT // 32) * 32
"""A scan's room: whole vectors of numbers are faster. What follows the last ray is the reach."""


class BatchScan(NamedTuple):
    """What the lidars of m worlds read."""

    ranges: Float32Array
    """(m, robots, SCAN_LENGTH) as far as agents see."""
    frame: Float32Array
    """(m, robots, frame size) the numbers of an observation; those that are of rays come first, the others are not written."""


class BatchLoops:
    """The loops for a task's cases; the arrays that they fill are of m worlds."""

    def __init__(self, task: LearningTask, case_arrays: CaseArrays, n: int, *, has_ways: bool) -> None:
        """``n``: how many worlds a step is of. ``has_ways``: whether targets stand, so that tables have the ways to them."""
        self._robots, self._frame_size = task.robots, task.observation.frame_size
        robot = case_arrays.robot
        lidar = robot.lidar
        single_rays, sectors = task.observation.ray_tables(task.robots)
        self.rules = StepRules(
            fleet=case_arrays.fleet,
            seen_fleet=geometry_for_scans(case_arrays.fleet, robot, task.robots),
            obstacles=case_arrays.obstacles,
            ways=case_arrays.ways,
            ways_corners=case_arrays.ways_corners,
            cell=CELL,
            has_ways=has_ways,
            radius=task.target_radius,
            is_by_hull=task.measured_to == "hull",
            lidar=np.array(lidar),
            is_lidar_offset=lidar != Pose(),
            max_sensed=task.observation.clip,
            scale=task.observation.scale,
            single_rays=single_rays,
            sectors=sectors,
        )
        """What is the same in every step."""
        self._scratch = batch_step.allocate_scratch(self.rules, n, task.robots)
        self._step = compilation.TypedKernel(batch_step.step_batch)
        self._find_arrivals = compilation.TypedKernel(world_kernels.find_arrivals)
        self._interpolate = compilation.TypedKernel(grids.interpolate_tables)
        self._carry = compilation.TypedKernel(world_kernels.carry_lidars)
        self._scan = compilation.TypedKernel(world_kernels.scan_worlds)

    def allocate_robots(self, n: int) -> RobotStates:
        """Arrays for the robots of ``n`` worlds, not filled."""
        shape, scan = (n, self._robots), self._allocate_scan(n)
        return RobotStates(
            pose=np.empty((*shape, 3)),
            clearance=np.empty(shape),
            hit=np.empty(shape, dtype=np.bool_),
            to_go=np.empty(shape),
            in_target=np.empty(shape, dtype=np.bool_),
            rotation=np.empty(shape),
            ranges=scan.ranges,
            readings=scan.frame,
        )

    def step(self, robots: RobotStates, inputs: StepInputs) -> RobotStates:
        """Makes one step of all ``n`` worlds; returns the robots after it. Ways are filled where tables have them."""
        after = self.allocate_robots(len(inputs.maps))
        self._step(self.rules, self._scratch, inputs, robots, after)
        return after

    def _allocate_scan(self, m: int) -> BatchScan:
        """Arrays for the scans of ``m`` worlds."""
        return BatchScan(
            np.empty((m, self._robots, SCAN_LENGTH), dtype=np.float32),
            np.empty((m, self._robots, self._frame_size), dtype=np.float32),
        )

    def find_arrivals(self, poses: FloatArray, targets: FloatArray) -> BoolArray:
        """(m, robots): who is in the target, whatever its heading."""
        rules, inside = self.rules, np.empty(poses.shape[:2], dtype=np.bool_)
        self._find_arrivals(rules.fleet, poses, targets, rules.radius, rules.is_by_hull, inside)
        return inside

    def measure_ways(self, rows: IntArray, poses: FloatArray) -> FloatArray:
        """(m, robots): the ways to the usual places of the targets ``rows`` (m), as the tables have them."""
        rules, found = self.rules, np.empty(poses.shape[:2])
        self._interpolate(rules.ways, rules.ways_corners, rules.cell, rows, poses, found)
        return found

    def scan(self, maps: IntArray, poses: FloatArray, draws: ScanDraws, bodies: FloatArray) -> BatchScan:
        """What robots at ``poses`` scan; see ``world_kernels.scan_worlds``."""
        rules, scan, lidars = self.rules, self._allocate_scan(len(poses)), poses
        if rules.is_lidar_offset:
            lidars = np.empty_like(poses)
            self._carry(rules.lidar, poses, lidars)
        self._scan(
            self._scratch.buffers,
            self._scratch.seen_hulls,
            rules.seen_fleet,
            maps,
            lidars,
            *draws,
            rules.obstacles,
            bodies,
            rules.max_sensed,
            rules.scale,
            rules.single_rays,
            rules.sectors,
            scan.ranges,
            scan.frame,
        )
        return scan
