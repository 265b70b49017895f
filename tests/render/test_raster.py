"""Lines, circles and polygons land on the dots where they are, and on no others."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.render import raster

WIDTH, HEIGHT = 40, 24
coordinates = st.floats(-100, 140, width=32)
lines = st.tuples(coordinates, coordinates, coordinates, coordinates)


def dots(found: raster.Dots) -> set[tuple[int, int]]:
    """(column, row)"""
    rows, columns = found
    return set(zip(columns.tolist(), rows.tolist(), strict=True))


def away(x: float, y: float, line: tuple[float, float, float, float]) -> float:
    """Distance of a point from a line's segment."""
    x1, y1, x2, y2 = line
    length = math.hypot(x2 - x1, y2 - y1)
    share = 0.0 if length == 0 else ((x - x1) * (x2 - x1) + (y - y1) * (y2 - y1)) / length**2
    share = min(max(share, 0.0), 1.0)
    return math.hypot(x - x1 - share * (x2 - x1), y - y1 - share * (y2 - y1))


@given(lines)
def test_a_line_is_where_it_is_and_inside_the_grid(line: tuple[float, float, float, float]) -> None:
    for column, row in dots(raster.line_dots(np.array([line]), WIDTH, HEIGHT)):
        assert 0 <= column < WIDTH
        assert 0 <= row < HEIGHT
        assert away(column + 0.5, row + 0.5, line) <= 1.5


@given(lines)
def test_a_line_has_no_gaps_and_is_one_dot_thick(line: tuple[float, float, float, float]) -> None:
    rows, columns = raster.line_dots(np.array([line]), WIDTH, HEIGHT)
    steps = np.maximum(np.abs(np.diff(rows)), np.abs(np.diff(columns)))
    assert (steps == 1).all()
    if len(rows):
        assert len(rows) == max(np.ptp(rows), np.ptp(columns)) + 1


@given(lines)
def test_what_is_seen_of_a_line_is_drawn(line: tuple[float, float, float, float]) -> None:
    drawn = dots(raster.line_dots(np.array([line]), WIDTH, HEIGHT))
    x1, y1, x2, y2 = line
    for share in np.linspace(0, 1, 60):
        x, y = x1 + share * (x2 - x1), y1 + share * (y2 - y1)
        if 0 <= x < WIDTH and 0 <= y < HEIGHT:
            assert any(abs(x - column - 0.5) <= 1.6 and abs(y - row - 0.5) <= 1.6 for column, row in drawn)


def test_level_and_upright_lines_are_exact() -> None:
    level = dots(raster.line_dots(np.array([(2.9, 5.2, 8.1, 5.8)]), WIDTH, HEIGHT))
    assert level == {(column, 5) for column in range(2, 9)}
    upright = dots(raster.line_dots(np.array([(7.0, -50.0, 7.0, 50.0)]), WIDTH, HEIGHT))
    assert upright == {(7, row) for row in range(HEIGHT)}


def test_many_lines_are_each_line_by_itself() -> None:
    generator = np.random.default_rng(1)
    many = generator.uniform(-20, 60, (200, 4))
    together = raster.line_dots(many, WIDTH, HEIGHT)
    alone = [raster.line_dots(many[i : i + 1], WIDTH, HEIGHT) for i in range(len(many))]
    assert np.array_equal(together[0], np.concatenate([rows for rows, _ in alone]))
    assert np.array_equal(together[1], np.concatenate([columns for _, columns in alone]))


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_left_out(bad: float) -> None:
    good = (1.0, 1.0, 5.0, 1.0)
    found = raster.line_dots(np.array([(bad, 1.0, 5.0, 5.0), good]), WIDTH, HEIGHT)
    assert dots(found) == {(column, 1) for column in range(1, 6)}
    assert dots(raster.point_dots(np.array([(bad, 2.0), (3.0, 2.0)]), WIDTH, HEIGHT)) == {(3, 2)}
    corners = np.array([(bad, 0.0), (5.0, 0.0), (5.0, 5.0)])
    assert not dots(raster.filled_dots(corners, WIDTH, HEIGHT))


def test_huge_coordinates_are_clipped() -> None:
    found = dots(raster.line_dots(np.array([(-1e12, 3.5, 1e12, 3.5)]), WIDTH, HEIGHT))
    assert found == {(column, 3) for column in range(WIDTH)}


def test_points_outside_are_left_out() -> None:
    points = np.array([(-0.1, 0.0), (0.0, 0.0), (39.9, 23.9), (40.0, 5.0), (5.0, 24.0)])
    assert dots(raster.point_dots(points, WIDTH, HEIGHT)) == {(0, 0), (39, 23)}


@given(st.floats(2, 30), st.floats(-5, 45), st.floats(-5, 30))
def test_a_circle_is_round(radius: float, x: float, y: float) -> None:
    corners = raster.circle_corners(x, y, radius, radius)
    for column, row in dots(raster.line_dots(raster.polyline(corners, closed=True), WIDTH, HEIGHT)):
        assert abs(math.hypot(column + 0.5 - x, row + 0.5 - y) - radius) <= 1.6


@given(st.floats(0, 6.28), st.floats(0, 40), st.floats(0, 24), st.floats(2, 12))
def test_a_polygon_is_filled_where_it_is(turn: float, x: float, y: float, size: float) -> None:
    angles = turn + np.arange(4) * math.tau / 4
    corners = np.stack((x + size * np.cos(angles), y + size * np.sin(angles)), axis=1)
    either_way = [dots(raster.filled_dots(way, WIDTH, HEIGHT)) for way in (corners, corners[::-1])]
    for column in range(WIDTH):
        for row in range(HEIGHT):
            dx, dy = column + 0.5 - x, row + 0.5 - y
            ahead = abs(dx * math.cos(turn) + dy * math.sin(turn))
            aside = abs(dy * math.cos(turn) - dx * math.sin(turn))
            if abs(ahead + aside - size) > 1e-6:
                inside = ahead + aside < size
                assert [(column, row) in filled for filled in either_way] == [inside, inside]


def test_the_more_important_stays_on_top() -> None:
    grid = raster.empty_grid(4, 1)
    row = np.zeros(4, dtype=np.intp)
    raster.draw_dots(grid, (row, np.arange(4)), 5)
    raster.draw_dots(grid, (row[:2], np.arange(2)), 3)
    raster.draw_dots(grid, (row[:1], np.arange(1)), 9)
    assert grid.tolist() == [[9, 5, 5, 5]]


def test_closing_gaps_fills_short_ones_between_drawn_dots_alone() -> None:
    grid = np.array([[0, 6, 0, 6, 0, 0, 6, 0, 0, 0, 6, 0]], dtype=np.uint8)
    raster.close_gaps(grid, across=2, down=0, role=6)
    assert grid.tolist() == [[0, 6, 6, 6, 6, 6, 6, 0, 0, 0, 6, 0]]
    column = np.array([[6], [0], [6], [0], [0]], dtype=np.uint8)
    raster.close_gaps(column, across=0, down=1, role=6)
    assert column.ravel().tolist() == [6, 6, 6, 0, 0]
