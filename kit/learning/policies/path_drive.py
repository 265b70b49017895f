"""Makes an episode of an evaluation a drive that can be drawn without its task."""

from __future__ import annotations

import numpy as np

from kit.learning.environment.batch_map import load_batch_map
from kit.learning.environment.env import obstacle_outlines
from kit.learning.environment.episode_stats import EpisodeOutcome
from kit.learning.environment.tasks import LearningTask
from kit.learning.policies.evaluation import EpisodePath, EvaluationResult, PathRecorder
from kit.learning.tasks.learning_task import PatrolGoal, TargetGoal
from kit.render.drive_playback import DrivenPlace, DrivePlayback
from kit.render.scene import Disc


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
    has_target = isinstance(task.goal, TargetGoal | PatrolGoal)
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
