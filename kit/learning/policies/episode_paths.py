"""Records the ways of a few episodes of each case."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kit.arrays import FloatArray, IndexArray
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.batch_state import BatchStep
from kit.learning.environment.episode_stats import EpisodeOutcome
from kit.learning.policies.policy import Policy
from kit.learning.policies.seeds import derive_seed
from kit.learning.tasks.learning_task import LearningTask


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
