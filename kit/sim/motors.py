"""Speed and acceleration limits of drive motors; one call per motor and step, so none of it is compiled."""

from __future__ import annotations

import math
from dataclasses import dataclass

from kit.world.yaml_section import Section


def tricycle_twist(speed: float, steering: float, wheelbase: float) -> tuple[float, float]:
    """Forward [m/s] and turn rate [rad/s] at the rear axle of a front-driven tricycle.

    ``speed``: of the front wheel's rim; ``steering``: its angle. The front wheel's axle and the rear one
    meet in the centre of the turn (bicycle model).
    """
    return speed * math.cos(steering), speed * math.sin(steering) / wheelbase


def move_towards(current: float, target: float, limit: float, dt: float) -> float:
    """``current`` moved towards ``target`` by at most ``limit * dt``; all the way if ``limit`` is 0 (none)."""
    if limit <= 0.0:
        return target
    return current + min(max(target - current, -limit * dt), limit * dt)


def limited_speed(
    current: float, target: float, acceleration: float, deceleration: float, max_speed: float, dt: float
) -> float:
    """The speed after ``dt`` of a motor asked for ``target``; a limit of 0 is none.

    Gaining speed is limited by ``acceleration``, losing it by ``deceleration``; on the way through zero the
    step is shared: first it brakes, and what is left of ``dt`` it accelerates.
    """
    if max_speed > 0.0:
        target = min(max(target, -max_speed), max_speed)
    if current * target >= 0.0:
        return move_towards(current, target, deceleration if abs(target) < abs(current) else acceleration, dt)
    braking = abs(current) / deceleration if deceleration > 0.0 else 0.0
    if braking >= dt:
        return move_towards(current, 0.0, deceleration, dt)
    return move_towards(0.0, target, acceleration, dt - braking)


@dataclass(frozen=True, slots=True)
class SpeedLimits:
    """Limits of a motor; 0 means no limit. Linear [m/s^2, m/s] or angular [rad/s^2, rad/s]."""

    acceleration: float = 0.0
    deceleration: float = 0.0
    speed: float = 0.0

    @property
    def is_unlimited(self) -> bool:
        """True if there is no limit at all."""
        return self.acceleration <= 0.0 and self.deceleration <= 0.0 and self.speed <= 0.0

    def limited_speed(self, current: float, target: float, dt: float) -> float:
        """The speed after ``dt`` when ``target`` is asked for."""
        if self.is_unlimited:
            return target
        return limited_speed(current, target, self.acceleration, self.deceleration, self.speed, dt)


def read_speed_limits(section: Section, key: str) -> SpeedLimits:
    """A mapping of limits; without one, none. Deceleration is limited like acceleration if not said otherwise."""
    limits = section.section(key, None)
    if limits is None:
        return SpeedLimits()
    acceleration = limits.number("acceleration_limit", 0.0, minimum=0)
    read = SpeedLimits(
        acceleration,
        limits.number("deceleration_limit", acceleration, minimum=0),
        limits.number("velocity_limit", 0.0, minimum=0),
    )
    limits.finish()
    return read
