"""Describes the world in words and in plain characters: for screen readers, pipes and logs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from kit.geometry import Pose, wrap_angle
from kit.kernels.arrays import BoolArray
from kit.render.camera import Camera
from kit.render.encode import AsciiEncoder, Encoder
from kit.render.painter import Painter
from kit.render.raster import polyline
from kit.render.scene import FloatArray, Scene, SceneBody

SIDES = ("ahead", "ahead left", "left", "behind left", "behind", "behind right", "right", "ahead right")
"""In eighths of a turn, counter-clockwise from the heading."""
POSES_AT_ONCE = 32
"""Poses whose distances are computed together: more take memory and save no time."""


def scene_rows(scene: Scene, columns: int, rows: int, encoder: Encoder | None = None) -> list[str]:
    """The whole scene as rows of characters without colours, by default in ASCII."""
    return Painter(encoder or AsciiEncoder()).paint(scene, Camera.fit(scene.bounds, columns, rows)).rows()


def describe_scene(scene: Scene) -> str:
    """Describes the scene robot by robot, one line each: the target's distance and bearing
    (left is positive), the nearest wall's distance from the hull and side, whether it touches something."""
    robots = scene.robots
    if not robots:
        return "no robot"
    lines = ["; ".join(_robot_facts(robot, scene)) for robot in robots]
    if len(robots) == 1:
        return lines[0]
    return "\n".join(f"{robot.model}: {line}" for robot, line in zip(robots, lines, strict=True))


def _robot_facts(robot: SceneBody, scene: Scene) -> Iterator[str]:
    pose = robot.pose
    if scene.targets:
        target = min(scene.targets, key=lambda disc: math.hypot(disc.x - pose.x, disc.y - pose.y))
        away = math.hypot(target.x - pose.x, target.y - pose.y)
        degrees = round(math.degrees(_bearing(pose, target.x, target.y)))
        reached = ", reached" if away <= target.radius else ""
        yield f"target {away:.1f} m at {degrees:+d} deg{reached}"
    if len(scene.walls):
        distance, point = nearest_wall(robot, scene.walls)
        eighth = round(_bearing(pose, *point) / math.tau * 8) % 8
        yield f"nearest wall {distance:.1f} m {SIDES[eighth]}"
    else:
        yield "no walls"
    touching = np.hypot(*(scene.contacts - pose[:2]).T) if len(scene.contacts) else np.empty(0)
    if (touching <= _outer_radius(robot) + 0.02).any():
        yield "touching"


def nearest_wall(robot: SceneBody, walls: FloatArray) -> tuple[float, tuple[float, float]]:
    """Returns the distance [m] of the hull from the walls (n, 4), n > 0, and the wall's nearest point. The hull's corners
    against the walls and the walls' ends against the hull's edges: one of the two is the shortest way between
    shapes that do not overlap."""
    walls = walls[_may_be_nearest([robot], walls)]
    found = []
    corners = [*robot.polygons] or [np.array([robot.pose[:2]])]
    for polygon in corners:
        found.append(_nearest_point(polygon, walls, on_segment=True))
        found.append(_nearest_point(walls.reshape(-1, 2), polyline(polygon, closed=True), on_segment=False))
    for disc in robot.discs:
        distance, point = _nearest_point(np.array([disc[:2]]), walls, on_segment=True)
        found.append((max(0.0, distance - disc.radius), point))
    return min(found)


def wall_distances(robots: Sequence[SceneBody], walls: FloatArray) -> FloatArray:
    """Returns (k,) the distances [m] that ``nearest_wall`` has for k poses of one robot, k > 0, all at once."""
    chunks = (robots[first : first + POSES_AT_ONCE] for first in range(0, len(robots), POSES_AT_ONCE))
    return np.concatenate([_wall_distances(each, walls[_may_be_nearest(each, walls)]) for each in chunks])


def _wall_distances(robots: Sequence[SceneBody], walls: FloatArray) -> FloatArray:
    found = []
    hulls = [[*robot.polygons] or [np.array([robot.pose[:2]])] for robot in robots]
    for polygons in zip(*hulls, strict=True):
        corners, _ = _distances(np.concatenate(polygons), walls)
        edges = np.concatenate([polyline(polygon, closed=True) for polygon in polygons])
        ends, _ = _distances(walls.reshape(-1, 2), edges)
        nearest = corners.min(axis=1), ends.min(axis=0)
        found += [each.reshape(len(robots), -1).min(axis=1) for each in nearest]
    for discs in zip(*(robot.discs for robot in robots), strict=True):
        centers, radii = np.array([disc[:2] for disc in discs]), np.array([disc.radius for disc in discs])
        distance, _ = _distances(centers, walls)
        found.append(np.maximum(0.0, distance.min(axis=1) - radii))
    shortest: FloatArray = np.min(found, axis=0)
    return shortest


def _may_be_nearest(robots: Sequence[SceneBody], walls: FloatArray) -> BoolArray:
    """(n,) whether a wall may be the one that is nearest to the hull of a robot, by its distance from the robots' poses:
    few may, and the rest need not be compared with every corner and edge."""
    reach = np.array([_reach(robot) for robot in robots])
    distance, _ = _distances(np.array([robot.pose[:2] for robot in robots]), walls)
    limit = distance.min(axis=1) + 2.0 * reach + 1e-6
    may: BoolArray = (distance <= limit[:, None]).any(axis=0)
    return may


def _reach(robot: SceneBody) -> float:
    """The distance of the hull's farthest point from the robot's pose [m]."""
    corners = (float(np.hypot(*(polygon - robot.pose[:2]).T).max()) for polygon in robot.polygons)
    rims = (math.hypot(disc.x - robot.pose.x, disc.y - robot.pose.y) + disc.radius for disc in robot.discs)
    return max((0.0, *corners, *rims))


def _nearest_point(
    points: FloatArray, segments: FloatArray, on_segment: bool
) -> tuple[float, tuple[float, float]]:
    """The shortest distance between points (p, 2) and segments (s, 4), and its end on the segment or, if not
    ``on_segment``, the point it starts from."""
    distance, foot = _distances(points, segments)
    which = np.unravel_index(int(distance.argmin()), distance.shape)
    x, y = (foot[which] if on_segment else points[which[0]]).tolist()
    return float(distance[which]), (x, y)


def _distances(points: FloatArray, segments: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The distances (p, s) [m] of points (p, 2) from segments (s, 4), and the segments' nearest points (p, s, 2)."""
    start, along = segments[:, :2], segments[:, 2:] - segments[:, :2]
    length = np.maximum((along**2).sum(axis=1), 1e-18)
    share = np.clip(((points[:, None] - start) * along).sum(axis=2) / length, 0.0, 1.0)
    foot = start + share[..., None] * along
    return np.hypot(*np.moveaxis(foot - points[:, None], 2, 0)), foot


def _bearing(pose: Pose, x: float, y: float) -> float:
    return wrap_angle(math.atan2(y - pose.y, x - pose.x) - pose.theta)


def _outer_radius(robot: SceneBody) -> float:
    left, bottom, right, top = robot.extent
    return math.hypot(max(-left, right), max(-bottom, top))
