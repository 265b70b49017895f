"""Counts what worlds have achieved of their goal: steps at a time, for many worlds at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kit.fields.adjacency import wrap_angles
from kit.kernels import grids
from kit.learning.environment.case_arrays import CaseArrays
from kit.learning.environment.observations import LEFT_RAYS, RIGHT_RAYS
from kit.learning.environment.tasks import LearningTask
from kit.learning.tasks.floor import FLOOR_CELL, hull_radius, hull_width, measure_floor
from kit.learning.tasks.goals import AvoidGoal, CoverGoal, FollowGoal, PatrolGoal, TargetGoal, WallGoal

FloatArray = NDArray[np.float64]
SingleArray = NDArray[np.float32]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


class GoalCount:
    """The goal of a task, and how much of it makes it reached."""

    def __init__(self, task: LearningTask, case_arrays: CaseArrays) -> None:
        self.task = task
        self._case_arrays = case_arrays
        cases = len(case_arrays.maps)
        self.needed = np.ones(cases)
        """(cases): the count at which the goal is reached."""
        self._floors = np.zeros((cases, 0, 0), dtype=np.bool_)
        self._origins = np.zeros((cases, 2))
        match task.goal:
            case PatrolGoal(rounds):
                self.needed = rounds * case_arrays.target_count.astype(np.float64)
            case WallGoal():
                self.needed[:] = task.goal.length
            case FollowGoal() | AvoidGoal():
                self.needed[:] = task.goal.time
            case CoverGoal():
                self._lay_floors(task.goal)
            case TargetGoal():
                pass

    def _lay_floors(self, goal: CoverGoal) -> None:
        """Which cells are to be covered: those that a robot's radius of covering can reach."""
        floors, origins = [], []
        for number, (_, batch_map) in enumerate(self._case_arrays.maps):
            floor, (x, y) = measure_floor(batch_map), self._case_arrays.first_start(number)
            reached = floor.reached_from(x, y, hull_width(batch_map)) & (
                floor.clearance > max(hull_radius(batch_map) - goal.radius, 0.0)
            )
            floors.append(reached)
            origins.append(floor.origin)
        rows, columns = (max(floor.shape[axis] for floor in floors) for axis in (0, 1))
        self._floors = np.zeros((len(floors), rows, columns), dtype=np.bool_)
        for whole, floor_cells in zip(self._floors, floors, strict=True):
            whole[: floor_cells.shape[0], : floor_cells.shape[1]] = floor_cells
        self._origins = np.array(origins)
        self.needed = goal.share * self._floors.sum(axis=(1, 2))

    @property
    def covered_shape(self) -> tuple[int, int]:
        """(rows, columns) of the cells that a world remembers as covered."""
        return self._floors.shape[1:]

    @property
    def has_targets(self) -> bool:
        """Whether episodes have a target that stands somewhere."""
        return isinstance(self.task.goal, TargetGoal | PatrolGoal)

    @property
    def wants_heading(self) -> bool:
        """Whether being in the target takes a heading."""
        goal = self.task.goal
        return isinstance(goal, TargetGoal) and goal.heading_tolerance is not None

    def is_facing(self, poses: FloatArray, rows: IntArray) -> BoolArray:
        """(m, robots): whose heading is that of its target, of the targets ``rows`` (m), as the goal asks."""
        goal = self.task.goal
        if not isinstance(goal, TargetGoal) or goal.heading_tolerance is None:
            return np.ones(poses.shape[:2], dtype=np.bool_)
        headings = self._case_arrays.targets[rows, 2]
        facing: BoolArray = np.abs(wrap_angles(poses[:, :, 2] - headings[:, None])) <= goal.heading_tolerance
        return facing

    def cover(self, cases: IntArray, poses: FloatArray, covered: BoolArray, counts: FloatArray) -> None:
        """Marks in ``covered`` (m, rows, columns) what robots cover at ``poses``, and adds new cells to ``counts`` (m,)."""
        goal = self.task.goal
        if isinstance(goal, CoverGoal):
            grids.cover_cells(
                poses, cases, self._origins, FLOOR_CELL, self._floors, goal.radius, covered, counts
            )

    def seconds_near_leader(self, distances: FloatArray) -> FloatArray:
        """(n,) for how long every robot was near its leader in a step that ended at these distances (n, robots)."""
        goal = self.task.goal
        assert isinstance(goal, FollowGoal)
        near = (distances >= goal.nearest) & (distances <= goal.farthest)
        return np.where(near.all(axis=1), self.task.step_time, 0.0)

    def seconds_away(self, nearest: FloatArray) -> FloatArray:
        """(n,) for how long every robot was far enough from everything that moves, ``nearest`` (n, robots) [m]."""
        goal = self.task.goal
        assert isinstance(goal, AvoidGoal)
        return np.where((nearest > goal.distance).all(axis=1), self.task.step_time, 0.0)

    def metres_along_wall(self, ranges: SingleArray, forward: FloatArray) -> FloatArray:
        """(n,) how far robots drove beside a wall, on average; ``ranges`` (n, robots, rays), ``forward`` (n, robots) [m]."""
        goal = self.task.goal
        assert isinstance(goal, WallGoal)
        rays = LEFT_RAYS if goal.side == "left" else RIGHT_RAYS
        beside = ranges[:, :, rays].min(axis=2)
        counts = np.abs(beside - goal.distance) <= goal.tolerance
        metres: FloatArray = (counts * np.maximum(forward, 0.0)).mean(axis=1)
        return metres
