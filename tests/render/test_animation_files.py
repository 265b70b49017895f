"""Asciicasts: a terminal that plays the file shows the same characters in the same colours as the frames."""

from __future__ import annotations

import json
from dataclasses import replace
from xml.etree import ElementTree as ET

import numpy as np
import pyte
import pytest

from kit.geometry import Pose
from kit.render.animation_files import asciicast_lines, svg_animation
from kit.render.encode import Frame
from kit.render.palettes import PALETTES, Palette
from kit.render.roles import Role
from kit.render.scene import Disc, Scene, SceneBody
from tests.render.scenes import robot


def random_frames(count: int, columns: int, rows: int) -> list[Frame]:
    """Each differs from the one before in some characters."""
    rng = np.random.default_rng(1)
    frames = [Frame.empty(columns, rows)]
    letters = np.array([ord(letter) for letter in " ⣿⡇#►"], dtype=np.uint32)
    while len(frames) < count:
        before = frames[-1]
        changed = rng.random((rows, columns)) < 0.1
        glyphs = np.where(changed, rng.choice(letters, (rows, columns)), before.glyphs)
        fg = np.where(changed, rng.integers(0, len(Role), (rows, columns)), before.fg)
        frames.append(Frame(glyphs.astype(np.uint32), fg.astype(np.uint8), before.bg))
    return frames


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
def test_a_terminal_that_plays_it_shows_every_frame(palette: Palette) -> None:
    frames = random_frames(6, 40, 12)
    header, *events = map(
        json.loads, asciicast_lines([(i / 10, each) for i, each in enumerate(frames)], palette)
    )
    assert (header["version"], header["width"], header["height"]) == (2, 40, 12)
    screen = pyte.Screen(40, 12)
    stream = pyte.Stream(screen)
    for number, (time_s, kind, text) in enumerate(events[:-1]):
        stream.feed(text)
        assert (time_s, kind) == (number / 10, "o")
        assert screen.display == [frames[number].text(row) for row in range(12)]
    last = frames[-1]
    for row, column in zip(*np.nonzero(last.glyphs != ord(" ")), strict=True):
        shown, style = screen.buffer[row][column], palette[Role(last.fg[row, column])]
        assert (shown.fg == "default") == (style.color is None)
        assert shown.bold == style.bold


def test_a_frame_that_changes_nothing_is_not_written() -> None:
    frame = Frame.empty(10, 3)
    lines = list(asciicast_lines([(0.0, frame), (0.5, frame), (1.0, frame)], PALETTES["16"]))
    assert len(lines) == 3  # header, first frame, end
    assert json.loads(lines[-1])[0] == 1.0


def test_no_frames_make_no_file() -> None:
    with pytest.raises(ValueError, match="no frames"):
        list(asciicast_lines([], PALETTES["16"]))


SVG = "{http://www.w3.org/2000/svg}"
WALLS = np.array([(0.0, 0.0, 4.0, 0.0), (4.0, 0.0, 4.0, 2.0), (4.0, 2.0, 0.0, 2.0), (0.0, 2.0, 0.0, 0.0)])


def test_what_moves_has_a_shape_for_every_scene() -> None:
    box = SceneBody("box", Pose(3, 1, 0), (np.array([(3.0, 1.0), (3.2, 1.0), (3.2, 1.2)]),))
    scenes = [
        Scene(WALLS, (robot(Pose(0.5 + 0.1 * i, 1, 0)), box), targets=(Disc(3, 1, 0.3),)) for i in range(5)
    ]
    tree = ET.fromstring(svg_animation(scenes, 0.2, size=(640, 480), title="A <drive>"))
    assert tree.findtext(f"{SVG}title") == "A <drive>"
    width, height = float(tree.attrib["width"]), float(tree.attrib["height"])
    assert width == 640
    assert 300 < height < 360  # the world is twice as wide as high
    moving = tree.findall(f"{SVG}path/{SVG}animate")
    assert {each.attrib["dur"] for each in moving} == {"1.00s"}
    assert [len(each.attrib["values"].split(";")) for each in moving] == [5, 5]  # the outline and the heading
    firsts = [float(shape[1:].split()[0]) for shape in moving[0].attrib["values"].split(";")]
    scale = (width - 24) / 4
    assert np.allclose(np.diff(firsts), 0.1 * scale, atol=0.11)


def test_a_body_that_comes_later_is_nowhere_before() -> None:
    alone = Scene(WALLS, (robot(Pose(1, 1, 0)),))
    ball = SceneBody("ball", Pose(2, 1, 0), discs=(Disc(2, 1, 0.2),))
    tree = ET.fromstring(svg_animation([alone, replace(alone, bodies=(*alone.bodies, ball))], 0.1))
    (animation,) = tree.findall(f"{SVG}path/{SVG}animate")
    before, after = animation.attrib["values"].split(";")
    assert before == "M0 0"
    assert "A" in after


def test_a_target_is_shown_while_it_is_one() -> None:
    first, second = Disc(1, 1, 0.2), Disc(3, 1, 0.2)
    scenes = [
        Scene(WALLS, (robot(Pose(1, 1, 0)),), targets=targets) for targets in ((first, second), (second,), ())
    ]
    tree = ET.fromstring(svg_animation(scenes, 0.1))
    shown = [each.attrib["values"].split(";") for each in tree.findall(f"{SVG}path/{SVG}animate")]
    assert [[shape != "M0 0" for shape in each] for each in shown] == [
        [True, False, False],
        [True, True, False],
    ]


def test_no_scenes_make_no_file() -> None:
    with pytest.raises(ValueError, match="no scenes"):
        svg_animation([], 0.1)
