"""The best behaviour under a reward, computed by value iteration, and what it leads to."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from grader.kinds.reward.task_model import HEADINGS, LAST_MOVES, MOVES, GridModel
from kit.arrays import BoolArray, FloatArray, IntArray

CONVERGENCE_SHARE: Final = 1e-10
"""Values count as settled when the rest of the iteration could change none by more than this share of the largest."""

TIE_SHARE: Final = 1e-9
"""Moves whose values differ by no more than this share of the largest are equally good."""


@dataclass(frozen=True, eq=False)
class OptimalPolicy:
    """The optimal behaviour under a reward."""

    model: GridModel
    rewards: FloatArray
    """(states, moves)"""
    values: FloatArray
    """(states, moves) Q-values: the return of each move with optimal behaviour after it."""
    best: BoolArray
    """(states, moves) True where no other move is better."""


TimeCheck = Callable[[], None]
"""Called between the steps of a long calculation; raises what ends it when its time is used up."""


def without_limit() -> None:
    """Lets a calculation take as long as it takes."""


def value_iteration(
    model: GridModel, rewards: FloatArray, check_time: TimeCheck = without_limit
) -> OptimalPolicy:
    """Iterates Bellman's optimality equation until it holds.

    ``rewards``: (states, moves), finite, and so small that their sums are. Q(s, a) = r(s, a) + discount * max Q(s', .),
    without the last term where the episode ends. An iteration changes the values by at most ``discount`` times what the
    one before did, and so their number is limited, also where rounding keeps the last digits moving.
    """
    discount = model.task.discount
    discounts = np.where(model.done, 0.0, discount)
    values = np.zeros(model.states)
    largest = max(float(np.abs(rewards).max(initial=0.0)), 1e-300)
    for _ in range(1 + math.ceil(math.log(CONVERGENCE_SHARE * (1.0 - discount)) / math.log(discount))):
        check_time()
        q_values = rewards + discounts * values[model.next]
        better = q_values.max(axis=1)
        change = float(np.abs(better - values).max())
        values = better
        if change * discount / (1.0 - discount) <= CONVERGENCE_SHARE * largest:
            break
    best = q_values >= better[:, None] - TIE_SHARE * max(largest, float(np.abs(q_values).max()))
    return OptimalPolicy(model, rewards, q_values, best)


@dataclass(frozen=True, eq=False)
class OptimalPolicyScore:
    """How the optimal behaviour does from every start, by the true goal."""

    success: float
    """Probability of reaching the target, the mean over all starts; equally good moves are equally likely."""
    steps: float
    """Steps per episode, the mean over all starts."""
    exploit_start: int | None
    """A start from which the target may be missed; None if there is none."""


def evaluate_policy(policy: OptimalPolicy, check_time: TimeCheck = without_limit) -> OptimalPolicyScore:
    """Evaluates the policy from every start from which the target can be reached, for ``max_steps``."""
    model = policy.model
    starts = model.starts[np.isfinite(model.to_go[model.cell_of(model.starts)])]
    probabilities = policy.best / policy.best.sum(axis=1, keepdims=True)
    success, steps = np.zeros(model.states), np.zeros(model.states)
    for _ in range(model.task.max_steps):
        check_time()
        success = (probabilities * np.where(model.done, model.reached, success[model.next])).sum(axis=1)
        steps = 1.0 + (probabilities * np.where(model.done, 0.0, steps[model.next])).sum(axis=1)
    lost = starts[success[starts] < 1.0 - 1e-9]
    # Where it is missed most; of these, from neither the nearest nor the farthest start: that shows best.
    worst = lost[success[lost] <= success[lost].min(initial=1.0) + 1e-9]
    order = np.argsort(model.to_go[model.cell_of(worst)], kind="stable")
    return OptimalPolicyScore(
        float(success[starts].mean()),
        float(steps[starts].mean()),
        int(worst[order[len(worst) // 2]]) if len(worst) else None,
    )


def rollout(policy: OptimalPolicy, start: int, steps: int) -> IntArray:
    """Returns the states along the policy's path, the start included; takes the first of equally good moves."""
    model, state, visited = policy.model, start, [start]
    for _ in range(steps):
        move = int(np.argmax(policy.best[state]))
        visited.append(int(model.next[state, move]))
        if model.done[state, move]:
            break
        state = visited[-1]
    return np.array(visited, dtype=np.int64)


def draw_path(model: GridModel, states: IntArray) -> str:
    """Draws a path on the map in characters: its start, how often each cell is visited, and its moves."""
    rows = [list(row) for row in model.task.rows]
    visits: dict[tuple[int, int], int] = {}
    for cell in model.cells[model.cell_of(states)].tolist():
        visits[cell[0], cell[1]] = visits.get((cell[0], cell[1]), 0) + 1
    for (x, y), count in visits.items():
        rows[-1 - y][x] = "+" if count > 9 else str(count)
    x, y = model.cells[model.cell_of(states[:1])[0]].tolist()
    rows[-1 - y][x] = "S"
    x, y = model.cells[model.target].tolist()
    rows[-1 - y][x] = "G"
    shown = "\n".join("".join(row) for row in rows)
    moves = [MOVES[last] for last in (states[1:] % LAST_MOVES).tolist()]
    moves_text = ", ".join(moves[:12]) + (", ..." if len(moves) > 12 else "")
    headings = ["E", "NE", "N", "NW", "W", "SW", "S", "SE"]
    facing = headings[int(states[0]) // LAST_MOVES % HEADINGS]
    return f"{shown}\nS start (facing {facing}), G target, 1-9 and + how often it was there.\nMoves: {moves_text}"
