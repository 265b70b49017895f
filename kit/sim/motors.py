"""What motors make of what they are asked for: one world, once a step, so nothing here need be compiled."""

from __future__ import annotations

import math


def tricycle_twist(speed: float, steering: float, wheelbase: float) -> tuple[float, float]:
    """Forward [m/s] and turn rate [rad/s] at the rear axle of a front-driven tricycle.

    ``speed``: of the front wheel's rim; ``steering``: its angle. The front wheel's axle and the rear one
    meet in the centre of the turn (bicycle model).
    """
    return speed * math.cos(steering), speed * math.sin(steering) / wheelbase


def approach(current: float, target: float, limit: float, dt: float) -> float:
    """``current`` moved towards ``target`` by at most ``limit * dt``; all the way if ``limit`` is 0 (none)."""
    if limit <= 0.0:
        return target
    return current + min(max(target - current, -limit * dt), limit * dt)


def limited_speed(
    current: float, target: float, acceleration: float, deceleration: float, top: float, dt: float
) -> float:
    """The speed after ``dt`` of a motor asked for ``target``; a limit of 0 is none.

    Gaining speed is limited by ``acceleration``, losing it by ``deceleration``; on the way through zero the
    step is shared: first it brakes, and what is left of ``dt`` it accelerates.
    """
    if top > 0.0:
        target = min(max(target, -top), top)
    if current * target >= 0.0:
        return approach(current, target, deceleration if abs(target) < abs(current) else acceleration, dt)
    braking = abs(current) / deceleration if deceleration > 0.0 else 0.0
    if braking >= dt:
        return approach(current, 0.0, deceleration, dt)
    return approach(0.0, target, acceleration, dt - braking)
