"""Converts a world for the batch engine: walls, hulls, lidars, free floor. Refuses features it cannot represent, by name."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import permutations

import numpy as np

from kit.arrays import FloatArray, IntArray
from kit.geometry import Pose
from kit.kernels import kernels
from kit.kernels.lidar_index import make_beams, make_visibility_cells, make_wall_blocks
from kit.learning.maps.obstacles import SEEN, TOUCHED, Obstacle, ObstaclePart
from kit.learning.maps.ray_directions import RAY_COUNT, ray_direction
from kit.learning.maps.wall_culling import cull_walls
from kit.plain_text import quoted, suggestion
from kit.sim.card_world import load_card_world
from kit.sim.plugins.bumper import BumperParams
from kit.sim.plugins.diff_drive import DiffDriveParams
from kit.sim.plugins.imu import ImuParams
from kit.sim.plugins.joint_states import JointStatesParams
from kit.sim.plugins.laser import LaserParams
from kit.sim.plugins.tricycle_drive import TricycleDriveParams
from kit.sim.plugins.tween import TweenParams
from kit.world.catalogue import MapCard
from kit.world.collision_rules import footprint_contains
from kit.world.records import Body, Circle, Footprint, Layer, Model, PluginSpec, Polygon, World

FEW_WALLS = 64
"""Up to this many walls are tested one by one, because sorting out invisible ones costs more (measured)."""

MAX_ROBOTS = 4
CIRCLE_CORNERS = 24
"""A round footprint becomes a polygon around it with this many corners, at most 1 % further out."""
RAY_TOLERANCE = math.radians(2.0)
"""Largest angle between an observed direction and the lidar's nearest ray: half the angle between two directions."""
DRIVES = (DiffDriveParams, TricycleDriveParams)
"""Plugins that move a robot."""
ONLY_PUBLISH = (LaserParams, BumperParams, ImuParams, JointStatesParams)
"""Plugins that have no part in how a robot moves."""

CornerPoints = tuple[tuple[float, float], ...]


class UnsupportedWorld(ValueError):
    """The batch engine cannot represent a world; the message names the feature and where it stands."""


@dataclass(frozen=True, slots=True)
class BatchRobot:
    """Properties that all robots of a batch share."""

    hull: tuple[CornerPoints, ...]
    """Convex polygons, counter-clockwise, in the robot's frame [m]."""
    visible_parts: tuple[bool, ...]
    """Which of them the other robot's lidar sees."""
    ray_angles: tuple[float, ...]
    """Angles in the lidar's frame [rad] of the rays that agents see; of all rays where they are not all round."""
    reach: float
    noise: float
    lidar: Pose = Pose()
    """Pose of the lidar on the robot."""
    max_speed: float = math.inf
    """The motors' limit [m/s]."""
    max_turn_rate: float = math.inf
    """The motors' limit [rad/s]; of a tricycle that of its steering [rad]."""
    wheelbase: float = 0.0
    """How far a tricycle's front wheel, its origin, lies before its rear axle [m]; 0 where two wheels drive."""
    untouched: tuple[CornerPoints, ...] = ()
    """Convex polygons like the hull's that the other robot's lidar sees and that touch nothing."""
    own_ranges: tuple[float, ...] = ()
    """How far each of these rays reaches before it meets the robot itself [m]; empty where none does."""


@dataclass(frozen=True, slots=True, eq=False)
class BatchMap:
    """One map, as the batch engine sees it."""

    name: str
    walls: FloatArray
    """(n, 4) ``x1 y1 x2 y2`` [m]: touched by every robot and seen by every lidar. Those that none can ever see or
    touch are left out."""
    robot: BatchRobot
    starts: tuple[Pose, ...]
    """Poses of the robots in the world file."""
    robot_names: tuple[str, ...] = ()
    obstacles: tuple[Obstacle, ...] = ()


def load_batch_map(card: MapCard, robots: tuple[str, ...] | None = None) -> BatchMap:
    """The map's ground, for these models of its world; by default its card's robot, and partner if it has one.

    Raises UnsupportedWorld, and WorldError if its files are wrong.
    """
    driving = tuple(name for name in (card.robot, card.partner) if name) if robots is None else robots
    return _load_batch_map(card, driving)


@cache
def _load_batch_map(card: MapCard, robots: tuple[str, ...]) -> BatchMap:
    return batch_map_of_world(load_card_world(card), card.name, robots)


def batch_map_of_world(world: World, name: str, robots: Sequence[str | None]) -> BatchMap:
    """The batch map of a world whose models ``robots`` drive; None is none."""
    wanted_names = [name for name in robots if name]
    names = [model.name for model in world.models]
    for wanted in wanted_names:
        if wanted not in names:
            raise UnsupportedWorld(
                f"{world.file}: no model is named {quoted(wanted)}: {suggestion(wanted, names)}"
            )
    driving = [model for wanted in wanted_names for model in world.models if model.name == wanted]
    for model in driving:
        _drive(model)
    if not 1 <= len(driving) <= MAX_ROBOTS:
        raise UnsupportedWorld(f"{name}: training drives 1 to {MAX_ROBOTS} robots, not {len(driving)}")
    for plugin in world.plugins:
        raise UnsupportedWorld(f"{plugin.location}: training has no {plugin.type} of the whole world")
    obstacles = [
        obstacle for model in world.models if model not in driving for obstacle in _obstacles(model, driving)
    ]
    observers = [driving[number - 1] for number in range(len(driving))]
    made = [_robot(model, other, world) for model, other in zip(driving, observers, strict=True)]
    for number, other in enumerate(made[1:], start=1):
        if other != made[0]:
            raise UnsupportedWorld(f"{driving[number].location}: training needs identical robots")
    touched = [
        _wall_layers(world, footprint.mask)
        for model, other in zip(driving, observers, strict=True)
        for footprint in _hull_footprints(model, other, world)
    ]
    seen = [_wall_layers(world, _laser(model).mount.bits) for model in driving]
    for each in (*touched, *seen):
        if each != touched[0]:
            raise UnsupportedWorld(f"{world.file}: training needs walls that every robot touches and sees")
    for one, other_model in permutations(driving, 2):
        _check_pair(one, other_model, world)
    ends = [layer.walls.segments for layer in touched[0] if layer.walls is not None]
    starts = tuple(model.pose for model in driving)
    walls = cull_walls(np.concatenate([np.zeros((0, 4)), *ends]), (starts[0].x, starts[0].y))
    return BatchMap(name, walls, made[0], starts, tuple(model.name for model in driving), tuple(obstacles))


def batch_geometry(batch_maps: Sequence[BatchMap], noise: float | None = None) -> kernels.BatchGeometry:
    """All maps for the compiled loops. ``noise`` [m]: of the lidars, instead of the robots' own.

    Raises UnsupportedWorld if the robots differ.
    """
    first = batch_maps[0]
    for other in batch_maps[1:]:
        if other.robot != first.robot or len(other.starts) != len(first.starts):
            raise UnsupportedWorld(
                f"training needs identical robots: those of {first.name} and {other.name} differ"
            )
    parts = [
        make_wall_blocks(each.walls, FEW_WALLS if len(each.walls) <= FEW_WALLS else 32) for each in batch_maps
    ]
    offsets = np.cumsum([0, *(len(part.ends) for part in parts)])
    starts = [part.starts[:-1] + offset for part, offset in zip(parts, offsets[:-1], strict=True)]
    hulls, robot_of = _hulls(first.robot.hull, len(first.starts))
    boxes = [_wall_boxes(part.ends) for part in parts]
    return kernels.BatchGeometry(
        walls=kernels.WallBlocks(
            np.concatenate([part.ends for part in parts]),
            np.concatenate([*starts, offsets[-1:]]).astype(np.int64),
            np.concatenate([part.discs for part in parts]),
        ),
        wall_boxes=np.ascontiguousarray(np.concatenate(boxes, axis=1)),
        box_starts=np.cumsum([0, *(each.shape[1] for each in boxes)], dtype=np.int64),
        map_blocks=np.cumsum([0, *(len(part.starts) - 1 for part in parts)], dtype=np.int64),
        visibility=make_visibility_cells(
            each.walls if len(each.walls) <= FEW_WALLS else None for each in batch_maps
        ),
        hulls=hulls,
        lidar_bits=np.where(first.robot.visible_parts * len(first.starts), hulls.polygon_bits, 0),
        corner_robot=robot_of,
        hull_radius=float(np.hypot(*np.array([c for part in first.robot.hull for c in part]).T).max()),
        axle=first.robot.wheelbase,
        beams=make_beams(first.robot.ray_angles),
        max_range=first.robot.reach,
        own_ranges=np.array(first.robot.own_ranges, dtype=np.float32),
        noise_std=first.robot.noise if noise is None else noise,
    )


def axle_twists(commands: FloatArray, wheelbase: float) -> FloatArray:
    """(..., 2) forward [m/s] and turn [rad/s] of robots with these commands (..., 2): a tricycle's are its front wheel's speed and
    angle [rad], as in ``kit.sim.motors.tricycle_twist``; without a ``wheelbase`` the commands are twists already."""
    if not wheelbase:
        return commands
    speed, steering = commands[..., 0], commands[..., 1]
    return np.stack([speed * np.cos(steering), speed * np.sin(steering) / wheelbase], axis=-1)


def geometry_for_scans(
    geometry: kernels.BatchGeometry, robot: BatchRobot, robots: int
) -> kernels.BatchGeometry:
    """The geometry for scans, where a robot's pose is that of its lidar: the hulls are given in the lidar's frame, and what is
    seen without being touched is one of them."""
    lidar = robot.lidar
    if lidar == Pose() and not robot.untouched:
        return geometry
    parts = robot.hull + robot.untouched
    hulls, robot_of = _hulls(parts, robots)
    is_seen = (robot.visible_parts + (True,) * len(robot.untouched)) * robots
    cos, sin = math.cos(lidar.theta), math.sin(lidar.theta)
    corners = (hulls.corners - (lidar.x, lidar.y)) @ np.array([[cos, -sin], [sin, cos]])
    return geometry._replace(
        hulls=hulls._replace(corners=corners),
        lidar_bits=np.where(is_seen, hulls.polygon_bits, 0),
        corner_robot=robot_of,
        hull_radius=float(np.hypot(*corners.T).max()),
    )


def _wall_boxes(walls: FloatArray) -> FloatArray:
    """(4, boxes) ``x1 y1 x2 y2`` of the boxes around walls (n, 4), and some infinitely far away, to a multiple of 8."""
    boxes = np.full((4, -(-len(walls) // 8) * 8), np.inf)
    boxes[:2, : len(walls)] = np.minimum(walls[:, :2], walls[:, 2:]).T
    boxes[2:, : len(walls)] = np.maximum(walls[:, :2], walls[:, 2:]).T
    return boxes


def _hulls(polygons: tuple[CornerPoints, ...], robots: int) -> tuple[kernels.Shapes, IntArray]:
    """Every robot's ``polygons`` in its own frame, and whose each corner is."""
    sizes = [len(polygon) for polygon in polygons]
    corners = np.array([corner for polygon in polygons for corner in polygon])
    nothing = np.zeros(0, dtype=np.int64)
    shapes = kernels.Shapes(
        circles=np.zeros((0, 3)),
        circle_bits=nothing,
        corners=np.tile(corners, (robots, 1)),
        starts=np.cumsum([0, *(sizes * robots)], dtype=np.int64),
        polygon_bits=np.repeat(1 << np.arange(robots, dtype=np.int64), len(sizes)),
    )
    return shapes, np.repeat(np.arange(robots, dtype=np.int64), len(corners))


def _obstacles(model: Model, driving: Sequence[Model]) -> Iterator[Obstacle]:
    """The bodies of a model that does not drive: those that robots may touch or see, or that move."""
    motions = {}
    for plugin in model.plugins:
        if isinstance(plugin.params, TweenParams):
            if plugin.params.progress is None:
                raise UnsupportedWorld(f"{plugin.location}: training has no Tween with a trigger")
            motions[plugin.params.body] = plugin.params
    for body in model.bodies:
        if body.kind == "dynamic":
            raise UnsupportedWorld(_why_not_dynamic(body, is_moved=body.name in motions))
        parts = tuple(part for footprint in body.footprints for part in _obstacle_parts(footprint, driving))
        motion = motions.get(body.name)
        if parts or motion is not None:
            if model.joints:
                raise UnsupportedWorld(f"{model.joints[0].location}: training has no joints")
            yield Obstacle(model.name, model.pose.compose(body.pose), parts, motion)


def _why_not_dynamic(body: Body, *, is_moved: bool) -> str:
    """What a body lacks that is neither a robot nor fixed."""
    if is_moved:
        return (
            f'{body.location}: a Tween moves the body {body.name}, which also lacks the line "type: kinematic": in training '
            "nothing else may push it"
        )
    return (
        f"{body.location}: nothing drives the body {body.name}, and in training only robots can be pushed. Give it "
        '"type: static" if it stands, or "type: kinematic" and a Tween that moves it'
    )


def _obstacle_parts(footprint: Footprint, driving: Sequence[Model]) -> Iterator[ObstaclePart]:
    hulls = [each for model in driving for each in _body(model).footprints]
    touched = {bool(footprint.mask & each.mask) and not footprint.sensor for each in hulls}
    seen = {bool(footprint.category & _laser(model).mount.bits) for model in driving}
    if len(touched) > 1 or len(seen) > 1:
        raise UnsupportedWorld(
            f"{footprint.location}: training needs obstacles that all parts of all robots touch, or none, "
            "and that all their lidars see or none"
        )
    bits = TOUCHED * touched.pop() | SEEN * seen.pop()
    if bits:
        yield ObstaclePart(footprint.shape, bits)


def _body(model: Model) -> Body:
    """A robot's only body, or a tricycle's, whose wheels touch nothing and are seen by nobody."""
    _, drive = _drive(model)
    beside = [each for each in model.bodies if each.name != drive.body]
    if isinstance(drive, TricycleDriveParams):
        for footprint in (part for wheel in beside for part in wheel.footprints):
            if footprint.mask or footprint.category:
                raise UnsupportedWorld(
                    f"{footprint.location}: in training a tricycle's wheels touch nothing: give this one no layers"
                )
    elif beside or model.joints:
        what = model.joints[0] if model.joints else beside[0]
        raise UnsupportedWorld(f"{what.location}: training has no joints, and one body per robot")
    return next(each for each in model.bodies if each.name == drive.body)


def _laser(model: Model) -> LaserParams:
    lasers = [plugin.params for plugin in model.plugins if isinstance(plugin.params, LaserParams)]
    if len(lasers) != 1:
        raise UnsupportedWorld(f"{model.location}: training needs a robot with one Laser, not {len(lasers)}")
    return lasers[0]


def _drive(model: Model) -> tuple[PluginSpec, DiffDriveParams | TricycleDriveParams]:
    for plugin in model.plugins:
        if not isinstance(plugin.params, (*DRIVES, *ONLY_PUBLISH)):
            raise UnsupportedWorld(
                f"{plugin.location}: training has no {plugin.type}; robots that it drives have a DiffDrive or a TricycleDrive"
            )
    drives = [(each, each.params) for each in model.plugins if isinstance(each.params, DRIVES)]
    if len(drives) != 1:
        raise UnsupportedWorld(
            f"{model.location}: training needs a robot with one DiffDrive or TricycleDrive, not {len(drives)}"
        )
    return drives[0]


def _hull_footprints(model: Model, observer: Model, world: World) -> tuple[Footprint, ...]:
    """The footprints that walls stop: without parts that a lidar looks at, the robot's own or its ``observer``'s, and that pass through
    every wall."""
    footprints, sight = _body(model).footprints, _laser(model).mount.bits | _laser(observer).mount.bits
    return tuple(each for each in footprints if _wall_layers(world, each.mask) or not each.category & sight)


def _robot(model: Model, observer: Model, world: World) -> BatchRobot:
    """``observer``: the robot whose lidar may see it."""
    body, laser = _body(model), _laser(model)
    if body.kind != "dynamic" or body.pose != Pose():
        raise UnsupportedWorld(f"{body.location}: training needs a dynamic body at the origin of its model")
    hull = _hull_footprints(model, observer, world)
    # A lidar does not see a part in which it stands.
    blocking = [
        footprint
        for footprint in body.footprints
        if footprint.category & laser.mount.bits and not footprint_contains(footprint, laser.mount.origin)
    ]
    plugin, drive = _drive(model)
    if isinstance(drive, TricycleDriveParams):
        turning, largest, wheelbase = drive.steering, drive.max_steering, drive.wheelbase
        if turning.speed > 0.0:
            raise UnsupportedWorld(f"{plugin.location}: in training a tricycle's wheel is steered at once")
    else:
        turning, largest, wheelbase = drive.angular, drive.angular.speed, 0.0
    for limits in (drive.linear, turning):
        if limits.acceleration > 0.0 or limits.deceleration > 0.0:
            raise UnsupportedWorld(f"{plugin.location}: in training motors have no acceleration limits")
    if drive.veer:
        raise UnsupportedWorld(f"{plugin.location}: in training robots do not veer")
    sight = _laser(observer).mount.bits
    untouched = [each for each in body.footprints if each not in hull and each.category & sight]
    return BatchRobot(
        hull=tuple(_polygons(hull)),
        visible_parts=tuple(bool(footprint.category & sight) for footprint in hull),
        untouched=tuple(_polygons(untouched)) if observer is not model else (),
        ray_angles=_agent_rays(laser),
        reach=laser.max_range,
        noise=laser.noise,
        lidar=laser.mount.origin,
        max_speed=drive.linear.speed or math.inf,  # 0 is no limit
        max_turn_rate=largest or math.inf,
        wheelbase=wheelbase,
        own_ranges=_own_ranges(blocking, laser),
    )


def _own_ranges(blocking: Sequence[Footprint], laser: LaserParams) -> tuple[float, ...]:
    """How far each ray that agents see reaches before it meets one of these parts; empty without any."""
    if not blocking:
        return ()
    mount, nearest = laser.mount.origin, []
    cos, sin = math.cos(mount.theta), math.sin(mount.theta)
    seen = [
        [
            (cos * (x - mount.x) + sin * (y - mount.y), cos * (y - mount.y) - sin * (x - mount.x))
            for x, y in each
        ]
        for each in _polygons(blocking)
    ]
    edges = [
        (one, other)
        for polygon in seen
        for one, other in zip(polygon, (*polygon[1:], polygon[0]), strict=True)
    ]
    for angle in _agent_rays(laser):
        dx, dy = math.cos(angle), math.sin(angle)
        nearest.append(min((_ray_range(dx, dy, *one, *other) for one, other in edges), default=math.inf))
    return tuple(nearest)


def _ray_range(dx: float, dy: float, ax: float, ay: float, bx: float, by: float) -> float:
    """How far a ray from the origin reaches before it meets the line from (ax, ay) to (bx, by); infinite if it does not."""
    ex, ey = bx - ax, by - ay
    across = dx * ey - dy * ex
    if across == 0.0:
        return math.inf
    along, share = (ax * ey - ay * ex) / across, (ax * dy - ay * dx) / across
    return along if along >= 0.0 and 0.0 <= share <= 1.0 else math.inf


def _agent_rays(laser: LaserParams) -> tuple[float, ...]:
    """The directions of the rays that agents see: of a lidar with more rays, all round, the nearest to theirs; else all."""
    wanted = [ray_direction(ray) for ray in range(RAY_COUNT)]
    directions, turned = np.array(laser.directions), laser.mount.origin.theta
    apart = np.angle(np.exp(1j * (directions + turned - np.array(wanted)[:, None])))
    nearest = np.abs(apart).argmin(axis=1)
    off = apart[range(RAY_COUNT), nearest]
    if (len(directions) == RAY_COUNT and turned == 0.0) or np.abs(off).max() > RAY_TOLERANCE:
        return laser.directions
    return tuple((wanted + off - turned).tolist())  # in turn, as agents count them


def _polygons(footprints: Sequence[Footprint]) -> Iterator[CornerPoints]:
    for footprint in footprints:
        if footprint.sensor or not footprint.mask:
            raise UnsupportedWorld(f"{footprint.location}: training needs all footprints to collide")
        if isinstance(footprint.shape, Polygon):
            yield footprint.shape.points
        else:
            yield _polygon_around(footprint.shape)


def _polygon_around(circle: Circle) -> CornerPoints:
    (x, y), step = circle.center, math.tau / CIRCLE_CORNERS
    radius = circle.radius / math.cos(step / 2)
    return tuple(
        (x + radius * math.cos(k * step), y + radius * math.sin(k * step)) for k in range(CIRCLE_CORNERS)
    )


def _wall_layers(world: World, bits: int) -> tuple[Layer, ...]:
    return tuple(layer for layer in world.layers if layer.walls is not None and layer.bits & bits)


def _check_pair(one: Model, other: Model, world: World) -> None:
    """Every part of one's hull touches every part of the other's, and no part beside them; and it sees some of the other."""
    mine, theirs = _hull_footprints(one, other, world), _hull_footprints(other, one, world)
    for each in mine:
        for part in theirs:
            if not each.mask & part.mask:
                raise UnsupportedWorld(
                    f"{part.location}: {one.name} and {other.name} must touch in training, and these parts of them share no "
                    f'layer: add one of {_layer_names(world, each.mask)} to "layers" here'
                )
    beside = [part for part in _body(other).footprints if part not in theirs]
    for part in beside:
        if any(each.mask & part.mask for each in _body(one).footprints):
            raise UnsupportedWorld(
                f"{part.location}: {one.name} touches a part of {other.name} that passes through walls: in training robots "
                "touch what walls stop"
            )
    sight = _laser(one).mount.bits
    if not any(sight & part.category for part in _body(other).footprints):
        raise UnsupportedWorld(
            f"{_body(other).footprints[0].location}: {one.name} does not see {other.name}, which it must in training: its "
            f'laser looks at {_layer_names(world, sight)}: add that to "layers" of a footprint here'
        )


def _layer_names(world: World, bits: int) -> str:
    """``solid, seen``"""
    return ", ".join(layer.name for layer in world.layers if layer.bits & bits)
