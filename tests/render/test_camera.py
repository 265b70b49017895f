"""The camera: all in view, metres square, and a picture that moves no more than it must."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.render.camera import FIT_MARGIN, FOLLOW_DEAD_ZONE, MAX_CELL_WIDTH, MIN_CELL_WIDTH, Camera
from kit.render.scene import SceneBounds

places = st.floats(-50, 50)
sizes = st.tuples(st.integers(1, 250), st.integers(1, 80))
aspects = st.sampled_from((1.0, 2.0, 2.2))


@given(places, places, st.floats(0.1, 60), st.floats(0.1, 60), sizes, aspects)
def test_fit_shows_everything_and_wastes_one_direction_at_most(
    x: float, y: float, width: float, height: float, size: tuple[int, int], aspect: float
) -> None:
    columns, rows = size
    camera = Camera.fit(SceneBounds(x, y, x + width, y + height), columns, rows, aspect)
    seen = camera.bounds
    # A picture of one character has no half of it to spare on both sides.
    if columns > 1 and rows > 1:
        assert seen.left <= x + 1e-9
        assert seen.right >= x + width - 1e-9
        assert seen.bottom <= y + 1e-9
        assert seen.top >= y + height - 1e-9
        tight_x = math.isclose(seen.width - 2 * FIT_MARGIN * camera.cell_width, width, rel_tol=1e-6)
        tight_y = math.isclose(seen.height - 2 * FIT_MARGIN * camera.cell_height, height, rel_tol=1e-6)
        assert tight_x or tight_y or camera.cell_width == MIN_CELL_WIDTH


@given(places, places, sizes, aspects, st.sampled_from(((1, 1), (2, 4), (1, 2))))
def test_a_metre_is_as_long_to_the_right_as_up(
    x: float, y: float, size: tuple[int, int], aspect: float, dots: tuple[int, int]
) -> None:
    camera = Camera(x, y, 0.1, *size, aspect)
    across, down = dots
    here, right, up = camera.project(np.array(((x, y), (x + 1, y), (x, y + 1))), across, down)
    assert right - here == pytest.approx((10 * across, 0))
    assert up - here == pytest.approx((0, -10 * down / aspect))


def test_the_corners_of_what_is_seen_are_the_corners_of_the_picture() -> None:
    camera = Camera(3.0, -2.0, 0.25, 80, 22)
    left, bottom, right, top = camera.bounds
    corners = camera.project(np.array(((left, top), (right, bottom))), 2, 4)
    assert corners == pytest.approx(np.array(((0, 0), (160, 88))))


@given(st.integers(-6, 6))
def test_zoom_goes_back_the_way_it_came(steps: int) -> None:
    camera = Camera(1.0, 2.0, 0.1, 80, 22)
    zoomed = camera.zoomed(steps)
    assert (zoomed.x, zoomed.y) == (1.0, 2.0)
    assert zoomed.zoomed(-steps).cell_width == pytest.approx(camera.cell_width)
    assert camera.zoomed(2).cell_width == pytest.approx(camera.cell_width / 2)


def test_zoom_has_limits() -> None:
    camera = Camera(0.0, 0.0, 0.1, 80, 22)
    assert camera.zoomed(100).cell_width == MIN_CELL_WIDTH
    assert camera.zoomed(-100).cell_width == MAX_CELL_WIDTH


@given(places, places, st.integers(-9, 9), st.integers(-9, 9))
def test_panning_moves_by_whole_characters(x: float, y: float, right: int, up: int) -> None:
    camera = Camera(0.0, 0.0, 0.13, 80, 22)
    point = np.array((x, y))
    moved = camera.project(point) - camera.panned(right, up).project(point)
    assert moved == pytest.approx((right, -up), abs=1e-9)


@given(places, places)
def test_a_followed_point_is_kept_in_the_calm_middle(x: float, y: float) -> None:
    camera = Camera(0.0, 0.0, 0.1, 80, 22).following(x, y)
    column, row = camera.project(np.array((x, y)))
    assert abs(column - 40) <= 80 * FOLLOW_DEAD_ZONE / 2 + 1e-6
    assert abs(row - 11) <= 22 * FOLLOW_DEAD_ZONE / 2 + 1e-6


@given(st.floats(-1, 1), st.floats(-1, 1))
def test_within_the_calm_middle_nothing_moves(right: float, up: float) -> None:
    camera = Camera(0.0, 0.0, 0.1, 80, 22)
    x, y = right * 20 * camera.cell_width, up * 5.5 * camera.cell_height
    assert camera.following(x, y) is camera


@pytest.mark.parametrize(("columns", "rows", "across", "down"), [(80, 22, 1, 1), (200, 48, 4, 2)])
def test_following_a_robot_that_drives_never_moves_more_than_a_step(
    columns: int, rows: int, across: int, down: int
) -> None:
    camera = Camera(0.0, 0.0, 0.1, columns, rows)
    steps = set()
    for step in range(1000):
        moved = camera.following(0.02 * step, 0.01 * step)
        steps.add(round(abs(moved.x - camera.x) / camera.cell_width, 6))
        steps.add(-round(abs(moved.y - camera.y) / camera.cell_height, 6))
        camera = moved
    assert steps == {0.0, across, -down}


@pytest.mark.parametrize("lost", [math.nan, math.inf])
def test_a_robot_that_is_nowhere_is_not_followed(lost: float) -> None:
    camera = Camera(0.0, 0.0, 0.1, 80, 22)
    assert camera.following(lost, 0.0) is camera


def test_no_room_at_all_is_one_character() -> None:
    camera = Camera.fit(SceneBounds(0, 0, 1, 1), 0, 0)
    assert (camera.columns, camera.rows) == (1, 1)
    assert camera.resized(0, 0).columns == 1
