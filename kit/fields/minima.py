"""Follows a force field from every cell: to the target, or into a trap where the forces cancel."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from kit.arrays import FloatArray, IntArray
from kit.fields.layout import ChargeLayout
from kit.fields.occupancy_grid import OccupancyGrid

STEP_CELLS: Final = 3
"""Cells to a step, so that sixteen directions and more are told apart."""
DOUBLINGS: Final = 14
"""Steps are followed 2 ** DOUBLINGS times: across any map."""
TRAP_DISTANCE: Final = 0.2
"""Ends nearer than this [m] are one trap: around its bottom steps go to and fro."""


class Trap(NamedTuple):
    """A local minimum of the potential: the field leads to it from all around."""

    x: float
    y: float
    share: float
    """0 to 1: of the floor, how much leads here."""


@dataclass(frozen=True, slots=True, eq=False)
class ForceFlow:
    """The end of the path along the forces, for every cell of the grid."""

    grid: OccupancyGrid
    ends: IntArray
    """(rows, columns): the number of the cell; -1 off the floor."""
    target: tuple[float, float]
    radius: float

    @classmethod
    def from_layout(
        cls, layout: ChargeLayout, grid: OccupancyGrid, target: tuple[float, float], radius: float = 0.25
    ) -> ForceFlow:
        """``radius`` [m]: how near to the target counts as there."""
        return cls.from_forces(layout.forces(grid.cell_centers, target), grid, target, radius)

    @classmethod
    def from_forces(
        cls, forces: FloatArray, grid: OccupancyGrid, target: tuple[float, float], radius: float = 0.25
    ) -> ForceFlow:
        """The flow of any forces (rows, columns, 2) at the floor's cells.

        Every cell points to the one a step along its force; pointing twice as far again and again leads to the end.
        """
        rows, columns = grid.shape
        here = np.arange(rows * columns).reshape(rows, columns)
        strength = np.hypot(forces[..., 0], forces[..., 1])
        step = np.rint(STEP_CELLS * forces / np.where(strength > 0, strength, 1.0)[..., None]).astype(int)
        row = np.clip(here // columns + step[..., 1], 0, rows - 1)
        column = np.clip(here % columns + step[..., 0], 0, columns - 1)
        after = row * columns + column
        away = np.hypot(grid.cell_centers[..., 0] - target[0], grid.cell_centers[..., 1] - target[1])
        stays = ~grid.inside | ~grid.inside[row, column] | (away <= radius)
        ends = np.where(stays, here, after).ravel()
        for _ in range(DOUBLINGS):
            ends = ends[ends]
        return cls(grid, np.where(grid.inside, ends.reshape(rows, columns), -1), target, radius)

    def end(self, x: float, y: float) -> tuple[float, float] | None:
        """The point [m] that the forces lead to; None off the floor."""
        number = int(self.ends[self.grid.cell_at(x, y)])
        return None if number < 0 else self.grid.cell_center(divmod(number, self.grid.shape[1]))

    def reaches(self, x: float, y: float) -> bool:
        """Whether they lead to the target."""
        end = self.end(x, y)
        return end is not None and math.dist(end, self.target) <= self.radius + self.grid.cell_size

    def traps(self, least: float = 0.01) -> tuple[Trap, ...]:
        """The traps, largest first; without those that catch less than a share ``least`` of the floor."""
        numbers, counts = np.unique(self.ends[self.ends >= 0], return_counts=True)
        columns = self.grid.shape[1]
        places = np.array([self.grid.cell_center(divmod(number, columns)) for number in numbers.tolist()])
        shares = counts / max(1, counts.sum())
        if not len(places):
            return ()
        elsewhere = np.hypot(*(places - self.target).T) > self.radius + self.grid.cell_size
        return tuple(
            sorted(
                (trap for trap in _merge_ends(places[elsewhere], shares[elsewhere]) if trap.share >= least),
                key=lambda trap: -trap.share,
            )
        )


def _merge_ends(places: FloatArray, shares: Sequence[float] | FloatArray) -> list[Trap]:
    """Ends that lie together as one, at the middle of those that most leads to."""
    rest = list(range(len(places)))
    traps = []
    while rest:
        first = max(rest, key=lambda number: shares[number])
        near = [number for number in rest if math.dist(places[number], places[first]) <= TRAP_DISTANCE]
        weights = np.array([shares[number] for number in near])
        x, y = (weights[:, None] * places[near]).sum(axis=0) / weights.sum()
        traps.append(Trap(float(x), float(y), float(weights.sum())))
        rest = [number for number in rest if number not in near]
    return traps
