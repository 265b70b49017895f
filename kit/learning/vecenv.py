"""The batch engine as a vector environment of stable-baselines3 (needs the extra ``learn``)."""

from __future__ import annotations

from kit.learning.batch import BatchEnv
from kit.learning.rewards import RewardFunction
from kit.learning.tasks import Task


class BatchVecEnv:
    """A stable_baselines3 VecEnv over a BatchEnv (``.batch``). Worlds reset themselves in the step in which they
    end. ``info`` of an ended episode: ``terminal_observation``, ``TimeLimit.truncated``, ``episode`` (r, l, t as
    Monitor gives them), ``case`` (its name), ``outcome`` ("reached", "collided", "timed out"), ``terms`` (sum by
    named term), ``adjacency`` (share of steps side by side; two robots only)."""

    def __init__(self, batch: BatchEnv) -> None:
        raise NotImplementedError


def make_vec(task: Task, n: int, seed: int = 0, reward: RewardFunction | None = None) -> BatchVecEnv:
    """``n`` worlds of the task as a VecEnv. No Monitor is needed around it."""
    return BatchVecEnv(BatchEnv(task, n, seed, reward=reward))
