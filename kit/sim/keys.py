"""Keys that several devices read in the same way."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from kit.sim import motors
from kit.world.plugin_reader import Section
from kit.world.problems import quoted

_TOPIC = re.compile(r"/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*", re.ASCII)


def read_topic(section: Section, key: str, default: str) -> str:
    """A topic's name as ROS 2 wants it; under the model's namespace unless it starts with a slash."""
    name = section.name(key, default)
    if section.has(key) and not _TOPIC.fullmatch(name):
        section.error(f"{quoted(name)} is no topic name: letters, digits, _ and /, no digit after a /", key)
        return default
    return name


def read_rate(section: Section, key: str, default: float = math.inf) -> float:
    """Updates per second [Hz]; inf means at every step."""
    return section.number(key, default, minimum=0, infinite=True)


def read_variances(section: Section, key: str) -> tuple[float, ...]:
    """Three variances, by default no noise."""
    variances = section.numbers(key, (0.0, 0.0, 0.0), length=3)
    if min(variances) < 0:
        section.error(f"{quoted(key)} are variances: not below 0", key)
        return (0.0, 0.0, 0.0)
    return variances


@dataclass(frozen=True, slots=True)
class SpeedLimits:
    """What a motor can do; 0 means no limit. Linear [m/s^2, m/s] or angular [rad/s^2, rad/s]."""

    acceleration: float = 0.0
    deceleration: float = 0.0
    speed: float = 0.0

    def limited(self, current: float, target: float, dt: float) -> float:
        """The speed after ``dt`` when ``target`` is asked for."""
        return motors.limited_speed(current, target, self.acceleration, self.deceleration, self.speed, dt)


def read_limits(section: Section, key: str) -> SpeedLimits:
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
