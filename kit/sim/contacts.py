"""Tracks the shapes that touch while the physics runs, and reports them by the names of the world file."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import pymunk

from kit.sim.bodies import PhysicalBody
from kit.sim.state import Contact

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
        space.on_collision(begin=self._begin, separate=self._separate)

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
            map(self._ordered, self._touching_pairs), key=lambda pair: [self._shape_owners[s] for s in pair]
        )
        return tuple(self._contact(pair, details, dt) for pair in pairs)

    def _contact(self, pair: ShapePair, details: dict[ShapePair, _ContactDetail], dt: float) -> Contact:
        a, b = (self._shape_owners[shape] for shape in pair)
        points: tuple[tuple[float, float], ...] = ()
        normal, impulse = (0.0, 0.0), 0.0
        if pair in details:
            points, normal, impulse = details[pair]
        elif pair[::-1] in details:
            points, (x, y), impulse = details[pair[::-1]]
            normal = (-x, -y)
        return Contact(a.entity, a.body, b.entity, b.body, points, normal, impulse / dt)

    def _ordered(self, pair: ShapePair) -> ShapePair:
        a, b = pair
        return pair if self._shape_owners[a] <= self._shape_owners[b] else (b, a)

    def _begin(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        pair = arbiter.shapes
        bodies = frozenset(self._shape_bodies[shape] for shape in pair if shape in self._shape_bodies)
        pushable = any(body.description.kind == "dynamic" for body in bodies)
        if pushable and bodies not in self._never_touching:
            self._touching_pairs[pair] = None
        else:  # as in Box2D, two that cannot be pushed do not touch
            arbiter.process_collision = False

    def _separate(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
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
