"""Solves cover and packing problems of a 0/1 matrix with HiGHS. The only module that imports it.

Rows are what has to be covered, columns the sets that cover them. All three are deterministic (one thread, one
seed) unless the time limit cuts them short.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

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
