"""Values of a grid world in characters: every cell says what it is, at each size."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kit.render.encode import AsciiEncoder, BrailleEncoder
from kit.render.value_grid import ValueGrid, draw_value_grids, value_grids_width, value_text

GRID = ValueGrid(
    "one",
    ("S.G", "#Cg"),
    np.array([[0.81, 0.9, np.nan], [np.nan, np.nan, np.nan]]),
    np.array([[0, -1, -1], [-1, -1, -1]]),
    robot=(0, 1),
)


def test_cells_of_two_rows() -> None:
    shown = draw_value_grids([GRID], 40, 7, AsciiEncoder()).rows()
    assert shown == [
        "one",
        "+------------------+",
        "|   >     @     G  |",
        "| 0.81  0.90       |",
        "|######xxxxxx   g  |",
        "|######xxxxxx      |",
        "+------------------+",
    ]


def test_cells_of_one_row_keep_the_values_where_they_fit() -> None:
    wide = draw_value_grids([GRID], 40, 5, AsciiEncoder()).rows()
    assert wide[2] == "|>0.81 @0.90    G  |"
    narrow = draw_value_grids([GRID], 11, 5, AsciiEncoder()).rows()
    assert narrow[2] == "| >  @  G |"


def test_a_large_cell_has_the_value_of_each_move_on_its_side() -> None:
    known = np.full((2, 3, 4), np.nan)
    known[0, 0] = 0.81, 0.2, -0.3, 0.0
    grid = replace(GRID, all_values=known)
    shown = draw_value_grids([grid], 50, 9, AsciiEncoder()).rows()
    assert [each[1:14].split() for each in shown[2:5]] == [["0.20"], ["-.30", ">", "0.81"], ["0"]]
    assert value_grids_width([grid], 50, 9) == 3 * 13 + 2
    for columns, rows in ((40, 9), (50, 8)):
        assert "0.20" not in "".join(draw_value_grids([grid], columns, rows, AsciiEncoder()).rows())


def test_two_grids_stand_beside_each_other() -> None:
    frame = draw_value_grids([GRID, GRID], 30, 7, BrailleEncoder())
    assert frame.rows()[0].split() == ["one", "one"]
    assert value_grids_width([GRID, GRID], 30, 20) == 30
    assert max(map(len, frame.rows())) == 30
    assert "→" in frame.rows()[2]


@pytest.mark.parametrize("value", [0.0, 0.005, 0.12345, 1.0, -0.5, -7.25, -13.0, -100.0, 12345.0])
@pytest.mark.parametrize("width", [1, 2, 3, 4, 5])
def test_a_value_is_as_exact_as_fits(value: float, width: int) -> None:
    text = value_text(value, width)
    assert 0 < len(text) <= width
    if text not in "<>":
        assert float(text) == pytest.approx(value, abs=0.5)


def test_the_way_to_the_target_is_seen_without_colours() -> None:
    shown = draw_value_grids([replace(GRID, path=frozenset({(0, 0)}))], 40, 7, BrailleEncoder()).rows()
    assert "⇒" in shown[2]
