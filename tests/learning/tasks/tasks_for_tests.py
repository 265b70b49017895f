"""Tasks as texts, for the tests of tasks."""

from __future__ import annotations

from pathlib import Path

from kit.learning.environment.batch import BatchEnv
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.task_reader import read_task

PLAIN = """\
actions: {linear: [-0.4, 0.4], angular: [-1.5, 1.5]}
observation: {sectors: 9}
reward: {terms: {achieving: 1, reached: 10, collided: -5}}
lidar_noise: 0
start: {shifted: false}
"""


def task_of(text: str, plain: str = PLAIN) -> LearningTask:
    """The task of a text, with ``plain`` behind it."""
    return read_task(Path("test/task.yaml"), text + "\n" + plain).task


def one_world(text: str, plain: str = PLAIN) -> BatchEnv:
    """A world of it, in its first episode, which waits at its end."""
    batch = BatchEnv(task_of(text, plain), 1, seed=3, autoreset=False)
    batch.reset()
    return batch
