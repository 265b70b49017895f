"""A task's cases as arrays: where episodes start and end, and how far it is from anywhere."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from kit.arrays import BoolArray, FloatArray, IntArray
from kit.kernels import compilation, grids, kernels, world_kernels
from kit.learning.environment.distance_field import CELL, DistanceField, compute_distance_field
from kit.learning.maps.batch_floor import FLOOR_CELL, hull_radius, hull_width, measure_floor
from kit.learning.maps.batch_map import BatchMap, UnsupportedWorld, batch_geometry, load_batch_map
from kit.learning.maps.obstacles import ObstacleMotions, make_obstacle_parts
from kit.learning.maps.ray_directions import RAY_COUNT
from kit.learning.tasks.goals.goal import GoalCase
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.task_case import TaskCase
from kit.plain_text import counted

MAX_AREA_TARGETS = 64
"""Number of evenly spread targets taken from a target area; the distance to each is computed from everywhere."""
MAX_TRIES = 30
"""Starts on free floor are drawn again at most this many times where robots would touch or begin in the target."""
DRAWS_PER_TRY = 64
START_ROOM = 0.02
"""Starts on free floor keep the hull this far from walls [m]."""


class EpisodeStarts(NamedTuple):
    """Start poses and targets of ``m`` episodes."""

    poses: FloatArray
    """(m, robots, 3)"""
    targets: FloatArray
    """(m, 2)"""
    rows: IntArray
    """(m,) the target's number among all targets of all cases."""
    phases: FloatArray
    """(m,) 0 to 1: where on their ways moving models begin."""


@dataclass(frozen=True, slots=True, eq=False)
class _CasePlaces:
    """The places of one case."""

    starts: FloatArray
    """(k, robots, 3): poses, or the middles of cells with no robot's heading yet."""
    is_area: bool
    headings: tuple[float, float]
    targets: FloatArray
    """(t, 3)"""
    target_jitter: float
    """m: a target lies up to this far from its place along x and y."""


class CaseArrays:
    """The cases of a task, numbered in the order of ``task.map_cases()``."""

    def __init__(self, task: LearningTask) -> None:
        """Raises UnsupportedWorld for a map that the batch engine cannot represent."""
        courses = task.map_cases()
        cards = list(dict.fromkeys(card for card, _ in courses))
        batch_maps = [load_batch_map(card, task.robots_on(card)) for card in cards]
        for each in batch_maps:
            _check_robots(task, each)
        self.task = task
        self._draw = compilation.TypedKernel(world_kernels.draw_starts)
        self.fleet = batch_geometry(batch_maps, task.lidar_noise)
        self.robot = batch_maps[0].robot
        """What all robots are: they are identical."""
        self.obstacles = make_obstacle_parts([each.obstacles for each in batch_maps])
        self.motions = ObstacleMotions([each.obstacles for each in batch_maps])
        self.map_of: IntArray = np.array([cards.index(card) for card, _ in courses], dtype=np.int64)
        """(cases): the number of each case's map in ``fleet``."""
        self.maps = [(cards[number], batch_maps[number]) for number in self.map_of]
        """(cases): each case's map."""
        cases = [case for _, case in courses]
        self.leaders = np.array(
            [_leader_index(case, each) for case, (_, each) in zip(cases, self.maps, strict=True)]
        )
        """(cases): the number of the obstacle that is the target; -1 where it does not move."""
        places = [_case_places(case, task, each) for case, (_, each) in zip(cases, self.maps, strict=True)]
        self._lay_out(cases, places)
        self._measure_ways(places)

    def _lay_out(self, cases: list[TaskCase], places: list[_CasePlaces]) -> None:
        """Tables of the places of all cases."""
        task = self.task
        self.target_count = np.array([len(each.targets) for each in places], dtype=np.int64)
        self.target_first = np.cumsum([0, *self.target_count], dtype=np.int64)[:-1]
        """(cases): the number of each case's first target."""
        self.targets = np.concatenate([each.targets for each in places])
        """(targets, 3): all targets' places and headings."""
        start_count = np.array([len(each.starts) for each in places], dtype=np.int64)
        jitter, shifted = np.array([each.target_jitter for each in places]), task.start.shifted
        self._start_tables = kernels.StartTables(
            starts=np.ascontiguousarray(np.concatenate([each.starts for each in places]), dtype=np.float64),
            start_first=np.cumsum([0, *start_count], dtype=np.int64)[:-1],
            start_count=start_count,
            start_shift=np.array([case.start_shift for case in cases]) * shifted,
            is_area=np.array([each.is_area for each in places]),
            headings=np.array([each.headings for each in places], dtype=np.float64),
            any_heading=np.array([float(case.is_heading_random and shifted) for case in cases]),
            targets=self.targets,
            target_first=self.target_first,
            target_choices=np.ones_like(self.target_count) if task.goal.is_route else self.target_count,
            target_shift=np.array([case.target_shift for case in cases]) * shifted + jitter[:, None],
            noise=np.array([task.start.noise, task.start.noise, task.start.max_rotation]),
            cell_size=FLOOR_CELL,
        )
        self._has_areas = bool(self._start_tables.is_area.any())

    def _measure_ways(self, places: list[_CasePlaces]) -> None:
        """Tables of the ways to every target."""
        tables = [
            _distance_field(self.task, batch_map, (x, y))
            for each, (_, batch_map) in zip(places, self.maps, strict=True)
            for x, y, _ in each.targets.tolist()
        ]
        self.ways_corners = np.array([table.origin for table in tables])
        """(targets, 2): the middle of the first cell of each table."""
        rows, columns = (max(table.values.shape[axis] for table in tables) for axis in (0, 1))
        self.ways = np.zeros((len(tables), rows, columns), dtype=np.float32)
        """(targets, rows, columns): the way to each target [m] from the middle of each cell."""
        for values, table in zip(self.ways, tables, strict=True):
            height, width = table.values.shape
            values[:height, :width] = table.values

    def draw_starts(self, cases: IntArray, keys: IntArray, first: IntArray) -> EpisodeStarts:
        """Starts for the ``cases`` (m); world i draws number ``first[i]`` and following of ``keys[i]``."""
        found = self._draw_starts(cases, keys, first)
        is_area = self._start_tables.is_area
        if not self._has_areas or not is_area[cases].any():
            return found
        for number in range(1, MAX_TRIES):
            bad = np.flatnonzero(is_area[cases] & self._is_bad(cases, found))
            if not len(bad):
                break
            again = self._draw_starts(cases[bad], keys[bad], first[bad] + number * DRAWS_PER_TRY)
            for old, new in zip(found, again, strict=True):
                old[bad] = new
        return found

    def _draw_starts(self, cases: IntArray, keys: IntArray, first: IntArray) -> EpisodeStarts:
        m = len(cases)
        found = EpisodeStarts(
            np.empty((m, self.task.robots, 3)), np.empty((m, 2)), np.empty(m, dtype=np.int64), np.empty(m)
        )
        self._draw(self._start_tables, cases, keys, first, *found)
        return found

    def _is_bad(self, cases: IntArray, found: EpisodeStarts) -> BoolArray:
        """(m,) where robots would touch each other or an obstacle, or begin in the target."""
        m, robots, radius = len(cases), self.task.robots, self.fleet.hull_radius
        bad = np.zeros(m, dtype=np.bool_)
        for one in range(robots):
            for other in range(one):
                apart = found.poses[:, one, :2] - found.poses[:, other, :2]
                bad |= np.hypot(*apart.T) <= 2.0 * radius + START_ROOM
        maps = self.map_of[cases]
        bodies = self.motions.poses(maps, np.zeros(m), found.phases)
        if bodies.shape[1]:
            nearest = np.full((m, robots), np.inf)
            grids.find_nearest_obstacles(self.obstacles, maps, bodies, found.poses, nearest)
            reach = self.obstacles.reach.max(initial=0.0)
            bad |= (nearest <= radius + reach + START_ROOM).any(axis=1)
        if self.task.goal.begins_outside_target:
            away = np.hypot(*np.moveaxis(found.poses[:, :, :2] - found.targets[:, None], 2, 0))
            bad |= (away <= self.task.target_radius + radius).any(axis=1)
        return bad

    @property
    def goal_cases(self) -> tuple[GoalCase, ...]:
        """What a goal knows of each case."""
        return tuple(
            GoalCase(
                card, self.task.robots_on(card), self._first_start(number), int(self.target_count[number])
            )
            for number, (card, _) in enumerate(self.maps)
        )

    def _first_start(self, case: int) -> tuple[float, float]:
        """A place where episodes of a case start [m]."""
        x, y, _ = self._start_tables.starts[self._start_tables.start_first[case], 0].tolist()
        return x, y

    def to_go(self, rows: IntArray, poses: FloatArray) -> FloatArray:
        """(m, robots): the way to the usual places [m] of the targets ``rows`` (m), from ``poses`` (m, robots, 3)."""
        found = np.empty(poses.shape[:2])
        grids.interpolate_tables(self.ways, self.ways_corners, CELL, rows, poses, found)
        return np.maximum(found, self.task.path_end)


def _check_robots(task: LearningTask, batch_map: BatchMap) -> None:
    if len(batch_map.starts) != task.robots:
        raise UnsupportedWorld(
            f"{batch_map.name} has {counted(len(batch_map.starts), 'robot')}, task {task.name} has {task.robots}"
        )
    rays = batch_map.robot.ray_angles
    if len(rays) != RAY_COUNT:
        low, high = math.degrees(min(rays)), math.degrees(max(rays))
        raise UnsupportedWorld(
            f"{batch_map.name}: agents see all round, in {RAY_COUNT} directions 4 degrees apart; its lidar has {len(rays)} "
            f"rays from {low:.0f} to {high:.0f} degrees"
        )
    robot, (speed, turn_rate) = batch_map.robot, task.actions.largest
    if robot.wheelbase and task.disturbances.inertia.high > 0.0:
        raise UnsupportedWorld(f"{batch_map.name}: training has no inertia of a tricycle's motors")
    turns = (turn_rate, robot.max_turn_rate, "rad" if robot.wheelbase else "rad/s")
    for fastest, limit, unit in ((speed, robot.max_speed, "m/s"), turns):
        if fastest > limit:
            raise UnsupportedWorld(
                f"{batch_map.name}: its motors do at most {limit:g} {unit}, and task {task.name} has an action of "
                f"{fastest:g} {unit}"
            )


def _case_places(case: TaskCase, task: LearningTask, batch_map: BatchMap) -> _CasePlaces:
    area = case.starts[0]
    if area.is_area:
        x, y = _reached_from(case, batch_map)
        floor = measure_floor(batch_map)
        room = hull_radius(batch_map) + START_ROOM + FLOOR_CELL / math.sqrt(2)
        allowed = floor.reached_from(x, y, hull_width(batch_map)) & (floor.clearance >= room)
        cells = floor.area_cells(area.area, allowed)
        if not len(cells):
            raise UnsupportedWorld(
                f"case {case.name}: there is no free floor to start on {area.description} from which "
                f"({x:g}, {y:g}) can be reached"
            )
        starts = np.zeros((len(cells), task.robots, 3))
        starts[:, :, :2] = cells[:, None]
    else:
        starts = np.array(_start_poses(case, task))
    targets, jitter = _target_places(case, batch_map)
    return _CasePlaces(starts, area.is_area, area.headings, targets, jitter)


def _reached_from(case: TaskCase, batch_map: BatchMap) -> tuple[float, float]:
    """A point from which everything in the case must be reached."""
    if case.targets.poses and case.targets.poses[0][:2] != (0.0, 0.0):
        return case.target
    if not case.starts[0].is_area:
        return case.start.x, case.start.y
    return batch_map.starts[0].x, batch_map.starts[0].y


def _target_places(case: TaskCase, batch_map: BatchMap) -> tuple[FloatArray, float]:
    """(t, 3) the places that targets may be, and how far they may lie from these along x and y [m]."""
    if not case.targets.is_area:
        return np.array(case.targets.poses or [(0.0, 0.0, 0.0)]).reshape(-1, 3), 0.0
    floor, (x, y) = measure_floor(batch_map), _reached_from(case, batch_map)
    reached = floor.reached_from(x, y, hull_width(batch_map))
    cells = floor.area_cells(case.targets.area, reached & (floor.clearance > hull_radius(batch_map)))
    if not len(cells):
        raise UnsupportedWorld(f"case {case.name}: no target {case.targets.description} can be reached")
    chosen = _spread_out_points(cells, MAX_AREA_TARGETS)
    return np.concatenate([chosen, np.zeros((len(chosen), 1))], axis=1), 0.5 * FLOOR_CELL


def _spread_out_points(cells: FloatArray, most: int) -> FloatArray:
    """Returns at most ``most`` of the points (k, 2), each as far as possible from those before it."""
    if len(cells) <= most:
        return cells
    chosen, nearest = [0], np.hypot(*(cells - cells[0]).T)
    while len(chosen) < most:
        chosen.append(int(nearest.argmax()))
        nearest = np.minimum(nearest, np.hypot(*(cells - cells[chosen[-1]]).T))
    return cells[chosen]


def _leader_index(case: TaskCase, batch_map: BatchMap) -> int:
    if case.targets.model is None:
        return -1
    names = [obstacle.name for obstacle in batch_map.obstacles]
    if case.targets.model not in names:
        raise UnsupportedWorld(
            f"case {case.name}: nothing movable on {batch_map.name} is named "
            f"{case.targets.model}. There is: {', '.join(names) or 'nothing'}"
        )
    return names.index(case.targets.model)


def _distance_field(task: LearningTask, batch_map: BatchMap, target: tuple[float, float]) -> DistanceField:
    """The ways to a target; nothing where the goal has none that stands."""
    if task.goal.has_standing_targets:
        return compute_distance_field(batch_map, target)
    return DistanceField(np.zeros((2, 2), dtype=np.float32), (0.0, 0.0))


def _start_poses(case: TaskCase, task: LearningTask) -> list[list[tuple[float, float, float]]]:
    """(k, robots) start poses of the case's robots, with the gap that the task asks for."""
    if len(case.starts) < task.robots:
        raise UnsupportedWorld(f"case {case.name} does not say where every robot starts")
    count = len(case.starts[0].poses)
    rows = [[places.poses[number] for places in case.starts[: task.robots]] for number in range(count)]
    if task.robots != 2:
        return [[(pose.x, pose.y, pose.theta) for pose in row] for row in rows]
    found = []
    for left, right in rows:
        x, y = (left.x + right.x) / 2, (left.y + right.y) / 2
        wide = 1.0
        if task.start.gap is not None:
            wide = task.start.gap / math.hypot(right.x - left.x, right.y - left.y)
        found.append(
            [(x + wide * (each.x - x), y + wide * (each.y - y), each.theta) for each in (left, right)]
        )
    return found
