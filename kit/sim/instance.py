"""The live state of a world that a reset rebuilds: clock, bodies and plugins."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import cast

from kit.sim.bodies import PhysicalBody
from kit.sim.clock_and_noise import WorldClock, stream_key
from kit.sim.context import PluginContext, PluginParams, WorldPluginContext, WorldPluginParams
from kit.sim.laser_scene import LaserScene
from kit.sim.physics import Physics
from kit.sim.plugin import Plugin
from kit.world.records import Model, PluginSpec, World


@dataclass(frozen=True, slots=True)
class ModelInstance:
    """A model in the simulation: its description, bodies and plugins."""

    model: Model
    bodies: tuple[PhysicalBody, ...]
    plugins: tuple[Plugin, ...]


class WorldInstance:
    """A world in simulation, from tick 0 on."""

    def __init__(
        self, world: World, seed: int, step_size: float, has_subscribers: Callable[[str], bool]
    ) -> None:
        self.clock = WorldClock(step_size)
        self.physics = Physics(world.velocity_iterations, step_size)
        self.laser_scene = LaserScene(self.physics)
        self.models: dict[str, ModelInstance] = {}
        self.plugins: tuple[Plugin, ...] = ()
        """In the order in which they are called: model by model, then those of the world."""
        self._world_plugins: list[Plugin] = []
        self._seed = seed
        self._has_subscribers = has_subscribers
        for layer in world.layers:
            if layer.walls is not None:
                self.physics.add_wall(layer.name, layer.bits, layer.walls.segments)
        for model in world.models:
            self.add_model(model)
        for spec in world.plugins:
            context = WorldPluginContext(spec.name, world, self.clock, self.physics)
            plugin = cast(WorldPluginParams, _params_of(spec)).build(context)
            plugin.reset(stream_key(seed, spec.name))
            self._world_plugins.append(plugin)
        self._index_plugins()

    def add_model(self, model: Model) -> None:
        """Adds a model with its bodies and plugins."""
        bodies = self.physics.add_model(model)
        by_name = {body.name: body for body in bodies}
        plugins = []
        for spec in model.plugins:
            context = PluginContext(
                spec.name, model, by_name, self.clock, self.physics, self.laser_scene, self._has_subscribers
            )
            plugin = cast(PluginParams, _params_of(spec)).build(context)
            plugin.reset(stream_key(self._seed, model.name, spec.name))
            plugins.append(plugin)
        self.models[model.name] = ModelInstance(model, bodies, tuple(plugins))
        self._index_plugins()

    def remove_model(self, name: str) -> None:
        """KeyError if it is not there."""
        del self.models[name]
        self.physics.remove_model(name)
        self.laser_scene.forget_model(name)
        self._index_plugins()

    def _index_plugins(self) -> None:
        """Lists the plugins to call in each phase of a step and for each topic."""
        model_plugins = [plugin for instance in self.models.values() for plugin in instance.plugins]
        self.plugins = (*model_plugins, *self._world_plugins)
        self.before_step_plugins = tuple(
            plugin for plugin in self.plugins if _overrides(plugin, "before_step")
        )
        self.after_step_plugins = tuple(plugin for plugin in self.plugins if _overrides(plugin, "after_step"))
        self.subscribers: dict[str, list[Plugin]] = {}
        for plugin in self.plugins:
            for endpoint in plugin.endpoints:
                if endpoint.direction == "subscribe":
                    self.subscribers.setdefault(endpoint.topic, []).append(plugin)


def _params_of(spec: PluginSpec) -> object:
    """Returns the parameters that the plugin's reader has read."""
    if not hasattr(spec.params, "build"):
        raise TypeError(
            f"{spec.location}: this plugin's parameters have not been read; load the world with kit.sim.simulation.load_world"
        )
    return spec.params


def _overrides(plugin: Plugin, method: str) -> bool:
    return getattr(type(plugin), method) is not getattr(Plugin, method)
