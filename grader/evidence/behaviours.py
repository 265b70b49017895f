"""What a reward pays for behaviours that everybody understands: a good drive, a detour, going round in circles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from grader.evidence import value_iteration
from grader.evidence.task_model import BACK, FORWARD, HEADINGS, LASTS, LEFT, RIGHT, Floats, Model

Moves = Sequence[int]

DETOUR = (LEFT, RIGHT) * 4
STARTS = 5
"""From how many places behaviours are compared."""


@dataclass(frozen=True, slots=True)
class Pair:
    """Two behaviours from the same start; the first should be paid more."""

    better: str
    worse: str
    paid_better: float
    paid_worse: float

    @property
    def is_right(self) -> bool:
        return self.paid_better > self.paid_worse + 1e-9 * max(abs(self.paid_better), abs(self.paid_worse))

    def __str__(self) -> str:
        return (
            f"It pays {self.paid_better:.3g} for {self.better}, but {self.paid_worse:.3g} for {self.worse}."
        )


@dataclass(frozen=True, slots=True)
class Loop:
    """A behaviour that never arrives, against driving to the target."""

    name: str
    paid: float
    arriving: float

    @property
    def pays(self) -> bool:
        return self.paid >= self.arriving - 1e-9 * max(abs(self.paid), abs(self.arriving))

    def __str__(self) -> str:
        return f"{self.name.capitalize()} for ever is paid {self.paid:.3g}, driving to the target only {self.arriving:.3g}."


def pairs(model: Model, rewards: Floats) -> tuple[Pair, ...]:
    """The comparisons, from several starts."""
    return tuple(_pairs(model, rewards))


def loops(model: Model, rewards: Floats) -> tuple[Loop, ...]:
    """Every closed way that fits, from several starts."""
    found = []
    for start, good in _drives(model):
        arriving = paid(model, rewards, start, good)
        for name, loop in LOOPS.items():
            if _fits(model, start, loop):
                repeated = loop * (model.task.max_steps // len(loop))
                found.append(Loop(name, paid(model, rewards, start, repeated), arriving))
    return tuple(found)


LOOPS: dict[str, tuple[int, ...]] = {
    "going forward and back": (FORWARD, BACK),
    "spinning on the spot": (LEFT,) * HEADINGS,
    "turning left and right": (LEFT, RIGHT),
    "driving in a circle": (FORWARD, LEFT) * HEADINGS,
    "driving in a circle to the right": (FORWARD, RIGHT) * HEADINGS,
}


def paid(model: Model, rewards: Floats, start: int, moves: Moves) -> float:
    """The discounted return of a sequence of moves, until the episode ends."""
    total, weight, state = 0.0, 1.0, start
    for move in moves[: model.task.max_steps]:
        total += weight * float(rewards[state, move])
        weight *= model.task.discount
        if model.done[state, move]:
            break
        state = int(model.next[state, move])
    return total


def _pairs(model: Model, rewards: Floats) -> Iterator[Pair]:
    for start, good in _drives(model):
        reached = paid(model, rewards, start, good)
        slowly = paid(model, rewards, start, (*DETOUR, *good))
        crash = _crash(model, start)
        for name, moves in (
            ("the same after turning to and fro", (*DETOUR, *good)),
            ("spinning on the spot until time runs out", (LEFT,) * model.task.max_steps),
            (
                "waiting near the target until time runs out",
                (*good[:-1], *((LEFT, RIGHT) * model.task.max_steps)),
            ),
            ("running into a wall", crash),
        ):
            yield Pair("driving to the target", name, reached, paid(model, rewards, start, moves))
        yield Pair(
            "reaching the target slowly",
            "spinning on the spot until time runs out",
            slowly,
            paid(model, rewards, start, (LEFT,) * model.task.max_steps),
        )


def _drives(model: Model) -> list[tuple[int, tuple[int, ...]]]:
    """Some starts, each with a shortest drive to the target."""
    truth = value_iteration.plan(model, np.where(model.reached, 1.0, np.where(model.hit, -1.0, -0.01)))
    starts = [int(start) for start in model.starts if np.isfinite(model.to_go[model.cell_of(start)])]
    found = []
    for start in starts[len(starts) // (2 * STARTS) :: max(1, len(starts) // STARTS)][:STARTS]:
        way = value_iteration.follow(truth, start, model.task.max_steps)
        moves = (way[1:] % LASTS).tolist()
        if len(moves) > 1:
            found.append((start, tuple(moves)))
    return found


def _crash(model: Model, start: int) -> Moves:
    return (
        (FORWARD,) * model.task.max_steps if _ends_in_wall(model, start) else (BACK,) * model.task.max_steps
    )


def _ends_in_wall(model: Model, start: int) -> bool:
    state = start
    for _ in range(model.task.max_steps):
        if model.done[state, FORWARD]:
            return bool(model.hit[state, FORWARD])
        state = int(model.next[state, FORWARD])
    return False


def _fits(model: Model, start: int, loop: Moves) -> bool:
    """Whether the way is closed and free, and does not touch the target."""
    state = start
    for move in loop:
        if model.done[state, move]:
            return False
        state = int(model.next[state, move])
    return bool(model.cell_of(np.array(state)) == model.cell_of(np.array(start)))
