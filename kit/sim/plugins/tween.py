"""A body that moves back and forth by itself."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import Any

from kit.geometry import Pose
from kit.msg.std_msgs import Bool
from kit.sim.plugin import OutgoingMessage, Plugin, PluginContext, PluginType
from kit.sim.plugin_messages import read_topic
from kit.world.plugin_reader import ModelScope
from kit.world.yaml_section import Section

Easing = Callable[[float], float]
"""Maps the elapsed fraction of the time, 0 to 1, to the fraction of the distance: 0 at 0 and 1 at 1. A function of a module, or a
partial one, so that a world can be pickled."""


def _power_easing(exponent: int, t: float) -> float:
    return float(t**exponent)


def _linear(t: float) -> float:
    return t


def _exponential(t: float) -> float:
    return 0.0 if t == 0.0 else float(2.0 ** (10.0 * (t - 1.0)))


def _circular(t: float) -> float:
    return 1.0 - math.sqrt(1.0 - t * t)


def _back_easing(t: float) -> float:
    """Moves back by a tenth of the distance first."""
    return t * t * (2.70158 * t - 1.70158)


def _elastic_easing(t: float) -> float:
    """A spring that swings, with growing swings and a period of 0.3."""
    return t if t in (0.0, 1.0) else -(2.0 ** (10.0 * (t - 1.0))) * math.sin((t - 1.075) * math.tau / 0.3)


def _bouncing_ball(t: float) -> float:
    """A ball that falls to 1 and bounces three times: parabolas, each half as wide as the one before."""
    bottoms = ((0.0, 0.0), (1.5, 0.75), (2.25, 0.9375), (2.625, 0.984375))
    return min(7.5625 * (t - middle / 2.75) ** 2 + height for middle, height in bottoms)


def _ease_in(curve: Easing, t: float) -> float:
    return curve(t)


def _ease_out(curve: Easing, t: float) -> float:
    """Reversed in time: slow at the end."""
    return 1.0 - curve(1.0 - t)


def _ease_in_out(curve: Easing, t: float) -> float:
    """Half of it, and half of it backwards."""
    return 0.5 * curve(2.0 * t) if t < 0.5 else 1.0 - 0.5 * curve(2.0 - 2.0 * t)


_EASING_CURVES: Mapping[str, Easing] = {
    "quadratic": partial(_power_easing, 2),
    "cubic": partial(_power_easing, 3),
    "quartic": partial(_power_easing, 4),
    "quintic": partial(_power_easing, 5),
    "exponential": _exponential,
    "circular": _circular,
    "back": _back_easing,
    "elastic": _elastic_easing,
    "bounce": partial(_ease_out, _bouncing_ball),
}
_EASING_KINDS = {"In": _ease_in, "Out": _ease_out, "InOut": _ease_in_out}

EASINGS: Mapping[str, Easing] = MappingProxyType(
    {"linear": _linear}
    | {
        f"{name}{end}": partial(shaped, curve)
        for name, curve in _EASING_CURVES.items()
        for end, shaped in _EASING_KINDS.items()
    }
)

ProgressCurve = Callable[[float], float]
"""Maps time / duration to the elapsed fraction of the time, 0 to 1."""


def _once(turns: float) -> float:
    return min(turns, 1.0)


def _loop(turns: float) -> float:
    """Jumps back to the start after the end, which it reaches."""
    return turns - math.ceil(turns) + 1.0 if turns > 0.0 else 0.0


def _yoyo(turns: float) -> float:
    return 1.0 - abs(turns % 2.0 - 1.0)


MODES: Mapping[str, ProgressCurve | None] = MappingProxyType(
    {"yoyo": _yoyo, "loop": _loop, "once": _once, "trigger": None}
)
"""None: driven to and fro by messages."""


@dataclass(frozen=True, slots=True)
class TweenParams:
    body: str
    progress: ProgressCurve | None
    duration: float
    delta: Pose
    easing: Easing
    trigger_topic: str

    def build(self, context: PluginContext) -> Tween:
        return Tween(self, context)


def read_params(section: Section, scope: ModelScope) -> TweenParams:
    progress = section.choice("mode", MODES, "yoyo")
    trigger_topic = read_topic(section, "trigger_topic", "")
    if progress is None and not trigger_topic:
        section.error('mode: trigger needs a "trigger_topic"', "mode")
    return TweenParams(
        body=scope.body(section, "body"),
        progress=progress,
        duration=section.number("duration", 1.0, above=0),
        delta=section.pose("delta", Pose()),
        easing=section.choice("easing", EASINGS, "linear"),
        trigger_topic=trigger_topic,
    )


class Tween(Plugin):
    """Puts a body, before every step, at a place between where it stood and ``delta`` from there.

    ============= ==============================================================================================
    body          the body it moves
    mode          ``yoyo`` to and fro, ``loop`` always from the start, ``once``, or ``trigger``: forward after a
                  true on the trigger topic, back after a false
    duration      of one way [s]
    delta         where it goes from where it stood, along the world's axes [m, m, rad]
    easing        how it speeds up and slows down: ``quadraticInOut``
    trigger_topic a topic of std_msgs/Bool, which ``mode: trigger`` needs
    ============= ==============================================================================================

    The body passes through everything. In Flatland it does not obey ``move_model`` and stands still at
    steps below a millisecond; here it goes on from where it was put, at steps of any length.
    """

    def __init__(self, params: TweenParams, context: PluginContext) -> None:
        self._params = params
        self._physics = context.physics
        self._body = context.bodies[params.body]
        self._start = self._body.pose
        if params.trigger_topic:
            self.endpoints = [context.subscription(params.trigger_topic, Bool)]

    def reset(self, seed: int) -> None:
        self._steps = 0
        self._time_fraction = 0.0
        self._is_forward = False

    def moved(self) -> None:
        pose, displacement = self._body.pose, self._displacement()
        self._start = Pose(pose.x - displacement.x, pose.y - displacement.y, pose.theta - displacement.theta)

    def accept(self, topic: str, message: Any) -> None:
        self._is_forward = message.data

    def before_step(self, dt: float) -> Iterable[OutgoingMessage]:
        self._steps += 1
        part = dt / self._params.duration
        if self._params.progress is not None:
            self._time_fraction = self._params.progress(self._steps * part)
        else:
            self._time_fraction = (
                min(self._time_fraction + part, 1.0)
                if self._is_forward
                else max(self._time_fraction - part, 0.0)
            )
        displacement = self._displacement()
        self._physics.hold(
            self._body,
            Pose(
                self._start.x + displacement.x,
                self._start.y + displacement.y,
                self._start.theta + displacement.theta,
            ),
        )
        return ()

    def _displacement(self) -> Pose:
        """Returns the present displacement from the start."""
        fraction = self._params.easing(self._time_fraction)
        return Pose(*(fraction * component for component in self._params.delta))


PLUGIN_TYPE = PluginType("Tween", Tween, read_params, example="body: base")
