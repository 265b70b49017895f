"""The simulation of one world: a step, the services around it, and the live state that a reset rebuilds."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, cast

from kit.geometry import Pose
from kit.msg.geometry_msgs import Twist
from kit.sim.bodies import PhysicalBody
from kit.sim.laser_scene import LaserScene, footprint_outlines, hull_distance
from kit.sim.physics import Physics
from kit.sim.plugin import (
    OutgoingMessage,
    Plugin,
    PluginContext,
    PluginParams,
    TopicEndpoint,
    WorldPluginContext,
    WorldPluginParams,
)
from kit.sim.plugin_clock import WorldClock, stream_key
from kit.sim.plugins import plugin_readers, world_plugin_readers
from kit.sim.state import BodyState, FootprintOutline, LatestScan, SimulationState
from kit.world import loading
from kit.world.catalogue import allowed_root_of
from kit.world.problems import WorldError
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
        """Plugins in the order in which they are called: model by model, then those of the world."""
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
            plugin for plugin in self.plugins if _overrides_method(plugin, "before_step")
        )
        self.after_step_plugins = tuple(
            plugin for plugin in self.plugins if _overrides_method(plugin, "after_step")
        )
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


def _overrides_method(plugin: Plugin, method: str) -> bool:
    return getattr(type(plugin), method) is not getattr(Plugin, method)


ORIGIN = Pose()

STEP_SIZE_S: Final = 0.01
"""One tick of simulated time."""


class SimulationError(Exception):
    """A service could not do what it was asked to; the message says why. Nothing was changed."""


def load_world(
    path: Path | str, *, root: Path | None = None, environment: Mapping[str, str] | None = None
) -> World:
    """Reads a Flatland world file with its models, maps and plugins into a record that can be simulated.

    ``path``: a ``world.yaml``. ``root``: the folder whose files the world may read (default: its own; for a world of
    the kit's maps, all maps). ``environment``: the variables that ``env()`` may read (default: none). Raises WorldError
    with every error of all its files.

    >>> world = kit.load_world(kit.find_map("maze").world_file)
    >>> [model.name for model in world.models]
    ['serp']
    """
    path = Path(path)
    return loading.load_world(
        path,
        plugin_readers=plugin_readers,
        world_plugin_readers=world_plugin_readers,
        root=allowed_root_of(path) if root is None else root,
        environment=environment,
    )


def load_model(path: Path | str, world: World, *, name: str, namespace: str, pose: Pose) -> Model:
    """Loads a model file for a world that is already loaded. Errors are those of ``load_world``."""
    return loading.load_model(
        Path(path),
        name=name,
        namespace=namespace,
        pose=pose,
        layer_bits=world.layer_bits,
        plugin_readers=plugin_readers,
    )


class Simulation:
    """A world in motion. The same world, seed and inputs give the same run, to the bit.

    ``world``: from ``load_world``. ``step_size`` [s]: one step of simulated time; pacing it by the
    wall clock is the caller's business.
    ``has_subscribers(topic)``: whether a topic has subscribers, since plugins do not compute what nothing reads; by
    default every topic has. It never changes the motion.
    """

    def __init__(
        self,
        world: World,
        *,
        seed: int = 0,
        step_size: float = STEP_SIZE_S,
        has_subscribers: Callable[[str], bool] | None = None,
    ) -> None:
        if not 0.0 < step_size < math.inf:
            raise SimulationError(f"a step must take some time, not {step_size} s")
        self.world = world
        self.seed = seed
        self.step_size = step_size
        self._has_subscribers = has_subscribers or (lambda topic: True)
        self._instance = WorldInstance(world, seed, step_size, self._has_subscribers)

    # One step

    def before_step(self) -> list[OutgoingMessage]:
        """Plugins act on the world as it is: drives set velocities, lasers scan."""
        sent: list[OutgoingMessage] = []
        for plugin in self._instance.before_step_plugins:
            sent += plugin.before_step(self.step_size)
        return sent

    def advance(self) -> None:
        """Contacts, velocities, poses, and the clock."""
        instance = self._instance
        instance.physics.step()
        instance.clock.advance()

    def after_step(self) -> list[OutgoingMessage]:
        """Plugins report what happened: such as bumpers."""
        sent: list[OutgoingMessage] = []
        for plugin in self._instance.after_step_plugins:
            sent += plugin.after_step(self.step_size)
        return sent

    def step(self, n: int = 1) -> list[OutgoingMessage]:
        """``n`` whole steps; returns what plugins sent, in order."""
        sent: list[OutgoingMessage] = []
        for _ in range(n):
            sent += self.before_step()
            self.advance()
            sent += self.after_step()
        return sent

    # Messages

    @property
    def endpoints(self) -> Sequence[TopicEndpoint]:
        """Every topic that a plugin publishes or subscribes, as the world stands now."""
        return [endpoint for plugin in self._instance.plugins for endpoint in plugin.endpoints]

    def model_endpoints(self, model: str) -> Sequence[TopicEndpoint]:
        """The endpoints of one model's plugins; none if there is no such model."""
        instance = self._instance.models.get(model)
        return [] if instance is None else [end for plugin in instance.plugins for end in plugin.endpoints]

    def command_topics(self, model: str) -> tuple[str, ...]:
        """The topics on which a model's plugins take Twists."""
        ends = self.model_endpoints(model)
        return tuple(end.topic for end in ends if end.direction == "subscribe" and end.type is Twist)

    def accept(self, topic: str, message: Any) -> None:
        """Hands a message to every plugin that subscribes to the topic; to none, if none does."""
        for plugin in self._instance.subscribers.get(topic, ()):
            plugin.accept(topic, message)

    # Services

    def reset(self, seed: int | None = None) -> None:
        """Back to the file, in one go: models, poses, velocities, contacts, clock, plugins, noise.

        From here the run is the one that a new simulation makes. ``seed``: by default the same as before.
        """
        seed = self.seed if seed is None else seed
        self._instance = WorldInstance(self.world, seed, self.step_size, self._has_subscribers)
        self.seed = seed

    def move_model(self, name: str, pose: Pose, *, at_rest: bool = False) -> None:
        """Puts the model's first body at ``pose``; the others keep their places around it.

        Unlike Flatland, which gives every body the angle of the pose, the model moves as it stands: a wheel
        that points aside still does. As in Flatland velocities and the last command stay; ``at_rest`` takes the
        velocities away. What the model touched is forgotten, so no contact is reported from where it was.
        """
        instance = self._model_instance(name, "move")
        _check_finite(pose, f'move model "{name}"')
        if at_rest:
            self.set_velocity(name, (0.0, 0.0, 0.0))
        self._instance.physics.move_model(name, pose)
        for plugin in instance.plugins:
            plugin.moved()

    def set_velocity(self, name: str, velocity: tuple[float, float, float]) -> None:
        """Gives every body of a model a velocity in the world frame: m/s, m/s, rad/s, about the first body."""
        instance = self._model_instance(name, "move")
        _check_finite(velocity, f'move model "{name}"')
        vx, vy, turn = velocity
        first = instance.bodies[0].pose
        for body in instance.bodies:
            x, y = body.pose.x - first.x, body.pose.y - first.y
            body.set_velocity(vx - turn * y, vy + turn * x, turn)

    def spawn_model(self, file: Path, name: str, namespace: str = "", pose: Pose = ORIGIN) -> None:
        """Adds the model that a model file describes."""
        if name in self._instance.models:
            raise SimulationError(
                f'Flatland World: failed to spawn model, model with name "{name}" already exists'
            )
        _check_finite(pose, f'spawn model "{name}"')
        try:
            model = load_model(file, self.world, name=name, namespace=namespace, pose=pose)
        except WorldError as error:
            raise SimulationError(f'Flatland World: failed to spawn model "{name}": {error}') from error
        self._instance.add_model(model)

    def delete_model(self, name: str) -> None:
        """Removes a model with its plugins."""
        self._model_instance(name, "delete")
        self._instance.remove_model(name)

    # State

    @property
    def time_ns(self) -> int:
        """Simulated time since the last reset."""
        return self._instance.clock.time_ns

    @property
    def tick(self) -> int:
        """Steps since the last reset."""
        return self._instance.clock.tick

    @property
    def model_names(self) -> tuple[str, ...]:
        """Names of the models in load order."""
        return tuple(self._instance.models)

    def state(self) -> SimulationState:
        """Returns a copy of all poses, velocities and contacts."""
        bodies = tuple(
            BodyState(body.model, body.name, body.pose, body.velocity)
            for body in self._instance.physics.bodies
        )
        return SimulationState(self.time_ns, self.tick, bodies, self._instance.physics.contacts())

    def pose(self, model: str) -> Pose:
        """Returns the pose of the model's first body. Raises KeyError if there is no such model."""
        return self._instance.models[model].bodies[0].pose

    def poses(self) -> list[Pose]:
        """Returns the pose of every model's first body, in load order."""
        return [model.bodies[0].pose for model in self._instance.models.values()]

    def is_touching(self, model: str) -> bool:
        """Returns whether anything solid touches the model, as of the last step."""
        physics = self._instance.physics
        if not any(physics.is_touching(body) for body in self._instance.models[model].bodies):
            return False
        return any(model in (c.entity_a, c.entity_b) and c.points for c in physics.contacts())

    def hull_distance(self, model: str, point: tuple[float, float]) -> float:
        """Returns the distance from a point of the world to the nearest footprint of the model [m]; 0 inside."""
        return hull_distance(self._instance.models[model].bodies, point)

    def outlines(self) -> tuple[FootprintOutline, ...]:
        """Every footprint where it is now."""
        return footprint_outlines(self._instance.physics.bodies)

    def latest_scans(self) -> tuple[LatestScan, ...]:
        """Returns the latest scan of every laser; one without subscribers does not scan."""
        return self._instance.laser_scene.latest_scans

    def _model_instance(self, name: str, verb: str) -> ModelInstance:
        if name not in self._instance.models:
            raise SimulationError(
                f'Flatland World: failed to {verb} model, model with name "{name}" does not exist'
            )
        return self._instance.models[name]


def _check_finite(values: Iterable[float], doing: str) -> None:
    if not all(map(math.isfinite, values)):
        raise SimulationError(f"Flatland World: failed to {doing}, {values} has no place in a world")


def _move(simulation: Simulation, name: str, pose: Sequence[float]) -> None:
    simulation.move_model(name, Pose(*pose))


def _spawn(simulation: Simulation, file: str, name: str, namespace: str, pose: Sequence[float]) -> None:
    simulation.spawn_model(Path(file), name, namespace, Pose(*pose))


SERVICES: Final[Mapping[str, Callable[..., None]]] = MappingProxyType(
    {
        "move_model": _move,
        "spawn_model": _spawn,
        "delete_model": Simulation.delete_model,
        "reset": Simulation.reset,
    }
)
"""Each takes the simulation, then arguments that JSON can hold."""


def call_service(simulation: Simulation, service: str, *arguments: Any) -> None:
    """Calls a service of the simulation by name. Raises KeyError if it is unknown, SimulationError if it fails."""
    SERVICES[service](simulation, *arguments)
