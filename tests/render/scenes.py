"""Scenes made by hand for the tests of the picture: a maze of 8.25 x 5.175 m and a robot that drives in it."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from kit.arrays import FloatArray
from kit.geometry import Pose
from kit.render.scene import Disc, Scene, SceneBody, SceneMark, Trail

BEAMS, RANGE = 91, 10.0

BASE = np.array(((0.048, 0.055), (-0.117, 0.055), (-0.117, -0.055), (0.048, -0.055)))
LEFT_WHEEL = np.array(((0.035, 0.085), (-0.035, 0.085), (-0.035, 0.060), (0.035, 0.060)))
FOOTPRINTS = (BASE, LEFT_WHEEL, LEFT_WHEEL * (1.0, -1.0))
"""0.165 x 0.17 m, about the middle of the axle."""

# Boxes x0, y0, x1, y1: walls 0.1 m thick, corridors about 0.9 m wide.
BOXES = (
    (0.0, 0.0, 8.25, 0.1),
    (0.0, 5.075, 8.25, 5.175),
    (0.0, 0.0, 0.1, 5.175),
    (8.15, 0.0, 8.25, 5.175),
    (1.0, 0.1, 1.1, 3.1),
    (1.1, 4.1, 3.1, 4.2),
    (2.0, 1.0, 2.1, 4.1),
    (2.1, 1.0, 4.1, 1.1),
    (3.0, 2.0, 3.1, 3.2),
    (3.1, 2.0, 5.1, 2.1),
    (4.0, 3.0, 4.1, 5.075),
    (5.0, 0.1, 5.1, 2.1),
    (5.0, 3.0, 7.2, 3.1),
    (5.0, 3.1, 5.1, 4.2),
    (6.0, 1.0, 6.1, 3.0),
    (6.1, 4.1, 8.15, 4.2),
    (7.1, 1.0, 7.2, 3.0),
)

ROUTE = (
    (0.55, 0.6), (0.55, 3.6), (1.55, 3.6), (1.55, 0.55), (4.55, 0.55), (4.55, 1.55), (2.55, 1.55), (2.55, 3.65),
    (3.55, 3.65), (3.55, 2.55), (4.55, 2.55), (5.55, 2.55), (5.55, 0.55), (6.6, 0.55), (6.6, 2.5), (6.6, 0.55),
    (7.65, 0.55), (7.65, 3.6), (5.6, 3.6), (5.6, 4.6), (7.6, 4.6),
)  # fmt: skip


def box_walls(boxes: tuple[tuple[float, float, float, float], ...]) -> FloatArray:
    walls = [
        side
        for x0, y0, x1, y1 in boxes
        for side in ((x0, y0, x1, y0), (x1, y0, x1, y1), (x1, y1, x0, y1), (x0, y1, x0, y0))
    ]
    return np.array(walls, dtype=float)


def maze() -> FloatArray:
    return box_walls(BOXES)


def robot(pose: Pose, model: str = "serp") -> SceneBody:
    cos, sin = math.cos(pose.theta), math.sin(pose.theta)
    turn = np.array(((cos, sin), (-sin, cos)))
    return SceneBody(model, pose, tuple(part @ turn + pose[:2] for part in FOOTPRINTS), is_robot=True)


def scan(walls: FloatArray, pose: Pose, noise: np.random.Generator | None = None) -> FloatArray:
    """Where 91 rays around the robot end: (m, 2), only those that hit."""
    angles = pose.theta + np.linspace(-math.pi, math.pi, BEAMS)
    rays = np.stack((np.cos(angles), np.sin(angles)), axis=1)
    start, along = walls[:, :2] - pose[:2], walls[:, 2:] - walls[:, :2]
    cross = rays[:, :1] * along[:, 1] - rays[:, 1:] * along[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = (start[:, 0] * along[:, 1] - start[:, 1] * along[:, 0]) / cross
        share = (start[:, 0] * rays[:, 1:] - start[:, 1] * rays[:, :1]) / cross
    distance[~((distance > 0) & (share >= 0) & (share <= 1))] = np.inf
    ranges = distance.min(axis=1)
    if noise is not None:
        ranges = ranges + noise.normal(0.0, 0.015, BEAMS)
    hit = ranges < RANGE
    return pose[:2] + ranges[hit, None] * rays[hit]


def drive(
    fps: float = 20.0, speed: float = 0.5, turning: float = 1.5, scan_rate: float = 10.0
) -> Iterator[Scene]:
    """The robot along its route for ever, frame by frame, its lidar seen at ``scan_rate`` and with noise."""
    walls, noise, trail = maze(), np.random.default_rng(7), Trail()
    scene = Scene(walls)
    targets, marks = (Disc(7.6, 4.6, 0.25),), (SceneMark(0.55, 0.6, "S"),)
    every = round(fps / scan_rate)
    for frame, pose in enumerate(_poses(fps, speed, turning)):
        trail.add(pose.x, pose.y)
        hits = scan(walls, pose, noise) if frame % every == 0 else scene.hits
        scene = Scene(walls, (robot(pose),), hits, targets=targets, trails=(trail.points,), marks=marks)
        yield scene


def _poses(fps: float, speed: float, turning: float) -> Iterator[Pose]:
    x, y = ROUTE[0]
    theta = math.pi / 2
    while True:
        for goal_x, goal_y in (*ROUTE[1:], *ROUTE[-2::-1]):
            while math.hypot(goal_x - x, goal_y - y) > speed / fps:
                ahead = math.atan2(goal_y - y, goal_x - x)
                error = (ahead - theta + math.pi) % math.tau - math.pi
                if abs(error) > turning / fps:
                    theta += math.copysign(turning / fps, error)
                else:
                    theta = ahead
                    x, y = x + speed / fps * math.cos(theta), y + speed / fps * math.sin(theta)
                yield Pose(x, y, theta)
