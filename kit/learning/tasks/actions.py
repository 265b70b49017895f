"""Defines the actions: a table of twists to choose from, or any twist within bounds; of one robot or several."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple, TypeAlias

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from kit.arrays import FloatArray, IntArray

MAX_SPEED = 2.0
"""No action drives faster [m/s]."""
MAX_TURN_RATE = 6.3
"""No action turns faster [rad/s]."""
STILL_SHARE = 0.05
"""A speed below this share of the largest one counts as none, when a twist is named a ``Move``."""


class Move(IntEnum):
    """The kind of a robot's motion during a step."""

    STOP = 0
    FORWARD = 1
    BACK = 2
    LEFT = 3
    RIGHT = 4
    FORWARD_LEFT = 5
    FORWARD_RIGHT = 6


_MOVE_BY_SIGNS = np.array(
    [
        [Move.BACK, Move.BACK, Move.BACK],
        [Move.RIGHT, Move.STOP, Move.LEFT],
        [Move.FORWARD_RIGHT, Move.FORWARD, Move.FORWARD_LEFT],
    ],
    dtype=np.int64,
)
"""(sign of the speed + 1, sign of the turn rate + 1)."""


def classify_twists(twists: FloatArray, largest: tuple[float, float]) -> IntArray:
    """(...) the ``Move`` that each twist (..., 2) is most like; ``largest``: the greatest speed and turn rate there are."""
    signs = np.sign(twists) * (np.abs(twists) > STILL_SHARE * np.array(largest))
    speed, turn = signs.astype(np.int64)[..., 0] + 1, signs.astype(np.int64)[..., 1] + 1
    moves: IntArray = _MOVE_BY_SIGNS[speed, turn]
    return moves


class Commands(NamedTuple):
    """The motion that actions ask for."""

    twists: FloatArray
    """(n, robots, 2) forward [m/s] and turn [rad/s]."""
    moves: IntArray
    """(n, robots) the ``Move`` that each twist is most like."""


@dataclass(frozen=True, slots=True)
class DiscreteActions:
    """A table of twists to choose from."""

    names: tuple[str, ...]
    twist_table: tuple[tuple[float, float], ...]
    """Forward [m/s] and turn [rad/s] of each; its place is the action's number."""
    one_number: bool = True
    """Whether the choices of several robots are one number (49 or 16 for two); else each robot has a number of its own."""

    @property
    def twists(self) -> FloatArray:
        """(k, 2) forward [m/s] and turn [rad/s] of each action."""
        return np.array(self.twist_table, dtype=np.float64)

    @property
    def moves(self) -> tuple[Move, ...]:
        """The ``Move`` that each action is most like."""
        return tuple(Move(code) for code in classify_twists(self.twists, self.largest).tolist())

    def space(self, robots: int) -> spaces.Discrete | spaces.MultiDiscrete:
        """Discrete for one robot; for several, Discrete over all combinations or MultiDiscrete."""
        count = len(self.names)
        if robots == 1 or self.one_number:
            return spaces.Discrete(count**robots)
        return spaces.MultiDiscrete([count] * robots)

    def decode(self, actions: NDArray[np.integer], robots: int) -> IntArray:
        """(n, robots): each robot's place in the table, from actions (n,) or (n, robots) of ``space``.

        Raises ValueError where an action is not in the space: a compiled loop would read past its tables.
        """
        numbers, count = np.asarray(actions, dtype=np.int64), len(self.names)
        if robots == 1 or not self.one_number:
            choices = numbers.reshape(-1, robots)
        else:
            whole = numbers.reshape(-1)
            rest = [whole // count ** (robots - 1)]  # beyond the space where the number is
            rest += [whole // count**place % count for place in reversed(range(robots - 1))]
            choices = np.stack(rest, axis=1)
        if choices.size and choices.view(np.uint64).max() >= count:  # negative ones are great there
            raise ValueError(f"an action is outside {self.space(robots)}: {actions}")
        return choices

    def encode(self, choices: IntArray, robots: int) -> IntArray:
        """(n,) or (n, robots) actions of ``space``, from each robot's place in the table (n, robots)."""
        if robots == 1:
            return choices[:, 0]
        if not self.one_number:
            return choices
        numbers: IntArray = choices @ len(self.names) ** np.arange(robots - 1, -1, -1)
        return numbers

    def commands(self, actions: NDArray[np.generic], robots: int) -> Commands:
        """The twists of actions (n,) or (n, robots). Raises ValueError where one is not in the space."""
        return TwistTable(self).commands(actions, robots)

    def mirror_table(self) -> IntArray:
        """(k,) which action each one is in a mirror. Raises ValueError where that is none of them."""
        mirrored = [(forward, -turn) for forward, turn in self.twist_table]
        if not set(mirrored) <= set(self.twist_table):
            raise ValueError("the moves to the two sides are not symmetric")
        return np.array([self.twist_table.index(twist) for twist in mirrored], dtype=np.int64)

    def mirror(self, actions: NDArray[np.generic], robots: int) -> NDArray[np.generic]:
        """Actions as they are in a mirror, of the same shape. The left one of two robots is the right one there."""
        choices = self.mirror_table()[self.decode(actions, robots)][:, ::-1]  # type: ignore[arg-type]  # discrete: integers
        return self.encode(choices, robots).reshape(actions.shape)

    @property
    def largest(self) -> tuple[float, float]:
        """The greatest speed [m/s] and turn rate [rad/s], without their signs."""
        speed, turn = np.abs(np.array(self.twist_table)).max(axis=0).tolist()
        return speed, turn


class TwistTable:
    """The table of twists as arrays, for those that look many actions up."""

    def __init__(self, actions: DiscreteActions) -> None:
        self._actions = actions
        self._twists = actions.twists
        self._moves = classify_twists(self._twists, actions.largest)

    def commands(self, actions: NDArray[np.generic], robots: int) -> Commands:
        """The twists of actions (n,) or (n, robots). Raises ValueError where one is not in the space."""
        choices = self._actions.decode(actions, robots)  # type: ignore[arg-type]  # discrete: integers
        # In the table for sure; numpy takes longer to say so again.
        return Commands(
            self._twists.take(choices, axis=0, mode="clip"), self._moves.take(choices, mode="clip")
        )


@dataclass(frozen=True, slots=True)
class ContinuousActions:
    """Any twist within bounds. An action is two numbers from -1 to 1 for each robot, the ends of the two ranges."""

    linear: tuple[float, float]
    """Least and greatest forward speed [m/s]."""
    angular: tuple[float, float]
    """Least and greatest turn rate [rad/s]."""

    def space(self, robots: int) -> spaces.Box:
        """Box (2 * robots,) from -1 to 1: robot by robot, forward then turn."""
        return spaces.Box(-1.0, 1.0, (2 * robots,), np.float32)

    def commands(self, actions: NDArray[np.generic], robots: int) -> Commands:
        """The twists of actions (n, 2 * robots); what lies outside the bounds is brought to them.

        Raises ValueError where a number is not finite.
        """
        shares = np.asarray(actions, dtype=np.float64).reshape(-1, robots, 2)
        if not np.isfinite(shares).all():
            raise ValueError("an action is not a finite number")
        low, high = np.array([self.linear, self.angular]).T
        twists = low + (np.clip(shares, -1.0, 1.0) + 1.0) * (0.5 * (high - low))
        return Commands(twists, classify_twists(twists, self.largest))

    def mirror(self, actions: NDArray[np.generic], robots: int) -> NDArray[np.generic]:
        """Actions as they are in a mirror. Raises ValueError where the two sides are not alike."""
        if self.angular[0] != -self.angular[1]:
            raise ValueError("the turns to the two sides are not symmetric")
        mirrored: NDArray[np.generic] = np.asarray(actions).reshape(-1, robots, 2)[:, ::-1] * [1.0, -1.0]
        return mirrored.reshape(actions.shape).astype(actions.dtype)

    @property
    def largest(self) -> tuple[float, float]:
        """The greatest speed [m/s] and turn rate [rad/s], without their signs."""
        return max(map(abs, self.linear)), max(map(abs, self.angular))


Actions: TypeAlias = DiscreteActions | ContinuousActions
