"""Evaluates policies: success by case, on episodes of their own, with confidence intervals; and the paths of a few episodes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Literal, NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from kit.arrays import FloatArray, IndexArray
from kit.document.blocks import Cell, CellStyle, Column, Table
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.batch_state import BatchStep
from kit.learning.environment.env import obstacle_outlines
from kit.learning.environment.episode_stats import EpisodeOutcome, EpisodeStats, EpisodeStatsRecorder
from kit.learning.maps.batch_map import load_batch_map
from kit.learning.policies.confidence_intervals import ConfidenceInterval, wilson_interval
from kit.learning.policies.policies import Policy, load_policy
from kit.learning.tasks.learning_task import Area, LearningTask, PatrolGoal, TargetGoal, TaskCase
from kit.learning.tasks.rewards import RewardFunction
from kit.render.drive_playback import DrivenPlace, DrivePlayback
from kit.render.scene import Disc, Scene, SceneMark, ScenePath
from kit.world.catalogue import MapCard

PARALLEL_WORLDS = 1024
"""About so many worlds side by side: more is not faster."""


def derive_seed(seed: int, purpose: str, number: int = 0) -> int:
    """A seed of its own for each use of a run's seed, so that no two uses see the same episodes."""
    words = np.random.SeedSequence((seed, number, *purpose.encode())).generate_state(1)
    return int(words[0])


class EpisodeShare(NamedTuple):
    """A share of an episode's steps, over several episodes."""

    mean: float
    """NaN of no episode."""
    sd: float
    """Sample standard deviation over the episodes; NaN of fewer than two."""

    @classmethod
    def of(cls, shares: Sequence[float]) -> EpisodeShare:
        """
        >>> EpisodeShare.of([0.5, 0.7]).mean
        0.6
        """
        sd = float(np.std(shares, ddof=1)) if len(shares) > 1 else np.nan
        return cls(sum(shares) / len(shares) if shares else np.nan, sd)


NO_SHARE: Final = EpisodeShare.of(())


@dataclass(frozen=True, slots=True)
class CaseResult:
    """Results of one case's episodes."""

    case: str
    group: str
    outcomes: tuple[int, int, int]
    """How many ended in each ``EpisodeOutcome``."""
    steps: float
    """Mean length of those that reached the target; NaN where none has."""
    reward: float
    """Mean sum over an episode."""
    adjacency: float
    """Mean share of an episode's steps that two robots were side by side, as rays tell; NaN for one robot."""
    adjacency_sd: float = np.nan
    """Sample standard deviation of that share over the episodes; NaN for one robot or one episode."""
    reached_by_rays: EpisodeShare = NO_SHARE
    """The share by rays of the episodes that reached the target alone: others may end side by side because they began so."""
    reached_by_poses: EpisodeShare = NO_SHARE
    """The same as poses tell."""

    @property
    def episodes(self) -> int:
        return sum(self.outcomes)

    @property
    def reached(self) -> int:
        return self.outcomes[0]

    @property
    def share(self) -> float:
        return self.reached / self.episodes

    @property
    def interval(self) -> ConfidenceInterval:
        """The 95 % confidence interval of the share."""
        return wilson_interval(self.reached, self.episodes)


def _case_cells(case: CaseResult) -> tuple[Cell, ...]:
    _, collided, timed_out = (count / case.episodes for count in case.outcomes)
    beside = (case.reached_by_rays.mean, case.reached_by_poses.mean)
    return (case.case, case.share, case.interval, collided, timed_out, case.steps, *beside)


@dataclass(frozen=True, slots=True)
class EvaluationResult:
    """Results of an evaluation on all cases."""

    task: str
    greedy: bool
    cases: tuple[CaseResult, ...]

    @property
    def mean(self) -> float:
        """Mean of the cases' shares."""
        return float(np.mean([case.share for case in self.cases]))

    @property
    def worst(self) -> CaseResult:
        """The case that goes worst: a mean hides it."""
        return min(self.cases, key=lambda case: case.share)

    @property
    def reward(self) -> float:
        """Mean sum over an episode, of all cases."""
        return float(np.mean([case.reward for case in self.cases]))

    @property
    def is_pair(self) -> bool:
        """Whether two robots drove."""
        return not np.isnan(self.cases[0].adjacency)

    def groups(self) -> dict[str, float]:
        """Mean share by group of cases; those without one are left out."""
        names = dict.fromkeys(case.group for case in self.cases if case.group)
        return {
            name: float(np.mean([case.share for case in self.cases if case.group == name])) for name in names
        }

    def table(self) -> Table:
        """A row for each case, then the mean; below it the worst case."""
        columns = [
            Column("case", CellStyle.TEXT),
            Column("success", decimals=3),
            Column("95 % interval", decimals=3),
            Column("collided", decimals=3),
            Column("timed out", decimals=3),
            Column("steps", decimals=0),
        ]
        if self.is_pair:
            columns += [Column("adj rays"), Column("adj poses")]
        rows = [_case_cells(case)[: len(columns)] for case in self.cases]
        rows.append(("mean", self.mean, *[""] * (len(columns) - 2)))
        worst = self.worst
        note = (
            f"worst: {worst.share:.3f} in {worst.case}; {worst.episodes} episodes each, {self.action_choice}"
        )
        if self.is_pair:
            note += "; adj: share of steps side by side, of episodes that reached the target"
        return Table("test", "", tuple(columns), tuple(rows), note, is_ruled=False)

    @property
    def action_choice(self) -> str:
        return "greedy" if self.greedy else "sampled"

    def as_dict(self) -> dict[str, Any]:
        """JSON-able; NaN as None."""
        return {
            "task": self.task,
            "greedy": self.greedy,
            "mean": self.mean,
            "worst": self.worst.share,
            "worst_case": self.worst.case,
            "groups": self.groups(),
            "cases": {
                case.case: {
                    **dict(zip(("reached", "collided", "timed_out"), case.outcomes, strict=True)),
                    "share": case.share,
                    "interval": list(case.interval),
                    "steps": _number_or_none(case.steps),
                    "reward": case.reward,
                    "adjacency": _number_or_none(case.adjacency),
                    "reached_by_rays": _number_or_none(case.reached_by_rays.mean),
                    "reached_by_poses": _number_or_none(case.reached_by_poses.mean),
                }
                for case in self.cases
            },
        }


def _number_or_none(number: float) -> float | None:
    """JSON has no NaN."""
    return None if np.isnan(number) else number


class Evaluator:
    """Evaluates policies on a task. Keeps its worlds from one evaluation to the next."""

    def __init__(self, task: LearningTask, reward: RewardFunction | None = None) -> None:
        self.task = task
        self._reward_function = reward
        self._cases = tuple(case for _, case in task.map_cases())
        self._batches: dict[int, BatchEnv] = {}

    @property
    def cases(self) -> tuple[str, ...]:
        return tuple(case.name for case in self._cases)

    def test(
        self,
        policy: Policy,
        episodes: int,
        seed: int,
        *,
        greedy: bool = True,
        before_step: Callable[[], None] = lambda: None,
        paths: PathRecorder | None = None,
    ) -> EvaluationResult:
        """Evaluates a policy on at least ``episodes`` episodes of each case, whose randomness comes from ``seed``.

        Every world drives the same number of episodes, so short ones do not count more often than long ones.
        ``before_step``: called before each step of all worlds; what it raises ends the evaluation.
        ``paths``: records the ways of some of the episodes.
        Raises PolicyError if the policy does not fit the task.
        """
        policy.check_fits(self.task)
        rounds = -(-episodes * len(self._cases) // PARALLEL_WORLDS)
        n = len(self._cases) * -(-episodes // rounds)
        batch = self._batch(n)
        player = policy.make_player(n, None if greedy else np.random.default_rng(derive_seed(seed, "moves")))
        left, sums = np.full(n, rounds), {case.name: _CaseSums() for case in self._cases}
        observations, fresh, recorder = (
            batch.reset(seed=seed),
            np.ones(n, dtype=np.bool_),
            EpisodeStatsRecorder(batch, with_poses=True),
        )
        if paths is not None:
            paths.begin(batch)
        with threadpool_limits(1, user_api="blas"):
            while left.any():
                before_step()
                step = batch.step(player.act(observations, fresh))
                if paths is not None:
                    paths.add(step)
                for episode in recorder.add(step):
                    if left[episode.world]:
                        left[episode.world] -= 1
                        sums[episode.case].add(episode)
                observations, fresh = step.observations, step.ended
        pair = self.task.robots > 1
        return EvaluationResult(
            self.task.name, greedy, tuple(sums[case.name].result(case, pair) for case in self._cases)
        )

    def _batch(self, n: int) -> BatchEnv:
        if n not in self._batches:
            self._batches[n] = BatchEnv(self.task, n, reward=self._reward_function)
        return self._batches[n]


@dataclass(slots=True)
class _CaseSums:
    """Over the episodes of one case."""

    outcomes: dict[EpisodeOutcome, int] = field(default_factory=lambda: dict.fromkeys(EpisodeOutcome, 0))
    steps: int = 0
    """Steps of the episodes that reached the target."""
    reward: float = 0.0
    adjacency: list[float] = field(default_factory=list)
    reached: list[tuple[float, float]] = field(default_factory=list)
    """By rays and by poses, of the episodes that reached the target."""

    def add(self, episode: EpisodeStats) -> None:
        self.outcomes[episode.outcome] += 1
        self.steps += episode.steps if episode.outcome is EpisodeOutcome.REACHED else 0
        self.reward += episode.reward
        self.adjacency.append(episode.adjacency)
        if episode.outcome is EpisodeOutcome.REACHED:
            self.reached.append((episode.adjacency, episode.by_poses))

    def result(self, case: TaskCase, pair: bool) -> CaseResult:
        reached, collided, timed_out = self.outcomes.values()
        episodes = reached + collided + timed_out
        told = [EpisodeShare.of([each[k] for each in self.reached if pair]) for k in range(2)]
        return CaseResult(
            case.name,
            case.group,
            (reached, collided, timed_out),
            steps=self.steps / reached if reached else np.nan,
            reward=self.reward / episodes,
            adjacency=sum(self.adjacency) / episodes if pair else np.nan,
            adjacency_sd=float(np.std(self.adjacency, ddof=1)) if pair and episodes > 1 else np.nan,
            reached_by_rays=told[0],
            reached_by_poses=told[1],
        )


def evaluate_policy(
    policy: Policy | Path | str,
    *,
    task: LearningTask | None = None,
    episodes: int = 100,
    seed: int = 0,
    greedy: bool = True,
) -> EvaluationResult:
    """Tests a policy on at least ``episodes`` episodes of each case and returns its success rate by case.

    ``policy``: a policy or its file. ``task``: default: the one that it was trained on. ``greedy``: whether it takes
    its best action, or draws actions as it did in training. The same arguments give the same result.

    Raises PolicyError if the file is damaged or the policy does not fit the task.

    >>> result = kit.evaluate_policy("best.npz", episodes=10)
    >>> [case.case for case in result.cases]
    ['turn_a_to_b', 'turn_b_to_a']
    >>> 0.0 <= result.worst.share <= result.mean <= 1.0
    True
    """
    policy = policy if isinstance(policy, Policy) else load_policy(policy)
    evaluator = Evaluator(policy.trained_on.resolve() if task is None else task)
    return evaluator.test(policy, episodes, seed, greedy=greedy)


@dataclass(frozen=True, slots=True, eq=False)
class EpisodePath:
    """One episode's way."""

    case: str
    outcome: EpisodeOutcome
    poses: FloatArray
    """(steps + 1, robots, 3), from the start on."""
    target: tuple[float, float]
    interval: float
    """Between two poses [s]."""


class PathRecorder:
    """Records the ways of the first ``episodes`` episodes of each case, among worlds that run side by side.

    Call ``begin`` after a reset, then ``add`` for each step of all worlds.
    """

    def __init__(self, episodes: int = 1) -> None:
        self._episodes = episodes
        self._names: list[str] = []
        self._interval = 0.0
        self._targets: FloatArray = np.empty((0, 2))
        self._running: IndexArray = np.empty(0, dtype=np.intp)
        """The worlds whose first episode is recorded and has not ended."""
        self._trails: dict[int, list[FloatArray]] = {}
        self._paths: dict[int, EpisodePath] = {}

    @property
    def is_complete(self) -> bool:
        """Whether every episode that is recorded has ended."""
        return not len(self._running)

    @property
    def paths(self) -> tuple[EpisodePath, ...]:
        """The episodes that have ended, in the order of the task's cases."""
        found = (self._paths[world] for world in sorted(self._paths))
        return tuple(sorted(found, key=lambda path: self._names.index(path.case)))

    def begin(self, batch: BatchEnv) -> None:
        """Takes the start of every world."""
        cases = batch.state.case
        chosen = [np.flatnonzero(cases == case)[: self._episodes] for case in range(len(batch.cases))]
        self._names = [case.name for case in batch.cases]
        self._interval = batch.task.step_time
        self._running = np.sort(np.concatenate(chosen))
        self._targets = batch.state.target.copy()
        self._trails = {int(world): [batch.state.pose[world].copy()] for world in self._running}
        self._paths = {}

    def add(self, step: BatchStep) -> None:
        """Takes one step of all worlds."""
        if self.is_complete:
            return
        transition, ended = step.transition, step.ended
        for world, pose in zip(self._running.tolist(), transition.pose[self._running], strict=True):
            self._trails[world].append(pose)
            if ended[world]:
                x, y = self._targets[world].tolist()
                self._paths[world] = EpisodePath(
                    self._names[int(transition.case[world])],
                    EpisodeOutcome.of(transition, world),
                    np.array(self._trails[world]),
                    (x, y),
                    self._interval,
                )
        self._running = self._running[~ended[self._running]]


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
    recorder = PathRecorder(episodes)
    recorder.begin(batch)
    while not recorder.is_complete:
        step = batch.step(player.act(observations, fresh))
        recorder.add(step)
        observations, fresh = step.observations, step.ended
    return recorder.paths


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


def _rectangle(area: Area) -> FloatArray:
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
