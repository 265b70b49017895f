"""Predicts from the records, without a simulation, which bodies collide, what each laser sees, and why.

Two footprints touch when they share a layer, neither has ``collision: false``, at least one of their bodies is
dynamic, and no joint that joins the bodies forbids it. A laser sees a footprint that is in one of the laser's
layers, colliding or not, unless it is a sensor or the ray starts inside it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum
from itertools import combinations
from typing import NamedTuple

from kit.geometry import Pose
from kit.world.records import ALL_LAYERS, Circle, Footprint, LaserMount, Layer, Model, World


class CollisionFilter(NamedTuple):
    """Category, mask and sensor flag of a footprint or of walls: what decides about contacts and visibility."""

    category: int
    mask: int
    is_sensor: bool


@dataclass(frozen=True, slots=True)
class CollisionBody:
    """A rigid body: one of a model, or all walls of one entry of ``layers``, which count as a static one."""

    model: str | None
    """None for walls."""
    body: str
    """For walls, the layer's first name."""
    is_dynamic: bool
    filters: frozenset[CollisionFilter]

    @property
    def name(self) -> str:
        return f"walls of {self.body}" if self.model is None else f"{self.model}/{self.body}"


@dataclass(frozen=True, slots=True)
class LaserPlugin:
    """A laser plugin of a model."""

    model: str
    plugin: str
    mount: LaserMount

    @property
    def name(self) -> str:
        return f"{self.model}/{self.plugin}"


class ContactKind(Enum):
    """The kind of contact between two bodies."""

    COLLIDES = "collides with"
    SENSES = "senses"
    PASSES = "passes through"


class RuleReason(Enum):
    """The reason for a rule; its text is completed with the names of layers or of a joint."""

    SHARED_LAYER = "both in {}"
    SENSOR = "both in {}, but a sensor only notices"
    COLLISION_OFF = "both in {}, but collision: false"
    NO_SHARED_LAYER = "no layer in common"
    NO_FOOTPRINT = "one has no footprint"
    NEITHER_MOVES = "neither is dynamic"
    JOINED = "joined by {} without collide_connected"
    SAME_BODY = "one rigid body"
    SEEN = "it is in {}"
    SEEN_BUT_FOR_ITS_OWN = "it is in {}; not the footprint around the laser"
    INSIDE = "it is in {}, but the rays start inside it"
    SENSORS_UNSEEN = "it is in {}, but no ray meets a sensor"


@dataclass(frozen=True, slots=True)
class ContactRule:
    """The kind of contact between two bodies, and its reason."""

    kind: ContactKind
    reason: RuleReason
    names: tuple[str, ...] = ()
    """The layers they share, or the joint."""

    @property
    def explanation(self) -> str:
        return self.reason.value.format(", ".join(self.names))


@dataclass(frozen=True, slots=True)
class LaserVisibility:
    """Whether a laser sees a body, and why."""

    is_visible: bool
    reason: RuleReason
    names: tuple[str, ...] = ()
    """The layers by which it does, or would."""

    @property
    def explanation(self) -> str:
        return self.reason.value.format(", ".join(self.names))


class CollisionRules:
    """The contact and visibility rules of one world. ``bodies`` and ``lasers`` are in load order, walls first."""

    def __init__(self, world: World) -> None:
        self._layer_bits = world.layer_bits
        self.bodies: tuple[CollisionBody, ...] = (*_wall_bodies(world.layers), *_model_bodies(world.models))
        self.lasers: tuple[LaserPlugin, ...] = tuple(_lasers(world.models))
        self._model_bodies = {(m.name, b.name): b for m in world.models for b in m.bodies}
        self._joints: dict[tuple[str | None, frozenset[str]], str] = {
            (model.name, frozenset(anchor.body for anchor in joint.anchors)): joint.name
            for model in world.models
            for joint in model.joints
            if not joint.collide_connected
        }
        self._rules_by_filters: dict[
            tuple[frozenset[CollisionFilter], frozenset[CollisionFilter]], ContactRule
        ] = {}

    def contact_rule(self, a: CollisionBody, b: CollisionBody) -> ContactRule:
        """Returns the contact rule of two bodies."""
        if a.model == b.model and a.body == b.body:
            return ContactRule(ContactKind.PASSES, RuleReason.SAME_BODY)
        if not a.is_dynamic and not b.is_dynamic:
            return ContactRule(ContactKind.PASSES, RuleReason.NEITHER_MOVES)
        if a.model == b.model and (joint := self._joints.get((a.model, frozenset({a.body, b.body})))):
            return ContactRule(ContactKind.PASSES, RuleReason.JOINED, (joint,))
        key = (a.filters, b.filters)
        if key not in self._rules_by_filters:
            self._rules_by_filters[key] = self._rule_for_filters(*key)
        return self._rules_by_filters[key]

    def contact_rules(self) -> Iterator[tuple[CollisionBody, CollisionBody, ContactRule]]:
        """Yields every pair of bodies once, with its rule."""
        return ((a, b, self.contact_rule(a, b)) for a, b in combinations(self.bodies, 2))

    def visibility(self, laser: LaserPlugin, body: CollisionBody) -> LaserVisibility:
        """Returns whether the laser sees a body that stands in its rays."""
        outside, around = self._split_by_laser(laser, body)
        bits = laser.mount.bits
        seen = _bit_union(s.category & bits for s in outside if not s.is_sensor)
        hidden = _bit_union(s.category & bits for s in around if not s.is_sensor)
        sensors = _bit_union(s.category & bits for s in body.filters if s.is_sensor)
        if seen:
            cause = RuleReason.SEEN_BUT_FOR_ITS_OWN if hidden else RuleReason.SEEN
            return LaserVisibility(True, cause, self._layer_names(seen))
        for shared, cause in ((hidden, RuleReason.INSIDE), (sensors, RuleReason.SENSORS_UNSEEN)):
            if shared:
                return LaserVisibility(False, cause, self._layer_names(shared))
        return LaserVisibility(False, RuleReason.NO_SHARED_LAYER if body.filters else RuleReason.NO_FOOTPRINT)

    def visibilities(self) -> Iterator[tuple[LaserPlugin, CollisionBody, LaserVisibility]]:
        """Yields every laser with every body."""
        return ((laser, body, self.visibility(laser, body)) for laser in self.lasers for body in self.bodies)

    def _rule_for_filters(self, a: frozenset[CollisionFilter], b: frozenset[CollisionFilter]) -> ContactRule:
        collides = senses = passes = 0
        for one in a:
            for other in b:
                shared = one.category & other.category
                if not (one.mask & other.category and other.mask & one.category):
                    passes |= shared
                elif one.is_sensor or other.is_sensor:
                    senses |= shared
                else:
                    collides |= shared
        for bits, touch, cause in (
            (collides, ContactKind.COLLIDES, RuleReason.SHARED_LAYER),
            (senses, ContactKind.SENSES, RuleReason.SENSOR),
            (passes, ContactKind.PASSES, RuleReason.COLLISION_OFF),
        ):
            if bits:
                return ContactRule(touch, cause, self._layer_names(bits))
        return ContactRule(
            ContactKind.PASSES, RuleReason.NO_SHARED_LAYER if a and b else RuleReason.NO_FOOTPRINT
        )

    def _split_by_laser(
        self, laser: LaserPlugin, body: CollisionBody
    ) -> tuple[frozenset[CollisionFilter], frozenset[CollisionFilter]]:
        """Splits a body's filters into those of footprints that do not, and that do, contain the laser."""
        if (laser.model, laser.mount.body) != (body.model, body.body):
            return body.filters, frozenset()
        sides: tuple[set[CollisionFilter], set[CollisionFilter]] = (set(), set())
        for footprint in self._model_bodies[laser.model, laser.mount.body].footprints:
            sides[footprint_contains(footprint, laser.mount.origin)].add(_filter_of(footprint))
        return frozenset(sides[False]), frozenset(sides[True])

    def _layer_names(self, bits: int) -> tuple[str, ...]:
        if bits == ALL_LAYERS:
            return ("all layers",)
        return tuple(name for name, bit in self._layer_bits.items() if bit & bits)


def _wall_bodies(layers: Iterable[Layer]) -> Iterator[CollisionBody]:
    for layer in layers:
        if layer.walls is not None:
            yield CollisionBody(
                None, layer.name, False, frozenset({CollisionFilter(layer.bits, layer.bits, False)})
            )


def _model_bodies(models: Iterable[Model]) -> Iterator[CollisionBody]:
    for model in models:
        for body in model.bodies:
            surfaces = frozenset(_filter_of(footprint) for footprint in body.footprints)
            yield CollisionBody(model.name, body.name, body.kind == "dynamic", surfaces)


def _lasers(models: Iterable[Model]) -> Iterator[LaserPlugin]:
    for model in models:
        for plugin in model.plugins:
            mount = getattr(plugin.params, "mount", None)
            if isinstance(mount, LaserMount):
                yield LaserPlugin(model.name, plugin.name, mount)


def _filter_of(footprint: Footprint) -> CollisionFilter:
    return CollisionFilter(footprint.category, footprint.mask, footprint.sensor)


def footprint_contains(footprint: Footprint, origin: Pose) -> bool:
    """Returns whether a point given in the body's frame lies in the footprint."""
    shape = footprint.shape
    if isinstance(shape, Circle):
        return math.dist(shape.center, origin[:2]) <= shape.radius
    corners = zip(shape.points, shape.points[1:] + shape.points[:1], strict=True)
    return all((bx - ax) * (origin.y - ay) >= (by - ay) * (origin.x - ax) for (ax, ay), (bx, by) in corners)


def _bit_union(bits: Iterable[int]) -> int:
    union = 0
    for some in bits:
        union |= some
    return union
