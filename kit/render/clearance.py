"""Measures how far a robot's hull is from the walls: from the nearest, in many poses at once, and to one side."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from kit.arrays import BoolArray, FloatArray
from kit.render.raster import polyline
from kit.render.scene import Disc, SceneBody
from kit.segments import nearest_on_segments

POSES_AT_ONCE = 32
"""Poses whose distances are computed together: more take memory and save no time."""


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


def nearest_wall_distances(robots: Sequence[SceneBody], walls: FloatArray) -> FloatArray:
    """Returns (k,) the distances [m] that ``nearest_wall`` has for k poses of one robot, k > 0, all at once."""
    chunks = (robots[first : first + POSES_AT_ONCE] for first in range(0, len(robots), POSES_AT_ONCE))
    return np.concatenate([_wall_distances(each, walls[_may_be_nearest(each, walls)]) for each in chunks])


def _wall_distances(robots: Sequence[SceneBody], walls: FloatArray) -> FloatArray:
    found = []
    hulls = [[*robot.polygons] or [np.array([robot.pose[:2]])] for robot in robots]
    for polygons in zip(*hulls, strict=True):
        corners, _ = nearest_on_segments(np.concatenate(polygons), walls)
        edges = np.concatenate([polyline(polygon, closed=True) for polygon in polygons])
        ends, _ = nearest_on_segments(walls.reshape(-1, 2), edges)
        nearest = corners.min(axis=1), ends.min(axis=0)
        found += [each.reshape(len(robots), -1).min(axis=1) for each in nearest]
    for discs in zip(*(robot.discs for robot in robots), strict=True):
        centers, radii = np.array([disc[:2] for disc in discs]), np.array([disc.radius for disc in discs])
        distance, _ = nearest_on_segments(centers, walls)
        found.append(np.maximum(0.0, distance.min(axis=1) - radii))
    shortest: FloatArray = np.min(found, axis=0)
    return shortest


def side_wall_distances(
    hull: SceneBody, poses: FloatArray, walls: FloatArray, *, left: bool, within: float
) -> FloatArray:
    """Returns (k,) how far the hull is [m] from what lies to one side of it, for poses (k, 3), k > 0: walls, or parts of
    walls, in front or behind count where they are on that side of the heading. Infinite beyond ``within``.

    ``hull``: the robot at the pose (0, 0, 0).
    """
    mirror = np.array([1.0, 1.0 if left else -1.0])  # the other side is the left one of a mirrored world
    polygons = [polygon * mirror for polygon in hull.polygons] or [np.zeros((1, 2))]
    shape = SceneBody(
        hull.model, hull.pose, tuple(polygons), tuple(_mirror_disc(each, mirror) for each in hull.discs)
    )
    found = []
    for first in range(0, len(poses), POSES_AT_ONCE):
        chunk = poses[first : first + POSES_AT_ONCE]
        is_near = (nearest_on_segments(chunk[:, :2], walls)[0] <= within + _outer_radius(shape)).any(axis=0)
        found.append(_left_distances(shape, chunk, walls[is_near], mirror))
    distances = np.concatenate(found)
    return np.where(distances <= within, distances, math.inf)


def _left_distances(hull: SceneBody, poses: FloatArray, walls: FloatArray, mirror: FloatArray) -> FloatArray:
    if not len(walls):
        return np.full(len(poses), math.inf)
    away = walls.reshape(1, -1, 2) - poses[:, None, :2]
    cos, sin = np.cos(poses[:, 2:]), np.sin(poses[:, 2:])
    ends = np.stack(
        [cos * away[..., 0] + sin * away[..., 1], cos * away[..., 1] - sin * away[..., 0]], axis=2
    )
    start, end = np.moveaxis((ends * mirror).reshape(-1, 2, 2), 1, 0)
    with np.errstate(divide="ignore", invalid="ignore"):  # along the heading: neither end is cut off then
        crossing = start + (start[:, 1] / (start[:, 1] - end[:, 1]))[:, None] * (end - start)
    is_left = np.maximum(start[:, 1], end[:, 1]) >= 0
    segments = np.hstack(
        [np.where(start[:, 1:] < 0, crossing, start), np.where(end[:, 1:] < 0, crossing, end)]
    )[is_left]
    nearest = np.full(len(is_left), math.inf)
    nearest[is_left] = _hull_distances(hull, segments)
    shortest: FloatArray = nearest.reshape(len(poses), -1).min(axis=1)
    return shortest


def _hull_distances(hull: SceneBody, segments: FloatArray) -> FloatArray:
    """(s,) the distances of the hull from each segment."""
    found = [np.full(len(segments), math.inf)]
    for polygon in hull.polygons:
        found.append(nearest_on_segments(polygon, segments)[0].min(axis=0))
        ends = nearest_on_segments(segments.reshape(-1, 2), polyline(polygon, closed=True))[0]
        found.append(ends.min(axis=1).reshape(-1, 2).min(axis=1))
    found += [
        np.maximum(0.0, nearest_on_segments(np.array([disc[:2]]), segments)[0][0] - disc.radius)
        for disc in hull.discs
    ]
    shortest: FloatArray = np.min(found, axis=0)
    return shortest


def _mirror_disc(disc: Disc, mirror: FloatArray) -> Disc:
    return Disc(disc.x, disc.y * float(mirror[1]), disc.radius)


def _may_be_nearest(robots: Sequence[SceneBody], walls: FloatArray) -> BoolArray:
    """(n,) whether a wall may be the one that is nearest to the hull of a robot, by its distance from the robots' poses:
    few may, and the rest need not be compared with every corner and edge."""
    reach = np.array([_outer_radius(robot) for robot in robots])
    distance, _ = nearest_on_segments(np.array([robot.pose[:2] for robot in robots]), walls)
    limit = distance.min(axis=1) + 2.0 * reach + 1e-6
    may: BoolArray = (distance <= limit[:, None]).any(axis=0)
    return may


def _outer_radius(robot: SceneBody) -> float:
    """The distance of the hull's farthest point from the robot's pose [m]."""
    corners = (float(np.hypot(*(polygon - robot.pose[:2]).T).max()) for polygon in robot.polygons)
    rims = (math.hypot(disc.x - robot.pose.x, disc.y - robot.pose.y) + disc.radius for disc in robot.discs)
    return max((0.0, *corners, *rims))


def _nearest_point(
    points: FloatArray, segments: FloatArray, on_segment: bool
) -> tuple[float, tuple[float, float]]:
    """The shortest distance between points (p, 2) and segments (s, 4), and its end on the segment or, if not
    ``on_segment``, the point it starts from."""
    distance, foot = nearest_on_segments(points, segments)
    which = np.unravel_index(int(distance.argmin()), distance.shape)
    x, y = (foot[which] if on_segment else points[which[0]]).tolist()
    return float(distance[which]), (x, y)
