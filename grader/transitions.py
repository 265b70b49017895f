"""Transitions of the model as what a reward gets: columns by name for a student's, a record for the kit's own."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from grader.model import CELL, LASTS, MOVES, NO_MOVE, Floats, Integers, Model

Column: TypeAlias = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Steps:
    """Some transitions of a model: which state, which move."""

    model: Model
    states: Integers
    moves: Integers

    def __len__(self) -> int:
        return len(self.states)

    @classmethod
    def all(cls, model: Model) -> Steps:
        """Every one there is, state by state."""
        states = np.repeat(np.arange(model.states), len(MOVES))
        return cls(model, states, np.tile(np.arange(len(MOVES)), model.states))

    @cached_property
    def after(self) -> Integers:
        return self.model.next[self.states, self.moves]

    @cached_property
    def before_pose(self) -> Floats:
        return self.model.pose(self.states)

    @cached_property
    def after_pose(self) -> Floats:
        return self.model.pose(self.after)

    @property
    def hit(self) -> NDArray[np.bool_]:
        return self.model.hit[self.states, self.moves]

    @property
    def reached(self) -> NDArray[np.bool_]:
        return self.model.reached[self.states, self.moves]

    @property
    def target(self) -> Floats:
        """(2)"""
        place: Floats = (self.model.cells[self.model.target] + 0.5) * CELL
        return place

    def columns(self, names: Sequence[str]) -> dict[str, Sequence[Any] | Column]:
        """What a student's reward asked for. KeyError for a name that there is not."""
        return {name: _listed(COLUMNS[name](self)) for name in names}

    def away(self, pose: Floats) -> Floats:
        found: Floats = np.hypot(self.target[0] - pose[:, 0], self.target[1] - pose[:, 1])
        return found

    def bearing(self, pose: Floats) -> Floats:
        towards = np.arctan2(self.target[1] - pose[:, 1], self.target[0] - pose[:, 0])
        # At the target itself every direction is right.
        found: Floats = np.where(self.away(pose) < 1e-9, 0.0, wrapped(towards - pose[:, 2]))
        return found


def wrapped(angle: Floats) -> Floats:
    """The same direction, in [-pi, pi); directions a rounding apart from the seam stay together."""
    turned: Floats = (np.round(angle, 12) + np.pi) % (2 * np.pi) - np.pi
    return turned


def _listed(column: Column) -> Sequence[Any] | Column:
    return column if column.dtype.kind == "f" else column.tolist()


def _names(moves: Integers) -> Column:
    return np.array([*MOVES, ""], dtype=object)[moves]


COLUMNS: Final[Mapping[str, Callable[[Steps], Column]]] = MappingProxyType(
    {
        "x": lambda s: s.after_pose[:, 0],
        "y": lambda s: s.after_pose[:, 1],
        "heading": lambda s: s.after_pose[:, 2],
        "previous_x": lambda s: s.before_pose[:, 0],
        "previous_y": lambda s: s.before_pose[:, 1],
        "previous_heading": lambda s: s.before_pose[:, 2],
        "target_x": lambda s: np.full(len(s), s.target[0]),
        "target_y": lambda s: np.full(len(s), s.target[1]),
        "distance": lambda s: s.away(s.after_pose),
        "previous_distance": lambda s: s.away(s.before_pose),
        "to_go": lambda s: s.model.to_go[s.model.cell_of(s.after)],
        "previous_to_go": lambda s: s.model.to_go[s.model.cell_of(s.states)],
        "bearing": lambda s: s.bearing(s.after_pose),
        "previous_bearing": lambda s: s.bearing(s.before_pose),
        "front": lambda s: s.model.ahead[s.model.cell_of(s.after), s.model.heading_of(s.after)],
        "move": lambda s: _names(s.moves),
        "previous_move": lambda s: _names(s.states % LASTS),
        "collided": lambda s: s.hit,
        "reached": lambda s: s.reached,
    }
)
"""How each of ``grader.model.NAMES`` is made."""

assert len(MOVES) == NO_MOVE  # so that the last name is the empty one
