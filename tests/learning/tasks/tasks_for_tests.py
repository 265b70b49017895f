"""Tasks as texts, for the tests of tasks."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.batch_state import BatchStep
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.task_reader import read_task

PLAIN = """\
actions: {linear: [-0.4, 0.4], angular: [-1.5, 1.5]}
observation: {sectors: 9}
reward: {terms: {achieving: 1, reached: 10, collided: -5}}
lidar_noise: 0
start: {shifted: false}
"""

AHEAD, STILL, LEFT = [1.0, 0.0], [0.0, 0.0], [0.0, 1.0]
HALL = "maps: [hall_straight]\ncases:\n  - {start: [0.625, 0.5, 1.5708], "
CROSSING = "maps: [crossing]\nmoving_models: as in their files\ncases:\n  - {start: [1.6, 1.2, 1.5708], "


def task_of(text: str, plain: str = PLAIN) -> LearningTask:
    """The task of a text, with ``plain`` behind it."""
    return read_task(Path("test/task.yaml"), text + "\n" + plain).task


def one_world(text: str, plain: str = PLAIN) -> BatchEnv:
    """A world of it, in its first episode, which waits at its end."""
    batch = BatchEnv(task_of(text, plain), 1, seed=3, autoreset=False)
    batch.reset()
    return batch


def drive(batch: BatchEnv, action: list[float], most: int = 200) -> list[BatchStep]:
    """Steps of one action, to the end of the episode."""
    found = []
    for _ in range(most):
        found.append(batch.step(np.array([action])))
        if found[-1].ended[0]:
            break
    return found


def achieved(step: BatchStep) -> float:
    return float(step.transition.achieved[0])
