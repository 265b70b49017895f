"""Two robots as one system: the dissertation's pair controller (sections 4.1.3.2, 4.1.3.3; tutorial 3).

Also for one robot alone, which then simply follows the force.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

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
