"""Records the paths of a few episodes and draws them over the map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.batch_map import load_batch_map
from kit.learning.environment.episode_stats import EpisodeOutcome, EpisodeStatsRecorder
from kit.learning.environment.tasks import LearningTask
from kit.learning.policies.evaluation import derive_seed
from kit.learning.policies.policies import Policy
from kit.learning.tasks.goals import Area, PatrolGoal, TargetGoal
from kit.learning.tasks.learning_task import TaskCase
from kit.render.scene import Disc, Scene, SceneMark, ScenePath
from kit.world.catalogue import MapCard


@dataclass(frozen=True, slots=True, eq=False)
class EpisodePath:
    """One episode's way."""

    case: str
    outcome: EpisodeOutcome
    poses: NDArray[np.float64]
    """(steps + 1, robots, 3), from the start on."""
    target: tuple[float, float]
    interval: float
    """Between two poses [s]."""


def record_paths(
    policy: Policy, task: LearningTask, episodes: int, seed: int, *, greedy: bool = True
) -> tuple[EpisodePath, ...]:
    """The ways of ``episodes`` episodes of each case, in the order of the task's cases.

    PolicyError if the policy does not fit.
    """
    policy.check_fits(task)
    batch = BatchEnv(task, episodes * len(task.map_cases()), seed)
    player = policy.make_player(
        batch.n, None if greedy else np.random.default_rng(derive_seed(seed, "moves"))
    )
    observations, fresh = batch.reset(seed=seed), np.ones(batch.n, dtype=np.bool_)
    starts, targets, recorder = (
        batch.state.pose.copy(),
        batch.state.target.copy(),
        EpisodeStatsRecorder(batch),
    )
    trails = [[start] for start in starts]
    ways: dict[int, EpisodePath] = {}
    while len(ways) < batch.n:
        step = batch.step(player.act(observations, fresh))
        for world in range(batch.n):
            if world not in ways:
                trails[world].append(step.transition.pose[world].copy())
        for episode in recorder.add(step):
            if episode.world not in ways:
                world, (x, y) = episode.world, targets[episode.world].tolist()
                poses = np.array(trails[world])
                ways[world] = EpisodePath(episode.case, episode.outcome, poses, (x, y), task.step_time)
        observations, fresh = step.observations, step.ended
    order = [case.name for _, case in task.map_cases()]
    return tuple(sorted((ways[world] for world in sorted(ways)), key=lambda way: order.index(way.case)))


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
    targets = targets if isinstance(task.goal, TargetGoal | PatrolGoal) else []
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


def _rectangle(area: Area) -> NDArray[np.float64]:
    x1, y1, x2, y2 = area
    return np.array([(x1, y1), (x2, y1), (x2, y2), (x1, y2), (x1, y1)])


def _robot_path(way: EpisodePath, robot: int) -> ScenePath:
    line = ROBOT_LINES[robot % len(ROBOT_LINES)]
    style = line if way.outcome is EpisodeOutcome.REACHED else "dotted"
    return ScenePath(way.poses[:, robot, :2], style, robot if way.poses.shape[1] > 1 else None)


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
