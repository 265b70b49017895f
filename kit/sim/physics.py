"""Bodies and walls in motion, and which of them touch: pymunk, with Box2D's order within a step.

Contacts are reported by the names of the world file.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import pymunk
from pymunk._chipmunk_cffi import lib as chipmunk

from kit.arrays import FloatArray
from kit.geometry import Pose
from kit.sim.bodies import (
    ERROR_BIAS,
    RESTITUTION_TYPE,
    ModelAssembly,
    PhysicalBody,
    RigidBody,
    assemble_model,
    friction_factor,
)
from kit.sim.state import Contact
from kit.world.records import Model

MIN_BOUNCE_SPEED = 1.0
"""Slower impacts do not bounce [m/s], as in Box2D."""

ShapePair = tuple[pymunk.Shape, pymunk.Shape]

_ContactDetail = tuple[tuple[tuple[float, float], ...], tuple[float, float], float]
"""Points, normal and impulse [N s] of a contact, as pymunk orders its shapes."""


@dataclass(frozen=True, slots=True, order=True)
class ShapeOwner:
    """The owner of a shape. Contacts name owners in this order: models before walls, each in order of addition."""

    is_wall: bool
    number: int
    entity: str
    body: str


class ContactTracker:
    """Pairs of shapes that touch, kept up to date by pymunk's callbacks."""

    def __init__(self, space: pymunk.Space) -> None:
        self._shape_owners: dict[pymunk.Shape, ShapeOwner] = {}
        self._shape_bodies: dict[pymunk.Shape, PhysicalBody] = {}
        self._touching_pairs: dict[ShapePair, None] = {}
        self._never_touching: set[frozenset[PhysicalBody]] = set()
        space.on_collision(begin=self._on_contact_begin, separate=self._on_contact_end)

    def add_wall(self, layer: str, number: int, segments: Iterable[pymunk.Shape]) -> None:
        self._shape_owners |= dict.fromkeys(segments, ShapeOwner(True, number, layer, layer))

    def add_body(self, body: PhysicalBody, number: int) -> None:
        self._shape_owners |= dict.fromkeys(body.shapes, ShapeOwner(False, number, body.model, body.name))
        self._shape_bodies |= dict.fromkeys(body.shapes, body)

    def exclude_pairs(self, pairs: Iterable[frozenset[PhysicalBody]]) -> None:
        """Excludes these pairs of bodies from contacts for good."""
        self._never_touching |= set(pairs)

    def remove(self, shapes: Iterable[pymunk.Shape]) -> None:
        gone = set(shapes)
        self._touching_pairs = {pair: None for pair in self._touching_pairs if gone.isdisjoint(pair)}
        for shape in gone:
            del self._shape_owners[shape]
            self._shape_bodies.pop(shape, None)
        self._never_touching = {
            pair for pair in self._never_touching if all(gone.isdisjoint(body.shapes) for body in pair)
        }

    def is_touching(self, body: PhysicalBody) -> bool:
        """Returns whether the body touches anything, or one of its sensor footprints overlaps anything."""
        return any(self._shape_bodies.get(shape) is body for pair in self._touching_pairs for shape in pair)

    def contacts(self, dt: float) -> tuple[Contact, ...]:
        """All of them, after a step of ``dt``."""
        details: dict[ShapePair, _ContactDetail] = {}
        bodies = {
            self._shape_bodies[s].rigid.body: None
            for pair in self._touching_pairs
            for s in pair
            if s in self._shape_bodies
        }
        for body in bodies:
            body.each_arbiter(_record_arbiter, details)
        pairs = sorted(
            map(self._order_pair, self._touching_pairs),
            key=lambda pair: [self._shape_owners[s] for s in pair],
        )
        return tuple(self._make_contact(pair, details, dt) for pair in pairs)

    def _make_contact(self, pair: ShapePair, details: dict[ShapePair, _ContactDetail], dt: float) -> Contact:
        a, b = (self._shape_owners[shape] for shape in pair)
        points: tuple[tuple[float, float], ...] = ()
        normal, impulse = (0.0, 0.0), 0.0
        if pair in details:
            points, normal, impulse = details[pair]
        elif pair[::-1] in details:
            points, (x, y), impulse = details[pair[::-1]]
            normal = (-x, -y)
        return Contact(a.entity, a.body, b.entity, b.body, points, normal, impulse / dt)

    def _order_pair(self, pair: ShapePair) -> ShapePair:
        a, b = pair
        return pair if self._shape_owners[a] <= self._shape_owners[b] else (b, a)

    def _on_contact_begin(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        pair = arbiter.shapes
        bodies = frozenset(self._shape_bodies[shape] for shape in pair if shape in self._shape_bodies)
        pushable = any(body.description.kind == "dynamic" for body in bodies)
        if pushable and bodies not in self._never_touching:
            self._touching_pairs[pair] = None
        else:  # as in Box2D, two that cannot be pushed do not touch
            arbiter.process_collision = False

    def _on_contact_end(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        a, b = arbiter.shapes
        self._touching_pairs.pop((a, b), None)
        self._touching_pairs.pop((b, a), None)


def _record_arbiter(arbiter: pymunk.Arbiter, details: dict[ShapePair, _ContactDetail]) -> None:
    found = arbiter.contact_point_set
    points = tuple(((p.point_a.x + p.point_b.x) / 2, (p.point_a.y + p.point_b.y) / 2) for p in found.points)
    details[arbiter.shapes] = points, (found.normal.x, found.normal.y), arbiter.total_impulse.length


def apply_restitution(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
    """The larger restitution counts, and only above BOUNCE_SPEED; pymunk would multiply the two."""
    a, b = arbiter.shapes
    first, second = arbiter.bodies
    found = arbiter.contact_point_set
    if not found.points:
        return
    point = found.points[0].point_a
    approach = first.velocity_at_world_point(point) - second.velocity_at_world_point(point)
    speed = approach.dot(found.normal)
    arbiter.restitution = max(a.elasticity, b.elasticity) if speed > MIN_BOUNCE_SPEED else 0.0


WALL_FRICTION = 0.2
"""Box2D's default, which Flatland leaves to its walls."""

CONTACT_SLOP = 0.001
"""Permanent overlap allowed between touching shapes [m]: without any, a contact would come and go."""

MAX_SUBSTEPS = 250
"""Most substeps of a step; bodies too fast for them are slowed down."""


@dataclass(frozen=True, slots=True, eq=False)
class WallBody:
    """The wall segments of one layer, in one static body."""

    layer: str
    """The layer's first name."""
    bits: int
    ends: FloatArray
    """(n, 4) ``x1 y1 x2 y2`` in the world [m]."""
    segments: tuple[pymunk.Segment, ...]


class Physics:
    """The pymunk space: bodies, walls and the step."""

    def __init__(self, iterations: int, step_size: float) -> None:
        """``iterations``: of the solver, per step; pymunk has none of its own for positions."""
        self.walls: list[WallBody] = []
        self.bodies: list[PhysicalBody] = []
        """Bodies in load order: model by model, body by body."""
        self.poses_version = 0
        """Incremented at every change of a pose."""
        self.shapes_version = 0
        """Incremented whenever shapes are added or removed."""
        self._step_size = step_size
        self._substep = step_size
        self._has_changed = True
        """Whether anything was added to the space or removed since the last step."""
        self._space = pymunk.Space()
        self._space.iterations = iterations
        self._space.collision_slop = CONTACT_SLOP
        self._space.collision_bias = ERROR_BIAS
        self._space.on_collision(RESTITUTION_TYPE, None, pre_solve=apply_restitution)
        self._contact_tracker = ContactTracker(self._space)
        self._contacts: tuple[int, tuple[Contact, ...]] = (0, ())
        """Those at the version given first."""
        self._assemblies: dict[str, ModelAssembly] = {}
        self._moving: list[RigidBody] = []

    # Adding and removing

    def add_wall(self, layer: str, bits: int, ends: FloatArray) -> WallBody:
        """Adds segments (n, 4) ``x1 y1 x2 y2`` in the world [m], of zero thickness and two-sided."""
        body = pymunk.Body(body_type=pymunk.Body.STATIC)
        segments = tuple(pymunk.Segment(body, (x1, y1), (x2, y2), 0.0) for x1, y1, x2, y2 in ends.tolist())
        of_layer = pymunk.ShapeFilter(categories=bits, mask=bits)
        for segment in segments:
            segment.filter = of_layer
            segment.friction = friction_factor(WALL_FRICTION)
        self._space.add(body, *segments)
        self._shapes_changed()
        self._contact_tracker.add_wall(layer, self.shapes_version, segments)
        wall = WallBody(layer, bits, ends, segments)
        self.walls.append(wall)
        return wall

    def remove_wall(self, wall: WallBody) -> None:
        self._contact_tracker.remove(wall.segments)
        self._space.remove(*wall.segments)
        self.walls.remove(wall)
        self._shapes_changed()

    def add_model(self, model: Model) -> tuple[PhysicalBody, ...]:
        """Adds a model's bodies, at the model's pose, at rest."""
        assembly = assemble_model(model, self._step_size)
        for rigid in assembly.rigid_bodies:
            self._space.add(rigid.body, *rigid.body.shapes)
        self._space.add(*assembly.constraints)
        for body in assembly.bodies:
            self._shapes_changed()
            self._contact_tracker.add_body(body, self.shapes_version)
        self._contact_tracker.exclude_pairs(assembly.never_touching)
        self._assemblies[model.name] = assembly
        self._list_bodies()
        return assembly.bodies

    def remove_model(self, name: str) -> None:
        assembly = self._assemblies.pop(name)
        self._space.remove(*assembly.constraints)
        for rigid in assembly.rigid_bodies:
            shapes = tuple(rigid.body.shapes)
            self._contact_tracker.remove(shapes)
            self._space.remove(rigid.body, *shapes)
        self._list_bodies()
        self._shapes_changed()

    def _shapes_changed(self) -> None:
        self._has_changed = True
        self.shapes_version += 1
        self.poses_version += 1

    def _list_bodies(self) -> None:
        assemblies = self._assemblies.values()
        self.bodies = [body for assembly in assemblies for body in assembly.bodies]
        self._moving = [rigid for a in assemblies for rigid in a.rigid_bodies if not rigid.is_static]

    # The step

    def step(self) -> None:
        """Contacts at the present poses, then velocities, then poses: Box2D's order.

        pymunk moves bodies first, by the velocities of the step before; a velocity set in between would carry a
        body through a wall, and act one step late. So its bodies stay put in ``Space.step`` and move after it. A
        fast body splits the step into substeps, in each of which nothing moves farther than its ``max_travel``.
        """
        moving, count = self._moving, 1
        for rigid in moving:
            distance = rigid.speed_bound() * self._step_size
            if not distance <= rigid.max_travel:
                count = max(count, min(MAX_SUBSTEPS, math.ceil(distance / rigid.max_travel)))
        self._substep = substep = self._step_size / count
        for _ in range(count):
            for rigid in moving:
                rigid.update_velocity(substep)
            if self._has_changed:
                for rigid in moving:
                    rigid.keep_position()
                self._space.step(substep)
                self._has_changed = False
            else:  # pymunk's own step does nothing else then, since no callback of ours adds or removes anything
                chipmunk.cpSpaceStep(self._space._space, substep)
            for rigid in moving:
                rigid.update_pose(substep)
        for rigid in moving:
            rigid.commanded_twist = rigid.held_pose = None
        self.poses_version += 1

    def hold(self, body: PhysicalBody, pose: Pose) -> None:
        """Puts a body, and what is stiffly welded to it, there for a step, whatever is in its way."""
        body.hold(pose)
        self.poses_version += 1

    def move_model(self, name: str, pose: Pose) -> None:
        """Puts the first body of a model there, and the others around it as they were. Contacts are forgotten."""
        assembly = self._assemblies[name]
        start = assembly.bodies[0].pose
        for rigid in assembly.rigid_bodies:
            rigid.set_pose(pose.compose(start.relative(rigid.pose)))
            shapes = tuple(rigid.body.shapes)  # taken out and put back, they touch nothing
            self._space.remove(*shapes)
            self._space.add(*shapes)
        self._has_changed = True
        self.poses_version += 1

    # Contacts

    def is_touching(self, body: PhysicalBody) -> bool:
        """Returns whether the body touches anything, or one of its sensor footprints overlaps anything."""
        return self._contact_tracker.is_touching(body)

    def contacts(self) -> tuple[Contact, ...]:
        """All pairs of footprints, and of footprints and wall segments, that touched in the last step."""
        if self._contacts[0] != self.poses_version:
            self._contacts = self.poses_version, self._contact_tracker.contacts(self._substep)
        return self._contacts[1]
