"""Learning curves: the shape of the data, on a scale of round numbers that moves seldom."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.render.curve import Axes, Curve, draw_curves
from kit.render.encode import ENCODERS, AsciiEncoder, BrailleEncoder, Frame
from kit.render.roles import CURVE_ROLES, Role
from kit.render.stacked_chart import ChartPart


def curve(values: list[float], name: str = "return", step: float = 100.0) -> Curve:
    return Curve(name, step * np.arange(1, len(values) + 1), np.array(values, dtype=float))


def heights(frame: Frame, role: Role = Role.CURVE_1) -> list[float]:
    """The mean row of the curve in each column of the plot that has it, left to right."""
    rows, columns = np.nonzero((frame.fg == role) & (np.arange(frame.shape[0]) > 0)[:, None])
    return [float(rows[columns == column].mean()) for column in np.unique(columns)]


def test_a_rising_curve_looks_like_this() -> None:
    frame = draw_curves([curve([0, 1, 2, 3, 4])], Axes("episodes"), 30, 7, AsciiEncoder())
    assert frame.rows() == [
        "  return 4",
        "4+                         ***",
        " |                    *****",
        "2+              ******",
        " |         *****",
        "0+     ****",
        " +0 ------------- 500 episodes",
    ]


@pytest.mark.parametrize("name", ENCODERS)
def test_higher_is_up_and_later_is_right(name: str) -> None:
    frame = draw_curves([curve([0, 5, 1, 9, 2] * 8)], Axes(), 60, 12, ENCODERS[name](False))
    rising = draw_curves([curve(list(range(50)))], Axes(), 60, 12, ENCODERS[name](False))
    found = heights(rising)
    assert found == sorted(found, reverse=True)
    assert len(found) > 40
    assert min(heights(frame)) < max(heights(frame))


def test_the_scale_moves_seldom_while_a_run_grows() -> None:
    scales = set()
    values: list[float] = []
    generator = np.random.default_rng(2)
    for step in range(400):
        values.append(np.tanh(step / 150) + generator.normal(0, 0.05))
        frame = draw_curves([curve(values)], Axes("steps", low=0, high=1), 40, 8, BrailleEncoder())
        scales.add((frame.text(1)[:4], frame.text(6)[:4], frame.text(7)))
    assert len(scales) <= 9  # 100, 200, 500, 1,000, 2,000, ... 50,000 steps


def test_a_goal_is_a_dashed_line_with_its_value() -> None:
    frame = draw_curves([curve([0, 1])], Axes(low=0, high=1, goal=0.5), 40, 9, AsciiEncoder())
    row = next(row for row in frame.rows() if row.startswith("0.5"))
    assert 10 < row.count("-") < 25


def test_two_curves_are_told_apart_by_number() -> None:
    frame = draw_curves([curve([1, 2, 3], "ppo"), curve([1, 1, 1], "dqn")], Axes(), 40, 9, BrailleEncoder())
    assert "1 ppo 3" in frame.rows()[0]
    assert "2 dqn 1" in frame.rows()[0]
    body = "".join(frame.text(row)[4:] for row in range(1, 8))
    assert body.count("1") == 1
    assert body.count("2") == 1


@pytest.mark.parametrize("name", ENCODERS)
def test_curves_are_told_apart_without_colours(name: str) -> None:
    curves = [curve([level] * 40, f"c{level}") for level in (1, 2, 3)]
    frame = draw_curves(curves, Axes(low=0, high=4), 60, 9, ENCODERS[name](True))
    filled = [sum(glyph != " " for glyph in frame.text(row)[5:]) for row in (6, 4, 3)]
    if name == "ascii":  # in braille a character holds more dots than a gap
        assert filled[0] > filled[1] > filled[2]
    legend = frame.rows()[0]
    marks = [legend[legend.index(f"{number} c{number}") - 1] for number in (1, 2, 3)]
    assert len(set(marks)) == 3
    lines = {tuple(frame.text(row)[5:40]) for row in range(1, 8) if frame.text(row)[5:40].strip()}
    assert len(lines) == 3


def test_each_of_four_curves_has_a_colour_a_dash_and_a_mark_of_its_own() -> None:
    curves = [curve([level] * 40, f"c{level}") for level in (1, 2, 3, 4)]
    frame = draw_curves(curves, Axes(low=0, high=5), 90, 16, BrailleEncoder())
    dots = {}
    for number, role in enumerate(CURVE_ROLES, 1):
        rows, columns = np.nonzero((frame.fg == role) & (frame.glyphs >= 0x2800))
        assert len(set(rows.tolist())) == 1, "a level curve"
        dots[number] = "".join(chr(glyph) for glyph in frame.glyphs[rows[0], columns])
    assert len({text[:12] for text in dots.values()}) == 4
    marks = [frame.rows()[0][frame.rows()[0].index(f"{number} c{number}") - 1] for number in dots]
    assert len(set(marks)) == 4


def test_a_curve_that_is_hidden_by_another_still_shows_its_number() -> None:
    frame = draw_curves(
        [curve([1] * 60, "a"), curve([1] * 60, "b")], Axes(low=0, high=2), 80, 9, BrailleEncoder()
    )
    shown = "".join(frame.text(row)[4:] for row in range(1, 8))
    assert min(shown.count("1"), shown.count("2")) >= 2
    rows, _ = np.nonzero((frame.fg == Role.CURVE_2)[1:])
    assert len(set(rows.tolist())) == 1, "the number stands on the line"


def test_values_that_are_not_finite_are_left_out() -> None:
    frame = draw_curves([curve([0, np.nan, 2, np.inf, 4])], Axes(), 40, 8, AsciiEncoder())
    assert (
        frame.rows()
        == draw_curves(
            [Curve("return", np.array((100.0, 300, 500)), np.array((0.0, 2, 4)))],
            Axes(),
            40,
            8,
            AsciiEncoder(),
        ).rows()
    )


@given(
    st.lists(st.floats(-1e6, 1e6), max_size=40),
    st.integers(1, 90),
    st.integers(1, 14),
    st.sampled_from((None, -3.0, 0.8)),
)
def test_any_data_fits_in_any_room(values: list[float], columns: int, rows: int, goal: float | None) -> None:
    for curves in ([], [curve(values)], [curve(values), curve(values[:3], "b")]):
        frame = draw_curves(curves, Axes("steps", goal=goal), columns, rows, BrailleEncoder())
        assert frame.shape == (rows, columns)


def test_five_thousand_points_are_their_means() -> None:
    generator = np.random.default_rng(3)
    noisy = list(np.linspace(0, 100, 5000) + generator.normal(0, 5, 5000))
    found = heights(draw_curves([curve(noisy)], Axes(), 80, 20, BrailleEncoder()))
    assert np.mean(np.diff(found) <= 0.51) > 0.95


def test_the_scale_may_begin_and_end_elsewhere() -> None:
    data = Curve("", np.array([-1.0, 1.0]), np.array([0.0, 1.0]))
    frame = draw_curves([data], Axes("rad", low=0, high=1, start=-1.0, end=1.0), 30, 7, AsciiEncoder())
    assert "+-1 ---" in frame.rows()[-1]
    assert frame.rows()[-1].endswith("1 rad")
    columns = np.flatnonzero((frame.fg[1:] == Role.CURVE_1).any(axis=0))
    assert (columns[0], columns[-1]) == (4, 29)


PARTS = (ChartPart("won", Role.TARGET, "W"), ChartPart("lost", Role.CONTACT, "L"))


def test_a_curve_with_gaps_is_broken_where_values_are_not_finite() -> None:
    values = [1.0] * 20 + [np.nan] * 20 + [1.0] * 20
    whole = curve(values)
    broken = Curve(whole.name, whole.x, whole.y, has_gaps=True)
    axes = Axes(low=0, high=2, end=6000.0)
    columns = [len(heights(draw_curves([each], axes, 60, 7, AsciiEncoder()))) for each in (whole, broken)]
    assert columns[0] > 50
    assert 30 < columns[1] < 42


@pytest.mark.parametrize(
    "values",
    [
        [np.nan, np.inf],
        [5e-324, 0.0],
        [1.0, 1.0 + 2**-52],
        [1e300, -1e300],
        [1.7e9, 1.7e9 + 1],
        [1e-300],
        [-1e17, -1e17 + 16],
    ],
)
def test_any_range_has_a_scale_with_two_different_ends(values: list[float]) -> None:
    frame = draw_curves([curve(values)], Axes(), 60, 8, AsciiEncoder())
    high, low = (frame.text(line).split("+ ")[0].rstrip("+|") for line in (1, 6))
    assert float(high) > float(low)


@given(st.lists(st.floats(-1e300, 1e300), min_size=1, max_size=5))
def test_any_finite_values_can_be_drawn(values: list[float]) -> None:
    assert draw_curves([curve(values)], Axes(), 40, 6, AsciiEncoder()).shape == (6, 40)
