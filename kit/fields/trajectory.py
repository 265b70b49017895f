"""Plans how two robots, side by side, or one alone follow a path or the forces of a field, within limits of comfort.

A ride keeps limits of speed, acceleration, turning and jerk. By the forces it is the dissertation's pair controller
(sections 4.1.3.2, 4.1.3.3; tutorial 3); one robot alone then simply follows the force.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from kit.arrays import FloatArray
from kit.fields.charges import PointCharge, TensionPoint
from kit.fields.layout import ChargeLayout
from kit.geometry import Pose, wrap_angle

Vector = tuple[float, float]


@dataclass(frozen=True, slots=True)
class PairSettings:
    """The dissertation's values (tutorial 3)."""

    speed: float = 0.3
    """m/s: of the robot that the stronger force acts on."""
    turn_rate: float = 1.0
    """rad/s, at most."""
    turn_gain: float = 5.0
    """1/s: of the heading's error, the turn rate."""
    tolerance: float = 0.02
    """rad: a robot that is so far off or less faces the right way."""
    gap: float = 0.3
    """m: from one robot to the other, side by side."""
    reach: float = 0.3
    """m: how far ahead of the middle the middle should be, at most."""


class VelocityCommand(NamedTuple):
    """m/s and rad/s."""

    linear: float
    angular: float


@dataclass(frozen=True, slots=True)
class PairControl:
    """One step of the pair controller with its intermediate results."""

    middle: Vector
    middle_force: Vector
    """N: of the walls and the target, on the middle."""
    targets: tuple[Vector, ...]
    """Where each robot should be."""
    forces: tuple[Vector, ...]
    """N: on each robot."""
    commands: tuple[VelocityCommand, ...]


def control_step(
    poses: Sequence[Pose], target: Vector, layout: ChargeLayout, settings: PairSettings = PairSettings()
) -> PairControl:
    """One step of the controller for the left and the right robot, or for one alone."""
    middle = (
        math.fsum(pose.x for pose in poses) / len(poses),
        math.fsum(pose.y for pose in poses) / len(poses),
    )
    force = _as_vector(layout.forces(middle, target))
    if len(poses) == 1:
        return PairControl(middle, force, (target,), (force,), drive_commands(poses, (force,), settings))
    targets = _robot_targets(middle, force, settings)
    walls = layout.wall_forces([pose[:2] for pose in poses])
    forces = []
    for number, pose in enumerate(poses):
        other = poses[1 - number]
        tension = TensionPoint(*targets[number], layout.intensities.tension).force(pose[:2])
        push = PointCharge(other.x, other.y, layout.intensities.robot).force(pose[:2])
        forces.append(_as_vector(walls[number] + tension + push))
    return PairControl(middle, force, targets, tuple(forces), drive_commands(poses, forces, settings))


def drive_commands(
    poses: Sequence[Pose], forces: Sequence[Vector], settings: PairSettings
) -> tuple[VelocityCommand, ...]:
    """Turn first, then drive: no robot drives before all face along their forces. The stronger force drives at full
    speed, the other in proportion (equations 4.14, 4.15)."""
    errors = [
        wrap_angle(math.atan2(force[1], force[0]) - pose.theta)
        for pose, force in zip(poses, forces, strict=True)
    ]
    if any(abs(error) > settings.tolerance for error in errors):
        turns = [settings.turn_gain * error if abs(error) > settings.tolerance else 0.0 for error in errors]
        most = settings.turn_rate
        return tuple(VelocityCommand(0.0, min(max(turn, -most), most)) for turn in turns)
    strengths = [math.hypot(*force) for force in forces]
    strongest = max(strengths)
    if strongest == 0.0:
        return tuple(VelocityCommand(0.0, 0.0) for _ in poses)
    return tuple(VelocityCommand(settings.speed * strength / strongest, 0.0) for strength in strengths)


def _robot_targets(middle: Vector, force: Vector, settings: PairSettings) -> tuple[Vector, Vector]:
    """Left and right of a point ahead of the middle, along the force."""
    strength = math.hypot(*force)
    ahead = (force[0] / strength, force[1] / strength) if strength else (0.0, 0.0)
    way = min(strength, settings.reach)
    x, y = middle[0] + way * ahead[0], middle[1] + way * ahead[1]
    aside = -ahead[1] * settings.gap / 2, ahead[0] * settings.gap / 2
    return (x + aside[0], y + aside[1]), (x - aside[0], y - aside[1])


def _as_vector(force: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> Vector:
    return float(force[0]), float(force[1])


STEP_S: Final = 0.1
"""s: as often as odometry comes."""
ALIGNMENT_TOLERANCE: Final = 0.05
"""A robot no farther off its place [m] and heading [rad] need not line up first."""


@dataclass(frozen=True, slots=True)
class ComfortLimits:
    """Limits of a comfortable ride, for a chair a quarter as large as a real one."""

    speed: float = 0.3
    """m/s: of the faster robot; the dissertation's."""
    acceleration: float = 0.2
    """m/s^2: of the faster robot."""
    smoothing_time: float = 0.8
    """s: an acceleration comes and goes over this long: jerk stays below 2 * acceleration / easing where the way is
    straight, and below twice that where two robots take a bend."""
    turn_rate: float = 0.8
    """rad/s"""
    turn_acceleration: float = 1.0
    """rad/s^2"""
    lateral_acceleration: float = 0.15
    """m/s^2, towards the outside of a bend."""


@dataclass(frozen=True, slots=True)
class TrackingGains:
    """Gains of the tracking controller (Kanayama and others, IROS 1990, equation 11)."""

    along: float = 1.0
    """1/s"""
    aside: float = 12.0
    """rad/m^2"""
    heading: float = 2.0
    """1/s"""
    wait_distance: float = 0.1
    """A robot farther [m] from its place makes all wait for it."""


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """The pose that each robot should have at every tick."""

    poses: FloatArray
    """(ticks, robots, 3) ``x y theta``"""

    @property
    def seconds(self) -> float:
        return (len(self.poses) - 1) * STEP_S

    def tracks(self) -> tuple[FloatArray, ...]:
        """One (ticks, 2) for each robot."""
        return tuple(self.poses[:, robot, :2] for robot in range(self.poses.shape[1]))


class TrajectoryTracker:
    """Keeps robots on a trajectory. Its clock waits for every robot that is behind its place."""

    def __init__(self, ride: Trajectory, gains: TrackingGains = TrackingGains()) -> None:
        self._ride = ride
        self._gains = gains
        self.tick = 0

    @property
    def is_done(self) -> bool:
        return self.tick >= len(self._ride.poses) - 1

    def commands(self, poses: Sequence[Pose]) -> tuple[VelocityCommand, ...]:
        """Returns the commands for the tick that begins now, from the robots' poses."""
        here = [Pose(*place) for place in self._ride.poses[self.tick].tolist()]
        late = max(math.dist(pose[:2], place[:2]) for pose, place in zip(poses, here, strict=True))
        moves = not self.is_done and late <= self._gains.wait_distance
        there = [Pose(*place) for place in self._ride.poses[self.tick + 1].tolist()] if moves else here
        self.tick += moves
        return tuple(self._command(pose, *places) for pose, *places in zip(poses, here, there, strict=True))

    def _command(self, pose: Pose, here: Pose, there: Pose) -> VelocityCommand:
        forward, turn = twist_between(here, there, STEP_S)
        error = pose.relative(here)
        heading = wrap_angle(error.theta)
        gains = self._gains
        return VelocityCommand(
            forward * math.cos(heading) + gains.along * error.x,
            turn + gains.aside * forward * error.y + gains.heading * math.sin(heading),
        )


def plan_trajectory(
    way: FloatArray, robots: Sequence[Pose], gap: float, limits: ComfortLimits = ComfortLimits()
) -> Trajectory:
    """Along a way (k, 2), one robot on it or two beside it, the left one first, ``gap`` [m] apart.

    Robots that do not stand where it begins, or do not face along it, first turn and drive there, one turn, one
    straight, one turn.
    """
    offsets = [0.0] if len(robots) == 1 else [gap / 2, -gap / 2]
    middle = _time_path(way, max(offsets), limits)
    together = np.stack([_offset_path(middle, offset) for offset in offsets], axis=1)
    first = [Pose(*place) for place in together[0].tolist()]
    lines = [_line_up(robot, place, limits) for robot, place in zip(robots, first, strict=True)]
    longest = max(map(len, lines))
    if longest == 1:
        return Trajectory(together)
    lined = np.stack(
        [np.concatenate([line, np.repeat(line[-1:], longest - len(line), axis=0)]) for line in lines], axis=1
    )
    return Trajectory(np.concatenate((lined, together[1:])))


def _time_path(way: FloatArray, aside: float, limits: ComfortLimits) -> FloatArray:
    """(ticks, 3): poses along the way at each tick, for something that reaches ``aside`` [m] to both sides."""
    steps = np.diff(way, axis=0)
    along = np.concatenate(([0.0], np.cumsum(np.hypot(steps[:, 0], steps[:, 1]))))
    turned = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    middles = 0.5 * (along[1:] + along[:-1])
    heading = np.interp(along, middles, turned)
    bend = np.gradient(heading, along)
    change = np.abs(np.gradient(bend, along))
    wider = 1.0 + np.abs(bend) * aside
    small = 1e-6
    speed = np.minimum.reduce(
        [
            limits.speed / wider,
            limits.turn_rate / (np.abs(bend) + small),
            np.sqrt(limits.lateral_acceleration / (np.abs(bend) + small)),
            np.sqrt(limits.turn_acceleration / (change + small)),
        ]
    )
    speeds = _limit_acceleration(along, speed, limits.acceleration / wider)
    at = _smooth_speed(along, speeds, limits.smoothing_time)
    return np.column_stack([np.interp(at, along, values) for values in (way[:, 0], way[:, 1], heading)])


def _limit_acceleration(along: FloatArray, most: FloatArray, acceleration: FloatArray) -> FloatArray:
    """Speeds that begin and end at rest, below ``most``, and change by no more than the acceleration allows."""
    speeds: list[float] = most.tolist()
    speeds[0] = speeds[-1] = 0.0
    steps = list(pairwise(range(len(speeds))))
    for order in (steps, [(after, before) for before, after in reversed(steps)]):
        for one, other in order:
            reach = 2 * float(acceleration[one]) * abs(float(along[other] - along[one]))
            speeds[other] = min(speeds[other], math.sqrt(speeds[one] ** 2 + reach))
    return np.array(speeds)


def _smooth_speed(along: FloatArray, speeds: FloatArray, smoothing_time: float) -> FloatArray:
    """Computes how far along the way one is at each tick. Speed over time is averaged over ``smoothing_time``, which leaves the way as
    long as it is and takes the corners off the acceleration."""
    length = np.diff(along)
    mean = np.maximum(0.5 * (speeds[1:] + speeds[:-1]), 1e-3)
    times = np.concatenate(([0.0], np.cumsum(length / mean)))
    window = max(1, round(smoothing_time / STEP_S))
    ticks = np.arange(0.0, times[-1] + STEP_S, STEP_S)
    at = np.interp(ticks, times, along)
    padded = np.concatenate((np.zeros(window), at, np.full(window, along[-1])))
    return np.convolve(padded, np.ones(window) / window, mode="valid")


def _offset_path(middle: FloatArray, offset: float) -> FloatArray:
    """(ticks, 3): to the left of the way by ``offset`` [m]."""
    x, y, theta = middle.T
    return np.column_stack((x - offset * np.sin(theta), y + offset * np.cos(theta), theta))


def _line_up(robot: Pose, place: Pose, limits: ComfortLimits) -> FloatArray:
    """(ticks, 3): a turn, a straight, a turn; one row alone where none is needed."""
    poses = [tuple(robot)]
    away = math.dist(robot[:2], place[:2])
    heading = robot.theta
    if away > ALIGNMENT_TOLERANCE:
        towards = math.atan2(place.y - robot.y, place.x - robot.x)
        poses += _turn_on_spot(poses[-1], towards, limits)
        x, y, heading = poses[-1]
        for way in _rest_to_rest(away, limits.speed, limits.acceleration, limits.smoothing_time):
            poses.append((x + way * math.cos(towards), y + way * math.sin(towards), heading))
    if abs(wrap_angle(place.theta - heading)) > ALIGNMENT_TOLERANCE:
        poses += _turn_on_spot(poses[-1], place.theta, limits)
    return np.array(poses)


def _turn_on_spot(pose: tuple[float, ...], to: float, limits: ComfortLimits) -> list[tuple[float, ...]]:
    """Turns on the spot to a heading."""
    x, y, theta = pose
    angle = wrap_angle(to - theta)
    sign = math.copysign(1.0, angle)
    turns = _rest_to_rest(abs(angle), limits.turn_rate, limits.turn_acceleration, limits.smoothing_time)
    return [(x, y, theta + sign * turn) for turn in turns]


def _rest_to_rest(length: float, speed: float, acceleration: float, smoothing_time: float) -> list[float]:
    """Distances [m or rad] at each tick after the first, from rest to rest."""
    along = np.linspace(0.0, length, 50)
    speeds = _limit_acceleration(along, np.full(50, speed), np.full(50, acceleration))
    return [float(way) for way in _smooth_speed(along, speeds, smoothing_time)[1:]]


def twist_between(here: Pose, there: Pose, seconds: float) -> VelocityCommand:
    """The constant twist that leads from one pose to the other, or nearly: along the arc over their chord."""
    step = here.relative(there)
    half = 0.5 * wrap_angle(step.theta)
    stretch = half / math.sin(half) if abs(half) > 1e-9 else 1.0
    return VelocityCommand(
        math.copysign(math.hypot(step.x, step.y), step.x) * stretch / seconds, 2.0 * half / seconds
    )
