"""Planning: the best behaviour under a reward, by value iteration, and what it does in truth.

A reward is judged by the behaviour it asks for. On a small model that behaviour can be computed instead of trained:
exactly, without chance, in milliseconds; and if it is not the one that was meant, it is the exploit.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from grader.evidence.task_model import HEADINGS, LAST_MOVES, MOVES, Flags, Floats, GridModel, Integers

CONVERGENCE_SHARE: Final = 1e-10
"""Values count as settled when the rest of the iteration could change none by more than this share of the largest."""
TIE_SHARE: Final = 1e-9
"""Moves whose values differ by no more than this share of the largest are equally good."""


@dataclass(frozen=True, eq=False)
class OptimalPolicy:
    """What a reward asks for."""

    model: GridModel
    rewards: Floats
    """(states, moves)"""
    values: Floats
    """(states, moves) of each move, with the best behaviour after it: Q of the reinforcement learning books."""
    best: Flags
    """(states, moves) whether no move is better."""


def value_iteration(model: GridModel, rewards: Floats) -> OptimalPolicy:
    """Bellman's optimality equation, iterated until it holds.

    ``rewards``: (states, moves). Q(s, a) = r(s, a) + discount * max Q(s', .), without the last term where the episode
    ends.
    """
    discount = model.task.discount
    discounts = np.where(model.done, 0.0, discount)
    values = np.zeros(model.states)
    largest = max(float(np.abs(rewards).max(initial=0.0)), 1e-300)
    while True:
        q_values = rewards + discounts * values[model.next]
        better = q_values.max(axis=1)
        change = float(np.abs(better - values).max())
        values = better
        if change * discount / (1.0 - discount) <= CONVERGENCE_SHARE * largest:
            break
    best = q_values >= better[:, None] - TIE_SHARE * max(largest, float(np.abs(q_values).max()))
    return OptimalPolicy(model, rewards, q_values, best)


@dataclass(frozen=True, eq=False)
class PolicyOutcome:
    """What the planned behaviour does from every start, by the true goal."""

    success: float
    """How often it reaches the target, the mean of all starts; of equally good moves each is as likely."""
    steps: float
    """How long episodes last, the mean of all starts."""
    exploit_start: int | None
    """A start from which the target may be missed; None if there is none."""


def evaluate_policy(policy: OptimalPolicy) -> PolicyOutcome:
    """Lets the plan drive from every start from which the target can be reached at all, for ``max_steps``."""
    model = policy.model
    starts = model.starts[np.isfinite(model.to_go[model.cell_of(model.starts)])]
    probabilities = policy.best / policy.best.sum(axis=1, keepdims=True)
    success, steps = np.zeros(model.states), np.zeros(model.states)
    for _ in range(model.task.max_steps):
        success = (probabilities * np.where(model.done, model.reached, success[model.next])).sum(axis=1)
        steps = 1.0 + (probabilities * np.where(model.done, 0.0, steps[model.next])).sum(axis=1)
    lost = starts[success[starts] < 1.0 - 1e-9]
    # Where it is missed most; of these, from neither the nearest nor the farthest start: that shows best.
    worst = lost[success[lost] <= success[lost].min(initial=1.0) + 1e-9]
    order = np.argsort(model.to_go[model.cell_of(worst)], kind="stable")
    return PolicyOutcome(
        float(success[starts].mean()),
        float(steps[starts].mean()),
        int(worst[order[len(worst) // 2]]) if len(worst) else None,
    )


def rollout(policy: OptimalPolicy, start: int, steps: int) -> Integers:
    """The states that the plan leads through, the first included; of equally good moves the first."""
    model, state, visited = policy.model, start, [start]
    for _ in range(steps):
        move = int(np.argmax(policy.best[state]))
        visited.append(int(model.next[state, move]))
        if model.done[state, move]:
            break
        state = visited[-1]
    return np.array(visited, dtype=np.int64)


def draw_path(model: GridModel, states: Integers) -> str:
    """A way through the map in characters: where it began, where it went how often, and how it ended."""
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
