"""The floor and what a laser sees of it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kit.arrays import FloatArray
from kit.geometry import Pose
from kit.render.camera import Camera
from kit.render.encode import BrailleEncoder
from kit.render.painter import Painter
from kit.render.roles import LIT_ROLES, Role
from kit.render.scene import Scene, SceneBody, SceneBounds
from kit.render.shading import facing, lit_cells, seen_surfaces, shade_roles
from tests.render.scenes import box_walls

ROOM = box_walls(((0.0, 0.0, 4.0, 4.0), (2.5, 2.5, 3.5, 3.5)))
"""A room with a table in it."""
CAMERA = Camera.fit(SceneBounds(-1.0, -1.0, 5.0, 5.0), 60, 30)


def robot(x: float, y: float) -> SceneBody:
    square = np.array(((0.1, 0.1), (-0.1, 0.1), (-0.1, -0.1), (0.1, -0.1)))
    return SceneBody("robot", Pose(x, y, 0.0), (np.add(square, (x, y)),), (), is_robot=True)


def cell(x: float, y: float) -> tuple[int, int]:
    column, row = CAMERA.project(np.array((x, y))).tolist()
    return math.floor(row), math.floor(column)


def test_the_floor_is_where_the_robot_can_go_and_what_is_enclosed_is_solid() -> None:
    frame = Painter(BrailleEncoder(), shaded=True).paint(Scene(ROOM, (robot(1.0, 1.0),)), CAMERA)
    assert frame.bg[cell(2.0, 3.0)] == Role.FLOOR
    assert frame.bg[cell(-0.5, 2.0)] == Role.EMPTY
    assert chr(frame.glyphs[cell(3.0, 3.0)]) == "█"
    assert frame.fg[cell(3.0, 3.0)] == Role.WALL


def test_beside_a_thin_wall_there_is_floor_wherever_it_stands() -> None:
    for shift in np.arange(0.0, 0.2, 0.013):
        walls = box_walls(((0.0, 0.0, 4.0, 4.0), (1.5 + shift, 1.0, 1.56 + shift, 3.0)))
        frame = Painter(BrailleEncoder(), shaded=True).paint(Scene(walls, (robot(1.0, 1.0),)), CAMERA)
        row, left = cell(1.2, 2.0)
        _, right = cell(2.2, 2.0)
        assert (frame.bg[row, left : right + 1] == Role.FLOOR).all(), shift


def test_a_robot_outside_stands_on_the_floor_outside() -> None:
    frame = Painter(BrailleEncoder(), shaded=True).paint(Scene(ROOM, (robot(-0.5, -0.5),)), CAMERA)
    assert frame.bg[cell(-0.5, 2.0)] == Role.FLOOR
    assert frame.bg[cell(1.0, 1.0)] == Role.EMPTY


def test_without_shades_no_background_is_drawn() -> None:
    frame = Painter(BrailleEncoder()).paint(Scene(ROOM, (robot(1.0, 1.0),)), CAMERA)
    assert not frame.bg.any()


def test_the_floor_does_not_change_when_the_camera_moves_over_it() -> None:
    painter, scene = Painter(BrailleEncoder(), shaded=True), Scene(ROOM, (robot(1.0, 1.0),))
    still = painter.paint(scene, CAMERA)
    moved = painter.paint(scene, CAMERA.panned(5, 0))
    assert np.array_equal(still.bg[:, 6:-1], moved.bg[:, 1:-6])


def rays(x: float, y: float, lengths: FloatArray, start: float, stop: float) -> FloatArray:
    angles = np.linspace(start, stop, len(lengths))
    ends = np.stack((x + lengths * np.cos(angles), y + lengths * np.sin(angles)), axis=1)
    return np.column_stack((np.full_like(ends, (x, y)), ends))


def test_a_laser_lights_its_fan_and_nothing_behind_it_or_beyond() -> None:
    lit = lit_cells(rays(2.0, 2.0, np.full(91, 1.0), -math.pi / 2, math.pi / 2), CAMERA)
    assert lit[cell(2.5, 2.0)]
    assert lit[cell(2.5, 2.6)]
    assert not lit[cell(1.5, 2.0)]
    assert not lit[cell(3.3, 2.0)]


def test_the_lit_floor_fades_with_the_distance_from_the_nearest_laser() -> None:
    one = rays(0.0, 2.0, np.full(61, 5.0), -0.5, 0.5)
    lit = lit_cells(one, CAMERA)
    row, _ = cell(0.0, 2.0)
    along = [Role(each) for each in lit[row] if each]
    assert along[0] == Role.LIT_NEAR, "the laser stands in the light"
    assert along == sorted(along, reverse=True)
    assert set(along) == set(LIT_ROLES)
    other = rays(5.0, 2.0, np.full(61, 5.0), math.pi - 0.5, math.pi + 0.5)
    assert np.array_equal(
        lit_cells(np.concatenate((one, other)), CAMERA), np.maximum(lit, lit_cells(other, CAMERA))
    )


def test_a_laser_all_around_has_no_seam() -> None:
    full = rays(2.0, 2.0, np.full(90, 1.0), -math.pi, math.pi * 88 / 90)
    lit = lit_cells(full, CAMERA)
    rows, columns = np.nonzero(lit)
    middle = cell(2.0, 2.0)
    assert {(2 * middle[0] - r, 2 * middle[1] - c) for r, c in zip(rows, columns, strict=True)} & set(
        zip(rows.tolist(), columns.tolist(), strict=True)
    )
    assert lit[cell(1.3, 2.0)]


def test_rays_of_two_lasers_are_two_fans() -> None:
    both = np.concatenate([rays(x, 2.0, np.full(31, 0.8), -0.5, 0.5) for x in (0.5, 3.0)])
    lit = lit_cells(both, CAMERA)
    assert lit[cell(1.0, 2.0)]
    assert lit[cell(3.5, 2.0)]
    assert not lit[cell(2.0, 2.0)]


@pytest.mark.parametrize("count", [0, 1, 2])
def test_too_few_rays_light_nothing(count: int) -> None:
    assert not lit_cells(rays(2.0, 2.0, np.full(count, 1.0), 0.0, 0.1), CAMERA).any()


def test_neighbouring_ends_are_one_surface_unless_one_lies_far_behind() -> None:
    lengths = np.array([1.0, 1.0, 1.0, 3.0, 3.0])
    assert len(seen_surfaces(rays(0.0, 0.0, lengths, 0.0, 0.08))) == 3


@pytest.mark.parametrize(("thickness", "is_solid"), [(0.35, True), (0.6, False)])
def test_what_two_robots_do_not_fit_into_side_by_side_is_the_inside_of_a_wall(
    thickness: float, is_solid: bool
) -> None:
    """A robot of 0.2 m in a room whose walls have two faces; together they take more than what furniture may."""
    far = 4.0 + thickness
    walls = box_walls(((-thickness, -thickness, far, far), (0.0, 0.0, 4.0, 4.0)))
    frame = Painter(BrailleEncoder(), shaded=True).paint(Scene(walls, (robot(1.0, 1.0),)), CAMERA)
    assert (chr(frame.glyphs[cell(-thickness / 2, 2.0)]) == "█") is is_solid
    assert frame.bg[cell(2.0, 2.0)] == Role.FLOOR


def test_a_picture_without_robots_draws_walls_as_thick_as_they_are_for_the_robot_that_will_drive() -> None:
    walls = box_walls(((0.0, 0.0, 4.0, 4.0), (1.0, 1.0, 1.25, 3.0)))
    wall = cell(1.125, 2.0)
    for passage, is_solid in ((0.0, False), (0.3, True)):
        frame = Painter(BrailleEncoder()).paint(Scene(walls, passage=passage), CAMERA)
        assert (chr(frame.glyphs[wall]) == "█") is is_solid, passage


def test_a_wall_seen_from_a_flat_angle_is_one_surface() -> None:
    """Rays every 5 degrees along a wall at 0.3 m: the far ends are further apart than a third of a ray."""
    angles = np.radians(np.arange(5.0, 90.0, 5.0))
    ends = np.column_stack((0.3 / np.tan(angles), np.full_like(angles, 0.3)))
    fan = np.column_stack((np.zeros_like(ends), ends))
    assert len(seen_surfaces(fan)) == len(fan) - 1
    noisy = fan.copy()
    noisy[:, 2:] *= 1.0 + np.random.default_rng(0).normal(0.0, 0.01, (len(fan), 1))
    assert len(seen_surfaces(noisy)) == len(fan) - 1
    before_the_wall = 0.85 * np.array((0.3 / math.tan(math.radians(7.5)), 0.3))
    camera = Camera.fit(SceneBounds(-1.0, -1.0, 5.0, 5.0), 120, 60)
    column, row = camera.project(before_the_wall).tolist()
    assert lit_cells(fan, camera)[math.floor(row), math.floor(column)]


def test_a_surface_behind_an_edge_is_another_one() -> None:
    """A wall that ends at x = 1, and one across behind it."""
    angles = np.radians(np.arange(10.0, 80.0, 4.0))
    ends = np.where(
        (0.5 / np.tan(angles) < 1.0)[:, None],
        np.column_stack((0.5 / np.tan(angles), np.full_like(angles, 0.5))),
        np.column_stack((np.full_like(angles, 2.5), 2.5 * np.tan(angles))),
    )
    joined = seen_surfaces(np.column_stack((np.zeros_like(ends), ends)))
    assert len(joined) == len(angles) - 2


def test_one_dark_character_among_lit_ones_is_lit_and_a_shadow_is_not() -> None:
    floor, lit = np.ones((6, 8), dtype=bool), np.full((6, 8), Role.LIT_FAR, dtype=np.uint8)
    floor[:, 0] = False
    lit[2, 1] = lit[4, 5] = lit[4, 6] = Role.EMPTY
    roles = shade_roles(floor, lit)
    assert roles[2, 1] == Role.LIT_FAR
    assert (roles[4, 5:7] == Role.FLOOR).all()


def test_of_a_thin_wall_the_face_towards_the_laser_lights_up() -> None:
    walls = np.zeros((8, 10), dtype=bool)
    walls[3:5, 2:8] = True
    above = facing(walls, np.array([[9.0, 0.0]]))
    assert above[3, 2:8].all()
    assert not above[4, 2:6].any()
    assert above[4, 7]  # its right end
    both = facing(walls, np.array([[9.0, 0.0], [5.0, 7.0], [math.nan, 1.0]]))
    assert both[3:5, 2:8].all()
    assert not (both & ~walls).any()
