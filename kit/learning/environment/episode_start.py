"""Where an episode of a task begins: for a race, and for the world of a package."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from kit.geometry import Pose
from kit.learning.environment.batch import BatchEnv
from kit.learning.tasks.learning_task import LearningTask

FIRST_SEED: Final = 1
"""Of the first start, where a task draws it."""


@dataclass(frozen=True, slots=True)
class EpisodeStart:
    """Where an episode of a task's first case begins, and where its target is."""

    robots: tuple[Pose, ...]
    target: Pose
    phase: float | None = None
    """How far moving models are on their ways, 0 to 1; None: as in their files."""

    @classmethod
    def drawn(cls, task: LearningTask, seed: int) -> EpisodeStart:
        """The start of an episode of the first case, drawn as in training. Raises UnsupportedWorld."""
        batch = BatchEnv(task, 1, seed)
        batch.reset(seed=seed, cases=np.zeros(1, dtype=np.int64))
        state = batch.state
        poses = tuple(Pose(*pose) for pose in state.pose[0].tolist())
        x, y = state.target[0].tolist()
        target = Pose(x, y, float(state.target_heading[0]))
        return cls(poses, target, float(state.phase[0]) if task.random_phase else None)


def first_start(task: LearningTask) -> EpisodeStart:
    """The start of a race and of a package's world: that of the first case, always the same. Raises UnsupportedWorld."""
    _, case = task.map_cases()[0]
    robots, target = tuple(places.nominal for places in case.starts), case.targets.nominal
    if not (case.starts[0].is_area or case.targets.is_area):
        return EpisodeStart(robots, target)
    drawn = EpisodeStart.drawn(task, FIRST_SEED)
    return EpisodeStart(
        drawn.robots if case.starts[0].is_area else robots, drawn.target if case.targets.is_area else target
    )
