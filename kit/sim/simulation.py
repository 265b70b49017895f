"""The simulation of one world: a step, and the services around it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from kit.geometry import Pose
from kit.sim.instance import Stage, StandingModel
from kit.sim.loading import load_model
from kit.sim.plugin import Endpoint, Outgoing
from kit.sim.state import BodyState, SimulationState
from kit.sim.surroundings import Outline, ScanView, hull_distance, outlines
from kit.world.problems import WorldError
from kit.world.records import World

ORIGIN = Pose()


class SimulationError(Exception):
    """A service could not do what it was asked to; the message says why. Nothing was changed."""


class Simulation:
    """A world in motion. The same world, seed and inputs give the same run, to the bit.

    ``world``: from ``kit.sim.loading.load``. ``step_size`` [s]: one step of simulated time; pacing it by the
    wall clock is the caller's business. ``wanted(topic)``: whether anybody listens, for devices do not
    compute what nobody reads; by default everything is wanted. What is wanted never changes what happens.
    """

    def __init__(
        self,
        world: World,
        *,
        seed: int = 0,
        step_size: float = 0.01,
        wanted: Callable[[str], bool] | None = None,
    ) -> None:
        if not 0.0 < step_size < math.inf:
            raise SimulationError(f"a step must take some time, not {step_size} s")
        self.world = world
        self.seed = seed
        self.step_size = step_size
        self._wanted = wanted or (lambda topic: True)
        self._stage = Stage(world, seed, step_size, self._wanted)

    # One step

    def before_step(self) -> list[Outgoing]:
        """Devices act on the world as it is: drives set velocities, lasers look."""
        return [sent for plugin in self._stage.before for sent in plugin.before_step(self.step_size)]

    def advance(self) -> None:
        """Contacts, velocities, poses, and the clock."""
        self._stage.physics.step()
        self._stage.clock.tick += 1

    def after_step(self) -> list[Outgoing]:
        """Devices report what happened: bumpers, whatever waits for the end of the step."""
        return [sent for plugin in self._stage.after for sent in plugin.after_step(self.step_size)]

    def step(self, n: int = 1) -> list[Outgoing]:
        """``n`` whole steps; returns what devices sent, in order."""
        sent: list[Outgoing] = []
        for _ in range(n):
            sent += self.before_step()
            self.advance()
            sent += self.after_step()
        return sent

    # Messages

    @property
    def endpoints(self) -> Sequence[Endpoint]:
        """Every topic that a device publishes or subscribes, as the world stands now."""
        return [endpoint for plugin in self._stage.plugins for endpoint in plugin.endpoints]

    def endpoints_of(self, model: str) -> Sequence[Endpoint]:
        """Those of one model's devices; none if it is not there."""
        standing = self._stage.models.get(model)
        return [] if standing is None else [end for plugin in standing.plugins for end in plugin.endpoints]

    def accept(self, topic: str, message: Any) -> None:
        """Hands a message to every device that subscribes to the topic; to none, if none does."""
        for plugin in self._stage.listeners.get(topic, ()):
            plugin.accept(topic, message)

    # Services

    def reset(self, seed: int | None = None) -> None:
        """Back to the file, in one go: models, poses, velocities, contacts, clock, devices, noise.

        From here the run is the one that a new simulation makes. ``seed``: by default the same as before.
        """
        seed = self.seed if seed is None else seed
        self._stage = Stage(self.world, seed, self.step_size, self._wanted)
        self.seed = seed

    def move_model(self, name: str, pose: Pose, *, at_rest: bool = False) -> None:
        """Puts the model's first body at ``pose``; the others keep their places around it.

        Unlike Flatland, which gives every body the angle of the pose, the model moves as it stands: a wheel
        that points aside still does. As in Flatland velocities and the last command stay; ``at_rest`` takes the
        velocities away. What the model touched is forgotten, so no contact is reported from where it was.
        """
        standing = self._standing(name, "move")
        _check_finite(pose, f'move model "{name}"')
        if at_rest:
            self.set_velocity(name, (0.0, 0.0, 0.0))
        self._stage.physics.move_model(name, pose)
        for plugin in standing.plugins:
            plugin.moved()

    def set_velocity(self, name: str, velocity: tuple[float, float, float]) -> None:
        """Gives every body of a model a velocity in the world frame: m/s, m/s, rad/s, about the first body."""
        standing = self._standing(name, "move")
        _check_finite(velocity, f'move model "{name}"')
        vx, vy, turn = velocity
        first = standing.bodies[0].pose
        for body in standing.bodies:
            x, y = body.pose.x - first.x, body.pose.y - first.y
            body.set_velocity(vx - turn * y, vy + turn * x, turn)

    def spawn_model(self, file: Path, name: str, namespace: str = "", pose: Pose = ORIGIN) -> None:
        """Adds the model that a model file describes."""
        if name in self._stage.models:
            raise SimulationError(
                f'Flatland World: failed to spawn model, model with name "{name}" already exists'
            )
        _check_finite(pose, f'spawn model "{name}"')
        try:
            model = load_model(file, self.world, name=name, namespace=namespace, pose=pose)
        except WorldError as error:
            raise SimulationError(f'Flatland World: failed to spawn model "{name}": {error}') from error
        self._stage.add_model(model)

    def delete_model(self, name: str) -> None:
        """Removes a model with its devices."""
        self._standing(name, "delete")
        self._stage.remove_model(name)

    # Looking

    @property
    def time_ns(self) -> int:
        """Simulated time since the last reset."""
        return self._stage.clock.time_ns

    @property
    def tick(self) -> int:
        """Steps since the last reset."""
        return self._stage.clock.tick

    @property
    def model_names(self) -> tuple[str, ...]:
        """In load order."""
        return tuple(self._stage.models)

    def state(self) -> SimulationState:
        """Where everything is, how it moves and what touches; a copy, for keeps."""
        bodies = tuple(
            BodyState(body.model, body.name, body.pose, body.velocity) for body in self._stage.physics.bodies
        )
        return SimulationState(self.time_ns, self.tick, bodies, self._stage.physics.contacts())

    def pose(self, model: str) -> Pose:
        """Of the model's first body. KeyError if there is no such model."""
        return self._stage.models[model].bodies[0].pose

    def poses(self) -> list[Pose]:
        """Of every model's first body, in load order."""
        return [model.bodies[0].pose for model in self._stage.models.values()]

    def touches(self, model: str) -> bool:
        """Whether anything solid touches the model, as of the last step."""
        physics = self._stage.physics
        if not any(physics.is_touching(body) for body in self._stage.models[model].bodies):
            return False
        return any(model in (c.entity_a, c.entity_b) and c.points for c in physics.contacts())

    def hull_distance(self, model: str, point: tuple[float, float]) -> float:
        """From a point of the world to the nearest footprint of the model [m]; 0 inside."""
        return hull_distance(self._stage.models[model].bodies, point)

    def outlines(self) -> tuple[Outline, ...]:
        """Every footprint where it is now."""
        return outlines(self._stage.physics.bodies)

    def scan_views(self) -> tuple[ScanView, ...]:
        """What every laser saw when it last looked; one that nobody listens to does not look."""
        return tuple(self._stage.surroundings.views.values())

    def _standing(self, name: str, verb: str) -> StandingModel:
        if name not in self._stage.models:
            raise SimulationError(
                f'Flatland World: failed to {verb} model, model with name "{name}" does not exist'
            )
        return self._stage.models[name]


def _check_finite(values: Iterable[float], doing: str) -> None:
    if not all(map(math.isfinite, values)):
        raise SimulationError(f"Flatland World: failed to {doing}, {values} has no place in a world")
