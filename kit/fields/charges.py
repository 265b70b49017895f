"""Charges on a map, given or derived from its walls, and the forces they exert (dissertation, sections 4.1.3.1 and 4.1.3.2).

Lengths in metres. A force is in newtons if intensities of charges are in N m^2 and those of tension points in
N/m; as in the dissertation only directions and ratios of forces matter. A positive intensity attracts, a
negative one repels: the robot itself counts as the charge -1, and Coulomb's constant as 1.

A new map needs no hand work: its charges are derived from its walls. Every wall's face that looks onto the reachable
floor becomes a line charge. Corners that stand out into the floor (more than half a turn of free space around them)
become point charges, and the lines that meet there one composite with them; so does all that such corners join. Lines
that meet in a corner that recedes stay apart and both act, as in the dissertation.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from kit.arrays import FloatArray, IntArray
from kit.kernels import grids

FIRST_LINE_RANK: Final = 1e12
"""Lines that go before nearer ones are preferred by this many square metres."""

BLOCK_SIZE: Final = 512
"""Number of points computed at once: their arrays stay in the processor's nearest cache."""


class Handover(Enum):
    """Which charge of a composite acts where several could."""

    NEAREST = "nearest"
    """The nearest one: the dissertation's text, section 4.1.3.1."""
    FIRST_LINE = "first_line"
    """The first line, in the order of the list, whose strip holds the point, else the nearest point charge: its
    code and appendix A.5. Differs only where two strips overlap."""


@dataclass(frozen=True, slots=True)
class PointCharge:
    """Coulomb's law: |F| = |i| / r^2 with r the distance to the point (equation 4.12).

    Towards the point if i > 0, away from it if i < 0; no force at the point itself, where no direction is right.
    """

    x: float
    y: float
    intensity: float = 1.0

    def force(self, points: ArrayLike) -> FloatArray:
        """Returns the forces (..., 2) at ``points`` (..., 2)."""
        return ChargeField.from_charges([self]).forces(points)


@dataclass(frozen=True, slots=True)
class LineCharge:
    """A wall's face, in any direction: as a point charge at the foot of the perpendicular (section 4.1.3.1).

    No force where the foot lies beyond the ends: the charge acts on a strip as wide as itself, on both sides.
    """

    ax: float
    ay: float
    bx: float
    by: float
    intensity: float = 1.0

    @property
    def length(self) -> float:
        return math.hypot(self.bx - self.ax, self.by - self.ay)

    @property
    def ends(self) -> tuple[tuple[float, float], tuple[float, float]]:
        return (self.ax, self.ay), (self.bx, self.by)

    def force(self, points: ArrayLike) -> FloatArray:
        """Returns the forces (..., 2) at ``points`` (..., 2)."""
        return ChargeField.from_charges([self]).forces(points)


@dataclass(frozen=True, slots=True)
class CompositeCharge:
    """Lines and the corners they meet in, of which one acts at a time (section 4.1.3.1).

    For wall corners that stand out into the free space: there the strips of the two lines leave a gap, which
    the corner's point charge fills. The force does not jump where one hands over to the other.
    """

    lines: tuple[LineCharge, ...]
    points: tuple[PointCharge, ...]
    handover: Handover = Handover.NEAREST

    def force(self, points: ArrayLike) -> FloatArray:
        """Returns the forces (..., 2) at ``points`` (..., 2)."""
        return ChargeField.from_charges([self]).forces(points)


Charge = PointCharge | LineCharge | CompositeCharge


@dataclass(frozen=True, slots=True)
class TensionPoint:
    """Hooke's law: |F| = i r, towards the point if i > 0 (equation 4.13). Grows with the distance, unlike Coulomb's."""

    x: float
    y: float
    intensity: float

    def force(self, points: ArrayLike) -> FloatArray:
        """Returns the forces (..., 2) at ``points`` (..., 2)."""
        forces: FloatArray = self.intensity * (np.array((self.x, self.y)) - np.asarray(points, dtype=float))
        return forces


@dataclass(frozen=True, slots=True, eq=False)
class ChargeField:
    """Many charges as arrays, for ``kit.kernels.grids.add_forces``, where the formula stands."""

    segments: FloatArray
    """(m, 9) ``ax ay ux uy length low high intensity rank``: points are stretches of no length."""
    starts: IntArray
    """(c + 1): the first stretch of each charge."""

    @classmethod
    def from_charges(cls, charges: Iterable[Charge]) -> ChargeField:
        groups = [list(_segment_rows(charge)) for charge in charges]
        rows = [row for group in groups for row in group]
        return cls(
            np.array(rows, dtype=np.float64).reshape(-1, 9),
            np.cumsum([0, *map(len, groups)], dtype=np.int64),
        )

    def forces(self, points: ArrayLike) -> FloatArray:
        """The sum of all charges' forces at ``points`` (..., 2), in that shape."""
        places = np.asarray(points, dtype=np.float64)
        x, y = (np.ascontiguousarray(places[..., axis].ravel()) for axis in (0, 1))
        fx, fy = np.zeros_like(x), np.zeros_like(y)
        for first in range(0, len(x), BLOCK_SIZE):
            some = slice(first, first + BLOCK_SIZE)
            grids.add_forces(x[some], y[some], self.segments, self.starts, fx[some], fy[some])
        return np.stack((fx, fy), axis=-1).reshape(places.shape)


SegmentRow = tuple[float, float, float, float, float, float, float, float, float]


def _segment_rows(charge: Charge) -> Iterator[SegmentRow]:
    if isinstance(charge, PointCharge):
        yield _point_row(charge)
    elif isinstance(charge, LineCharge):
        yield _line_row(charge, 0.0)
    elif _is_closed(charge):
        yield from (_line_row(line, 0.0, clamped=True) for line in charge.lines)
    else:
        first = charge.handover is Handover.FIRST_LINE
        count = len(charge.lines)
        for number, line in enumerate(charge.lines):
            yield _line_row(line, FIRST_LINE_RANK * (number - count) if first else 0.0)
        yield from map(_point_row, charge.points)


def _is_closed(composite: CompositeCharge) -> bool:
    """Whether every line's ends are corners of its strength, and nothing else is. Then each line acts beyond its
    ends like its corners: half the members for the same force."""
    ends = {(end, line.intensity) for line in composite.lines for end in line.ends}
    corners = {((point.x, point.y), point.intensity) for point in composite.points}
    return composite.handover is Handover.NEAREST and ends == corners


def _point_row(charge: PointCharge) -> SegmentRow:
    return charge.x, charge.y, 0.0, 0.0, 0.0, 0.0, 0.0, charge.intensity, 0.0


def _line_row(line: LineCharge, rank: float, *, clamped: bool = False) -> SegmentRow:
    length = line.length
    ux, uy = ((line.bx - line.ax) / length, (line.by - line.ay) / length) if length else (0.0, 0.0)
    low, high = (-math.inf, math.inf) if clamped else (0.0, length)
    return line.ax, line.ay, ux, uy, length, low, high, line.intensity, rank


def iter_members(charges: Iterable[Charge]) -> Iterator[PointCharge | LineCharge]:
    """Every point and line, those of composites too."""
    for charge in charges:
        if isinstance(charge, CompositeCharge):
            yield from charge.lines
            yield from charge.points
        else:
            yield charge
