"""Dots to characters and back: nothing is lost but what gives way."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.render.encode import ENCODERS, AsciiEncoder, BrailleEncoder, HalfBlockEncoder
from kit.render.roles import SHADES, Role

grids = st.integers(0, 2**32 - 1).map(
    lambda seed: np.random.default_rng(seed).choice(
        np.arange(len(Role), dtype=np.uint8),
        size=(24, 20),
        p=[0.6] + [0.4 / (len(Role) - 1)] * (len(Role) - 1),
    )
)
# A braille pattern's dots 1 to 8, as (column, row).
BRAILLE_DOTS = ((0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (0, 3), (1, 3))


QUARTERS = {
    "▘": {0}, "▝": {1}, "▖": {2}, "▗": {3}, "▀": {0, 1}, "▌": {0, 2}, "▚": {0, 3}, "▞": {1, 2}, "▐": {1, 3}, "▄": {2, 3},
    "▛": {0, 1, 2}, "▜": {0, 1, 3}, "▙": {0, 2, 3}, "▟": {1, 2, 3}, "█": {0, 1, 2, 3},
}  # fmt: skip
"""Upper left, upper right, lower left, lower right."""


def test_with_layers_a_wall_is_behind_the_robot_that_stands_before_it() -> None:
    grid = np.full((4, 2), Role.WALL, dtype=np.uint8)
    grid[0, 0] = Role.ROBOT
    frame = BrailleEncoder(layers=True).encode(grid)
    assert (chr(frame.glyphs[0, 0]), frame.fg[0, 0], frame.bg[0, 0]) == ("⠁", Role.ROBOT, Role.WALL)


@pytest.mark.long
@given(grids)
def test_braille_shows_each_dot_that_does_not_give_way_and_walls_as_quarter_blocks(grid: np.ndarray) -> None:
    frame = BrailleEncoder().encode(grid)
    assert frame.shape == (6, 10)
    for row in range(6):
        for column in range(10):
            cell = grid[row * 4 : row * 4 + 4, column * 2 : column * 2 + 2]
            top = cell.max()
            least = max(1, min(int(top), Role.WALL))
            expected = {number for number, (x, y) in enumerate(BRAILLE_DOTS) if cell[y, x] >= least}
            glyph = chr(frame.glyphs[row, column])
            walls = np.isin(cell, (Role.WALL, Role.WALL_HIT))
            if walls.any() and top <= Role.TARGET and top != Role.BODY:
                quarters = [walls[y : y + 2, x].any() for y in (0, 2) for x in (0, 1)]
                assert [quarter in QUARTERS[glyph] for quarter in range(4)] == quarters
                assert frame.fg[row, column] == (Role.WALL if top == Role.TARGET else top)
                continue
            pattern = 0 if glyph == " " else ord(glyph) - 0x2800
            assert {number for number in range(8) if pattern >> number & 1} == expected
            assert frame.fg[row, column] == top


@given(grids)
def test_half_blocks_show_both_halves_unless_they_are_thin(grid: np.ndarray) -> None:
    frame = HalfBlockEncoder().encode(grid)
    for (row, column), glyph in np.ndenumerate(frame.glyphs):
        upper, lower = grid[2 * row, column], grid[2 * row + 1, column]
        ink, paper = frame.fg[row, column], frame.bg[row, column]
        shown = {" ": (0, 0), "▀": (ink, paper), "▄": (paper, ink), "█": (ink, ink)}
        if chr(glyph) in shown:
            assert (upper, lower) == shown[chr(glyph)]
        else:
            assert chr(glyph) in "·▒"
            assert ink == max(upper, lower)


@given(grids)
def test_ascii_names_what_is_there(grid: np.ndarray) -> None:
    frame = AsciiEncoder().encode(grid)
    assert np.array_equal(frame.fg, grid)
    assert {chr(glyph) for glyph in frame.glyphs[grid == Role.WALL]} <= {"#"}
    assert {chr(glyph) for glyph in frame.glyphs[grid == Role.HIT]} <= {"."}
    assert all(glyph < 128 for glyph in frame.glyphs.ravel())


@pytest.mark.parametrize("name", ENCODERS)
@pytest.mark.parametrize("other", [Role.WALL, Role.EMPTY])
def test_without_colours_a_hit_still_looks_like_no_wall(name: str, other: Role) -> None:
    encoder = ENCODERS[name](True)
    shape = encoder.down, encoder.across
    touched = np.full(shape, other, dtype=np.uint8)
    touched[0, 0] = Role.HIT
    hit = encoder.encode(touched)
    wall = encoder.encode(np.full(shape, Role.WALL, dtype=np.uint8))
    assert hit.glyphs[0, 0] != wall.glyphs[0, 0]
    assert not hit.bg.any()


@pytest.mark.parametrize("name", ENCODERS)
def test_every_symbol_is_one_character_wide_and_says_which_way(name: str) -> None:
    symbols = ENCODERS[name](False).symbols
    for arrows in (*symbols.robot_arrows, symbols.field_arrows, symbols.strong_field_arrows):
        assert len(arrows) in (4, 8)
        assert len(set(arrows)) == len(arrows)
    assert len({symbols.target, symbols.contact, symbols.weak_field_dot}) == 3


def test_ascii_gives_every_role_a_shape_of_its_own() -> None:
    assert set(AsciiEncoder.shapes) == set(Role) - {Role.EMPTY, *SHADES}
    assert len(set(AsciiEncoder.shapes.values())) == len(AsciiEncoder.shapes)
