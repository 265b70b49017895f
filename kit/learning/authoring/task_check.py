"""Checks a task against its worlds: starts that touch a wall, targets out of reach, rewards that cannot be called."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from kit.arrays import BoolArray, FloatArray
from kit.geometry import Pose
from kit.kernels import world_kernels
from kit.learning.environment.case_arrays import CaseArrays
from kit.learning.maps.batch_floor import are_on_floor, hull_radius, hull_width, measure_floor
from kit.learning.maps.batch_map import BatchMap, batch_geometry, load_batch_map
from kit.learning.tasks.case_reader import START_KEYS, TARGET_KEYS, PlacedCase
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.student_reward import reward_parameters
from kit.learning.tasks.task_case import TaskCase
from kit.learning.tasks.task_reader import ReadTask
from kit.plain_text import quoted, suggestion
from kit.sim.card_world import load_card_world


def check_task(read: ReadTask) -> None:
    """Raises WorldError with all that is wrong with a task's starts and targets, each with its place in the file;
    UnsupportedWorld for a map that the batch engine cannot represent, UnknownTask for a case that is none, and
    RewardFileError."""
    task = read.task
    if task.reward_file is not None:
        reward_parameters(task.reward_file)
    cards = task.map_cards
    _check_robots(read)
    read.problems.raise_if_any()  # without its robots a map is no ground to check starts on
    maps = [load_batch_map(card, task.robots_on(card)) for card in cards]
    for batch_map in maps:
        if task.goal.needs_obstacles and not batch_map.obstacles:
            read.section.error(
                f"the goal {task.goal.kind} needs models that move, and {batch_map.name} has none but robots: give its world "
                "a model with a Tween, as the map crossing has",
                "goal",
            )
        seen = min(task.observation.clip, batch_map.robot.reach)
        if task.goal.farthest_measured >= seen:
            read.section.error(
                f"the goal {task.goal.kind} counts up to {task.goal.farthest_measured:g} m from a wall, and an agent on "
                f"{batch_map.name} sees {seen:g} m at the most (the observation's clip, the lidar's range): "
                "it could not tell what counts from what does not",
                "goal",
            )
    for placed in read.cases:
        _check_case(task, placed, maps[placed.map_number])
    read.problems.raise_if_any()
    _check_time(read, maps)
    read.problems.raise_if_any()
    CaseArrays(task)


def _check_robots(read: ReadTask) -> None:
    """Notes the robots that a map does not have."""
    if not read.section.has("robots"):
        return
    for card in read.task.map_cards:
        names = [model.name for model in load_card_world(card).models]
        for robot in read.task.robots_on(card):
            if robot not in names:
                read.section.error(
                    f"{card.name} has no model named {quoted(robot)}: {suggestion(robot, names)}", "robots"
                )


def _check_case(task: LearningTask, placed: PlacedCase, batch_map: BatchMap) -> None:
    case, is_free = placed.case, True
    movable = [obstacle.name for obstacle in batch_map.obstacles]
    if case.targets.model is not None and case.targets.model not in movable:
        placed.error(
            f"nothing that moves on {batch_map.name} is named {quoted(case.targets.model)}: "
            f"{suggestion(case.targets.model, movable)}",
            TARGET_KEYS,
        )
    for number in range(max(len(places.poses) for places in case.starts)):
        poses = [places.poses[number] for places in case.starts if places.poses]
        touches = np.flatnonzero(touching(batch_map, poses))
        off = ~are_on_floor(batch_map, np.array([[pose.x, pose.y] for pose in poses]).reshape(-1, 2))
        is_free &= not (len(touches) or off.any())
        for robot in np.flatnonzero(off):
            placed.error(
                f"the start ({poses[robot].x:g}, {poses[robot].y:g}) is inside a wall, or off the floor that the walls around the "
                "robot's place in the world enclose",
                (("other_starts",) if robot else ()) + START_KEYS,
            )
        for robot in touches[~off[touches]]:
            x, y, theta = poses[robot]
            placed.error(
                f"the start ({x:g}, {y:g}, {theta:g} rad) is inside a wall or another robot, or touches one",
                (("other_starts",) if robot else ()) + START_KEYS,
            )
    is_free = is_free and _has_floor_to_start_on(placed, batch_map)
    if _starts_in_target(task, case):
        placed.error("every robot starts in the target, so that an episode is over at once", START_KEYS)
    if case.targets.model is None and task.goal.needs_target and is_free:
        _check_targets(task, placed, batch_map)


def _has_floor_to_start_on(placed: PlacedCase, batch_map: BatchMap) -> bool:
    """Whether there is a place in the area where episodes start; if not, that is noted."""
    starts = placed.case.starts[0]
    floor = measure_floor(batch_map)
    if not starts.is_area or len(floor.area_cells(starts.area, floor.clearance > hull_radius(batch_map))):
        return True
    placed.error("it has no free floor for a robot to start on", START_KEYS)
    return False


def _check_time(read: ReadTask, maps: list[BatchMap]) -> None:
    """Notes what cannot be reached before the time is up, however a robot drives."""
    task, speed = read.task, read.task.actions.largest[0]
    if not speed:
        read.section.error("no action moves a robot forward or back", "actions")
        return
    lasts = task.max_steps * task.step_time
    for card, case in task.map_cases():
        way = _least_way(task, case, hull_radius(maps[task.map_cards.index(card)]))
        needed = task.goal.least_time(way, speed)
        if needed > lasts:
            read.section.error(
                f"an episode is over after {lasts:g} s, and at {speed:g} m/s the goal takes {needed:.1f} s or more in {case.name}: "
                "give a greater limit, or faster actions",
                "step",
            )


def _least_way(task: LearningTask, case: TaskCase, hull: float) -> float:
    """[m] No way of the first robot to its targets is shorter; 0 where they or its start are drawn by chance. ``hull`` [m]: the
    robot's radius."""
    starts, targets = (
        [(pose.x, pose.y) for pose in places.poses] for places in (case.starts[0], case.targets)
    )
    if not (starts and targets and task.goal.has_standing_targets):
        return 0.0
    reach = task.target_radius + hull + _most_shift(task, case)
    route = task.route(case) if task.goal.is_route else ()
    to_first = min(math.dist(start, end) for start in starts for end in route[:1] or targets) - reach
    return max(0.0, to_first) + sum(max(0.0, math.dist(*leg) - 2.0 * reach) for leg in pairwise(route))


def _starts_in_target(task: LearningTask, case: TaskCase) -> bool:
    """Whether in some start all robots are in the target for sure, whatever is drawn."""
    room = task.target_radius - _most_shift(task, case)
    if not task.goal.begins_outside_target or task.goal.heading_tolerance is not None:
        return False
    return any(
        all(math.hypot(pose.x - target.x, pose.y - target.y) <= room for pose in start)
        for start in zip(*(places.poses for places in case.starts), strict=True)
        for target in case.targets.poses
    )


def _most_shift(task: LearningTask, case: TaskCase) -> float:
    """[m] By so much a start and its target are nearer or farther at most than the file says."""
    shifts = (case.start_shift, case.target_shift, (task.start.noise, task.start.noise))
    return sum(math.hypot(*shift) for shift in shifts)


def _check_targets(task: LearningTask, placed: PlacedCase, batch_map: BatchMap) -> None:
    """Whether the targets can be reached from the first robot's first start."""
    case, floor, width = placed.case, measure_floor(batch_map), hull_width(batch_map)
    starts = case.starts[0]
    if starts.is_area:
        found = floor.area_cells(starts.area, floor.clearance > hull_radius(batch_map))
        start = Pose(float(found[0, 0]), float(found[0, 1]))
    else:
        start = starts.poses[0]
    reached = floor.reached_from(start.x, start.y, width)
    targets = [(each.x, each.y) for each in case.targets.poses]
    for x, y in targets:
        if not len(
            _cells_within(floor.area_cells(None, reached), x, y, task.target_radius + hull_radius(batch_map))
        ):
            placed.error(
                f"the target ({x:g}, {y:g}) cannot be reached: there is no path from ({start.x:g}, {start.y:g}) "
                f"that is {width:g} m wide",
                TARGET_KEYS,
            )
    if case.targets.is_area and not len(floor.area_cells(case.targets.area, reached)):
        placed.error(
            f"nothing in it can be reached from ({start.x:g}, {start.y:g})",
            TARGET_KEYS,
        )


def _cells_within(cells: FloatArray, x: float, y: float, distance: float) -> FloatArray:
    """The points, of (k, 2), that lie within a distance [m] of another one."""
    near: FloatArray = cells[np.hypot(cells[:, 0] - x, cells[:, 1] - y) <= distance]
    return near


def touching(batch_map: BatchMap, poses: list[Pose]) -> BoolArray:
    """(robots,) which robots touch a wall or another robot at these poses."""
    count = len(poses)
    hit = np.zeros((1, count), dtype=np.bool_)
    fleet = batch_geometry([batch_map])
    world_kernels.step_worlds(
        fleet,
        np.zeros(1, dtype=np.int64),
        np.zeros((1, count, 2)),
        np.zeros(1),
        np.array([poses], dtype=np.float64),
        np.zeros((1, count)),
        hit,
    )
    found: BoolArray = hit[0]
    return found
