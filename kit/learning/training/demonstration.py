"""Drives one world with a run's newest policy, episode after episode, for display.

Needs no torch: the learner leaves its policy as plain arrays. A newer one takes over between two episodes.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.env import build_batch_scene, lidar_places
from kit.learning.environment.episode_stats import EpisodeOutcome
from kit.learning.policies.agent_view import AgentView, ExpectedReturns, build_agent_view
from kit.learning.policies.policy import Policy, PolicyPlayer
from kit.learning.training.runs import TrainingRun
from kit.render.scene import Scene, Trail


@dataclass(frozen=True, slots=True, eq=False)
class DemonstrationView:
    """A snapshot of the demonstration between two steps."""

    scene: Scene
    case: str
    step: int
    trained: int
    """Steps of training behind the policy."""
    kept: bool
    """The policy that was kept as the best one; else the newest one."""
    outcome: EpisodeOutcome | None
    """Outcome at the end of the episode."""
    environment: str
    """The task that it was trained on."""
    total_reward: float | None
    """The sum of rewards of this episode so far; None where the run has a reward file, which is not run here."""
    agent: AgentView
    """What it perceives now."""


class Demonstration:
    """Drives episode after episode of a run's task, case after case."""

    def __init__(self, run: TrainingRun, *, greedy: bool = True, seed: int = 0) -> None:
        self.case: str | None = None
        """The case of the next episodes; None: one after the other."""
        self._run = run
        self._rng = None if greedy else np.random.default_rng(seed)
        self._seed = seed
        self._stamp: tuple[Path, int, int] | None = None
        self._policy: Policy | None = None
        self._player: PolicyPlayer | None = None
        self._expected: ExpectedReturns
        self._batch: BatchEnv | None = None
        self._fresh = np.ones(1, dtype=np.bool_)
        self._trails: list[Trail] = []
        self._outcome: EpisodeOutcome | None = None
        self._total_reward = 0.0
        self._has_reward_file = False

    @property
    def step_time(self) -> float:
        """Seconds of the robot's time that a step takes."""
        assert self._batch is not None
        return self._batch.task.step_time

    @property
    def is_over(self) -> bool:
        """Whether the episode has ended."""
        return self._outcome is not None

    def begin_episode(self, *, kept: bool = False) -> bool:
        """Begins the next episode, with the newest policy, or with the best one; False if there is none yet.

        PolicyError if it is damaged.
        """
        if not self._load_newest_policy(kept):
            return False
        assert self._policy is not None
        batch = self._batch
        if batch is None:
            task = self._policy.trained_on.resolve()
            self._policy.check_fits(task)
            self._has_reward_file = self._run.config().reward_file is not None
            batch = self._batch = BatchEnv(task, 1, self._seed, autoreset=False)
        names = [case.name for case in batch.cases]
        cases = np.array([names.index(self.case)]) if self.case in names else None
        self._observations = batch.reset(cases=cases)
        self._player = self._policy.make_player(1, self._rng)
        self._expected = ExpectedReturns(self._policy)
        self._fresh = np.ones(1, dtype=np.bool_)
        self._trails = [Trail() for _ in range(batch.task.robots)]
        self._outcome, self._total_reward = None, 0.0
        self._extend_trails(batch)
        self._choose_action()
        return True

    def step(self) -> None:
        """The robots do one step."""
        assert self._batch is not None
        step = self._batch.step(self._action)
        self._observations, self._fresh = step.observations, np.zeros(1, dtype=np.bool_)
        self._total_reward += float(step.rewards[0])
        self._extend_trails(self._batch)
        if step.ended[0]:
            self._outcome = EpisodeOutcome.of(step.transition, 0)
        self._choose_action()

    def _choose_action(self) -> None:
        """Decides on the action of the next step, so that what it thinks of what it perceives can be shown now."""
        assert self._player is not None
        self._action = self._player.act(self._observations, self._fresh)
        self._expected.add(self._player, self._observations, self._action)

    def view(self) -> DemonstrationView:
        """Returns the present snapshot."""
        assert self._batch is not None
        assert self._policy is not None
        assert self._stamp is not None
        assert self._player is not None
        state, task = self._batch.state, self._batch.task
        return DemonstrationView(
            build_batch_scene(self._batch, 0, tuple(trail.points for trail in self._trails)),
            self._batch.cases[int(state.case[0])].name,
            int(state.step[0]),
            self._policy.steps,
            self._stamp[0] == self._run.best_policy,
            self._outcome,
            self._policy.trained_on.title,
            None if self._has_reward_file else self._total_reward,
            build_agent_view(
                self._policy,
                task,
                self._observations[0],
                self._player.scores[0],
                lidar_places(self._batch, 0),
                self._expected.values,
            ),
        )

    def _load_newest_policy(self, kept: bool) -> bool:
        """Reads the policy's file, if it is another one than before."""
        files = self._run.newest_policy, self._run.best_policy
        for file in reversed(files) if kept else files:
            with suppress(FileNotFoundError):
                found = file.stat()
                stamp = file, found.st_mtime_ns, found.st_size
                if stamp != self._stamp:
                    self._policy = self._run.policy(newest=not kept)
                    self._stamp = stamp
                return True
        return False

    def _extend_trails(self, batch: BatchEnv) -> None:
        for trail, (x, y, _) in zip(self._trails, batch.state.pose[0].tolist(), strict=True):
            trail.add(x, y)
