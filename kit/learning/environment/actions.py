"""Defines the actions: moves of one robot, or of two at once."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

IntArray = NDArray[np.int64]


class Move(IntEnum):
    """The motion of one robot during a step."""

    STOP = 0
    FORWARD = 1
    BACK = 2
    LEFT = 3
    RIGHT = 4
    FORWARD_LEFT = 5
    FORWARD_RIGHT = 6


MOVE_DIRECTIONS = np.array([(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1)], dtype=np.float64)
"""(7, 2): by which sign speed and turn rate count, move by move."""


MIRRORED_MOVES = {
    Move.LEFT: Move.RIGHT,
    Move.RIGHT: Move.LEFT,
    Move.FORWARD_LEFT: Move.FORWARD_RIGHT,
    Move.FORWARD_RIGHT: Move.FORWARD_LEFT,
}


@dataclass(frozen=True, slots=True)
class Actions:
    """The moves to choose from, and how fast they are."""

    moves: tuple[Move, ...]
    speed: float
    """m/s"""
    turn_rate: float
    """rad/s"""
    one_number: bool = True
    """Whether a pair's moves are chosen as one number (49, 16); else each robot has a number of its own."""

    def space(self, robots: int) -> spaces.Discrete | spaces.MultiDiscrete:
        """Discrete for one robot; for two, Discrete over all pairs or MultiDiscrete."""
        count = len(self.moves)
        if robots == 1 or self.one_number:
            return spaces.Discrete(count**robots)
        return spaces.MultiDiscrete([count] * robots)

    def decode(self, actions: NDArray[np.integer], robots: int) -> IntArray:
        """(n, robots): each robot's place in ``moves``, from actions (n,) or (n, robots) of ``space``.

        Raises ValueError where an action is not in the space: a compiled loop would read past its tables.
        """
        numbers = np.asarray(actions, dtype=np.int64)
        if robots == 1 or not self.one_number:
            choices = numbers.reshape(-1, robots)
        else:
            choices = np.stack(np.divmod(numbers.reshape(-1), len(self.moves)), axis=1)
        if choices.size and (choices.min() < 0 or choices.max() >= len(self.moves)):
            raise ValueError(f"an action is outside {self.space(robots)}: {actions}")
        return choices

    def mirror_table(self) -> IntArray:
        """(k,) which of the moves each one is in a mirror. Raises ValueError where that is none of them."""
        other = [MIRRORED_MOVES.get(move, move) for move in self.moves]
        if not set(other) <= set(self.moves):
            raise ValueError("the moves to the two sides are not alike")
        return np.array([self.moves.index(move) for move in other], dtype=np.int64)

    @property
    def move_codes(self) -> IntArray:
        """(k,) the moves as numbers."""
        return np.array(self.moves, dtype=np.int64)

    @property
    def twists(self) -> NDArray[np.float64]:
        """(k, 2) forward [m/s] and turn [rad/s] of each move."""
        return MOVE_DIRECTIONS[list(self.moves)] * (self.speed, self.turn_rate)


QUARTER_TURN = 1.57079632679
SIXTH_OF_A_TURN = 1.0471975512

THREE_MOVES = Actions((Move.FORWARD, Move.LEFT, Move.RIGHT), 0.5, QUARTER_TURN)
"""Tutorial 2 (dissertation, table 5.1)."""

SEVEN_MOVES = Actions(tuple(Move), 0.3, SIXTH_OF_A_TURN)
"""Hallways (table 3.2); for two robots 49."""

FOUR_MOVES = Actions((Move.STOP, Move.FORWARD, Move.LEFT, Move.RIGHT), 0.3, SIXTH_OF_A_TURN)
"""Two wheelchairs (table 4.3): 16."""
