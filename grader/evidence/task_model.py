"""A small model of a driving task, on which the best behaviour under any reward can be computed exactly."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from grader.assignment import GridTask
from kit.learning.environment.actions import Move
from kit.learning.environment.observations import RAY_COUNT
from kit.learning.environment.rewards import RewardFunction
from kit.learning.environment.transition import FAR, Transition

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]

CELL: Final = 0.25
"""m"""
HEADINGS: Final = 8
MOVES: Final = ("forward", "back", "left", "right")
FORWARD, BACK, LEFT, RIGHT = range(4)
NO_MOVE: Final = 4
"""The last move of a start state: none."""
LAST_MOVES: Final = len(MOVES) + 1
HEADING_STEPS: Final = ((1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1))
"""By heading, counter-clockwise from x: the next cell (columns, rows up)."""
MAX_RANGE: Final = 10.0
"""m: the most free distance ahead that the model knows."""


@dataclass(frozen=True, eq=False)
class GridModel:
    """All states and transitions of one task. A state is a number: ``(cell * HEADINGS + heading) * LASTS + last``."""

    task: GridTask
    cells: Integers
    """(n, 2) column and row (from below) of every cell of floor."""
    target: int
    """The number of the target's cell."""
    next: Integers
    """(states, moves) the state after; the same place after a collision."""
    hit: Flags
    """(states, moves) whether the move runs into a wall."""
    reached: Flags
    """(states, moves) whether the move enters the target."""

    @property
    def states(self) -> int:
        return len(self.next)

    @property
    def done(self) -> Flags:
        """(states, moves) whether the episode ends."""
        return self.hit | self.reached

    @property
    def starts(self) -> Integers:
        """Every state in which an episode may begin: not in the target, no move before."""
        states: Integers = np.arange(self.states)
        begin: Integers = states[(self.cell_of(states) != self.target) & (states % LAST_MOVES == NO_MOVE)]
        return begin

    def cell_of(self, states: Integers) -> Integers:
        return states // (HEADINGS * LAST_MOVES)

    def heading_of(self, states: Integers) -> Integers:
        return states // LAST_MOVES % HEADINGS

    def pose(self, states: Integers) -> Floats:
        """(..., 3) ``x y theta`` [m, m, rad]"""
        middle = (self.cells[self.cell_of(states)] + 0.5) * CELL
        return np.concatenate([middle, (self.heading_of(states) * (np.pi / 4))[..., None]], axis=-1)

    @cached_property
    def ahead(self) -> Floats:
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
    def to_go(self) -> Floats:
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

    def state_at(self, column: int, row: int, heading: int) -> int:
        """Returns the start state in a cell. Raises LookupError if it is no floor."""
        found = np.flatnonzero((self.cells == (column, row)).all(axis=1))
        if not len(found):
            raise LookupError(f"no floor at {column}, {row}")
        return (int(found[0]) * HEADINGS + heading) * LAST_MOVES + NO_MOVE


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
    states: Integers
    moves: Integers

    def __len__(self) -> int:
        return len(self.states)

    @classmethod
    def all(cls, model: GridModel) -> TransitionBatch:
        """Returns all transitions, ordered by state."""
        states = np.repeat(np.arange(model.states), len(MOVES))
        return cls(model, states, np.tile(np.arange(len(MOVES)), model.states))

    def at(self, index: Integers) -> TransitionBatch:
        """Selects transitions by index."""
        return TransitionBatch(self.model, self.states[index], self.moves[index])

    @cached_property
    def next_states(self) -> Integers:
        return self.model.next[self.states, self.moves]

    @property
    def hit(self) -> Flags:
        return self.model.hit[self.states, self.moves]

    @property
    def reached(self) -> Flags:
        return self.model.reached[self.states, self.moves]


def rewards_of(reward: RewardFunction, model: GridModel) -> Floats:
    """Returns (states, moves) rewards of one of the kit's functions.

    What it knows of an episode's past beyond the last move is not part of the model's states: every transition stands
    for one at an episode's beginning.
    """
    return np.asarray(reward(to_transition(TransitionBatch.all(model))), dtype=np.float64).reshape(
        model.states, -1
    )


def to_transition(steps: TransitionBatch) -> Transition:
    """Returns the kit's record of these transitions, for one robot."""
    model, count = steps.model, len(steps)
    before, after = model.cell_of(steps.states), model.cell_of(steps.next_states)
    front = np.minimum(model.ahead[after, model.heading_of(steps.next_states)], AGENT_SIGHT)
    zeros = np.zeros((count, 1), dtype=np.int64)
    return Transition(
        case=np.zeros(count, dtype=np.int64),
        step=np.ones(count, dtype=np.int64),
        max_steps=model.task.max_steps,
        hit=steps.hit[:, None],
        in_target=steps.reached[:, None],
        was_in_target=zeros.astype(np.bool_),
        move=KIT_MOVES[steps.moves][:, None],
        previous_move=KIT_MOVES[steps.states % LAST_MOVES][:, None],
        pose=model.pose(steps.next_states)[:, None, :],
        previous_pose=model.pose(steps.states)[:, None, :],
        target=np.broadcast_to((model.cells[model.target] + 0.5) * CELL, (count, 2)),
        to_go=model.to_go[after][:, None],
        previous_to_go=model.to_go[before][:, None],
        full_turns=zeros,
        previous_full_turns=zeros,
        forward_steps=zeros.astype(np.float64),
        ranges=np.repeat(front[:, None, None], RAY_COUNT, axis=2),
        twist=KIT_TWISTS[steps.moves][:, None, :],
        target_heading=np.zeros(count),
        obstacle_distance=np.full((count, 1), FAR),
        achieved=1.0 * steps.reached,
        previous_achieved=np.zeros(count),
    )
