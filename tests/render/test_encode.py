"""What differs between two frames, and how a row falls into runs of one ink."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.render.encode import (
    BLANK,
    ENCODERS,
    MERGE_GAP,
    AsciiEncoder,
    BrailleEncoder,
    CellSpan,
    Frame,
    HalfBlockEncoder,
    changed_spans,
)
from kit.render.roles import SHADES, Role


def random_frame(seed: int, shape: tuple[int, int] = (6, 40)) -> Frame:
    generator = np.random.default_rng(seed)
    glyphs = generator.choice(np.array([BLANK, BLANK, ord("#"), 0x28FF], dtype=np.uint32), shape)
    inks = np.where(glyphs == BLANK, 0, generator.integers(0, 4, shape)).astype(np.uint8)
    papers = (generator.random(shape) < 0.1).astype(np.uint8)
    return Frame(glyphs, inks, papers)


def changed(frame: Frame, cells: list[tuple[int, int]]) -> Frame:
    glyphs = frame.glyphs.copy()
    for row, column in cells:
        glyphs[row, column] = ord("x")
    return Frame(glyphs, frame.fg, frame.bg)


cells = st.lists(st.tuples(st.integers(0, 5), st.integers(0, 39)), max_size=12)


@given(st.integers(0, 1000), cells)
def test_the_spans_hold_every_difference_and_end_on_one(seed: int, where: list[tuple[int, int]]) -> None:
    before = random_frame(seed)
    after = changed(before, where)
    covered = set()
    for row, start, stop in changed_spans(before, after):
        assert before.glyphs[row, start] != after.glyphs[row, start]
        assert before.glyphs[row, stop - 1] != after.glyphs[row, stop - 1]
        covered |= {(row, column) for column in range(start, stop)}
    assert set(where) <= covered


@given(st.integers(0, 1000), cells, st.integers(0, 12))
def test_spans_of_a_row_lie_further_apart_than_the_gap(
    seed: int, where: list[tuple[int, int]], gap: int
) -> None:
    before = random_frame(seed)
    spans = changed_spans(before, changed(before, where), gap)
    for left, right in itertools.pairwise(spans):
        assert left.row < right.row or right.start - left.stop > gap


def test_a_gap_is_bridged_and_one_that_is_wider_by_one_is_not() -> None:
    before = Frame.empty(40, 1)
    after = 4 + MERGE_GAP
    assert changed_spans(before, changed(before, [(0, 3), (0, after)])) == [CellSpan(0, 3, after + 1)]
    assert changed_spans(before, changed(before, [(0, 3), (0, after + 1)])) == [
        CellSpan(0, 3, 4),
        CellSpan(0, after + 1, after + 2),
    ]


def test_equal_frames_do_not_differ_and_frames_of_other_sizes_do_everywhere() -> None:
    assert changed_spans(random_frame(1), random_frame(1)) == []
    assert changed_spans(None, Frame.empty(7, 2)) == [CellSpan(0, 0, 7), CellSpan(1, 0, 7)]
    assert changed_spans(Frame.empty(6, 2), Frame.empty(7, 2)) == [CellSpan(0, 0, 7), CellSpan(1, 0, 7)]
    assert changed_spans(None, Frame.empty(0, 2)) == []


def test_another_ink_or_paper_is_a_difference() -> None:
    before, after = random_frame(3), random_frame(3)
    after.fg[2, 5] += 1
    after.bg[4, 7] += 1
    assert changed_spans(before, after) == [CellSpan(2, 5, 6), CellSpan(4, 7, 8)]


@given(st.integers(0, 1000))
def test_runs_say_the_row_with_the_look_of_every_visible_character(seed: int) -> None:
    frame = random_frame(seed)
    for row in range(6):
        runs = list(frame.runs(row))
        assert "".join(run.text for run in runs) == frame.text(row)
        looks = [(run.fg, run.bg) for run in runs for _ in run.text]
        for column, (ink, paper) in enumerate(looks):
            assert paper == frame.bg[row, column]
            if frame.glyphs[row, column] != BLANK:
                assert ink == frame.fg[row, column]
        assert all(left[1:] != right[1:] for left, right in itertools.pairwise(runs))


def test_blanks_do_not_cut_a_run() -> None:
    frame = Frame.empty(9, 1)
    for column in (2, 4, 7):
        frame.glyphs[0, column], frame.fg[0, column] = ord("."), 3
    assert [run.text for run in frame.runs(0)] == ["  ", ". .  . "]


def test_rows_are_read_without_the_blanks_at_their_ends() -> None:
    frame = Frame.empty(5, 2)
    frame.glyphs[1, 2] = 0x28FF
    assert frame.rows() == ["", "  ⣿"]


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


@pytest.mark.parametrize("role", [Role.ROBOT, Role.ROBOT_2])
def test_with_layers_a_robot_is_solid_and_the_line_of_its_heading_is_not(role: Role) -> None:
    grid = np.zeros((16, 8), np.uint8)
    grid[3:12, 1:6] = role  # its edges lie within characters
    grid[0:3, 3] = role
    assert BrailleEncoder(layers=True).encode(grid).rows() == ["⢀▟⣀", "▐██", "▐██", ""]
    thin = np.zeros((8, 2), np.uint8)
    thin[:, 0] = role
    assert BrailleEncoder(layers=True).encode(thin).rows() == ["⡇", "⡇"]
    for plain in (BrailleEncoder(), BrailleEncoder(mono=True)):
        assert not set("".join(plain.encode(grid).rows())) & set("▗▐▖█▌▟▙")


def test_dots_of_a_target_give_way_to_a_wall() -> None:
    grid = np.full((4, 2), Role.TARGET, dtype=np.uint8)
    grid[:2] = Role.WALL
    frame = BrailleEncoder().encode(grid)
    assert (chr(frame.glyphs[0, 0]), frame.fg[0, 0], frame.bg[0, 0]) == ("▀", Role.WALL, Role.EMPTY)


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
