"""Scenes to characters: golden pictures, and what must hold of every picture."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from kit.geometry import Pose
from kit.render import painter as painter_module
from kit.render.camera import Camera
from kit.render.encode import BLANK, ENCODERS, AsciiEncoder, BrailleEncoder, Encoder, Frame, HalfBlockEncoder
from kit.render.painter import Painter
from kit.render.roles import Role
from kit.render.scene import (
    CellState,
    Disc,
    PenStroke,
    Scene,
    SceneBody,
    SceneBounds,
    SceneCells,
    SceneMark,
    ScenePath,
)
from tests.cases import every_case
from tests.render.scenes import box_walls, maze, robot, scan

every_encoder = pytest.mark.parametrize(
    "encoder", [BrailleEncoder(), HalfBlockEncoder(), AsciiEncoder()], ids=list(ENCODERS)
)
GHOST_ROLES = [role for role in Role if role.name.startswith("GHOST_")]


def room() -> Scene:
    """2.4 x 1.2 m, with everything in it that can be drawn of one robot."""
    walls = box_walls(
        ((0, 0, 2.4, 0.1), (0, 1.1, 2.4, 1.2), (0, 0.1, 0.1, 1.1), (2.3, 0.1, 2.4, 1.1), (1.2, 0.1, 1.3, 0.6))
    )
    pose = Pose(0.6, 0.6, 0.6)
    return Scene(
        walls,
        (robot(pose),),
        scan(walls, pose),
        targets=(Disc(1.9, 0.8, 0.2),),
        trails=(np.array([(0.2 + 0.1 * i, 0.6) for i in range(4)]),),
        contacts=np.array([(1.2, 0.3)]),
        marks=(SceneMark(0.2, 0.25, "S"),),
    )


GOLDEN = {
    "braille": """
 ▐████████████████████████████▌
 ▐█▀▀▀▀▀▀▀▀▀▀▀▀▀▀▀▀▀▀▀▀▀▀▀▀▀▀█▌
 ▐█                  ⢠⠋⠉◎⠉⢣  █▌
 ▐█      ⡠⠔⠁    ▄▖   ⠈⢆⡀ ⣀⠎  █▌
 ▐█ ⠁⠁⠈⠈◥       █▌     ⠈⠉    █▌
 ▐█             ×▌           █▌
 ▐█▄S▄▄▄▄▄▄▄▄▄▄▄█▙▄▄▄▄▄▄▄▄▄▄▄█▌
 ▐████████████████████████████▌
""",
    "block": """
 ██████████████████████████████
 █▒▒▒▒▒▒▒▒▒▒▒▒▒▒▒▒▒▀▒▀▀▒▀▀▒▀▀▒█
 █▒                   █▀◎▀█  ▒█
 █▒      ▄▄▀    ▄▄    █▄▄▄█  ▒█
 █▒ ····◥       ▒█           ██
 █▒             ×█           ██
 █▒▒S▒▒▒▒▒▒▒▒▒▒▒▒█▄▄▄▄▄▄▄▄▄▄▄██
 ██████████████████████████████
""",
    "ascii": """
 ##############################
 #.................#.##.##.##.#
 #.                   oo*oo  .#
 #.      /      ##    ooooo  .#
 #. ,,,,>       .#           ##
 #.             X#           ##
 #..S............##############
 ##############################
""",
}


@pytest.mark.parametrize("name", ENCODERS)
def test_a_room_looks_like_this(name: str) -> None:
    frame = draw(room(), ENCODERS[name](False), columns=32, rows=8)
    assert frame.rows() == GOLDEN[name].strip("\n").split("\n")


@every_encoder
def test_a_large_robot_has_its_shape_and_its_nose(encoder: Encoder) -> None:
    scene = Scene(bodies=(robot(Pose(0, 0, 0)),))
    frame = Painter(encoder).paint(scene, Camera(0.0, 0.0, 0.005, 60, 24))
    rows, columns = np.nonzero(np.isin(frame.fg, (Role.ROBOT,)))
    # 0.165 m from -0.117 to 0.048, and the nose beyond; 0.17 m across.
    assert columns.min() == math.floor(30 - 0.117 / 0.005)
    assert columns.max() > 30 + 0.048 / 0.005
    assert rows.min() == math.floor(12 - 0.085 / 0.01)
    assert rows.max() == math.floor(12 + 0.085 / 0.01)
    # Its nose is on the axis, alone.
    tip = rows[columns == columns.max()]
    assert len(set(tip.tolist())) == 1
    assert tip[0] in (11, 12)


def test_characters_on_a_solid_robot_have_its_colour_behind_them() -> None:
    scene = Scene(bodies=(robot(Pose(0, 0, 0)), robot(Pose(0, 0.3, 0))))
    frame = Painter(BrailleEncoder(layers=True), shaded=True).paint(scene, Camera(0.0, 0.0, 0.04, 60, 60))
    for arrows, role in zip(BrailleEncoder.symbols.robot_arrows, (Role.ROBOT, Role.ROBOT_2), strict=True):
        assert set(frame.bg[frame.glyphs == ord(arrows[0])].tolist()) == {role}
    alone = Painter(BrailleEncoder(layers=True), shaded=True).paint(scene, Camera(0.0, 0.0, 0.2, 20, 20))
    assert not set(alone.bg.ravel().tolist()) & {Role.ROBOT, Role.ROBOT_2}, "an arrow is no robot's body"


@every_encoder
@every_case("eighth", range(8))
def test_a_small_robot_is_an_arrow_with_a_nose_ahead(encoder: Encoder, eighth: int) -> None:
    theta = eighth * math.tau / 8
    frame = Painter(encoder).paint(Scene(bodies=(robot(Pose(0, 0, theta)),)), Camera(0, 0, 0.2, 21, 11))
    arrows = encoder.symbols.robot_arrows[0]
    expected = arrows[round(theta / math.tau * len(arrows)) % len(arrows)]
    row, column = np.argwhere(frame.glyphs == ord(expected))[0].tolist()
    assert (row, column) == (5, 10) or (abs(row - 5) <= 1 and abs(column - 10) <= 1)
    others = np.argwhere((frame.fg == Role.ROBOT) & (frame.glyphs != ord(expected)))
    ahead = others - (row, column)
    assert len(ahead)
    along = ahead[:, 1] * math.cos(theta) - 2 * ahead[:, 0] * math.sin(theta)
    aside = ahead[:, 1] * math.sin(theta) + 2 * ahead[:, 0] * math.cos(theta)
    assert (along > 0).all()
    assert (np.abs(aside) <= 2.5).all()


@every_encoder
def test_several_robots_differ_by_number_and_not_only_by_colour(encoder: Encoder) -> None:
    poses = (Pose(-2, 0, 0), Pose(0, 0, 0), Pose(2, 0, 0))
    scene = Scene(bodies=tuple(robot(pose, f"serp{i}") for i, pose in enumerate(poses)))
    frame = Painter(encoder).paint(scene, Camera(0, 0, 0.2, 41, 11))
    text = "\n".join(frame.rows())
    assert all(text.count(number) == 1 for number in "123")
    alone = Painter(encoder).paint(replace(scene, bodies=scene.bodies[:1]), Camera(0, 0, 0.2, 41, 11))
    assert "1" not in "".join(alone.rows())


def test_two_robots_have_different_arrows() -> None:
    scene = Scene(bodies=(robot(Pose(-2, 0, 0)), robot(Pose(2, 0, 0))))
    text = "".join(Painter(BrailleEncoder()).paint(scene, Camera(0, 0, 0.2, 41, 11)).rows())
    assert "►" in text
    assert "▷" in text


@every_encoder
@pytest.mark.parametrize("toward", [(0.09, 0.0), (-0.09, 0.01), (0.01, 0.09), (0.0, -0.09)])
def test_a_contact_is_seen_even_where_the_robots_arrow_is(
    encoder: Encoder, toward: tuple[float, float]
) -> None:
    pose = Pose(0.0345, 0.0, 0.0)  # its middle at the origin
    scene = Scene(bodies=(robot(pose),), contacts=np.array([toward]))
    frame = Painter(encoder).paint(scene, Camera(0, 0, 0.4, 21, 11))
    ((row, column),) = np.argwhere(frame.fg == Role.CONTACT).tolist()
    assert chr(frame.glyphs[row, column]) == encoder.symbols.contact
    (arrow_row, arrow_column) = 5, 10
    assert (column - arrow_column) * toward[0] - (row - arrow_row) * toward[1] > 0


@every_encoder
@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("is_upright", [False, True])
def test_a_robot_at_a_wall_stands_beside_it_on_its_own_side(
    encoder: Encoder, side: int, is_upright: bool
) -> None:
    along, off = (0.5, 0.5 + 0.1 * side)
    wall = np.array(((0.5, -9.0, 0.5, 9.0) if is_upright else (-9.0, 0.5, 9.0, 0.5),))
    place = (off, along) if is_upright else (along, off)
    camera = Camera(0, 0, 21, 21, 21)  # a cell is a metre: wall and robot are in one
    empty = Painter(encoder).paint(Scene(walls=wall), camera)
    frame = Painter(encoder).paint(Scene(walls=wall, bodies=(robot(Pose(*place, 0.0)),)), camera)
    arrows = [ord(glyph) for glyph in encoder.symbols.robot_arrows[0]]
    ((row, column),) = np.argwhere((frame.fg == Role.ROBOT) & np.isin(frame.glyphs, arrows)).tolist()
    wall_row, wall_column = np.argwhere(empty.fg == Role.WALL)[0].tolist()
    assert (column - wall_column if is_upright else wall_row - row) == side


@every_encoder
def test_a_wall_is_seen_where_it_is(encoder: Encoder) -> None:
    camera = Camera(0.0, 0.0, 0.1, 40, 20)
    generator = np.random.default_rng(5)
    for x1, y1, x2, y2 in generator.uniform(-3, 3, (60, 4)).tolist():
        frame = Painter(encoder).paint(Scene(np.array([(x1, y1, x2, y2)])), camera)
        for share in np.linspace(0, 1, 30):
            column, row = camera.project(np.array((x1 + share * (x2 - x1), y1 + share * (y2 - y1))))
            if 1 <= column < 39 and 1 <= row < 19:
                near = frame.fg[int(row) - 1 : int(row) + 2, int(column) - 1 : int(column) + 2]
                assert (near == Role.WALL).any()
        for row, column in np.argwhere(frame.fg).tolist():
            x, y = (column + 0.5 - 20) * 0.1, (10 - row - 0.5) * 0.2
            length = math.hypot(x2 - x1, y2 - y1)
            share = min(max(((x - x1) * (x2 - x1) + (y - y1) * (y2 - y1)) / length**2, 0), 1)
            assert math.hypot(x - x1 - share * (x2 - x1), y - y1 - share * (y2 - y1)) < 0.25


@every_encoder
def test_panning_shifts_the_picture_and_changes_nothing_else(encoder: Encoder) -> None:
    scene = room()
    camera = Camera(1.21, 0.62, 0.05, 60, 20)
    still = Painter(encoder).paint(scene, camera)
    moved = Painter(encoder).paint(scene, camera.panned(7, -3))
    assert np.array_equal(still.glyphs[3:, 7:], moved.glyphs[:-3, :-7])
    assert np.array_equal(still.fg[3:, 7:], moved.fg[:-3, :-7])


@every_encoder
@pytest.mark.parametrize("steps", [-6, -2, 0, 3, 8])
def test_any_view_has_its_size_and_single_characters(encoder: Encoder, steps: int) -> None:
    scene = full_scene()
    for size in ((1, 1), (2, 40), (80, 22), (200, 3)):
        camera = Camera.fit(scene.bounds, *size).zoomed(steps)
        frame = Painter(encoder).paint(scene, camera)
        assert frame.shape == (size[1], size[0])
        assert all(len(frame.text(row)) == size[0] for row in range(size[1]))
        assert (frame.fg[frame.glyphs != BLANK] > 0).all()
        assert frame.fg.max() <= Role.TEXT


@every_encoder
def test_nothing_that_is_out_of_sight_is_drawn(encoder: Encoder) -> None:
    scene = replace(full_scene(), walls=maze())
    frame = Painter(encoder).paint(scene, Camera(100.0, 100.0, 0.1, 80, 22))
    assert not frame.fg.any()
    assert (frame.glyphs == BLANK).all()


def test_noise_lights_no_wall_behind_the_face_that_the_laser_sees() -> None:
    """A wall three characters thick, whose face in the room rays end on, some of them a little inside of it."""
    walls = box_walls(((0, 0, 2.4, 0.2), (0, 1.0, 2.4, 1.2), (0, 0.2, 0.2, 1.0), (2.2, 0.2, 2.4, 1.0)))
    pose = Pose(1.2, 0.6, 0.0)
    hits = scan(walls, pose)
    away = hits - np.array(pose[:2])
    noisy = hits + away / np.hypot(*away.T)[:, None] * np.tile((0.0, 0.08), len(hits))[: len(hits), None]
    beams = np.column_stack((np.full_like(noisy, pose[:2]), noisy))
    scene = Scene(walls, (robot(pose),), noisy, beams)
    camera = Camera.fit(scene.bounds, 60, 20)
    lit = Painter(BrailleEncoder(), shaded=True).paint(scene, camera).fg == Role.WALL_HIT
    assert lit.sum() > 50
    left, top, right, bottom = camera.project(np.array(((0.2, 1.0), (2.2, 0.2)))).ravel()
    lit[math.ceil(top) - 1 : math.floor(bottom) + 1, math.ceil(left) - 1 : math.floor(right) + 1] = False
    assert not lit.any()


@every_encoder
def test_what_is_nowhere_is_left_out(encoder: Encoder) -> None:
    nan = math.nan
    scene = Scene(
        np.array([(nan, 0, 1, 1)]),
        (robot(Pose(nan, 0, 0)), robot(Pose(0, 0, nan)), SceneBody("ball", Pose(), discs=(Disc(nan, 0, 1),))),
        hits=np.array([(nan, 1.0)]),
        targets=(Disc(nan, 0, 0.3), Disc(0, 0, nan)),
        contacts=np.array([(nan, nan)]),
        arrows=np.array([(nan, 0, 1, 1, 1.0)]),
        marks=(SceneMark(math.inf, 0, "S"),),
    )
    frame = Painter(encoder).paint(scene, Camera(5.0, 5.0, 0.1, 20, 10))
    assert not frame.fg.any()


def test_standing_walls_are_drawn_once(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = []
    draw_walls = painter_module._draw_walls

    def counted(*args: Any) -> Any:
        drawn.append(args)
        return draw_walls(*args)

    monkeypatch.setattr(painter_module, "_draw_walls", counted)
    painter, walls = Painter(BrailleEncoder()), maze()
    camera = Camera.fit(SceneBounds(0, 0, 8.25, 5.175), 80, 22)
    frames = [
        painter.paint(Scene(walls, (robot(Pose(1, 1, turn)),)), camera) for turn in np.linspace(0, 6, 40)
    ]
    assert len(drawn) == 1
    assert len({frame.glyphs.tobytes() for frame in frames}) > 20
    painter.paint(Scene(walls), camera.panned(1, 0))
    assert len(drawn) == 2
    painter.paint(Scene(walls.copy()), camera.panned(1, 0))
    assert len(drawn) == 3


def test_the_faces_of_a_thin_wall_are_one_wall_at_every_scale_that_is_not_coarse() -> None:
    walls = box_walls(((0, -1, 0.1, 1),))
    for cell in np.geomspace(0.004, 0.06, 40).tolist():
        for x in (0.0, 0.013, 0.027):
            camera = Camera(x, 0.0, cell, 60, 5)
            scene = Scene(walls, (robot(Pose(50, 50, 0.3)),))
            dots = Painter(AsciiEncoder())._static_grid(scene, camera)
            row = dots[2] > 0
            if row.any():
                first, last = np.flatnonzero(row)[[0, -1]]
                assert row[first:last].all()
            else:
                assert cell < 0.02


def test_a_gap_a_robot_fits_through_stays_open() -> None:
    walls = box_walls(((0, 0, 1, 0.1), (1.2, 0, 2.2, 0.1)))
    scene = Scene(walls, (robot(Pose(0.5, 0.5, 0)),))
    for columns in (40, 60, 80, 200):
        frame = Painter(BrailleEncoder()).paint(scene, Camera(1.1, 0.05, 3 / columns, columns, 5))
        column = int((1.1 - 1.1 + 1.5) / 3 * columns)
        assert (frame.fg[:, column] == Role.EMPTY).any()


def test_a_field_gives_way_to_what_is_there() -> None:
    scene = Scene(
        np.array([(-1, 0.0, 1, 0.0)]),
        arrows=np.array(
            [(-0.5, 0.0, 1, 0, 1), (0.5, 0.6, 0, 1, 0.4), (1, 0.6, 0, -1, 1), (0, -0.6, 1, 0, 0)]
        ),
    )
    frame = Painter(BrailleEncoder()).paint(scene, Camera(0, 0, 0.1, 30, 12))
    text = "".join(frame.rows())
    assert not {"→", "⇒"} & set(text)
    assert "↑" in text
    assert "⇓" in text  # the stronger, the heavier
    assert "·" in text


def test_paths_are_solid_dashed_or_dotted() -> None:
    line = np.array([(-1.4, 0.0), (1.4, 0.0)])
    drawn = []
    for style in ("solid", "dashed", "dotted"):
        scene = Scene(paths=(ScenePath(line, style),))
        drawn.append(
            int((Painter(AsciiEncoder()).paint(scene, Camera(0, 0, 0.1, 30, 3)).fg == Role.PATH).sum())
        )
    assert drawn == sorted(drawn, reverse=True)
    assert len(set(drawn)) == 3


def test_ghosts_ways_differ_in_their_dashes_and_their_letters_have_their_colours() -> None:
    line = np.array([(-1.4, 0.0), (1.4, 0.0)])
    camera = Camera(0, 0, 0.1, 30, 3)
    drawn = set()
    for role in GHOST_ROLES:
        scene = Scene(paths=(ScenePath(line, role=role),), marks=(SceneMark(0.0, 0.1, "K", role),))
        frame = Painter(BrailleEncoder()).paint(scene, camera)
        assert set(frame.fg.ravel().tolist()) == {Role.EMPTY, role}
        assert "K" in "".join(frame.rows())
        drawn.add(next(row for row in frame.rows() if row.strip()[:1] > "⠀"))
    assert len(drawn) == len(GHOST_ROLES)


@pytest.mark.parametrize("name", ENCODERS)
@pytest.mark.parametrize("mono", [False, True])
def test_a_cart_is_filled_and_the_targets_own_body_is_a_part_of_it(name: str, mono: bool) -> None:
    camera = Camera(0, 0, 0.1, 30, 15)
    bodies = (
        SceneBody("cart", Pose(-0.8, 0.0), discs=(Disc(-0.8, 0.0, 0.4),)),
        SceneBody("beacon", Pose(0.8, 0.0), discs=(Disc(0.8, 0.0, 0.4),), is_target=True),
    )
    frame = Painter(ENCODERS[name](mono)).paint(Scene(bodies=bodies), camera)
    left, right = frame.fg[:, :15], frame.fg[:, 15:]
    assert set(left.ravel().tolist()) == {Role.EMPTY, Role.BODY}
    assert set(right.ravel().tolist()) == {Role.EMPTY, Role.TARGET}
    assert frame.glyphs[7, 7] != BLANK
    assert frame.glyphs[7, 22] == BLANK, "a ring is hollow"


@pytest.mark.parametrize("layers", [False, True])
def test_a_targets_ring_beside_a_wall_is_closed_and_of_dots_as_everywhere(layers: bool) -> None:
    camera = Camera(0, 0, 0.1, 30, 15)
    walls = box_walls(((0.5, -1.4, 0.7, 1.4),))
    scene = Scene(walls, targets=(Disc(0.2, 0.0, 0.5),), bodies=(robot(Pose(-1.0, 0.5)),))
    frame = Painter(BrailleEncoder(layers=layers)).paint(scene, camera)
    is_target = frame.fg == Role.TARGET
    assert Role.TARGET not in frame.bg
    assert (frame.glyphs[is_target & (frame.glyphs != ord("◎"))] > 0x2800).all()
    right = is_target.any(axis=0).nonzero()[0].max()
    middle = slice(is_target.any(axis=1).nonzero()[0].min() + 1, is_target.any(axis=1).nonzero()[0].max())
    assert is_target[middle, right].all(), "its rim runs down along the wall"


def full_scene() -> Scene:
    scene = room()
    ball = SceneBody("ball", Pose(0.5, 0.3, 0), discs=(Disc(0.5, 0.3, 0.1),))
    box = SceneBody("box", Pose(0.9, 0.9, 0), (np.array([(0.8, 0.8), (1.0, 0.8), (1.0, 1.0)]),))
    return replace(
        scene,
        bodies=(*scene.bodies, robot(Pose(1.6, 0.4, -2.0), "two"), ball, box),
        beams=np.concatenate((np.broadcast_to((0.6, 0.6), scene.hits.shape), scene.hits), axis=1),
        arrows=np.array([(0.3, 0.9, 1.0, 0.5, 1.0)]),
        paths=(ScenePath(np.array([(0.2, 0.2), (2.0, 1.0)]), "dotted"),),
    )


def draw(scene: Scene, encoder: Encoder, columns: int, rows: int) -> Frame:
    return Painter(encoder).paint(scene, Camera.fit(scene.bounds, columns, rows))


def test_pens_draw_in_the_nearest_colour() -> None:
    red = PenStroke(np.array([(-1.0, 0.0), (1.0, 0.0)]), (250, 10, 20))
    scene = Scene(walls=np.array([(-2.0, -2.0, 2.0, -2.0), (-2.0, 2.0, 2.0, 2.0)]), strokes=(red,))
    frame = Painter(BrailleEncoder()).paint(scene, Camera.fit(scene.bounds, 20, 10))
    assert Role.PEN_RED in frame.fg
    assert Role.PEN_BLUE not in frame.fg


def test_a_way_that_is_open_is_not_closed_by_thick_walls() -> None:
    """Two walls a little more than a robot apart, in a picture in which that is about a dot."""
    walls = np.array([(0.0, 0.0, 4.0, 0.0), (0.0, 0.25, 4.0, 0.25)])
    scene = Scene(walls, (robot(Pose(2.0, 0.125, 0.0)),))
    camera = Camera(2.0, 0.125, 0.3, 12, 5)
    picture = "".join(Painter(BrailleEncoder()).paint(scene, camera).rows())
    assert "█" not in picture


def test_cells_are_drawn_where_they_are_known() -> None:
    states = np.zeros((10, 20), dtype=np.uint8)
    states[:, 10:] = CellState.FREE
    states[4:6, 15] = CellState.OCCUPIED
    scene = Scene(cells=SceneCells(states, (1.0, 2.0), 0.1))
    assert scene.bounds == pytest.approx((1.0, 2.0, 3.0, 3.0))
    camera = Camera.fit(scene.bounds, 40, 12)
    frame = Painter(BrailleEncoder()).paint(scene, camera)
    column, row = (int(each) for each in camera.project(np.array((2.55, 2.5))))
    assert frame.fg[row, column] == Role.WALL
    middle = frame.fg.shape[1] // 2
    assert (frame.fg[:, : middle - 2] == Role.FIELD).any()  # a pattern over what is unknown
    assert not (frame.fg[:, middle + 2 :] == Role.FIELD).any()
    assert not (frame.fg[0] == Role.FIELD).any()  # outside the grid nothing is claimed

    shaded = Painter(BrailleEncoder(), shaded=True).paint(scene, camera)
    assert (shaded.bg[row, middle + 2 : column - 1] == Role.FLOOR).all()
    assert not (shaded.bg[:, : middle - 2] == Role.FLOOR).any()
    assert not (shaded.fg == Role.FIELD).any()


@pytest.mark.parametrize(("cell", "has_outline"), [(0.1, False), (0.03, True)])
def test_the_outline_within_a_target_is_drawn_where_there_is_room_for_it(
    cell: float, has_outline: bool
) -> None:
    beacon = SceneBody("beacon", Pose(0.0, 0.0), discs=(Disc(0.0, 0.0, 0.2),), is_target=True)
    scene = Scene(bodies=(beacon,), targets=(Disc(0.0, 0.0, 0.6),))

    def drawn(shown: Scene) -> list[str]:
        return Painter(BrailleEncoder()).paint(shown, Camera(0, 0, cell, 60, 30)).rows()

    assert (drawn(scene) != drawn(replace(scene, bodies=()))) is has_outline
    alone = replace(scene, targets=())
    assert drawn(alone) != drawn(replace(alone, bodies=())), (
        "without a symbol it is all that shows the target"
    )
