"""What differs between two frames, and how a row falls into runs of one ink."""

from __future__ import annotations

import itertools

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from kit.render.frame import BLANK, MERGE_GAP, CellSpan, Frame, changed_spans


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


def test_a_gap_of_eight_is_bridged_and_one_of_nine_is_not() -> None:
    before = Frame.empty(40, 1)
    assert changed_spans(before, changed(before, [(0, 3), (0, 12)])) == [CellSpan(0, 3, 13)]
    assert changed_spans(before, changed(before, [(0, 3), (0, 13)])) == [
        CellSpan(0, 3, 4),
        CellSpan(0, 13, 14),
    ]
    assert MERGE_GAP == 8


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
