"""Who touches whom: kept while the physics runs, told in the words of the world file."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import pymunk

from kit.sim.bodies import PhysicalBody
from kit.sim.state import Contact

BOUNCE_SPEED = 1.0
"""Slower impacts do not bounce [m/s], as in Box2D."""

Pair = tuple[pymunk.Shape, pymunk.Shape]

_Detail = tuple[tuple[tuple[float, float], ...], tuple[float, float], float]
"""Points, normal and impulse [N s] of a contact, as pymunk orders its shapes."""


@dataclass(frozen=True, slots=True, order=True)
class Owner:
    """Whose a shape is. Sorted as contacts name them: models before walls, each in the order they came."""

    is_wall: bool
    number: int
    entity: str
    body: str


class Contacts:
    """Pairs of shapes that touch, kept up to date by pymunk's callbacks."""

    def __init__(self, space: pymunk.Space) -> None:
        self._owners: dict[pymunk.Shape, Owner] = {}
        self._bodies: dict[pymunk.Shape, PhysicalBody] = {}
        self._touching: dict[Pair, None] = {}
        self._apart: set[frozenset[PhysicalBody]] = set()
        space.on_collision(begin=self._begin, separate=self._separate)

    def add_wall(self, layer: str, number: int, segments: Iterable[pymunk.Shape]) -> None:
        self._owners |= dict.fromkeys(segments, Owner(True, number, layer, layer))

    def add_body(self, body: PhysicalBody, number: int) -> None:
        self._owners |= dict.fromkeys(body.shapes, Owner(False, number, body.model, body.name))
        self._bodies |= dict.fromkeys(body.shapes, body)

    def keep_apart(self, pairs: Iterable[frozenset[PhysicalBody]]) -> None:
        """These bodies never touch."""
        self._apart |= set(pairs)

    def remove(self, shapes: Iterable[pymunk.Shape]) -> None:
        gone = set(shapes)
        self._touching = {pair: None for pair in self._touching if gone.isdisjoint(pair)}
        for shape in gone:
            del self._owners[shape]
            self._bodies.pop(shape, None)
        self._apart = {pair for pair in self._apart if all(gone.isdisjoint(body.shapes) for body in pair)}

    def touch(self, body: PhysicalBody) -> bool:
        """Whether the body touches anything, or one of its sensor footprints overlaps anything."""
        return any(self._bodies.get(shape) is body for pair in self._touching for shape in pair)

    def found(self, dt: float) -> tuple[Contact, ...]:
        """All of them, after a step of ``dt``."""
        details: dict[Pair, _Detail] = {}
        bodies = {
            self._bodies[s].rigid.body: None for pair in self._touching for s in pair if s in self._bodies
        }
        for body in bodies:
            body.each_arbiter(_note, details)
        pairs = sorted(map(self._ordered, self._touching), key=lambda pair: [self._owners[s] for s in pair])
        return tuple(self._contact(pair, details, dt) for pair in pairs)

    def _contact(self, pair: Pair, details: dict[Pair, _Detail], dt: float) -> Contact:
        a, b = (self._owners[shape] for shape in pair)
        points: tuple[tuple[float, float], ...] = ()
        normal, impulse = (0.0, 0.0), 0.0
        if pair in details:
            points, normal, impulse = details[pair]
        elif pair[::-1] in details:
            points, (x, y), impulse = details[pair[::-1]]
            normal = (-x, -y)
        return Contact(a.entity, a.body, b.entity, b.body, points, normal, impulse / dt)

    def _ordered(self, pair: Pair) -> Pair:
        a, b = pair
        return pair if self._owners[a] <= self._owners[b] else (b, a)

    def _begin(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        pair = arbiter.shapes
        bodies = frozenset(self._bodies[shape] for shape in pair if shape in self._bodies)
        pushable = any(body.description.kind == "dynamic" for body in bodies)
        if pushable and bodies not in self._apart:
            self._touching[pair] = None
        else:  # as in Box2D, two that cannot be pushed do not touch
            arbiter.process_collision = False

    def _separate(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        a, b = arbiter.shapes
        self._touching.pop((a, b), None)
        self._touching.pop((b, a), None)


def _note(arbiter: pymunk.Arbiter, details: dict[Pair, _Detail]) -> None:
    found = arbiter.contact_point_set
    points = tuple(((p.point_a.x + p.point_b.x) / 2, (p.point_a.y + p.point_b.y) / 2) for p in found.points)
    details[arbiter.shapes] = points, (found.normal.x, found.normal.y), arbiter.total_impulse.length


def bounce(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
    """The larger restitution counts, and only above BOUNCE_SPEED; pymunk would multiply the two."""
    a, b = arbiter.shapes
    first, second = arbiter.bodies
    found = arbiter.contact_point_set
    if not found.points:
        return
    point = found.points[0].point_a
    approach = first.velocity_at_world_point(point) - second.velocity_at_world_point(point)
    speed = approach.dot(found.normal)
    arbiter.restitution = max(a.elasticity, b.elasticity) if speed > BOUNCE_SPEED else 0.0
