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

Solves cover and packing problems of a 0/1 matrix with HiGHS. The only module that imports it.

Rows are what has to be covered, columns the sets that cover them. All three are deterministic (one thread, one
seed) unless the time limit cuts them short.
"""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from heapq import heapify, heappop, heappush
from typing import Any, Literal

import numpy as np

CoverColumn = frozenset[int]

_MAX_DENOMINATOR = 1000
_CLOCK_INTERVAL = 64


@dataclass(frozen=True, slots=True)
class SetCover:
    """The columns chosen to cover every row, and a lower bound on their number."""

    chosen: tuple[int, ...]
    bound: int
    packed_rows: tuple[int, ...]
    """Rows of which no column covers two."""
    row_weights: tuple[dict[int, Fraction], ...]
    """Per part that needs it: weights of rows; no column collects more than 1, nor touches two parts."""

    @property
    def is_proved(self) -> bool:
        return self.bound == len(self.chosen)


@dataclass(slots=True)
class _CoverMatrix:
    """The part of a matrix that the reductions left. Invariant: ``covers`` and ``covered_by`` mirror each other."""

    covers: dict[int, set[int]]
    covered_by: dict[int, set[int]]

    def drop_row(self, row: int) -> None:
        for column in self.covered_by.pop(row):
            self.covers[column].discard(row)

    def drop_column(self, column: int) -> None:
        for row in self.covers.pop(column):
            self.covered_by[row].discard(column)


def minimum_cover(columns: Sequence[CoverColumn], rows: int, *, deadline: float = math.inf) -> SetCover:
    """The fewest of ``columns`` whose union is ``range(rows)``; as good a cover as the deadline allows, with its bound.

    Every row must lie in some column. The deadline is one of ``time.monotonic``.
    """
    whole = _CoverMatrix(
        {i: set(column) for i, column in enumerate(columns)}, {row: set() for row in range(rows)}
    )
    for i, column in enumerate(columns):
        for row in column:
            whole.covered_by[row].add(i)
    if uncovered := [row for row, by in whole.covered_by.items() if not by]:
        raise ValueError(f"no column covers row {uncovered[0]}")
    essential, packed = _reduce(whole, deadline)
    results = [_solve_component(part, deadline) for part in _connected_components(whole)]
    return SetCover(
        tuple(sorted([*essential, *(c for result in results for c in result.chosen)])),
        len(packed) + sum(result.bound for result in results),
        tuple(sorted([*packed, *(row for result in results for row in result.packed_rows)])),
        tuple(weights for result in results for weights in result.row_weights),
    )


def _reduce(matrix: _CoverMatrix, deadline: float) -> tuple[list[int], list[int]]:
    """Applies the reductions in place until none applies. Returns the essential columns and their witnesses."""
    essential: list[int] = []
    witnesses: list[int] = []
    changed = True
    while changed and time.monotonic() < deadline:
        changed = _drop_dominated_rows(matrix, deadline) | _drop_dominated_columns(matrix, deadline)
        for row in sorted(matrix.covered_by):
            by = matrix.covered_by.get(row)
            if by is not None and len(by) == 1:
                (column,) = by
                essential.append(column)
                witnesses.append(row)
                for covered in sorted(matrix.covers[column]):
                    matrix.drop_row(covered)
                matrix.drop_column(column)
                changed = True
    return essential, witnesses


def _drop_dominated_rows(matrix: _CoverMatrix, deadline: float) -> bool:
    dropped = False
    for count, row in enumerate(sorted(matrix.covered_by)):
        if count % _CLOCK_INTERVAL == 0 and time.monotonic() > deadline:
            break
        if (by := matrix.covered_by.get(row)) is None:
            continue
        # A row that all of ``by`` cover lies in each of them: it is enough to look into the smallest.
        smallest = min(by, key=lambda c: (len(matrix.covers[c]), c))
        for other in sorted(matrix.covers[smallest]):
            if other != row and by <= matrix.covered_by[other]:
                matrix.drop_row(other)
                dropped = True
    return dropped


def _drop_dominated_columns(matrix: _CoverMatrix, deadline: float) -> bool:
    dropped = False
    for count, column in enumerate(sorted(matrix.covers)):
        if count % _CLOCK_INTERVAL == 0 and time.monotonic() > deadline:
            break
        rows = matrix.covers[column]
        if not rows:
            matrix.drop_column(column)
            dropped = True
            continue
        # A column that covers all of ``rows`` covers the rarest of them.
        rarest = min(rows, key=lambda r: (len(matrix.covered_by[r]), r))
        if any(other != column and rows <= matrix.covers[other] for other in matrix.covered_by[rarest]):
            matrix.drop_column(column)
            dropped = True
    return dropped


def _connected_components(matrix: _CoverMatrix) -> list[_CoverMatrix]:
    """The connected components of a reduced matrix, each column and row in one of them."""
    parts: list[_CoverMatrix] = []
    left = set(matrix.covered_by)
    while left:
        rows: set[int] = set()
        columns: set[int] = set()
        open_rows = [min(left)]
        while open_rows:
            row = open_rows.pop()
            if row not in rows:
                rows.add(row)
                fresh = matrix.covered_by[row] - columns
                columns |= fresh
                open_rows.extend(r for c in sorted(fresh) for r in matrix.covers[c] if r not in rows)
        left -= rows
        parts.append(
            _CoverMatrix(
                {c: matrix.covers[c] for c in sorted(columns)},
                {r: matrix.covered_by[r] for r in sorted(rows)},
            )
        )
    return parts


def _solve_component(component: _CoverMatrix, deadline: float) -> SetCover:
    """The cover of one part: by the greedy methods if they meet, else by HiGHS."""
    chosen, packed = _greedy_cover(component), _greedy_packing(component)
    if len(chosen) == len(packed):
        return SetCover(chosen, len(chosen), packed, ())
    columns, rows = sorted(component.covers), sorted(component.covered_by)
    number = {row: i for i, row in enumerate(rows)}
    matrix = [frozenset(number[row] for row in component.covers[column]) for column in columns]

    def left() -> float:
        return deadline - time.monotonic()

    if left() <= 0:
        return SetCover(chosen, len(packed), packed, ())
    values = fractional_packing(matrix, len(rows), left())
    selection = minimum_columns(matrix, len(rows), left())
    bound = len(packed)
    if selection is not None:
        bound = max(bound, selection.bound)
        if len(selection.chosen) < len(chosen):
            chosen = tuple(columns[c] for c in selection.chosen)
    weights = None if values is None else _feasible_fractions(values, matrix)
    if weights is None:
        return SetCover(chosen, bound, packed, ())
    total = sum(weights, Fraction(0))
    bound = max(bound, math.ceil(total))
    if total > len(packed) and total.denominator == 1:  # else no packing reaches the bound of the weights
        packed = max(packed, tuple(rows[i] for i in maximum_packing(matrix, len(rows), left())), key=len)
    if len(packed) >= math.ceil(total):
        return SetCover(chosen, bound, packed, ())
    return SetCover(chosen, bound, (), ({rows[i]: weight for i, weight in enumerate(weights) if weight},))


def _feasible_fractions(values: Sequence[float], matrix: Sequence[CoverColumn]) -> list[Fraction]:
    """The weights as fractions that certainly obey "no column collects more than 1"."""
    weights = [Fraction(value).limit_denominator(_MAX_DENOMINATOR) for value in values]
    heaviest = max(
        (sum((weights[row] for row in column), Fraction(0)) for column in matrix), default=Fraction(1)
    )
    return [weight / heaviest for weight in weights] if heaviest > 1 else weights


def _greedy_cover(matrix: _CoverMatrix) -> tuple[int, ...]:
    """The column that covers most of what is left, until nothing is; then whatever turned out superfluous is dropped."""
    left = set(matrix.covered_by)
    chosen: list[int] = []
    # What a column adds can only shrink, so the first whose stored gain is still right adds the most.
    heap = [(-len(rows), column) for column, rows in matrix.covers.items()]
    heapify(heap)
    while left:
        stored, column = heappop(heap)
        gain = len(matrix.covers[column] & left)
        if -stored == gain:
            chosen.append(column)
            left -= matrix.covers[column]
        elif gain:
            heappush(heap, (-gain, column))
    times = Counter(row for column in chosen for row in matrix.covers[column])
    for column in list(chosen):
        if all(times[row] > 1 for row in matrix.covers[column]):
            chosen.remove(column)
            times.subtract(matrix.covers[column])
    return tuple(sorted(chosen))


def _greedy_packing(matrix: _CoverMatrix) -> tuple[int, ...]:
    """Rows that share no column, those in the fewest columns first."""
    used: set[int] = set()
    packed: list[int] = []
    for row in sorted(matrix.covered_by, key=lambda r: (len(matrix.covered_by[r]), r)):
        if used.isdisjoint(matrix.covered_by[row]):
            packed.append(row)
            used |= matrix.covered_by[row]
    return tuple(packed)


_BOUND_TOLERANCE = 1e-6


@dataclass(frozen=True, slots=True)
class SolverSelection:
    """The columns (or rows) chosen, and how many any choice must have at least (or at most)."""

    chosen: tuple[int, ...]
    bound: int


def minimum_columns(columns: Sequence[frozenset[int]], rows: int, seconds: float) -> SolverSelection | None:
    """The fewest columns that cover every row: ``min sum z, A z >= 1, z binary``. None: nothing found in time."""
    highs = _build_model(columns, rows, sense="cover", integer=True, seconds=seconds)
    highs.run()
    bound = _round_bound_up(highs.getInfo().mip_dual_bound)
    chosen = _selected_variables(highs)
    return None if chosen is None else SolverSelection(chosen, min(bound, len(chosen)))


def maximum_packing(columns: Sequence[frozenset[int]], rows: int, seconds: float) -> tuple[int, ...]:
    """The most rows of which no column contains two: ``max sum y, y A <= 1, y binary``. Empty: none found in time."""
    highs = _build_model(columns, rows, sense="packing", integer=True, seconds=seconds)
    highs.run()
    return _selected_variables(highs) or ()


def fractional_packing(
    columns: Sequence[frozenset[int]], rows: int, seconds: float
) -> tuple[float, ...] | None:
    """Weights of the rows of which no column collects more than 1, of the greatest sum: the packing's relaxation.

    By duality their sum is the least fractional cover, so no cover is smaller. None: not solved in time.
    """
    highs = _build_model(columns, rows, sense="packing", integer=False, seconds=seconds)
    highs.run()
    if highs.getModelStatus() != _highspy().HighsModelStatus.kOptimal:
        return None
    return tuple(min(1.0, max(0.0, value)) for value in highs.getSolution().col_value)


def minimum_uncovered(
    columns: Sequence[frozenset[int]], rows: int, at_most: int, seconds: float
) -> SolverSelection | None:
    """``at_most`` columns that leave the fewest rows uncovered; the bound is on how few those can be.

    ``min sum d, A z + d >= 1, sum z <= at_most, z binary, d >= 0``. ``chosen`` are the columns.
    """
    highs = _build_model(columns, rows, sense="cover", integer=True, seconds=seconds)
    count = len(columns)
    every = np.arange(count, dtype=np.int32)
    highs.changeColsCost(count, every, np.zeros(count))
    highs.addRow(0.0, float(at_most), count, every, np.ones(count))
    for row in range(rows):
        highs.addCol(1.0, 0.0, 1.0, 1, np.array([row], dtype=np.int32), np.ones(1))
    highs.run()
    bound = max(0, _round_bound_up(highs.getInfo().mip_dual_bound))
    chosen = _selected_variables(highs)
    return None if chosen is None else SolverSelection(tuple(c for c in chosen if c < count), bound)


def _highspy() -> Any:
    import highspy

    return highspy


def _build_model(
    columns: Sequence[frozenset[int]],
    rows: int,
    *,
    sense: Literal["cover", "packing"],
    integer: bool,
    seconds: float,
) -> Any:
    """A HiGHS model of the matrix; for the packing its transpose, so that HiGHS's columns are our rows."""
    highspy = _highspy()
    lp = highspy.HighsLp()
    lengths = np.array([len(column) for column in columns], dtype=np.int32)
    lp.a_matrix_.start_ = np.concatenate(([0], np.cumsum(lengths))).astype(np.int32)
    lp.a_matrix_.index_ = np.array([row for column in columns for row in sorted(column)], dtype=np.int32)
    lp.a_matrix_.value_ = np.ones(int(lengths.sum()))
    cover = sense == "cover"
    lp.num_col_, lp.num_row_ = (len(columns), rows) if cover else (rows, len(columns))
    lp.a_matrix_.format_ = highspy.MatrixFormat.kColwise if cover else highspy.MatrixFormat.kRowwise
    lp.a_matrix_.num_col_, lp.a_matrix_.num_row_ = lp.num_col_, lp.num_row_
    lp.sense_ = highspy.ObjSense.kMinimize if cover else highspy.ObjSense.kMaximize
    lp.col_cost_ = np.ones(lp.num_col_)
    lp.col_lower_ = np.zeros(lp.num_col_)
    lp.col_upper_ = np.ones(lp.num_col_)
    lp.row_lower_ = np.ones(lp.num_row_) if cover else np.full(lp.num_row_, -math.inf)
    lp.row_upper_ = np.full(lp.num_row_, math.inf) if cover else np.ones(lp.num_row_)
    if integer:
        lp.integrality_ = [highspy.HighsVarType.kInteger] * lp.num_col_
    highs = highspy.Highs()
    for option, value in (
        ("output_flag", False),
        ("threads", 1),
        ("parallel", "off"),
        ("random_seed", 0),
        ("time_limit", max(seconds, 0.0)),
    ):
        highs.setOptionValue(option, value)
    highs.passModel(lp)
    return highs


def _selected_variables(highs: Any) -> tuple[int, ...] | None:
    """The variables set to 1 in the best solution found, if there is one."""
    if highs.getInfo().primal_solution_status != _highspy().SolutionStatus.kSolutionStatusFeasible:
        return None
    return tuple(i for i, value in enumerate(highs.getSolution().col_value) if value > 0.5)


def _round_bound_up(bound: float) -> int:
    return math.ceil(bound - _BOUND_TOLERANCE) if math.isfinite(bound) else 0
