"""The values of a grid world as characters: in each cell the best move's arrow and its value, and the robot.

Where there is much room a cell has the arrow in its middle and around it the value of each move, on the side that the move leads
to; where there is less two rows, the arrow above the value; else one, the arrow before it or alone. Shapes and numbers say everything;
colour only repeats it: strong arrows lead from the start to the target.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from kit.arrays import FloatArray, IntArray
from kit.render.encode import Encoder, Frame
from kit.render.frame_text import write_text
from kit.render.roles import Role

GRID_GAP: Final = 2
"""Columns between two grids."""
WIDEST_CELL: Final = 6
NARROWEST_CELL_WITH_VALUE: Final = 3
"""Columns, where the value has a row of its own."""
NARROWEST_CELL_IN_ONE_ROW: Final = 5
"""Columns, where arrow and value share a row."""
ALL_MOVES_CELL: Final = (3, 13)
"""Rows and columns of a cell with the values of all moves."""
SMALL_VALUE_CELL: Final = 5
"""Columns from which on a value has decimals."""
WALL_SIGN, CLIFF_SIGN, START_SIGN, TARGET_SIGN, SMALL_TARGET_SIGN = "#CSGg"


@dataclass(frozen=True, slots=True, eq=False)
class ValueGrid:
    """The values that one learner has for its states and actions."""

    title: str
    signs: tuple[str, ...]
    """The map's rows: ``#`` wall, ``C`` cliff, ``G`` target, ``g`` small target, ``S`` start, anything else floor."""
    values: FloatArray
    """(rows, columns): the best move's value; nan where nothing was learned yet."""
    moves: IntArray
    """(rows, columns): the best move in quarter turns, counter-clockwise from the right; -1 where there is none."""
    robot: tuple[int, int] | None = None
    """Its row and column."""
    heading: int = 0
    """Its last move."""
    path: frozenset[tuple[int, int]] = frozenset()
    """The cells along the best moves from the start."""
    changed: tuple[int, int] | None = None
    """The cell whose value changed last."""
    all_values: FloatArray | None = None
    """(rows, columns, 4): the value of each move, counter-clockwise from the right; nan where nothing was learned yet."""

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return len(self.signs), len(self.signs[0])


def draw_value_grids(grids: Sequence[ValueGrid], columns: int, rows: int, encoder: Encoder) -> Frame:
    """A frame of ``columns`` x ``rows`` characters: the grids side by side, each under its title."""
    frame = Frame.empty(columns, rows)
    room = (columns - GRID_GAP * (len(grids) - 1)) // max(1, len(grids))
    left = 0
    for grid in grids:
        left += _draw_grid(frame, grid, left, room, rows, encoder) + GRID_GAP
    return frame


def value_grids_width(grids: Sequence[ValueGrid], columns: int, rows: int) -> int:
    """Columns that the grids take of ``columns`` x ``rows`` characters."""
    room = (columns - GRID_GAP * (len(grids) - 1)) // max(1, len(grids))
    widths = (_cell_size(grid, room, rows)[2] * grid.shape[1] + 2 for grid in grids)
    return sum(widths) + GRID_GAP * (len(grids) - 1)


def value_grids_height(grids: Sequence[ValueGrid], columns: int, rows: int) -> int:
    """Rows that the highest grid takes of ``rows``, with its title."""
    room = (columns - GRID_GAP * (len(grids) - 1)) // max(1, len(grids))
    sizes = [_cell_size(grid, room, rows) for grid in grids]
    return max(
        (top + height * grid.shape[0] + 2 for grid, (top, height, _) in zip(grids, sizes, strict=True)),
        default=0,
    )


def value_text(value: float, width: int) -> str:
    """A value in at most ``width`` characters, as exact as fits; empty for nan.

    >>> value_text(0.8145, 5), value_text(-12.34, 5), value_text(-12.34, 3), value_text(0.81, 3)
    ('0.81', '-12.3', '-12', '.81')
    """
    if not np.isfinite(value):
        return ""
    for decimals in (2, 1, 0):
        text = f"{value:.{decimals}f}"
        short = text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text
        for each in (text, short):
            if len(each) <= width:
                return "0" if float(each) == 0 else each
    return "<" if value < 0 else ">"


def _cell_size(grid: ValueGrid, room: int, rows: int) -> tuple[int, int, int]:
    """Rows of the title, and rows and columns of a cell."""
    top, width = int(rows >= grid.shape[0] + 3), (room - 2) // grid.shape[1]
    height = (rows - top - 2) // grid.shape[0]
    if grid.all_values is not None and height >= ALL_MOVES_CELL[0] and width >= ALL_MOVES_CELL[1]:
        return top, *ALL_MOVES_CELL
    width = max(1, min(WIDEST_CELL, width))
    return top, 2 if height >= 2 and width >= NARROWEST_CELL_WITH_VALUE else 1, width


def _draw_grid(frame: Frame, grid: ValueGrid, left: int, room: int, rows: int, encoder: Encoder) -> int:
    """Returns the columns that it takes."""
    is_ascii = ord(encoder.symbols.field_arrows[0]) < 128
    grid_rows, grid_columns = grid.shape
    top, height, width = _cell_size(grid, room, rows)
    if top:
        write_text(frame, 0, left, grid.title[:room], Role.TEXT)
    across, down, corners = ("-", "|", "++++") if is_ascii else ("─", "│", "┌┐└┘")
    inner, bottom = width * grid_columns, top + height * grid_rows + 1
    write_text(frame, top, left, corners[0] + across * inner + corners[1])
    write_text(frame, bottom, left, corners[2] + across * inner + corners[3])
    for row in range(top + 1, bottom):
        write_text(frame, row, left, down)
        write_text(frame, row, left + inner + 1, down)
    for row in range(grid_rows):
        for column in range(grid_columns):
            at = top + 1 + height * row, left + 1 + width * column
            _draw_cell(frame, grid, (row, column), at, (height, width), encoder, is_ascii)
    return inner + 2


def _draw_cell(
    frame: Frame,
    grid: ValueGrid,
    cell: tuple[int, int],
    at: tuple[int, int],
    size: tuple[int, int],
    encoder: Encoder,
    is_ascii: bool,
) -> None:
    (top, left), (height, width) = at, size
    sign = grid.signs[cell[0]][cell[1]]
    if sign in (WALL_SIGN, CLIFF_SIGN):
        fill = ("#" if is_ascii else "█") if sign == WALL_SIGN else ("x" if is_ascii else "░")
        for row in range(top, top + height):
            write_text(frame, row, left, fill * width, Role.WALL if sign == WALL_SIGN else Role.CONTACT)
        return
    glyph, role = _cell_glyph(grid, cell, encoder, is_ascii)
    ends = sign in (TARGET_SIGN, SMALL_TARGET_SIGN)
    if (height, width) == ALL_MOVES_CELL and grid.all_values is not None:
        write_text(frame, top + 1, left + width // 2, glyph, role)
        if not ends:
            _write_moves(frame, grid, grid.all_values[cell], cell, at)
        return
    in_one_row = height == 1 and width >= NARROWEST_CELL_IN_ONE_ROW and not ends
    write_text(frame, top, left if in_one_row else left + width // 2, glyph, role)
    if (height > 1 or in_one_row) and not ends:
        room = width - 2 if in_one_row else width - 1 if width >= SMALL_VALUE_CELL else width
        text = value_text(float(grid.values[cell]), room)
        role = Role.HIT if cell == grid.changed else Role.TARGET if cell in grid.path else Role.WALL
        at_column = left + 1 if in_one_row else left + (width - len(text) + 1) // 2
        write_text(frame, top + height - 1, at_column, text, role)


def _write_moves(
    frame: Frame, grid: ValueGrid, values: FloatArray, cell: tuple[int, int], at: tuple[int, int]
) -> None:
    """The value of each move on its side of a cell; that of the best one in the cell's colour."""
    (top, left), width = at, ALL_MOVES_CELL[1]
    room = width // 2 - 2
    texts = [value_text(float(each), room) for each in values]
    right, up, middle, down = (
        left + width - len(texts[0]),
        left + (width - len(texts[1])) // 2,
        left + 1,
        left + (width - len(texts[3])) // 2,
    )
    best = Role.HIT if cell == grid.changed else Role.TARGET if cell in grid.path else Role.TEXT
    for move, place in enumerate(((top + 1, right), (top, up), (top + 1, middle), (top + 2, down))):
        role = best if move == int(grid.moves[cell]) else Role.WALL
        write_text(frame, *place, texts[move], role)


def _cell_glyph(grid: ValueGrid, cell: tuple[int, int], encoder: Encoder, is_ascii: bool) -> tuple[str, Role]:
    """The character of a floor cell: an end, the robot, the best move's arrow, or the start."""
    sign, move = grid.signs[cell[0]][cell[1]], int(grid.moves[cell])
    symbols = encoder.symbols
    if sign in (TARGET_SIGN, SMALL_TARGET_SIGN):
        return sign, Role.TARGET
    if cell == grid.robot:
        arrows = symbols.robot_arrows[0]
        return "@" if is_ascii else arrows[grid.heading * len(arrows) // 4], Role.ROBOT
    if move >= 0:
        on_path = cell in grid.path
        arrows = symbols.strong_field_arrows if on_path else symbols.field_arrows
        return arrows[move * len(arrows) // 4], Role.TARGET if on_path else Role.FIELD
    return sign if sign == START_SIGN else "." if is_ascii else "·", Role.WALL
