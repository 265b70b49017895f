"""Bodies and walls in motion: pymunk, with Box2D's order within a step."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pymunk
from numpy.typing import NDArray

from kit.geometry import Pose
from kit.sim.assembly import BOUNCY, CORRECTION, Assembly, assemble, mixable
from kit.sim.bodies import PhysicalBody, Rigid
from kit.sim.contacts import Contacts, bounce
from kit.sim.state import Contact
from kit.world.records import Model

WALL_FRICTION = 0.2
"""Box2D's default, which Flatland leaves to its walls."""

SLOP = 0.001
"""How deep things that touch may overlap for good [m]: without any, a contact would come and go."""

MAX_SUBSTEPS = 250
"""A step falls into no more parts; what is too fast for that is slowed down."""


@dataclass(frozen=True, slots=True, eq=False)
class Wall:
    """The wall segments of one layer, in one static body."""

    layer: str
    """The layer's first name."""
    bits: int
    ends: NDArray[np.float64]
    """(n, 4) ``x1 y1 x2 y2`` in the world [m]."""
    segments: tuple[pymunk.Segment, ...]


class Physics:
    """What moves, and what is in its way."""

    def __init__(self, iterations: int, step_size: float) -> None:
        """``iterations``: of the solver, per step; pymunk has none of its own for positions."""
        self.walls: list[Wall] = []
        self.bodies: list[PhysicalBody] = []
        """In load order: model by model, body by body."""
        self.version = 0
        """Counts every change of a pose."""
        self.cast = 0
        """Counts every change of who is there."""
        self._step_size = step_size
        self._substep = step_size
        self._space = pymunk.Space()
        self._space.iterations = iterations
        self._space.collision_slop = SLOP
        self._space.collision_bias = CORRECTION
        self._space.on_collision(BOUNCY, None, pre_solve=bounce)
        self._touching = Contacts(self._space)
        self._contacts: tuple[int, tuple[Contact, ...]] = (0, ())
        """Those at the version given first."""
        self._assemblies: dict[str, Assembly] = {}
        self._moving: list[Rigid] = []

    # Who is there

    def add_wall(self, layer: str, bits: int, ends: NDArray[np.float64]) -> Wall:
        """Adds segments (n, 4) ``x1 y1 x2 y2`` in the world [m], of zero thickness and two-sided."""
        body = pymunk.Body(body_type=pymunk.Body.STATIC)
        segments = tuple(pymunk.Segment(body, (x1, y1), (x2, y2), 0.0) for x1, y1, x2, y2 in ends.tolist())
        of_layer = pymunk.ShapeFilter(categories=bits, mask=bits)
        for segment in segments:
            segment.filter = of_layer
            segment.friction = mixable(WALL_FRICTION)
        self._space.add(body, *segments)
        self._recast()
        self._touching.add_wall(layer, self.cast, segments)
        wall = Wall(layer, bits, ends, segments)
        self.walls.append(wall)
        return wall

    def remove_wall(self, wall: Wall) -> None:
        self._touching.remove(wall.segments)
        self._space.remove(*wall.segments)
        self.walls.remove(wall)
        self._recast()

    def add_model(self, model: Model) -> tuple[PhysicalBody, ...]:
        """Adds a model's bodies, at the model's pose, at rest."""
        assembly = assemble(model, self._step_size)
        for rigid in assembly.rigids:
            self._space.add(rigid.body, *rigid.body.shapes)
        self._space.add(*assembly.constraints)
        for body in assembly.bodies:
            self._recast()
            self._touching.add_body(body, self.cast)
        self._touching.keep_apart(assembly.apart)
        self._assemblies[model.name] = assembly
        self._list_bodies()
        return assembly.bodies

    def remove_model(self, name: str) -> None:
        assembly = self._assemblies.pop(name)
        self._space.remove(*assembly.constraints)
        for rigid in assembly.rigids:
            shapes = tuple(rigid.body.shapes)
            self._touching.remove(shapes)
            self._space.remove(rigid.body, *shapes)
        self._list_bodies()
        self._recast()

    def _recast(self) -> None:
        self.cast += 1
        self.version += 1

    def _list_bodies(self) -> None:
        assemblies = self._assemblies.values()
        self.bodies = [body for assembly in assemblies for body in assembly.bodies]
        self._moving = [rigid for a in assemblies for rigid in a.rigids if not rigid.is_static]

    # The step

    def step(self) -> None:
        """Contacts at the present poses, then velocities, then poses: Box2D's order.

        pymunk moves bodies first, by the velocities of the step before; a velocity set in between would carry a
        body through a wall, and act one step late. So its bodies stay put in ``Space.step`` and move after it. A
        fast body makes the step fall into shorter ones, in each of which nothing goes farther than its stride.
        """
        count = max((self._parts(rigid) for rigid in self._moving), default=1)
        self._substep = self._step_size / count
        for _ in range(count):
            for rigid in self._moving:
                rigid.accelerate(self._substep)
            self._space.step(self._substep)
            for rigid in self._moving:
                rigid.move(self._substep)
        for rigid in self._moving:
            rigid.command = rigid.held = None
        self.version += 1

    def _parts(self, rigid: Rigid) -> int:
        """Into how many parts a step must fall for this body."""
        distance = rigid.speed() * self._step_size
        return 1 if distance <= rigid.stride else min(MAX_SUBSTEPS, math.ceil(distance / rigid.stride))

    def hold(self, body: PhysicalBody, pose: Pose) -> None:
        """Puts a body, and what is stiffly welded to it, there for a step, whatever is in its way."""
        body.hold(pose)
        self.version += 1

    def move_model(self, name: str, pose: Pose) -> None:
        """Puts the first body of a model there, and the others around it as they were. Contacts are forgotten."""
        assembly = self._assemblies[name]
        start = assembly.bodies[0].pose
        for rigid in assembly.rigids:
            rigid.place(pose.compose(start.relative(rigid.pose)))
            shapes = tuple(rigid.body.shapes)  # taken out and put back, they touch nothing
            self._space.remove(*shapes)
            self._space.add(*shapes)
        self.version += 1

    # What touches

    def is_touching(self, body: PhysicalBody) -> bool:
        """Whether the body touches anything, or one of its sensor footprints overlaps anything."""
        return self._touching.touch(body)

    def contacts(self) -> tuple[Contact, ...]:
        """All pairs of footprints, and of footprints and wall segments, that touched in the last step."""
        if self._contacts[0] != self.version:
            self._contacts = self.version, self._touching.found(self._substep)
        return self._contacts[1]
