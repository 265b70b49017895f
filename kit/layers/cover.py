"""The fewest sets that cover everything, with the reasons why there cannot be fewer.

Reductions come first, each exact, repeated until none applies (Garfinkel and Nemhauser 1972, chapter 8):

    essential column   a row that one column alone covers: take the column. The row is its *witness*.
    dominated row      every column that covers row r covers row s as well: s is forgotten.
    dominated column   what column c covers, column d covers too: c is forgotten.

What is left falls into independent parts, no column touching two of them. In each part a greedy cover and a
greedy packing (rows of which no column covers two) often meet, which settles it; otherwise HiGHS does, by
branch and bound.

The reasons, from strong to weak: *packed* rows, of which no column of the whole matrix covers two, so that each
needs a column of its own; *weighted* rows of one part, where no column collects more than 1 in weight, so that
a total weight of w needs at least w columns, rounded up (linear programming duality); and for the rest the word
of the solver that its search found nothing smaller. The reductions keep both kinds of reason valid for the whole
matrix: a forgotten row has weight 0, a witness weight 1, and a forgotten column collects no more than the one
that dominates it.
"""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from heapq import heapify, heappop, heappush

from kit.layers import solver

Column = frozenset[int]

_LARGEST_DENOMINATOR = 1000
_LOOK_AT_CLOCK_EVERY = 64


@dataclass(frozen=True, slots=True)
class Cover:
    """Which columns cover every row, and the bound on how few can."""

    chosen: tuple[int, ...]
    bound: int
    packed: tuple[int, ...]
    """Rows of which no column covers two."""
    weighted: tuple[dict[int, Fraction], ...]
    """Per part that needs it: weights of rows; no column collects more than 1, nor touches two parts."""

    @property
    def proved(self) -> bool:
        return self.bound == len(self.chosen)


@dataclass(slots=True)
class _Part:
    """The part of a matrix that the reductions left. Invariant: ``covers`` and ``covered_by`` mirror each other."""

    covers: dict[int, set[int]]
    covered_by: dict[int, set[int]]

    def drop_row(self, row: int) -> None:
        for column in self.covered_by.pop(row):
            self.covers[column].discard(row)

    def drop_column(self, column: int) -> None:
        for row in self.covers.pop(column):
            self.covered_by[row].discard(column)


def minimum_cover(columns: Sequence[Column], rows: int, *, deadline: float = math.inf) -> Cover:
    """The fewest of ``columns`` whose union is ``range(rows)``; as good a cover as the deadline allows, with its bound.

    Every row must lie in some column. The deadline is one of ``time.monotonic``.
    """
    whole = _Part({i: set(column) for i, column in enumerate(columns)}, {row: set() for row in range(rows)})
    for i, column in enumerate(columns):
        for row in column:
            whole.covered_by[row].add(i)
    if uncovered := [row for row, by in whole.covered_by.items() if not by]:
        raise ValueError(f"no column covers row {uncovered[0]}")
    essential, packed = _reduce(whole, deadline)
    results = [_settle(part, deadline) for part in _parts(whole)]
    return Cover(
        tuple(sorted([*essential, *(c for result in results for c in result.chosen)])),
        len(packed) + sum(result.bound for result in results),
        tuple(sorted([*packed, *(row for result in results for row in result.packed)])),
        tuple(weights for result in results for weights in result.weighted),
    )


def _reduce(part: _Part, deadline: float) -> tuple[list[int], list[int]]:
    """Applies the reductions in place until none applies. Returns the essential columns and their witnesses."""
    essential: list[int] = []
    witnesses: list[int] = []
    changed = True
    while changed and time.monotonic() < deadline:
        changed = _drop_dominated_rows(part, deadline) | _drop_dominated_columns(part, deadline)
        for row in sorted(part.covered_by):
            by = part.covered_by.get(row)
            if by is not None and len(by) == 1:
                (column,) = by
                essential.append(column)
                witnesses.append(row)
                for covered in sorted(part.covers[column]):
                    part.drop_row(covered)
                part.drop_column(column)
                changed = True
    return essential, witnesses


def _drop_dominated_rows(part: _Part, deadline: float) -> bool:
    dropped = False
    for count, row in enumerate(sorted(part.covered_by)):
        if count % _LOOK_AT_CLOCK_EVERY == 0 and time.monotonic() > deadline:
            break
        if (by := part.covered_by.get(row)) is None:
            continue
        # A row that all of ``by`` cover lies in each of them: it is enough to look into the smallest.
        smallest = min(by, key=lambda c: (len(part.covers[c]), c))
        for other in sorted(part.covers[smallest]):
            if other != row and by <= part.covered_by[other]:
                part.drop_row(other)
                dropped = True
    return dropped


def _drop_dominated_columns(part: _Part, deadline: float) -> bool:
    dropped = False
    for count, column in enumerate(sorted(part.covers)):
        if count % _LOOK_AT_CLOCK_EVERY == 0 and time.monotonic() > deadline:
            break
        rows = part.covers[column]
        if not rows:
            part.drop_column(column)
            dropped = True
            continue
        # A column that covers all of ``rows`` covers the rarest of them.
        rarest = min(rows, key=lambda r: (len(part.covered_by[r]), r))
        if any(other != column and rows <= part.covers[other] for other in part.covered_by[rarest]):
            part.drop_column(column)
            dropped = True
    return dropped


def _parts(part: _Part) -> list[_Part]:
    """The connected components of a reduced matrix, each column and row in one of them."""
    parts: list[_Part] = []
    left = set(part.covered_by)
    while left:
        rows: set[int] = set()
        columns: set[int] = set()
        open_rows = [min(left)]
        while open_rows:
            row = open_rows.pop()
            if row not in rows:
                rows.add(row)
                fresh = part.covered_by[row] - columns
                columns |= fresh
                open_rows.extend(r for c in sorted(fresh) for r in part.covers[c] if r not in rows)
        left -= rows
        parts.append(
            _Part({c: part.covers[c] for c in sorted(columns)}, {r: part.covered_by[r] for r in sorted(rows)})
        )
    return parts


def _settle(part: _Part, deadline: float) -> Cover:
    """The cover of one part: by the greedy methods if they meet, else by HiGHS."""
    chosen, packed = _greedy_cover(part), _greedy_packing(part)
    if len(chosen) == len(packed):
        return Cover(chosen, len(chosen), packed, ())
    columns, rows = sorted(part.covers), sorted(part.covered_by)
    number = {row: i for i, row in enumerate(rows)}
    matrix = [frozenset(number[row] for row in part.covers[column]) for column in columns]

    def left() -> float:
        return deadline - time.monotonic()

    if left() <= 0:
        return Cover(chosen, len(packed), packed, ())
    values = solver.row_weights(matrix, len(rows), left())
    selection = solver.fewest_columns(matrix, len(rows), left())
    bound = len(packed)
    if selection is not None:
        bound = max(bound, selection.bound)
        if len(selection.chosen) < len(chosen):
            chosen = tuple(columns[c] for c in selection.chosen)
    weights = None if values is None else _exact(values, matrix)
    if weights is None:
        return Cover(chosen, bound, packed, ())
    total = sum(weights, Fraction(0))
    bound = max(bound, math.ceil(total))
    if total > len(packed) and total.denominator == 1:  # else no packing reaches the bound of the weights
        packed = max(packed, tuple(rows[i] for i in solver.most_rows(matrix, len(rows), left())), key=len)
    if len(packed) >= math.ceil(total):
        return Cover(chosen, bound, packed, ())
    return Cover(chosen, bound, (), ({rows[i]: weight for i, weight in enumerate(weights) if weight},))


def _exact(values: Sequence[float], matrix: Sequence[Column]) -> list[Fraction]:
    """The weights as fractions that certainly obey "no column collects more than 1"."""
    weights = [Fraction(value).limit_denominator(_LARGEST_DENOMINATOR) for value in values]
    heaviest = max(
        (sum((weights[row] for row in column), Fraction(0)) for column in matrix), default=Fraction(1)
    )
    return [weight / heaviest for weight in weights] if heaviest > 1 else weights


def _greedy_cover(part: _Part) -> tuple[int, ...]:
    """The column that covers most of what is left, until nothing is; then whatever turned out superfluous is dropped."""
    left = set(part.covered_by)
    chosen: list[int] = []
    # What a column adds can only shrink, so the first whose stored gain is still right adds the most.
    heap = [(-len(rows), column) for column, rows in part.covers.items()]
    heapify(heap)
    while left:
        stored, column = heappop(heap)
        gain = len(part.covers[column] & left)
        if -stored == gain:
            chosen.append(column)
            left -= part.covers[column]
        elif gain:
            heappush(heap, (-gain, column))
    times = Counter(row for column in chosen for row in part.covers[column])
    for column in list(chosen):
        if all(times[row] > 1 for row in part.covers[column]):
            chosen.remove(column)
            times.subtract(part.covers[column])
    return tuple(sorted(chosen))


def _greedy_packing(part: _Part) -> tuple[int, ...]:
    """Rows that share no column, those in the fewest columns first."""
    used: set[int] = set()
    packed: list[int] = []
    for row in sorted(part.covered_by, key=lambda r: (len(part.covered_by[r]), r)):
        if used.isdisjoint(part.covered_by[row]):
            packed.append(row)
            used |= part.covered_by[row]
    return tuple(packed)
