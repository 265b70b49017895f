"""Stacked charts: every batch over its steps, the rest as it was."""

from __future__ import annotations

import numpy as np
import pytest

from kit.render.stacked_chart import NEWEST, StackedCounts, draw_stacked_chart
from tests.render.test_curve import PARTS


def shares(*batches: tuple[int, int, int]) -> StackedCounts:
    """Of (end, won, lost)."""
    table = np.array(batches, dtype=np.int64).reshape(-1, 3)
    return StackedCounts(table[:, 0].astype(float), table[:, 1:])


def column(frame_rows: list[str], at: int) -> str:
    """From the bottom up."""
    return "".join(row.ljust(99)[at] for row in reversed(frame_rows[1:])).strip()


def test_every_batch_stands_over_its_steps() -> None:
    rows = draw_stacked_chart(shares((50, 1, 3), (100, 1, 1)), PARTS, 25, 5).rows()
    assert rows[0] == "Wwon Llost", "shares would not fit with what they are of"
    assert rows[1].startswith("100%")
    assert rows[4].startswith("  0%")
    assert [column(rows, at) for at in range(5, 25)] == ["WLLL"] * 10 + ["WWLL"] * 10


def test_the_shares_say_what_they_are_of() -> None:
    rows = draw_stacked_chart(shares((50, 1, 3), (100, 1, 1)), PARTS, 40, 5).rows()
    assert rows[0] == f"Wwon 50% Llost 50% {NEWEST}"


def test_batches_that_share_a_column_are_added_up() -> None:
    many = [(step, 1, 0) if step % 2 else (step, 0, 1) for step in range(1, 1001)]
    rows = draw_stacked_chart(shares(*many), PARTS, 25, 5).rows()
    assert {column(rows, at) for at in range(5, 25)} == {"WWLL"}


def test_it_grows_to_the_right_and_leaves_the_rest_as_it_is() -> None:
    batches = [(60, 1, 3), (70, 3, 1), (80, 0, 4), (100, 4, 0)]
    before = draw_stacked_chart(shares(*batches[:2]), PARTS, 25, 5).glyphs
    after = draw_stacked_chart(shares(*batches), PARTS, 25, 5).glyphs
    assert (before[1:, :19] == after[1:, :19]).all()
    assert (before[1:, 19:] == ord(" ")).all()


@pytest.mark.parametrize("size", [(1, 1), (3, 2), (19, 3), (20, 2), (200, 50)])
@pytest.mark.parametrize("given", [shares(), shares((7, 0, 2)), shares(*((k, k, 1) for k in range(1, 400)))])
def test_any_size_and_no_data_at_all(size: tuple[int, int], given: StackedCounts) -> None:
    columns, rows = size
    assert draw_stacked_chart(given, PARTS, columns, rows).shape == (rows, columns)
