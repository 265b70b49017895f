"""Who collides with whom, which laser sees whom, and why: told from the records, without a simulation.

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
from kit.world.records import ALL_LAYERS, Circle, Footprint, Layer, Model, Sight, World

__all__ = [
    "Cause",
    "Laser",
    "Seeing",
    "Sight",
    "Surface",
    "Thing",
    "Touch",
    "Touching",
    "Verdict",
    "contains",
]


class Surface(NamedTuple):
    """What matters of a footprint, or of walls, for touching and seeing."""

    category: int
    mask: int
    sensor: bool


@dataclass(frozen=True, slots=True)
class Thing:
    """A rigid body: one of a model, or all walls of one entry of ``layers``, which count as a static one."""

    model: str | None
    """None for walls."""
    body: str
    """For walls, the layer's first name."""
    dynamic: bool
    surfaces: frozenset[Surface]

    @property
    def name(self) -> str:
        return f"walls of {self.body}" if self.model is None else f"{self.model}/{self.body}"


@dataclass(frozen=True, slots=True)
class Laser:
    """A plugin that sees."""

    model: str
    plugin: str
    sight: Sight

    @property
    def name(self) -> str:
        return f"{self.model}/{self.plugin}"


class Touch(Enum):
    """What happens where two bodies meet."""

    COLLIDES = "collides with"
    SENSES = "senses"
    PASSES = "passes through"


class Cause(Enum):
    """Why; the text is completed with the names of layers or of a joint."""

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
class Verdict:
    """What two bodies do where they meet, and why."""

    touch: Touch
    cause: Cause
    names: tuple[str, ...] = ()
    """The layers they share, or the joint."""

    @property
    def why(self) -> str:
        return self.cause.value.format(", ".join(self.names))


@dataclass(frozen=True, slots=True)
class Seeing:
    """Whether a laser sees a body, and why."""

    sees: bool
    cause: Cause
    names: tuple[str, ...] = ()
    """The layers by which it does, or would."""

    @property
    def why(self) -> str:
        return self.cause.value.format(", ".join(self.names))


class Touching:
    """Answers for one world. ``things`` and ``lasers`` are in load order, walls first."""

    def __init__(self, world: World) -> None:
        self._layer_bits = world.layer_bits
        self.things: tuple[Thing, ...] = (*_walls(world.layers), *_bodies(world.models))
        self.lasers: tuple[Laser, ...] = tuple(_lasers(world.models))
        self._carriers = {(m.name, b.name): b for m in world.models for b in m.bodies}
        self._joined: dict[tuple[str | None, frozenset[str]], str] = {
            (model.name, frozenset(anchor.body for anchor in joint.anchors)): joint.name
            for model in world.models
            for joint in model.joints
            if not joint.collide_connected
        }
        self._by_surfaces: dict[tuple[frozenset[Surface], frozenset[Surface]], Verdict] = {}

    def between(self, a: Thing, b: Thing) -> Verdict:
        """What happens where the two meet."""
        if a.model == b.model and a.body == b.body:
            return Verdict(Touch.PASSES, Cause.SAME_BODY)
        if not a.dynamic and not b.dynamic:
            return Verdict(Touch.PASSES, Cause.NEITHER_MOVES)
        if a.model == b.model and (joint := self._joined.get((a.model, frozenset({a.body, b.body})))):
            return Verdict(Touch.PASSES, Cause.JOINED, (joint,))
        key = (a.surfaces, b.surfaces)
        if key not in self._by_surfaces:
            self._by_surfaces[key] = self._meeting(*key)
        return self._by_surfaces[key]

    def pairs(self) -> Iterator[tuple[Thing, Thing, Verdict]]:
        """Every pair of things, each once."""
        return ((a, b, self.between(a, b)) for a, b in combinations(self.things, 2))

    def seeing(self, laser: Laser, thing: Thing) -> Seeing:
        """Whether the laser sees the thing when it stands in its way."""
        outside, around = self._sides(laser, thing)
        bits = laser.sight.bits
        seen = _union(s.category & bits for s in outside if not s.sensor)
        hidden = _union(s.category & bits for s in around if not s.sensor)
        sensors = _union(s.category & bits for s in thing.surfaces if s.sensor)
        if seen:
            cause = Cause.SEEN_BUT_FOR_ITS_OWN if hidden else Cause.SEEN
            return Seeing(True, cause, self._names(seen))
        for shared, cause in ((hidden, Cause.INSIDE), (sensors, Cause.SENSORS_UNSEEN)):
            if shared:
                return Seeing(False, cause, self._names(shared))
        return Seeing(False, Cause.NO_SHARED_LAYER if thing.surfaces else Cause.NO_FOOTPRINT)

    def views(self) -> Iterator[tuple[Laser, Thing, Seeing]]:
        """Every laser with every thing."""
        return ((laser, thing, self.seeing(laser, thing)) for laser in self.lasers for thing in self.things)

    def _meeting(self, a: frozenset[Surface], b: frozenset[Surface]) -> Verdict:
        collides = senses = passes = 0
        for one in a:
            for other in b:
                shared = one.category & other.category
                if not (one.mask & other.category and other.mask & one.category):
                    passes |= shared
                elif one.sensor or other.sensor:
                    senses |= shared
                else:
                    collides |= shared
        for bits, touch, cause in (
            (collides, Touch.COLLIDES, Cause.SHARED_LAYER),
            (senses, Touch.SENSES, Cause.SENSOR),
            (passes, Touch.PASSES, Cause.COLLISION_OFF),
        ):
            if bits:
                return Verdict(touch, cause, self._names(bits))
        return Verdict(Touch.PASSES, Cause.NO_SHARED_LAYER if a and b else Cause.NO_FOOTPRINT)

    def _sides(self, laser: Laser, thing: Thing) -> tuple[frozenset[Surface], frozenset[Surface]]:
        """The thing's surfaces that do not, and that do, lie around the laser: its own body's may."""
        if (laser.model, laser.sight.body) != (thing.model, thing.body):
            return thing.surfaces, frozenset()
        sides: tuple[set[Surface], set[Surface]] = (set(), set())
        for footprint in self._carriers[laser.model, laser.sight.body].footprints:
            sides[contains(footprint, laser.sight.origin)].add(_surface(footprint))
        return frozenset(sides[False]), frozenset(sides[True])

    def _names(self, bits: int) -> tuple[str, ...]:
        if bits == ALL_LAYERS:
            return ("all layers",)
        return tuple(name for name, bit in self._layer_bits.items() if bit & bits)


def _walls(layers: Iterable[Layer]) -> Iterator[Thing]:
    for layer in layers:
        if layer.walls is not None:
            yield Thing(None, layer.name, False, frozenset({Surface(layer.bits, layer.bits, False)}))


def _bodies(models: Iterable[Model]) -> Iterator[Thing]:
    for model in models:
        for body in model.bodies:
            surfaces = frozenset(_surface(footprint) for footprint in body.footprints)
            yield Thing(model.name, body.name, body.kind == "dynamic", surfaces)


def _lasers(models: Iterable[Model]) -> Iterator[Laser]:
    for model in models:
        for plugin in model.plugins:
            sight = getattr(plugin.params, "sight", None)
            if isinstance(sight, Sight):
                yield Laser(model.name, plugin.name, sight)


def _surface(footprint: Footprint) -> Surface:
    return Surface(footprint.category, footprint.mask, footprint.sensor)


def contains(footprint: Footprint, origin: Pose) -> bool:
    """Whether a point given in the body's frame lies in the footprint."""
    shape = footprint.shape
    if isinstance(shape, Circle):
        return math.dist(shape.center, origin[:2]) <= shape.radius
    corners = zip(shape.points, shape.points[1:] + shape.points[:1], strict=True)
    return all((bx - ax) * (origin.y - ay) >= (by - ay) * (origin.x - ax) for (ax, ay), (bx, by) in corners)


def _union(bits: Iterable[int]) -> int:
    union = 0
    for some in bits:
        union |= some
    return union
