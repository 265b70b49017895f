"""The contract between the simulation and a plugin: what it is built with, its clock, random streams, topics and messages.

A plugin is one file of ``kit/sim/plugins/``: a frozen record of parameters with ``build(context)``, the plugin that this
builds, and a ``PLUGIN_TYPE`` that says under which type world files know it and how its parameters are read. It never
touches the graph: it *returns* messages and *accepts* messages, and the runner of the simulation delivers them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple, Protocol, TypeAlias

from kit.sim.bodies import PhysicalBody
from kit.sim.laser_scene import LaserScene
from kit.sim.physics import Physics
from kit.sim.plugin_clock import WorldClock
from kit.world.plugin_reader import ModelScope, WorldScope
from kit.world.records import Model, World
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class CommandLimit:
    """The largest value, in either direction, of a field of a command that a plugin carries out."""

    field: str
    """Its path in the message: ``linear.x``."""
    largest: float
    unit: str


@dataclass(frozen=True, slots=True)
class TopicEndpoint:
    """A topic that a plugin publishes or subscribes, by its absolute name, and its message class."""

    direction: Literal["publish", "subscribe"]
    topic: str
    type: type[Any]
    is_ground_truth: bool = field(default=False, compare=False)
    """Whether its messages are the true state of the world, which no sensor could measure."""
    limits: tuple[CommandLimit, ...] = field(default=(), compare=False)
    """Of the commands that arrive on it; none: whatever is asked for is carried out."""


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

    def subscription(
        self, topic: str, message_type: type[Any], limits: Iterable[CommandLimit] = ()
    ) -> TopicEndpoint:
        """``limits``: of what is carried out; those of 0 are none."""
        some = tuple(limit for limit in limits if limit.largest > 0.0)
        return TopicEndpoint("subscribe", self.model.topic(topic), message_type, limits=some)


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
