"""Sketches: what is drawn is what the reader of drawings reads."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kit.mapmaking.map_sketch import SCALES, MapSketch, read_drawing, squares_between

SQUARES = st.tuples(st.integers(-3, 14), st.integers(-3, 12))


def test_a_sketch_reads_as_what_was_drawn() -> None:
    sketch = MapSketch.room(8, 5, 0.25).drawn("S", (1, 1)).drawn_line("#", (4, 1), (4, 2)).drawn("T", (6, 3))
    assert sketch.text == "########\n#S  #  #\n#   #  #\n#     T#\n########\n"
    plan = read_drawing(sketch.text, cell=sketch.cell)
    assert plan.size == sketch.size == (2.0, 1.25)
    assert plan.start == (0.375, 0.875)
    assert plan.target == (1.625, 0.375)


@settings(max_examples=50)
@given(st.lists(st.tuples(st.sampled_from("# ST"), SQUARES, SQUARES), max_size=12))
def test_whatever_is_drawn_keeps_its_size_and_one_start(
    strokes: list[tuple[str, tuple[int, int], tuple[int, int]]],
) -> None:
    sketch = MapSketch.room(12, 10)
    for mark, first, last in strokes:
        sketch = sketch.drawn_line(mark, first, last)  # type: ignore[arg-type]  # one of the four
        if mark in "ST" and sketch.is_inside(last):
            assert sketch.find(mark) == last  # type: ignore[arg-type]  # one of the four
    assert {len(row) for row in sketch.rows} == {12}
    assert len(sketch.rows) == 10
    assert all(sketch.text.count(mark) <= 1 for mark in "ST")


@given(SQUARES, SQUARES)
def test_a_line_is_connected_and_as_long_as_its_longer_side(
    first: tuple[int, int], last: tuple[int, int]
) -> None:
    squares = squares_between(first, last)
    assert (squares[0], squares[-1]) == (first, last)
    assert len(squares) == max(abs(last[0] - first[0]), abs(last[1] - first[1])) + 1
    assert all(abs(a - c) <= 1 and abs(b - d) <= 1 for (a, b), (c, d) in pairwise(squares))


def test_the_scale_goes_from_finest_to_coarsest_and_stays_there() -> None:
    sketch = MapSketch.room(8, 5)
    assert sketch.scaled(-100).cell == SCALES[0]
    assert sketch.scaled(100).cell == SCALES[-1]
    assert sketch.scaled(1).scaled(-1) == sketch


@pytest.mark.parametrize("size", [(3, 10), (10, 0), (401, 10)])
def test_a_sheet_of_no_use_is_refused(size: tuple[int, int]) -> None:
    with pytest.raises(ValueError, match="4 to 400"):
        MapSketch.room(*size)
