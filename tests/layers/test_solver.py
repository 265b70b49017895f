"""The three questions HiGHS is asked, on matrices small enough to count."""

from __future__ import annotations

import pytest

from kit.layers.cover import fractional_packing, maximum_packing, minimum_columns, minimum_uncovered
from tests.layers.test_cover import CYCLE, POINTS


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
