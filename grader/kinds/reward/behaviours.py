"""Compares what a reward pays for behaviours: drives to the target, detours, loops."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from grader.kinds.reward.optimal_policy import TimeCheck, rollout, value_iteration, without_limit
from grader.kinds.reward.task_model import BACK, FORWARD, HEADINGS, LAST_MOVES, LEFT, RIGHT, GridModel
from kit.arrays import FloatArray
from kit.plain_text import counted

Moves = Sequence[int]
DETOUR = (LEFT, RIGHT) * 4

START_COUNT = 5
"""The number of start states from which behaviours are compared."""

NOTICED = 1e-3
"""By how much of the largest reward of a step a drive that comes nearer must be paid more: nobody learns from less."""

KEPT = 0.5
"""A loop pays by itself if the rest of its round takes back less than this share of the most that it has earned in between."""


@dataclass(frozen=True, slots=True)
class BehaviourComparison:
    """The returns of two behaviours from the same start; the first should be larger."""

    better: str
    worse: str
    better_return: float
    worse_return: float
    margin: float = 0.0
    """By which it should be larger."""

    @property
    def is_ordered(self) -> bool:
        return self.better_return > self.worse_return + self.margin + 1e-9 * max(
            abs(self.better_return), abs(self.worse_return)
        )

    def __str__(self) -> str:
        if self.better_return > self.worse_return:
            more = self.better_return - self.worse_return
            return (
                f"For {self.better} it pays {more:.3g} more than for {self.worse}: next to a reward of {self.margin / NOTICED:.3g}, "
                "nobody learns from that."
            )
        if self.better_return == self.worse_return:
            return f"It pays {self.better_return:.3g} for {self.better}, and as much for {self.worse}."
        return f"It pays {self.better_return:.3g} for {self.better}, but {self.worse_return:.3g} for {self.worse}."


@dataclass(frozen=True, slots=True)
class LoopComparison:
    """The returns of a loop that never arrives and of driving to the target."""

    name: str
    loop_return: float
    arrival_return: float
    round_pay: float = 0.0
    """What it earns by itself, each time round; 0 if it takes back what it pays."""

    @property
    def is_profitable(self) -> bool:
        return self.round_pay > 0.0 or self._pays_as_well

    @property
    def _pays_as_well(self) -> bool:
        """Whether it pays as well as driving to the target."""
        least = self.arrival_return - 1e-9 * max(abs(self.loop_return), abs(self.arrival_return))
        return self.loop_return >= least

    def __str__(self) -> str:
        name = self.name.capitalize()
        if self._pays_as_well:
            return f"{name} forever earns {self.loop_return:.3g}, driving to the target only {self.arrival_return:.3g}."
        return f"{name} earns {self.round_pay:.3g} each time round, and can go on for ever."


def compare_behaviours(
    model: GridModel, rewards: FloatArray, check_time: TimeCheck = without_limit
) -> tuple[BehaviourComparison, ...]:
    """Compares good and bad behaviours from several starts."""
    return tuple(_compare_behaviours(model, rewards, check_time))


def compare_loops(
    model: GridModel, rewards: FloatArray, check_time: TimeCheck = without_limit
) -> tuple[LoopComparison, ...]:
    """Compares every loop that fits into the map with driving to the target, from several starts."""
    drives = []
    for start, good in _sample_drives(model, check_time):
        arrival_return = discounted_return(model, rewards, start, good)
        for name, loop in LOOPS.items():
            check_time()
            if _is_free_loop(model, start, loop):
                repeated = loop * (model.task.max_steps // len(loop))
                loop_return = discounted_return(model, rewards, start, repeated)
                pay = _round_pay(model, rewards, start, loop)
                drives.append(LoopComparison(name, loop_return, arrival_return, pay))
    return tuple(drives)


def compare_approaches(
    model: GridModel, rewards: FloatArray, check_time: TimeCheck = without_limit
) -> tuple[BehaviourComparison, ...]:
    """Compares drives towards the target with others that take as many steps; none of them arrives.

    Arriving and the number of steps cannot tell such drives apart, only what a reward pays for the way. The better drive
    is the last stretch of a shortest drive in which no step leads farther from the target, neither in a straight line
    nor along the way: potential-based shaping with either distance pays it best (Ng, Harada and Russell, 1999).
    """
    return tuple(_compare_approaches(model, rewards, check_time))


LOOPS: dict[str, tuple[int, ...]] = {
    "going forward and back": (FORWARD, BACK),
    "spinning on the spot": (LEFT,) * HEADINGS,
    "turning left and right": (LEFT, RIGHT),
    "driving in a circle": (FORWARD, LEFT) * HEADINGS,
    "driving in a circle to the right": (FORWARD, RIGHT) * HEADINGS,
}


def discounted_return(model: GridModel, rewards: FloatArray, start: int, moves: Moves) -> float:
    """Returns the discounted return of a sequence of moves, until the episode ends."""
    total, weight, state = 0.0, 1.0, start
    for move in moves[: model.task.max_steps]:
        total += weight * float(rewards[state, move])
        weight *= model.task.discount
        if model.done[state, move]:
            break
        state = int(model.next[state, move])
    return total


def _compare_behaviours(
    model: GridModel, rewards: FloatArray, check_time: TimeCheck
) -> Iterator[BehaviourComparison]:
    for start, good in _sample_drives(model, check_time):
        check_time()
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


def _compare_approaches(
    model: GridModel, rewards: FloatArray, check_time: TimeCheck
) -> Iterator[BehaviourComparison]:
    margin = NOTICED * float(np.abs(rewards).max())
    for start, good in _sample_drives(model, check_time):
        check_time()
        state, moves = _last_approach(model, start, good)
        if not moves:
            continue
        near_return = discounted_return(model, rewards, state, moves)
        for name, other in (
            ("turning to and fro", ((LEFT, RIGHT) * len(moves))[: len(moves)]),
            ("driving away", _away_moves(model, state, len(moves))),
        ):
            yield BehaviourComparison(
                f"coming nearer for {counted(len(moves), 'step')}",
                f"{name} as long, and neither arrives",
                near_return,
                discounted_return(model, rewards, state, other),
                margin,
            )


def _last_approach(model: GridModel, start: int, good: Moves) -> tuple[int, Moves]:
    """Returns the last stretch of a drive before it arrives in which every step keeps or lessens the distance: its first
    state and its moves; no moves if it comes no nearer."""
    states = [start]
    for move in good[:-1]:
        states.append(int(model.next[states[-1], move]))
    cells = model.cell_of(np.array(states))
    distances = np.column_stack([model.to_target[cells], model.to_go[cells]])
    first = len(states) - 1
    while first > 0 and (distances[first - 1] >= distances[first] - 1e-9).all():
        first -= 1
    is_nearer = bool((distances[first] > distances[-1] + 1e-9).all())
    return states[first], good[first:-1] if is_nearer else ()


def _away_moves(model: GridModel, start: int, count: int) -> Moves:
    """Returns moves ahead or back, as long as they lead away from the target and into no wall, and turns after them."""
    away = max((_leading_away(model, start, move, count) for move in (BACK, FORWARD)), key=len)
    return (*away, *((LEFT, RIGHT) * count)[: count - len(away)])


def _leading_away(model: GridModel, start: int, move: int, count: int) -> Moves:
    """Returns the same move as often as it leads farther from the target, at most ``count`` times."""
    state = start
    for number in range(count):
        after = int(model.next[state, move])
        before_to_go, to_go = model.to_go[model.cell_of(np.array([state, after]))]
        if model.done[state, move] or to_go <= before_to_go:
            return (move,) * number
        state = after
    return (move,) * count


def _round_pay(model: GridModel, rewards: FloatArray, start: int, loop: Moves) -> float:
    """Returns the sum of the rewards of one round, if most of what it earns on the way is kept at its end; else 0.

    What a step earns is compared with turning where it begins: shaping by a potential with discount pays for being far away,
    whatever the robot does there, and takes back in every round what the way has earned.
    """
    total, earned, most, state = 0.0, 0.0, 0.0, start
    for move in loop:
        total += float(rewards[state, move])
        earned += float(rewards[state, move] - rewards[state, [LEFT, RIGHT]].min())
        most = max(most, earned)
        state = int(model.next[state, move])
    slack = 1e-9 * float(np.abs(rewards).max())
    return total if total > slack and most > slack and earned > KEPT * most else 0.0


def _sample_drives(model: GridModel, check_time: TimeCheck) -> list[tuple[int, tuple[int, ...]]]:
    """Returns some start states, each with the moves of a shortest drive to the target."""
    rewards = np.where(model.reached, 1.0, np.where(model.hit, -1.0, -0.01))
    policy = value_iteration(model, rewards, check_time)
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
