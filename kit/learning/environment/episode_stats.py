"""Records the statistics of episodes step by step."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from kit.arrays import FloatArray
from kit.fields.adjacency import is_adjacent_by_poses
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.batch_state import BatchStep
from kit.learning.tasks.transition import Transition


class EpisodeOutcome(Enum):
    """How an episode ended."""

    REACHED = "reached"
    COLLIDED = "collided"
    TIMED_OUT = "timed out"

    @classmethod
    def of(cls, transition: Transition, world: int) -> EpisodeOutcome:
        """The outcome of the episode that this transition ended."""
        if transition.crashed[world]:
            return cls.COLLIDED
        return cls.REACHED if transition.reached[world] else cls.TIMED_OUT


@dataclass(frozen=True, slots=True)
class EpisodeStats:
    """One episode, from start to end."""

    world: int
    case: str
    outcome: EpisodeOutcome
    steps: int
    reward: float
    """The sum over all steps."""
    terms: dict[str, float]
    """The same by named term; for a student's reward its metrics, by name."""
    adjacency: float
    """The share of steps in which two robots were side by side, as their rays tell."""
    by_poses: float = 0.0
    """The same as their poses tell, where that is recorded."""


class EpisodeStatsRecorder:
    """Sums the rewards of a BatchEnv's worlds and returns the statistics of each episode that ends.

    Begins where the worlds begin: make a new one after a reset.
    """

    def __init__(self, batch: BatchEnv, *, with_poses: bool = False) -> None:
        """``with_poses``: whether being side by side is also recorded as poses tell, of two robots."""
        self._names = [case.name for case in batch.cases]
        self._pair = batch.task.robots > 1
        self._reward = np.zeros(batch.n)
        self._adjacent = np.zeros(batch.n)
        self._with_poses = with_poses and batch.task.robots == 2
        self._by_poses = np.zeros(batch.n)
        self._terms: dict[str, FloatArray] = {}

    def add(self, step: BatchStep) -> list[EpisodeStats]:
        """Takes one step of all worlds; returns the episodes that it ended."""
        self._reward += step.rewards
        for name, value in step.terms.items():
            self._terms[name] = self._terms.get(name, 0.0) + value
        if self._pair:
            self._adjacent += step.transition.adjacent
        if self._with_poses:
            pose = step.transition.pose
            self._by_poses += is_adjacent_by_poses(pose[:, 0], pose[:, 1])
        over = np.flatnonzero(step.ended)
        episodes = [self._episode(int(world), step.transition) for world in over]
        for sums in (self._reward, self._adjacent, self._by_poses, *self._terms.values()):
            sums[over] = 0.0
        return episodes

    def _episode(self, world: int, transition: Transition) -> EpisodeStats:
        steps = int(transition.step[world])
        return EpisodeStats(
            world=world,
            case=self._names[int(transition.case[world])],
            outcome=EpisodeOutcome.of(transition, world),
            steps=steps,
            reward=float(self._reward[world]),
            terms={name: float(sums[world]) for name, sums in self._terms.items()},
            adjacency=float(self._adjacent[world]) / steps,
            by_poses=float(self._by_poses[world]) / steps,
        )
