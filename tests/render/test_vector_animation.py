"""Animated SVG: well-formed, everything in its place, one value a frame for what moves and none for what does not."""

from __future__ import annotations

from dataclasses import replace
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from kit.geometry import Pose
from kit.render.scene import Disc, Scene, SceneBody
from kit.render.vector_animation import svg_animation
from tests.render.scenes import robot

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


def test_no_scenes_make_no_file() -> None:
    with pytest.raises(ValueError, match="no scenes"):
        svg_animation([], 0.1)
