"""The contract between the simulation and a plugin: what it is built with, its clock, random streams, topics and messages.

A plugin is one file of ``kit/sim/plugins/``: a frozen record of parameters with ``build(context)``, the plugin that this
builds, and a ``PLUGIN_TYPE`` that says under which type world files know it and how its parameters are read. It never
touches the graph: it *returns* messages and *accepts* messages, and the runner of the simulation delivers them.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import blake2b
from typing import Any, Literal, NamedTuple, Protocol, TypeAlias

from kit.geometry import Pose
from kit.kernels import kernels
from kit.msg import geometry_msgs
from kit.msg.builtin_interfaces import Time
from kit.msg.std_msgs import Header
from kit.msg.tf2_msgs import TFMessage
from kit.plain_text import quoted
from kit.sim.bodies import PhysicalBody
from kit.sim.laser_scene import LaserScene
from kit.sim.physics import Physics
from kit.world.plugin_reader import ModelScope, WorldScope
from kit.world.records import Model, World
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class TopicEndpoint:
    """A topic that a plugin publishes or subscribes, by its absolute name, and its message class."""

    direction: Literal["publish", "subscribe"]
    topic: str
    type: type[Any]
    is_ground_truth: bool = field(default=False, compare=False)
    """Whether its messages are the true state of the world, which no sensor could measure."""


class OutgoingMessage(NamedTuple):
    """A message that a plugin sends to a topic."""

    topic: str
    message: Any


class Plugin:
    """One plugin of one model (or of the world). The simulation calls it; these defaults do nothing."""

    endpoints: Sequence[TopicEndpoint] = ()

    def reset(self, seed: int) -> None:
        """Back to how it was when built, with noise that depends on ``seed`` alone."""

    def moved(self) -> None:
        """Called after a service has put its model elsewhere."""

    def accept(self, topic: str, message: Any) -> None:
        """Takes a message that arrived on one of its subscribed topics."""

    def before_step(self, dt: float) -> Iterable[OutgoingMessage]:
        """Called before the physics step: drives set velocities; lasers scan the world as it is now."""
        return ()

    def after_step(self, dt: float) -> Iterable[OutgoingMessage]:
        """Called after the physics step and the advance of the clock: bumpers report what touched."""
        return ()


@dataclass(frozen=True, slots=True)
class PluginContext:
    """What a model plugin is built with."""

    name: str
    """The plugin's own."""
    model: Model
    bodies: Mapping[str, PhysicalBody]
    clock: WorldClock
    physics: Physics
    laser_scene: LaserScene
    has_subscribers: Callable[[str], bool]
    """Tells whether a topic has subscribers."""

    def publisher(
        self, topic: str, message_type: type[Any], *, is_ground_truth: bool = False
    ) -> PluginPublisher:
        """Creates a publisher for a topic as the model file names it: under the model's namespace, unless it starts with /."""
        return PluginPublisher(self.model.topic(topic), message_type, self.has_subscribers, is_ground_truth)

    def subscription(self, topic: str, message_type: type[Any]) -> TopicEndpoint:
        return TopicEndpoint("subscribe", self.model.topic(topic), message_type)


@dataclass(frozen=True, slots=True)
class WorldPluginContext:
    """What a world plugin is built with."""

    name: str
    world: World
    clock: WorldClock
    physics: Physics


@dataclass(frozen=True, slots=True)
class PluginPublisher:
    """One topic that a plugin publishes, by its absolute name."""

    topic: str
    type: type[Any]
    _has_subscribers: Callable[[str], bool]
    is_ground_truth: bool = False

    @property
    def endpoint(self) -> TopicEndpoint:
        return TopicEndpoint("publish", self.topic, self.type, self.is_ground_truth)

    def publish(self, make_message: Callable[[], Any]) -> list[OutgoingMessage]:
        """Returns the message that ``make_message`` makes, or nothing if the topic has no subscribers."""
        return [OutgoingMessage(self.topic, make_message())] if self._has_subscribers(self.topic) else []


class PluginParams(Protocol):
    """The parameters of a model plugin."""

    def build(self, context: PluginContext) -> Plugin: ...


class WorldPluginParams(Protocol):
    """The parameters of a world plugin."""

    def build(self, context: WorldPluginContext) -> Plugin: ...


PluginClass: TypeAlias = type[Plugin]
AnyClass: TypeAlias = type[object]


@dataclass(frozen=True, slots=True)
class PluginType:
    """A type of model plugin."""

    type: str
    """Type name in model files."""
    plugin: PluginClass
    """What the parameters build. Its docstring is its page; a table in it says what each key means."""
    read_params: Callable[[Section, ModelScope], PluginParams]
    """Reads the parameters from the plugin's section."""
    example: str
    """The least that a model file must say about it, for a model whose bodies and joints have plain names."""
    parts: tuple[AnyClass, ...] = ()
    """What it is made of that has keys of its own, which a table in its docstring explains."""


@dataclass(frozen=True, slots=True)
class WorldPluginType:
    """A type of world plugin."""

    type: str
    plugin: PluginClass
    read_params: Callable[[Section, WorldScope], WorldPluginParams]
    example: str
    parts: tuple[AnyClass, ...] = ()


NEVER = 2.0**31 - 1.0
"""The period [s] of rate 0: the first update, at time 0, is the only one."""


class WorldClock:
    """Counts steps. Time is computed from the count, so that it does not drift."""

    def __init__(self, step_size: float) -> None:
        self.step_size = step_size
        """[s]"""
        self.tick = 0
        self.time_ns = 0

    def advance(self) -> None:
        """Counts a step."""
        self.tick += 1
        self.time_ns = round(self.tick * self.step_size * 1e9)

    @property
    def stamp(self) -> Time:
        """Now, as messages carry it."""
        time_ns = self.time_ns
        return Time(sec=time_ns // 1_000_000_000, nanosec=time_ns % 1_000_000_000)


class UpdateTimer:
    """Tells in which steps an update at a given rate is due: those that contain a multiple of its period.

    ``rate`` [Hz]: inf means every step, 0 only the very first. As in Flatland, time is compared from the middle
    of the step, so that a multiple that rounding moves a little still falls into its own step.
    """

    def __init__(self, rate: float, clock: WorldClock) -> None:
        self._clock = clock
        self._every_step = math.isinf(rate)
        self._step = clock.step_size
        self._period = 1.0 / rate if rate > 0.0 else NEVER

    def is_due(self) -> bool:
        if self._every_step:
            return True
        return math.fmod((self._clock.tick + 0.5) * self._step, self._period) < self._step


def stream_key(seed: int, *names: str) -> int:
    """A stream's key, 0 to 2**63 - 1, from the world's seed and the names of the plugin."""
    text = "\0".join([str(seed), *names])
    return int.from_bytes(blake2b(text.encode(), digest_size=8).digest(), "big") >> 1


class RandomStream:
    """Random numbers from one stream. Value ``i`` is always the same, whatever was drawn before."""

    def __init__(self, stream: int) -> None:
        self._stream = stream

    def uniform(self, index: int) -> float:
        """Returns a number in [0, 1)."""
        return float(kernels.uniform(self._stream, index))

    def normal(self, index: int, deviation: float = 1.0) -> float:
        return float(deviation * kernels.normal(self._stream, index)) if deviation else 0.0


TF_TOPIC = "/tf"

_TOPIC = re.compile(r"/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*", re.ASCII)


def read_topic(section: Section, key: str, default: str) -> str:
    """A topic's name as ROS 2 wants it; under the model's namespace unless it starts with a slash."""
    name = section.name(key, default)
    if section.has(key) and not _TOPIC.fullmatch(name):
        section.error(
            f"{quoted(name)} is not a topic name: use letters, digits, _ and /, no digit after a /", key
        )
        return default
    return name


def read_rate(section: Section, key: str, default: float = math.inf) -> float:
    """Updates per second [Hz]; inf means at every step."""
    return section.number(key, default, minimum=0, infinite=True)


def read_variances(section: Section, key: str) -> tuple[float, ...]:
    """Three variances, by default no noise."""
    variances = section.numbers(key, (0.0, 0.0, 0.0), length=3)
    if min(variances) < 0:
        section.error(f"{quoted(key)} contains variances: they must not be below 0", key)
        return (0.0, 0.0, 0.0)
    return variances


def yaw_quaternion(theta: float) -> geometry_msgs.Quaternion:
    """A turn about the vertical axis."""
    return geometry_msgs.Quaternion(z=math.sin(theta / 2), w=math.cos(theta / 2))


def pose_message(pose: Pose) -> geometry_msgs.Pose:
    return geometry_msgs.Pose(
        position=geometry_msgs.Point(x=pose.x, y=pose.y), orientation=yaw_quaternion(pose.theta)
    )


def twist_message(forward: float, lateral: float, turn: float) -> geometry_msgs.Twist:
    return geometry_msgs.Twist(
        linear=geometry_msgs.Vector3(x=forward, y=lateral), angular=geometry_msgs.Vector3(z=turn)
    )


def transform_message(stamp: Time, parent: str, child: str, pose: Pose) -> geometry_msgs.TransformStamped:
    """Returns the transform of the frame ``child`` in the frame ``parent``."""
    return geometry_msgs.TransformStamped(
        header=Header(stamp=stamp, frame_id=parent),
        child_frame_id=child,
        transform=geometry_msgs.Transform(
            translation=geometry_msgs.Vector3(x=pose.x, y=pose.y), rotation=yaw_quaternion(pose.theta)
        ),
    )


def tf_message(*stamped: geometry_msgs.TransformStamped) -> TFMessage:
    return TFMessage(transforms=list(stamped))
