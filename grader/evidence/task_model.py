"""A small model of a driving task, on which the best behaviour under any reward is computed exactly instead of trained.

A reward is judged by that behaviour: if it misses the target, it is the exploit of the reward.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from grader.assignment import GridTask
from kit.arrays import BoolArray, FloatArray, IntArray
from kit.learning.maps.ray_directions import RAY_COUNT
from kit.learning.tasks.actions import Move
from kit.learning.tasks.transition import FAR, EpisodeState, Transition

CELL: Final = 0.25
"""m"""
HEADINGS: Final = 8
MOVES: Final = ("forward", "back", "left", "right")
FORWARD, BACK, LEFT, RIGHT = range(4)
NO_MOVE: Final = 4
"""The last move of a start state: none."""
LAST_MOVES: Final = len(MOVES) + 1
HEADING_STEPS: Final = ((1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1))
"""Next cell (columns, rows up) for each heading, counter-clockwise from x."""
MAX_RANGE: Final = 10.0
"""m: the most free distance ahead that the model knows."""


@dataclass(frozen=True, eq=False)
class GridModel:
    """All states and transitions of one task. A state is a number: ``(cell * HEADINGS + heading) * LASTS + last``."""

    task: GridTask
    cells: IntArray
    """(n, 2) column and row (from below) of every cell of floor."""
    target: int
    """The number of the target's cell."""
    next: IntArray
    """(states, moves) the state after; the same place after a collision."""
    hit: BoolArray
    """(states, moves) whether the move runs into a wall."""
    reached: BoolArray
    """(states, moves) whether the move enters the target."""

    @property
    def states(self) -> int:
        return len(self.next)

    @property
    def done(self) -> BoolArray:
        """(states, moves) whether the episode ends."""
        return self.hit | self.reached

    @property
    def starts(self) -> IntArray:
        """Every state in which an episode may begin: not in the target, no move before."""
        states: IntArray = np.arange(self.states)
        begin: IntArray = states[(self.cell_of(states) != self.target) & (states % LAST_MOVES == NO_MOVE)]
        return begin

    def cell_of(self, states: IntArray) -> IntArray:
        return states // (HEADINGS * LAST_MOVES)

    def heading_of(self, states: IntArray) -> IntArray:
        return states // LAST_MOVES % HEADINGS

    def pose(self, states: IntArray) -> FloatArray:
        """(..., 3) ``x y theta`` [m, m, rad]"""
        middle = (self.cells[self.cell_of(states)] + 0.5) * CELL
        return np.concatenate([middle, (self.heading_of(states) * (np.pi / 4))[..., None]], axis=-1)

    @cached_property
    def ahead(self) -> FloatArray:
        """(cells, HEADINGS) free distance ahead [m]: from a cell's centre to the nearest wall's edge."""
        floor = {tuple(cell): number for number, cell in enumerate(self.cells.tolist())}
        room = np.zeros((len(self.cells), HEADINGS))
        for number, (column, row) in enumerate(self.cells.tolist()):
            for heading, (dx, dy) in enumerate(HEADING_STEPS):
                free = 0
                while (column + (free + 1) * dx, row + (free + 1) * dy) in floor:
                    free += 1
                room[number, heading] = min(MAX_RANGE, (free + 0.5) * CELL * float(np.hypot(dx, dy)))
        return room

    @cached_property
    def to_go(self) -> FloatArray:
        """(cells,) length of the shortest path to the target [m]; infinite where there is none."""
        length = np.full(len(self.cells), np.inf)
        length[self.target] = 0.0
        number = {tuple(cell): index for index, cell in enumerate(self.cells.tolist())}
        waiting = [self.target]
        while waiting:
            at = waiting.pop(0)
            column, row = self.cells[at].tolist()
            for dx, dy in HEADING_STEPS:
                beside = number.get((column + dx, row + dy))
                far = length[at] + CELL * float(np.hypot(dx, dy))
                if beside is not None and far < length[beside] - 1e-9:
                    length[beside] = far
                    waiting.append(beside)
        return length


def build_model(task: GridTask) -> GridModel:
    """Builds the model of a map drawn in characters."""
    rows = task.rows[::-1]
    cells = [(x, y) for y, row in enumerate(rows) for x, sign in enumerate(row) if sign != "#"]
    number = {cell: index for index, cell in enumerate(cells)}
    target = next(index for (x, y), index in number.items() if rows[y][x] == "G")
    states = len(cells) * HEADINGS * LAST_MOVES
    after = np.zeros((states, len(MOVES)), dtype=np.int64)
    hit = np.zeros((states, len(MOVES)), dtype=np.bool_)
    for cell, (x, y) in enumerate(cells):
        for heading in range(HEADINGS):
            first = (cell * HEADINGS + heading) * LAST_MOVES
            for move, (to, turned, is_hit) in enumerate(_move_results(number, x, y, heading)):
                after[first : first + LAST_MOVES, move] = (to * HEADINGS + turned) * LAST_MOVES + move
                hit[first : first + LAST_MOVES, move] = is_hit
    reached = (after // (HEADINGS * LAST_MOVES) == target) & (
        np.arange(states) // (HEADINGS * LAST_MOVES) != target
    )[:, None]
    return GridModel(task, np.array(cells, dtype=np.int64), target, after, hit, reached & ~hit)


def _move_results(
    number: Mapping[tuple[int, int], int], x: int, y: int, heading: int
) -> Sequence[tuple[int, int, bool]]:
    """Returns for each move the cell and heading after it, and whether it collides."""
    here = number[x, y]
    dx, dy = HEADING_STEPS[heading]
    driven = []
    for sign in (1, -1):
        # Between two walls that touch at a corner nothing passes.
        entered = ((x + sign * dx, y + sign * dy), (x + sign * dx, y), (x, y + sign * dy))
        free = all(cell in number for cell in entered)
        driven.append((number[entered[0]] if free else here, heading, not free))
    return (*driven, (here, (heading + 1) % HEADINGS, False), (here, (heading - 1) % HEADINGS, False))


MODEL_FACTS: Final = (
    "collided",
    "reached",
    "hit",
    "in_target",
    "was_in_target",
    "move",
    "previous_move",
    "pose",
    "previous_pose",
    "target",
    "to_go",
    "previous_to_go",
    "front",
    "distance",
    "previous_distance",
    "bearing",
    "previous_bearing",
    "max_steps",
)
"""Parameters of a reward function that the model can provide. The others (the step's number, the turns made so far, the
lidar's rays) depend on what the model leaves out."""

KIT_MOVES: Final = np.array([Move.FORWARD, Move.BACK, Move.LEFT, Move.RIGHT, -1])
KIT_TWISTS: Final = np.array([(0.3, 0.0), (-0.3, 0.0), (0.0, np.pi / 3), (0.0, -np.pi / 3)])
"""m/s and rad/s of these moves, as in the hallways."""
"""The kit's number for each of the model's moves; the last stands for no move."""

AGENT_SIGHT: Final = 2.0
"""m: how far the agent of the kit's tasks sees (dissertation, section 3.1.2)."""


@dataclass(frozen=True, eq=False)
class TransitionBatch:
    """Some transitions of a model, as states and moves."""

    model: GridModel
    states: IntArray
    moves: IntArray

    def __len__(self) -> int:
        return len(self.states)

    @classmethod
    def all(cls, model: GridModel) -> TransitionBatch:
        """Returns all transitions, ordered by state."""
        states = np.repeat(np.arange(model.states), len(MOVES))
        return cls(model, states, np.tile(np.arange(len(MOVES)), model.states))

    def at(self, index: IntArray) -> TransitionBatch:
        """Selects transitions by index."""
        return TransitionBatch(self.model, self.states[index], self.moves[index])

    @cached_property
    def next_states(self) -> IntArray:
        return self.model.next[self.states, self.moves]

    @property
    def hit(self) -> BoolArray:
        return self.model.hit[self.states, self.moves]

    @property
    def reached(self) -> BoolArray:
        return self.model.reached[self.states, self.moves]


def to_transition(steps: TransitionBatch) -> Transition:
    """Returns the kit's record of these transitions, for one robot."""
    model, count = steps.model, len(steps)
    front = np.minimum(
        model.ahead[model.cell_of(steps.next_states), model.heading_of(steps.next_states)], AGENT_SIGHT
    )
    standing = EpisodeState(
        case=np.zeros(count, dtype=np.int64),
        step=np.zeros(count, dtype=np.int64),
        pose=model.pose(steps.states)[:, None, :],
        hit=np.zeros((count, 1), dtype=np.bool_),
        in_target=np.zeros((count, 1), dtype=np.bool_),
        to_go=model.to_go[model.cell_of(steps.states)][:, None],
        rotation=np.zeros((count, 1)),
        ranges=np.repeat(front[:, None, None], RAY_COUNT, axis=2),
        move=KIT_MOVES[steps.states % LAST_MOVES][:, None],
        twist=np.zeros((count, 1, 2)),
        forward_steps=np.zeros((count, 1)),
        target=np.broadcast_to((model.cells[model.target] + 0.5) * CELL, (count, 2)),
        target_heading=np.zeros(count),
        obstacle_distance=np.full((count, 1), FAR),
        count=np.zeros(count),
        achieved=np.zeros(count),
    )
    moved = replace(
        standing,
        step=np.ones(count, dtype=np.int64),
        pose=model.pose(steps.next_states)[:, None, :],
        hit=steps.hit[:, None],
        in_target=steps.reached[:, None],
        to_go=model.to_go[model.cell_of(steps.next_states)][:, None],
        move=KIT_MOVES[steps.moves][:, None],
        twist=KIT_TWISTS[steps.moves][:, None, :],
        count=1.0 * steps.reached,
        achieved=1.0 * steps.reached,
    )
    return Transition(standing, moved, model.task.max_steps)


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
class PolicyOutcome:
    """How the optimal behaviour does from every start, by the true goal."""

    success: float
    """Probability of reaching the target, the mean over all starts; equally good moves are equally likely."""
    steps: float
    """Steps per episode, the mean over all starts."""
    exploit_start: int | None
    """A start from which the target may be missed; None if there is none."""


def evaluate_policy(policy: OptimalPolicy, check_time: TimeCheck = without_limit) -> PolicyOutcome:
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
    return PolicyOutcome(
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
        return f"{self.name.capitalize()} forever earns {self.loop_return:.3g}, driving to the target only {self.arrival_return:.3g}."


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
