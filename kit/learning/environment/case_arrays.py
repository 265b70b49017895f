"""A task's cases as arrays: where episodes start and end, and how far it is from anywhere."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kit.kernels import kernels
from kit.learning.environment.batch_map import UnsupportedWorld, build_fleet, load_batch_map
from kit.learning.environment.distance_field import CELL, compute_distance_field
from kit.learning.environment.observations import RAY_COUNT
from kit.learning.environment.tasks import LearningTask
from kit.learning.tasks.learning_task import TaskCase

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

SHARED_DRAWS = 5
"""A start takes so many random numbers for all robots together, and three more for each of them."""


class EpisodeStarts(NamedTuple):
    """Start poses and targets of ``m`` episodes."""

    poses: FloatArray
    """(m, robots, 3)"""
    targets: FloatArray
    """(m, 2)"""


class CaseArrays:
    """The cases of a task, numbered in the order of ``task.map_cases()``."""

    def __init__(self, task: LearningTask) -> None:
        """Raises UnsupportedWorld for a map that the batch engine cannot represent."""
        courses = task.map_cases()
        cards = list(dict.fromkeys(card for card, _ in courses))
        batch_maps = [load_batch_map(card, task.robots_on(card)) for card in cards]
        for each in batch_maps:
            if len(each.starts) != task.robots:
                raise UnsupportedWorld(
                    f"{each.name} has {len(each.starts)} robots, task {task.name} {task.robots}"
                )
            if len(each.robot.ray_angles) != RAY_COUNT:
                rays = len(each.robot.ray_angles)
                raise UnsupportedWorld(
                    f"{each.name}: observations are made of {RAY_COUNT} rays, its lidar has {rays}"
                )
        self.task = task
        self.fleet = build_fleet(batch_maps, task.lidar_noise)
        self.map_of: IntArray = np.array([cards.index(card) for card, _ in courses], dtype=np.int64)
        """(cases): the number of each case's map in ``fleet``."""
        self.maps = [(cards[number], batch_maps[number]) for number in self.map_of]
        """(cases): each case's map."""
        cases = [case for _, case in courses]
        self._starts = np.array([_start_poses(case, task) for case in cases])
        self._targets = np.array([case.target for case in cases])
        shifted = task.start.shifted
        self._start_shift = np.array([case.start_shift for case in cases]) * shifted
        self._target_shift = np.array([case.target_shift for case in cases]) * shifted
        self._any_heading = np.array([case.is_heading_random and shifted for case in cases])
        tables = [
            compute_distance_field(batch_maps[number], case.target)
            for number, case in zip(self.map_of, cases, strict=True)
        ]
        self._corners = np.array([table.origin for table in tables])
        rows, columns = (max(table.values.shape[axis] for table in tables) for axis in (0, 1))
        self._to_go = np.zeros((len(cases), rows, columns), dtype=np.float32)
        for values, table in zip(self._to_go, tables, strict=True):
            height, width = table.values.shape
            values[:height, :width] = table.values

    def draw_starts(self, cases: IntArray, keys: IntArray, first: IntArray) -> EpisodeStarts:
        """Starts for the ``cases`` (m); world i draws number ``first[i]`` and following of ``keys[i]``."""
        robots = self.task.robots
        drawn = np.empty((len(cases), SHARED_DRAWS + 3 * robots))
        kernels.fill_uniform(keys, first, drawn)
        drawn = 2.0 * drawn - 1.0
        poses = self._starts[cases]
        poses[:, :, :2] += (drawn[:, 0:2] * self._start_shift[cases])[:, None, :]
        turned = math.pi * drawn[:, 2] * self._any_heading[cases]
        noise, most = self.task.start.noise, self.task.start.max_rotation
        poses += drawn[:, SHARED_DRAWS:].reshape(-1, robots, 3) * (noise, noise, most)
        poses[:, :, 2] += turned[:, None]
        return EpisodeStarts(poses, self._targets[cases] + drawn[:, 3:5] * self._target_shift[cases])

    def to_go(self, cases: IntArray, poses: FloatArray) -> FloatArray:
        """(m, robots): the way to the targets' usual places [m], from ``poses`` (m, robots, 3)."""
        found = np.empty(poses.shape[:2])
        kernels.interpolate_tables(self._to_go, self._corners, CELL, cases, poses, found)
        return np.maximum(found, self.task.path_end)


def _start_poses(case: TaskCase, task: LearningTask) -> list[tuple[float, float, float]]:
    """Start poses of the case's robots, with the gap that the task asks for."""
    if len(case.starts) < task.robots:
        raise UnsupportedWorld(f"case {case.name} does not say where every robot starts")
    poses = [places.nominal for places in case.starts[: task.robots]]
    if task.robots != 2:
        return [(pose.x, pose.y, pose.theta) for pose in poses]
    left, right = poses
    x, y = (left.x + right.x) / 2, (left.y + right.y) / 2
    wide = 1.0
    if task.start.gap is not None:
        wide = task.start.gap / math.hypot(right.x - left.x, right.y - left.y)
    return [(x + wide * (each.x - x), y + wide * (each.y - y), each.theta) for each in (left, right)]
