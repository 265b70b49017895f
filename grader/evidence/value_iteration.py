"""Value iteration: the optimal behaviour under a reward, how well it reaches the target, and what simple behaviours earn.

A reward is judged by the behaviour that is optimal under it. On a small model that behaviour is computed instead of
trained: exactly, deterministically, in milliseconds. If it misses the target, it is the exploit of the reward.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from grader.evidence.task_model import (
    BACK,
    FORWARD,
    HEADINGS,
    LAST_MOVES,
    LEFT,
    MOVES,
    RIGHT,
    Flags,
    Floats,
    GridModel,
    Integers,
)

CONVERGENCE_SHARE: Final = 1e-10
"""Values count as settled when the rest of the iteration could change none by more than this share of the largest."""
TIE_SHARE: Final = 1e-9
"""Moves whose values differ by no more than this share of the largest are equally good."""


@dataclass(frozen=True, eq=False)
class OptimalPolicy:
    """The optimal behaviour under a reward."""

    model: GridModel
    rewards: Floats
    """(states, moves)"""
    values: Floats
    """(states, moves) Q-values: the return of each move with optimal behaviour after it."""
    best: Flags
    """(states, moves) True where no other move is better."""


def value_iteration(model: GridModel, rewards: Floats) -> OptimalPolicy:
    """Iterates Bellman's optimality equation until it holds.

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
    """How the optimal behaviour does from every start, by the true goal."""

    success: float
    """Probability of reaching the target, the mean over all starts; equally good moves are equally likely."""
    steps: float
    """Steps per episode, the mean over all starts."""
    exploit_start: int | None
    """A start from which the target may be missed; None if there is none."""


def evaluate_policy(policy: OptimalPolicy) -> PolicyOutcome:
    """Evaluates the policy from every start from which the target can be reached, for ``max_steps``."""
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
    """Returns the states along the policy's path, the start included; takes the first of equally good moves."""
    model, state, visited = policy.model, start, [start]
    for _ in range(steps):
        move = int(np.argmax(policy.best[state]))
        visited.append(int(model.next[state, move]))
        if model.done[state, move]:
            break
        state = visited[-1]
    return np.array(visited, dtype=np.int64)


def draw_path(model: GridModel, states: Integers) -> str:
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


Moves = Sequence[int]

DETOUR = (LEFT, RIGHT) * 4
START_COUNT = 5
"""The number of start states from which behaviours are compared."""


@dataclass(frozen=True, slots=True)
class BehaviourComparison:
    """The returns of two behaviours from the same start; the first should be larger."""

    better: str
    worse: str
    better_return: float
    worse_return: float

    @property
    def is_ordered(self) -> bool:
        return self.better_return > self.worse_return + 1e-9 * max(
            abs(self.better_return), abs(self.worse_return)
        )

    def __str__(self) -> str:
        return f"It pays {self.better_return:.3g} for {self.better}, but {self.worse_return:.3g} for {self.worse}."


@dataclass(frozen=True, slots=True)
class LoopComparison:
    """The returns of a loop that never arrives and of driving to the target."""

    name: str
    loop_return: float
    arrival_return: float

    @property
    def is_profitable(self) -> bool:
        return self.loop_return >= self.arrival_return - 1e-9 * max(
            abs(self.loop_return), abs(self.arrival_return)
        )

    def __str__(self) -> str:
        return f"{self.name.capitalize()} for ever is paid {self.loop_return:.3g}, driving to the target only {self.arrival_return:.3g}."


def compare_behaviours(model: GridModel, rewards: Floats) -> tuple[BehaviourComparison, ...]:
    """Compares good and bad behaviours from several starts."""
    return tuple(_compare_behaviours(model, rewards))


def compare_loops(model: GridModel, rewards: Floats) -> tuple[LoopComparison, ...]:
    """Compares every loop that fits into the map with driving to the target, from several starts."""
    drives = []
    for start, good in _sample_drives(model):
        arrival_return = discounted_return(model, rewards, start, good)
        for name, loop in LOOPS.items():
            if _is_free_loop(model, start, loop):
                repeated = loop * (model.task.max_steps // len(loop))
                drives.append(
                    LoopComparison(name, discounted_return(model, rewards, start, repeated), arrival_return)
                )
    return tuple(drives)


LOOPS: dict[str, tuple[int, ...]] = {
    "going forward and back": (FORWARD, BACK),
    "spinning on the spot": (LEFT,) * HEADINGS,
    "turning left and right": (LEFT, RIGHT),
    "driving in a circle": (FORWARD, LEFT) * HEADINGS,
    "driving in a circle to the right": (FORWARD, RIGHT) * HEADINGS,
}


def discounted_return(model: GridModel, rewards: Floats, start: int, moves: Moves) -> float:
    """Returns the discounted return of a sequence of moves, until the episode ends."""
    total, weight, state = 0.0, 1.0, start
    for move in moves[: model.task.max_steps]:
        total += weight * float(rewards[state, move])
        weight *= model.task.discount
        if model.done[state, move]:
            break
        state = int(model.next[state, move])
    return total


def _compare_behaviours(model: GridModel, rewards: Floats) -> Iterator[BehaviourComparison]:
    for start, good in _sample_drives(model):
        direct_return = discounted_return(model, rewards, start, good)
        slow_return = discounted_return(model, rewards, start, (*DETOUR, *good))
        crash = _crash_moves(model, start)
        for name, moves in (
            ("the same after turning to and fro", (*DETOUR, *good)),
            ("spinning on the spot until time runs out", (LEFT,) * model.task.max_steps),
            (
                "waiting near the target until time runs out",
                (*good[:-1], *((LEFT, RIGHT) * model.task.max_steps)),
            ),
            ("running into a wall", crash),
        ):
            yield BehaviourComparison(
                "driving to the target", name, direct_return, discounted_return(model, rewards, start, moves)
            )
        yield BehaviourComparison(
            "reaching the target slowly",
            "spinning on the spot until time runs out",
            slow_return,
            discounted_return(model, rewards, start, (LEFT,) * model.task.max_steps),
        )


def _sample_drives(model: GridModel) -> list[tuple[int, tuple[int, ...]]]:
    """Returns some start states, each with the moves of a shortest drive to the target."""
    policy = value_iteration(model, np.where(model.reached, 1.0, np.where(model.hit, -1.0, -0.01)))
    starts = [int(start) for start in model.starts if np.isfinite(model.to_go[model.cell_of(start)])]
    drives = []
    for start in starts[len(starts) // (2 * START_COUNT) :: max(1, len(starts) // START_COUNT)][:START_COUNT]:
        states = rollout(policy, start, model.task.max_steps)
        moves = (states[1:] % LAST_MOVES).tolist()
        if len(moves) > 1:
            drives.append((start, tuple(moves)))
    return drives


def _crash_moves(model: GridModel, start: int) -> Moves:
    return (
        (FORWARD,) * model.task.max_steps if _ends_in_wall(model, start) else (BACK,) * model.task.max_steps
    )


def _ends_in_wall(model: GridModel, start: int) -> bool:
    state = start
    for _ in range(model.task.max_steps):
        if model.done[state, FORWARD]:
            return bool(model.hit[state, FORWARD])
        state = int(model.next[state, FORWARD])
    return False


def _is_free_loop(model: GridModel, start: int, loop: Moves) -> bool:
    """True if the loop is closed and free of walls, and does not touch the target."""
    state = start
    for move in loop:
        if model.done[state, move]:
            return False
        state = int(model.next[state, move])
    return bool(model.cell_of(np.array(state)) == model.cell_of(np.array(start)))
