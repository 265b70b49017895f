"""The ways of episodes over their map, and one of them as a drive that is played back."""

from __future__ import annotations

from typing import Literal

import numpy as np

from kit.arrays import FloatArray
from kit.learning.environment.env import obstacle_outlines
from kit.learning.environment.episode_stats import EpisodeOutcome
from kit.learning.maps.batch_map import load_batch_map
from kit.learning.policies.episode_paths import EpisodePath, PathRecorder
from kit.learning.policies.evaluation import EvaluationResult
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.task_case import Area, TaskCase
from kit.render.drive_playback import DrivenPlace, DrivePlayback
from kit.render.scene import Disc, Scene, SceneMark, ScenePath
from kit.world.catalogue import MapCard

ROBOT_MARKS = "•o"
"""Where the first robot was at every full second, and where the second was."""


ROBOT_LINES: tuple[Literal["solid"], Literal["dashed"]] = ("solid", "dashed")


def build_paths_scene(
    task: LearningTask, card: MapCard, case: TaskCase, ways: tuple[EpisodePath, ...]
) -> Scene:
    """The ways of one case over its map, with a mark for every second: solid with ``•`` for the first robot, dashed with
    ``o`` for the second, dotted where the goal was not reached. Areas in which starts (S) and targets (T) are drawn are
    dashed rectangles.
    """
    mine = [way for way in ways if way.case == case.name]
    is_fixed = len(case.targets.poses) == 1 and case.targets.model is None
    targets = [case.target] if is_fixed else sorted({way.target for way in mine})
    targets = targets if task.goal.has_standing_targets else []
    starts = [(case.start.x, case.start.y)]
    if case.starts[0].is_area or len(case.starts[0].poses) > 1:
        starts = [(x, y) for x, y in (way.poses[0, 0, :2].tolist() for way in mine)]
    ends = [way for way in mine if way.outcome is not EpisodeOutcome.REACHED]
    contacts = [way.poses[-1, 0, :2] for way in ends if way.outcome is EpisodeOutcome.COLLIDED]
    areas = [(places.area, "S") for places in case.starts] + ([(case.targets.area, "T")] if targets else [])
    known_areas = dict.fromkeys((area, label) for area, label in areas if area is not None)
    return Scene(
        walls=load_batch_map(card, task.robots_on(card)).walls,
        targets=tuple(Disc(x, y, task.target_radius) for x, y in targets),
        paths=(
            *(ScenePath(_rectangle(area), "dashed") for area, _ in known_areas),
            *(_robot_path(way, robot) for way in mine for robot in range(way.poses.shape[1])),
        ),
        contacts=np.array(contacts).reshape(-1, 2),
        marks=(
            *(mark for way in mine for mark in _second_marks(way)),
            *(SceneMark(min(area[0], area[2]), max(area[1], area[3]), label) for area, label in known_areas),
            *(SceneMark(x, y, "S") for x, y in starts),
        ),
    )


def _rectangle(area: Area) -> FloatArray:
    x1, y1, x2, y2 = area
    return np.array([(x1, y1), (x2, y1), (x2, y2), (x1, y2), (x1, y1)])


def _robot_path(way: EpisodePath, robot: int) -> ScenePath:
    line = ROBOT_LINES[robot % len(ROBOT_LINES)]
    style = line if way.outcome is EpisodeOutcome.REACHED else "dotted"
    return ScenePath(way.poses[:, robot, :2], style, robot=robot if way.poses.shape[1] > 1 else None)


def _second_marks(way: EpisodePath) -> list[SceneMark]:
    """A mark where each robot was at every full second, the start left out."""
    seconds = range(1, int((len(way.poses) - 1) * way.interval + 1e-9) + 1)
    times = np.arange(len(way.poses)) * way.interval
    marks = []
    for robot in range(way.poses.shape[1]):
        across, up = (np.interp(seconds, times, way.poses[:, robot, axis]).tolist() for axis in (0, 1))
        label = ROBOT_MARKS[robot % len(ROBOT_MARKS)]
        marks += [SceneMark(x, y, label) for x, y in zip(across, up, strict=True)]
    return marks


def worst_drive(task: LearningTask, result: EvaluationResult, recorder: PathRecorder) -> DrivePlayback:
    """The first episode of the case that went worst in an evaluation, of those that ``recorder`` has recorded."""
    return playback_of(next(each for each in recorder.paths if each.case == result.worst.case), task)


def playback_of(path: EpisodePath, task: LearningTask) -> DrivePlayback:
    """An episode of a task as a drive that can be drawn without the task. Things that move are left out."""
    card = next(card for card, each in task.map_cases() if each.name == path.case)
    batch_map = load_batch_map(card, task.robots_on(card))
    still = [each for each in batch_map.obstacles if each.motion is None]
    outlines = [outline for each in still for outline in obstacle_outlines(each, each.pose)]
    edges = [np.concatenate((corners, np.roll(corners, -1, axis=0)), axis=1) for corners in outlines]
    has_target = task.goal.has_standing_targets
    place = DrivenPlace(
        np.concatenate((batch_map.walls, *edges)),
        tuple(np.array(polygon) for polygon in batch_map.robot.hull),
        Disc(*path.target, task.target_radius) if has_target else None,
    )
    seconds = (len(path.poses) - 1) * path.interval
    return DrivePlayback(path.case, _result_text(path, seconds, has_target), path.poses, seconds, place)


def _result_text(path: EpisodePath, seconds: float, has_target: bool) -> str:
    if path.outcome is EpisodeOutcome.REACHED:
        return f"reached the {'target' if has_target else 'goal'} in {seconds:.1f} s"
    is_single = path.poses.shape[1] == 1
    collided = "hit a wall" if is_single else "collided"
    what = collided if path.outcome is EpisodeOutcome.COLLIDED else "ran out of time"
    x, y = (path.poses[-1, 0, :2].round(1) + 0.0).tolist()  # no -0.0
    return f"{what} after {seconds:.1f} s" + (f" at ({x:.1f}, {y:.1f})" if is_single else "")
