"""Where a device stands: what it is built from, and what it may ask of the simulation.

A device is one file of ``kit/sim/plugins/``: a frozen record of parameters with ``build(site)``, the plugin that
this builds, and a ``DEVICE`` that says under which type world files know it and how its parameters are read.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from kit.sim.bodies import PhysicalBody
from kit.sim.clock import Clock
from kit.sim.physics import Physics
from kit.sim.plugin import Endpoint, Outgoing, Plugin
from kit.sim.surroundings import Surroundings
from kit.world.plugin_reader import ModelScope, Section, WorldScope
from kit.world.records import Model, World


@dataclass(frozen=True, slots=True)
class Site:
    """A model's device and its surroundings."""

    name: str
    """The plugin's own."""
    model: Model
    bodies: Mapping[str, PhysicalBody]
    clock: Clock
    physics: Physics
    surroundings: Surroundings
    wanted: Callable[[str], bool]
    """Whether anybody listens to a topic."""

    def publisher(self, topic: str, message_type: type[Any]) -> Publisher:
        """For a topic as the model file names it: under the model's namespace, unless it starts with /."""
        return Publisher(self.model.topic(topic), message_type, self.wanted)

    def subscription(self, topic: str, message_type: type[Any]) -> Endpoint:
        return Endpoint("subscribe", self.model.topic(topic), message_type)


@dataclass(frozen=True, slots=True)
class WorldSite:
    """A device of the world itself."""

    name: str
    world: World
    clock: Clock
    physics: Physics


@dataclass(frozen=True, slots=True)
class Publisher:
    """One topic of a device, by its absolute name."""

    topic: str
    type: type[Any]
    _wanted: Callable[[str], bool]

    @property
    def endpoint(self) -> Endpoint:
        return Endpoint("publish", self.topic, self.type)

    @property
    def wanted(self) -> bool:
        """Whether anybody listens."""
        return self._wanted(self.topic)

    def send(self, make: Callable[[], Any]) -> list[Outgoing]:
        """The message that ``make`` makes, if anybody listens."""
        return [Outgoing(self.topic, make())] if self._wanted(self.topic) else []


class Params(Protocol):
    """The parameters of a model's device."""

    def build(self, site: Site) -> Plugin: ...


class WorldParams(Protocol):
    """The parameters of a device of the world."""

    def build(self, site: WorldSite) -> Plugin: ...


@dataclass(frozen=True, slots=True)
class Device:
    """A type of model plugin."""

    type: str
    """As model files name it."""
    read: Callable[[Section, ModelScope], Params]
    """Makes parameters of its section."""
    example: str
    """The least that a model file must say about it, for a model whose bodies and joints have plain names."""


@dataclass(frozen=True, slots=True)
class WorldDevice:
    """A type of world plugin."""

    type: str
    read: Callable[[Section, WorldScope], WorldParams]
    example: str
