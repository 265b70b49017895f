"""Everything that a reset makes anew: clock, bodies, devices."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import cast

from kit.sim.bodies import PhysicalBody
from kit.sim.clock import Clock
from kit.sim.context import Params, Site, WorldParams, WorldSite
from kit.sim.noise import stream_of
from kit.sim.physics import Physics
from kit.sim.plugin import Plugin
from kit.sim.surroundings import Surroundings
from kit.world.records import Model, PluginSpec, World


@dataclass(frozen=True, slots=True)
class StandingModel:
    """A model in the simulation."""

    model: Model
    bodies: tuple[PhysicalBody, ...]
    plugins: tuple[Plugin, ...]


class Stage:
    """One run of a world, from its beginning."""

    def __init__(self, world: World, seed: int, step_size: float, wanted: Callable[[str], bool]) -> None:
        self.clock = Clock(step_size)
        self.physics = Physics(world.velocity_iterations, step_size)
        self.surroundings = Surroundings(self.physics)
        self.models: dict[str, StandingModel] = {}
        self.plugins: tuple[Plugin, ...] = ()
        """In the order in which they are called: model by model, then those of the world."""
        self._world_plugins: list[Plugin] = []
        self._seed = seed
        self._wanted = wanted
        for layer in world.layers:
            if layer.walls is not None:
                self.physics.add_wall(layer.name, layer.bits, layer.walls.segments)
        for model in world.models:
            self.add_model(model)
        for spec in world.plugins:
            site = WorldSite(spec.name, world, self.clock, self.physics)
            plugin = cast(WorldParams, _read(spec)).build(site)
            plugin.reset(stream_of(seed, spec.name))
            self._world_plugins.append(plugin)
        self._line_up()

    def add_model(self, model: Model) -> None:
        """Puts a model and its devices on the stage."""
        bodies = self.physics.add_model(model)
        by_name = {body.name: body for body in bodies}
        plugins = []
        for spec in model.plugins:
            site = Site(spec.name, model, by_name, self.clock, self.physics, self.surroundings, self._wanted)
            plugin = cast(Params, _read(spec)).build(site)
            plugin.reset(stream_of(self._seed, model.name, spec.name))
            plugins.append(plugin)
        self.models[model.name] = StandingModel(model, bodies, tuple(plugins))
        self._line_up()

    def remove_model(self, name: str) -> None:
        """KeyError if it is not there."""
        del self.models[name]
        self.physics.remove_model(name)
        self.surroundings.forget(name)
        self._line_up()

    def _line_up(self) -> None:
        """Who is called in each phase of a step, and by which topics."""
        of_models = [plugin for standing in self.models.values() for plugin in standing.plugins]
        self.plugins = (*of_models, *self._world_plugins)
        self.before = tuple(plugin for plugin in self.plugins if _overrides(plugin, "before_step"))
        self.after = tuple(plugin for plugin in self.plugins if _overrides(plugin, "after_step"))
        self.listeners: dict[str, list[Plugin]] = {}
        for plugin in self.plugins:
            for endpoint in plugin.endpoints:
                if endpoint.direction == "subscribe":
                    self.listeners.setdefault(endpoint.topic, []).append(plugin)


def _read(spec: PluginSpec) -> object:
    """The parameters of a plugin, as its device read them."""
    if not hasattr(spec.params, "build"):
        raise TypeError(
            f"{spec.place}: nobody has read this plugin; load the world with kit.sim.loading.load"
        )
    return spec.params


def _overrides(plugin: Plugin, method: str) -> bool:
    return getattr(type(plugin), method) is not getattr(Plugin, method)
