"""Defines what differs between a robot and its simulation: noise, lost rays, late commands, slow motors, wheels that are off.

One record serves training (domain randomisation: J. Tobin et al., "Domain randomization for transferring deep neural
networks from simulation to the real world", IROS 2017), evaluation and its sweep.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, NamedTuple

from kit.plain_text import quoted, suggestion


class DisturbanceError(ValueError):
    """A disturbance is unknown, or its numbers are impossible; the message says which and what is possible."""


class UniformRange(NamedTuple):
    """A number drawn uniformly from ``low`` to ``high`` at the start of every episode; a constant where both are equal."""

    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.low:g}" if self.low == self.high else f"{self.low:g}:{self.high:g}"

    @classmethod
    def parse(cls, text: str) -> UniformRange:
        """Reads ``0.1`` or ``0:0.2``. Raises DisturbanceError for anything else.

        >>> UniformRange.parse("0:0.2")
        UniformRange(low=0.0, high=0.2)
        """
        parts = text.split(":")
        try:
            numbers = [float(part) for part in parts]
        except ValueError:
            numbers = []
        if len(numbers) not in (1, 2) or not all(map(math.isfinite, numbers)):
            raise DisturbanceError(f"{quoted(text)} is neither a number nor a range such as 0:0.2")
        if numbers[0] > numbers[-1]:
            raise DisturbanceError(f"the range {text} ends below its start: write {parts[-1]}:{parts[0]}")
        return cls(numbers[0], numbers[-1])


NONE = UniformRange(0.0, 0.0)
TURN_SHARE = 3.0
"""Slow motors change their turn by so many rad/s while their speed changes by 1 m/s."""


@dataclass(frozen=True, slots=True)
class DisturbanceKind:
    """One kind of disturbance: a field of ``Disturbances``."""

    name: str
    """The field's name, and the option's with dashes."""
    unit: str
    low: float
    high: float
    """Values that are possible."""
    summary: str
    sweep: tuple[float, ...]
    """Values that ``kit evaluate --sweep`` tries; 0 among them."""

    @property
    def option(self) -> str:
        return self.name.replace("_", "-")

    def check(self, values: UniformRange) -> None:
        """Raises DisturbanceError unless all values of the range are possible."""
        if not self.low <= values.low <= values.high <= self.high:
            unit = f" {self.unit}" if self.unit else ""
            raise DisturbanceError(
                f"{self.option} is {values}: it must be between {self.low:g} and {self.high:g}{unit}"
            )


DISTURBANCE_KINDS = (
    DisturbanceKind(
        "lidar_noise",
        unit="m",
        low=0.0,
        high=10.0,
        summary="Standard deviation of extra noise on every range, added to the lidar's own.",
        sweep=(0.0, 0.02, 0.05, 0.1, 0.2, 0.5),
    ),
    DisturbanceKind(
        "dropped_rays",
        unit="",
        low=0.0,
        high=1.0,
        summary="Share of rays in each scan that return nothing.",
        sweep=(0.0, 0.05, 0.1, 0.2, 0.4, 0.8),
    ),
    DisturbanceKind(
        "latency",
        unit="s",
        low=0.0,
        high=5.0,
        summary="Delay between a scan and the resulting command at the wheels.",
        sweep=(0.0, 0.05, 0.1, 0.2, 0.3, 0.5),
    ),
    DisturbanceKind(
        "command_jitter",
        unit="s",
        low=0.0,
        high=5.0,
        summary="Random extra delay of each command, from 0 up to this.",
        sweep=(0.0, 0.05, 0.1, 0.2, 0.3, 0.5),
    ),
    DisturbanceKind(
        "inertia",
        unit="s per m/s",
        low=0.0,
        high=100.0,
        summary="Time the motors need to gain or lose 1 m/s, or 3 rad/s, as on ice.",
        sweep=(0.0, 0.2, 0.5, 1.0, 2.0, 4.0),
    ),
    DisturbanceKind(
        "wheel_radius",
        unit="",
        low=-0.9,
        high=2.0,
        summary="Relative error of the wheel radius; at 0.1 the robot drives and turns 10 % too fast.",
        sweep=(-0.5, -0.2, -0.1, 0.0, 0.1, 0.2, 0.5),
    ),
    DisturbanceKind(
        "drift",
        unit="rad/m",
        low=-10.0,
        high=10.0,
        summary="Turn to the left per metre driven, as wheels of unequal size cause.",
        sweep=(-4.0, -2.0, -1.0, 0.0, 1.0, 2.0, 4.0),
    ),
)
"""All of them, in the order of the fields of ``Disturbances``."""


@dataclass(frozen=True, slots=True)
class Disturbances:
    """What differs between a robot and its simulation; nothing where all are zero. Each of several robots has wheels
    of its own, and its commands are late by times of their own; the rest is the same for all.

    >>> Disturbances(latency=UniformRange(0.0, 0.2)).as_dict()
    {'latency': [0.0, 0.2]}
    """

    lidar_noise: UniformRange = NONE
    """m, standard deviation, beside the lidar's own."""
    dropped_rays: UniformRange = NONE
    """Share of rays that read nothing, 0 to 1; others in every scan."""
    latency: UniformRange = NONE
    """s, by which every command is late."""
    command_jitter: UniformRange = NONE
    """s, up to which each command of each robot is late by another time, beside ``latency``."""
    inertia: UniformRange = NONE
    """s per m/s: 1 / the greatest acceleration [m/s^2]; that of turning is three times as many rad/s^2."""
    wheel_radius: UniformRange = NONE
    """Relative error: the robot moves ``1 + wheel_radius`` times as fast as it is told."""
    drift: UniformRange = NONE
    """rad/m, to the left."""

    def __post_init__(self) -> None:
        for kind in DISTURBANCE_KINDS:
            kind.check(self.range_of(kind.name))

    def __bool__(self) -> bool:
        """Whether there is any."""
        return any(self.range_of(kind.name) != NONE for kind in DISTURBANCE_KINDS)

    def __str__(self) -> str:
        """``latency 0:0.2 s, drift 0.1 rad/m``; ``none``."""
        parts = [
            f"{kind.option.replace('-', ' ')} {self.range_of(kind.name)} {kind.unit}".rstrip()
            for kind in DISTURBANCE_KINDS
            if self.range_of(kind.name) != NONE
        ]
        return ", ".join(parts) or "none"

    def range_of(self, kind: str) -> UniformRange:
        """The values of one kind, by its name."""
        values: UniformRange = getattr(self, kind)
        return values

    def changed(self, ranges: Mapping[str, UniformRange]) -> Disturbances:
        """A copy with other ranges for some kinds, by their names. Raises DisturbanceError for impossible ones."""
        return replace(self, **ranges)

    @property
    def longest_delay(self) -> float:
        """s: no command is later than that."""
        return self.latency.high + self.command_jitter.high

    def as_dict(self) -> dict[str, Any]:
        """JSON-able: the kinds that are not zero, as numbers or as pairs."""
        found = {field.name: self.range_of(field.name) for field in fields(self)}
        return {
            name: values.low if values.low == values.high else list(values)
            for name, values in found.items()
            if values != NONE
        }

    @classmethod
    def from_dict(cls, data: Any) -> Disturbances:
        """Reads what ``as_dict`` returned, or a mapping of a YAML file: numbers, pairs, or texts such as ``0:0.2``.

        Raises DisturbanceError for anything else.

        >>> Disturbances.from_dict({"latency": [0, 0.2], "drift": 0.1}).latency
        UniformRange(low=0.0, high=0.2)
        """
        if not isinstance(data, Mapping):
            raise DisturbanceError(f"disturbances must be a mapping of kinds to numbers, not {data!r}")
        names = [kind.name for kind in DISTURBANCE_KINDS]
        for name in data:
            if name not in names:
                raise DisturbanceError(
                    f"there is no disturbance {quoted(str(name))}: {suggestion(str(name), names)}"
                )
        return cls(**{name: _read_range(name, value) for name, value in data.items()})


UNDISTURBED = Disturbances()
"""Everything is as in the robots' files."""


def _read_range(name: str, value: Any) -> UniformRange:
    numbers = value if isinstance(value, list | tuple) else [value]
    if isinstance(value, str):
        return UniformRange.parse(value)
    if not 1 <= len(numbers) <= 2 or any(
        isinstance(each, bool) or not isinstance(each, int | float) for each in numbers
    ):
        raise DisturbanceError(
            f"{name} is {value!r}: it must be a number, or a pair of numbers from low to high"
        )
    return UniformRange.parse(":".join(str(float(each)) for each in numbers))
