"""Pictures as pixels: the right size, the right colours in the right places, whatever the scene."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from kit.geometry import Pose
from kit.render.camera import Camera
from kit.render.image import BACKGROUND, IMAGE_THEMES, draw_image, image_camera, save_animation, save_image
from kit.render.roles import Role
from kit.render.scene import Disc, Scene, SceneBody, SceneBounds
from tests.render.scenes import robot
from tests.render.test_painter import full_scene


def near(pixels: np.ndarray, camera: Camera, x: float, y: float, role: Role) -> bool:
    """Whether the colour of a role is seen within three pixels of a place."""
    column, row = camera.project(np.array((x, y))).astype(int)
    patch = pixels[max(0, row - 3) : row + 4, max(0, column - 3) : column + 4].astype(int)
    return bool((np.abs(patch - IMAGE_THEMES["light"][role]).max(axis=2) < 40).any())


def test_things_are_where_they_are() -> None:
    scene = full_scene()
    camera = image_camera(scene.bounds, 480, 260)
    pixels = draw_image(scene, camera)
    assert pixels.shape == (260, 480, 3)
    assert pixels.dtype == np.uint8
    assert near(pixels, camera, 2.4, 0.6, Role.WALL)
    assert near(pixels, camera, 1.9, 0.8, Role.TARGET)
    assert near(pixels, camera, 1.2, 0.3, Role.CONTACT)
    assert near(pixels, camera, *scene.robots[0].pose.transform_point(-0.1, 0.0), Role.ROBOT)
    assert near(pixels, camera, *scene.robots[1].pose.transform_point(-0.1, 0.0), Role.ROBOT_2)
    assert tuple(pixels[-1, -1]) == BACKGROUND


def test_the_picture_holds_all_that_was_to_be_seen() -> None:
    bounds = SceneBounds(-3, 1, 5, 2)
    for width, height in ((160, 120), (640, 480), (33, 200)):
        seen = image_camera(bounds, width, height).bounds
        assert seen.left < -3 < 5 < seen.right
        assert seen.bottom < 1 < 2 < seen.top


@pytest.mark.parametrize("steps", [-20, 20])
def test_any_zoom_is_drawn_at_once(steps: int) -> None:
    scene = full_scene()
    pixels = draw_image(scene, image_camera(scene.bounds, 200, 100).zoomed(steps))
    assert pixels.shape == (100, 200, 3)


def test_what_is_nowhere_is_left_out() -> None:
    nan = math.nan
    scene = Scene(
        np.array([(nan, 0, 1, 1), (0.0, -0.5, 1.0, -0.5)]),
        (robot(Pose(nan, 0, 0)), SceneBody("ball", Pose(), discs=(Disc(nan, 0, 1),))),
        hits=np.array([(nan, 1.0), (0.5, 0.5)]),
        targets=(Disc(nan, 0, 0.3),),
    )
    pixels = draw_image(scene, Camera(0.5, 0.0, 0.02, 100, 100, aspect=1.0))
    assert {tuple(color) for color in pixels.reshape(-1, 3)} > {BACKGROUND}


def test_pictures_are_written(tmp_path: Path) -> None:
    scenes = [Scene(bodies=(robot(Pose(0.1 * i, 0, 0)),)) for i in range(3)]
    frames = [draw_image(scene, Camera(0.0, 0.0, 0.01, 80, 60, aspect=1.0)) for scene in scenes]
    save_image(tmp_path / "one.png", frames[0])
    with Image.open(tmp_path / "one.png") as picture:
        assert np.array_equal(np.array(picture), frames[0])
    save_animation(tmp_path / "drive.gif", frames, fps=10)
    with Image.open(tmp_path / "drive.gif") as animation:
        assert animation.n_frames == 3
        assert animation.info["duration"] == 100
    with pytest.raises(ValueError, match="no frames"):
        save_animation(tmp_path / "none.gif", [])
