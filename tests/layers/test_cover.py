"""Set cover: the optimum, and reasons that hold."""

from __future__ import annotations

import random
import time
from fractions import Fraction
from itertools import combinations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kit.layers.cover import (
    SetCover,
    fractional_packing,
    maximum_packing,
    minimum_columns,
    minimum_cover,
    minimum_uncovered,
)

# The affine plane of order three: twelve lines, nine points. Every line is hit by five points, not by four, but a
# third of every point hits each line once: the fractional cover is three (Fulkerson, Nemhauser and Trotter 1974).
LINES = [frozenset(3 * x + (a * x + b) % 3 for x in range(3)) for a in range(3) for b in range(3)] + [
    frozenset(3 * x + y for y in range(3)) for x in range(3)
]
POINTS = [frozenset(i for i, line in enumerate(LINES) if point in line) for point in range(9)]

CYCLE = [frozenset({i, (i + 1) % 5}) for i in range(5)]


@st.composite
def matrices(draw: st.DrawFn) -> tuple[list[frozenset[int]], int]:
    rows = draw(st.integers(0, 7))
    column = st.frozensets(st.integers(0, max(rows - 1, 0)), max_size=4) if rows else st.just(frozenset())
    columns = draw(st.lists(column, max_size=8))
    return [*columns, *(frozenset({row}) for row in range(rows) if not any(row in c for c in columns))], rows


def check(cover: SetCover, columns: list[frozenset[int]], rows: int) -> None:
    """Whether a cover is one, and its reasons hold for every column of the matrix."""
    assert frozenset().union(*(columns[c] for c in cover.chosen)) == frozenset(range(rows))
    assert cover.bound <= len(cover.chosen)
    parts: list[dict[int, Fraction]] = [{row: Fraction(1)} for row in cover.packed_rows]
    parts += cover.row_weights
    for column in columns:
        touched = [part for part in parts if part.keys() & column]
        assert len(touched) <= 1
        assert sum(weight for part in touched for row, weight in part.items() if row in column) <= 1


@settings(deadline=None)  # the first example loads HiGHS
@given(matrices())
def test_no_choice_of_columns_is_smaller(matrix: tuple[list[frozenset[int]], int]) -> None:
    columns, rows = matrix
    cover = minimum_cover(columns, rows)
    check(cover, columns, rows)
    assert cover.is_proved
    everything = frozenset(range(rows))
    smaller = combinations(columns, len(cover.chosen) - 1) if cover.chosen else ()
    assert not any(frozenset().union(*choice) == everything for choice in smaller)


@pytest.mark.parametrize(
    ("columns", "rows", "size", "packed", "weight"),
    [
        ([], 0, 0, 0, None),
        ([frozenset({0, 1}), frozenset({1, 2})], 3, 2, 2, None),
        (CYCLE, 5, 3, 0, Fraction(5, 2)),
    ],
)
def test_the_kind_of_reason(
    columns: list[frozenset[int]], rows: int, size: int, packed: int, weight: Fraction | None
) -> None:
    """Packed rows where they reach; weights of one half around an odd cycle."""
    cover = minimum_cover(columns, rows)
    check(cover, columns, rows)
    assert (len(cover.chosen), cover.bound, len(cover.packed_rows)) == (size, size, packed)
    assert [sum(part.values()) for part in cover.row_weights] == ([] if weight is None else [weight])


def test_where_only_the_search_proves_it() -> None:
    cover = minimum_cover(POINTS, 12)
    check(cover, POINTS, 12)
    assert (len(cover.chosen), cover.bound) == (5, 5)
    reasons = len(cover.packed_rows) + sum(-(-sum(part.values()) // 1) for part in cover.row_weights)
    assert reasons == 3


def test_independent_parts_are_settled_one_by_one() -> None:
    columns = [frozenset(row + 5 * k for row in column) for k in range(4) for column in CYCLE]
    cover = minimum_cover(columns, 20)
    check(cover, columns, 20)
    assert (len(cover.chosen), cover.bound, len(cover.row_weights)) == (12, 12, 4)


def test_a_row_that_no_column_covers_is_an_error() -> None:
    with pytest.raises(ValueError, match="row 1"):
        minimum_cover([frozenset({0})], 2)


def test_out_of_time_it_still_covers_and_bounds() -> None:
    rng = random.Random(2)
    columns = [frozenset(rng.sample(range(60), 6)) for _ in range(80)]
    columns += [frozenset({row}) for row in range(60)]
    quick = minimum_cover(columns, 60, deadline=time.monotonic() - 1)
    check(quick, columns, 60)
    best = minimum_cover(columns, 60)
    assert quick.bound <= best.bound <= len(best.chosen) <= len(quick.chosen)
    assert best.is_proved


def test_the_fewest_columns() -> None:
    found = minimum_columns(POINTS, 12, 10)
    assert found is not None
    assert (len(found.chosen), found.bound) == (5, 5)
    assert frozenset().union(*(POINTS[c] for c in found.chosen)) == frozenset(range(12))


def test_the_most_rows_of_which_no_column_has_two() -> None:
    found = maximum_packing(POINTS, 12, 10)
    assert len(found) == 3  # parallel lines
    assert all(len(set(found) & column) <= 1 for column in POINTS)


def test_the_weights_sum_to_the_fractional_cover() -> None:
    weights = fractional_packing(CYCLE, 5, 10)
    assert weights is not None
    assert sum(weights) == pytest.approx(2.5)


@pytest.mark.parametrize(("at_most", "left"), [(0, 5), (1, 3), (2, 1), (3, 0), (5, 0)])
def test_the_fewest_rows_left_out(at_most: int, left: int) -> None:
    found = minimum_uncovered(CYCLE, 5, at_most, 10)
    assert found is not None
    assert len(found.chosen) <= at_most
    assert 5 - len(frozenset().union(*(CYCLE[c] for c in found.chosen))) == left == found.bound
