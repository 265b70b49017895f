"""A world as its files describe it: frozen records, without I/O and without physics.

Field for field Flatland's format (world, layer and model YAML). Lengths in metres, angles in radians.
"""

from __future__ import annotations

import copyreg
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Literal

from kit.geometry import Pose
from kit.plain_text import counted

if TYPE_CHECKING:
    from kit.arrays import FloatArray

MAX_LAYERS = 16
"""Layer names in one world: Flatland has 16 collision bits."""

ALL_LAYERS = 0xFFFF
"""The bits of ``layers: ["all"]``, the default of a footprint and of a laser."""

Color = tuple[float, float, float, float]
"""Red, green, blue, alpha, each 0 to 1."""

BodyKind = Literal["dynamic", "kinematic", "static"]


def _read_only(values: dict[str, object]) -> MappingProxyType[str, object]:
    return MappingProxyType(values)


def _reduce_read_only(mapping: MappingProxyType[str, object]) -> tuple[object, ...]:
    return _read_only, (dict(mapping),)


copyreg.pickle(MappingProxyType, _reduce_read_only)  # type: ignore[arg-type]  # so that a world can be pickled and copied


@dataclass(frozen=True, slots=True, order=True)
class SourceLocation:
    """A position in a file: 1-based line and column."""

    file: Path
    line: int = 1
    column: int = 1

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


@dataclass(frozen=True, slots=True, order=True)
class ReadingRemark:
    """How a value was read that others may read otherwise: no mistake, but to be said once."""

    location: SourceLocation
    message: str

    def __str__(self) -> str:
        return f"{self.location}: {self.message}"


def turn_remark(location: SourceLocation, name: str, theta: float) -> ReadingRemark | None:
    """How a heading [rad] was read, if it is more than a whole turn, as those in degrees are."""
    if abs(theta) <= math.tau:
        return None
    return ReadingRemark(
        location,
        f"the heading {theta:g} of {name} was read as radians: {math.degrees(theta):g} degrees. "
        f"{theta:g} degrees are {math.radians(theta):.4g}.",
    )


@dataclass(frozen=True, slots=True, eq=False)
class Walls:
    """The zero-thickness, two-sided wall segments of one map, all in one static body.

    ``local``: (n, 4) float64, ``x1 y1 x2 y2`` [m] in the map's own frame; ``origin``: that frame's pose in
    the world.
    """

    local_segments: FloatArray
    origin: Pose
    file: Path
    """The map YAML."""
    drawing_file: Path
    """The image or .dat file it names."""
    readings: tuple[ReadingRemark, ...] = ()
    """How its values were read, where others read them otherwise."""

    @property
    def segments(self) -> FloatArray:
        """(n, 4) float64 ``x1 y1 x2 y2`` [m] in world coordinates."""
        import numpy as np  # only here: whatever reads a YAML file imports this module

        cos, sin = np.cos(self.origin.theta), np.sin(self.origin.theta)
        x, y = self.local_segments[:, 0::2], self.local_segments[:, 1::2]
        out = np.empty_like(self.local_segments)
        out[:, 0::2] = self.origin.x + cos * x - sin * y
        out[:, 1::2] = self.origin.y + sin * x + cos * y
        return out


@dataclass(frozen=True, slots=True, eq=False)
class Layer:
    """One entry of ``layers``: its names (the first is its identity), and its walls if it has a map."""

    names: tuple[str, ...]
    bits: int
    """One bit per name; the walls carry all of them."""
    color: Color
    walls: Walls | None
    properties: Mapping[str, object]
    location: SourceLocation

    @property
    def name(self) -> str:
        return self.names[0]


@dataclass(frozen=True, slots=True)
class Circle:
    center: tuple[float, float]
    radius: float

    @property
    def outer_points(self) -> list[tuple[tuple[float, float], float]]:
        """Its middle, and what lies around it [m]."""
        return [(self.center, self.radius)]


@dataclass(frozen=True, slots=True)
class Polygon:
    points: tuple[tuple[float, float], ...]
    """The corners of the convex hull of what the file lists, counter-clockwise, in the body's frame."""

    @property
    def outer_points(self) -> list[tuple[tuple[float, float], float]]:
        """Its corners, around which nothing lies."""
        return [(point, 0.0) for point in self.points]


@dataclass(frozen=True, slots=True)
class Footprint:
    """One shape of a body, and its collision filter."""

    shape: Circle | Polygon
    density: float
    """kg/m^2"""
    friction: float
    restitution: float
    sensor: bool
    collision: bool
    layers: tuple[str, ...]
    """Layers as written: ``("all",)`` or layer names."""
    category: int
    """The bits of its layers; what a laser compares with."""
    location: SourceLocation

    @property
    def mask(self) -> int:
        """The bits that it collides with: its category, or none with ``collision: false``."""
        return self.category if self.collision else 0


@dataclass(frozen=True, slots=True)
class Body:
    name: str
    pose: Pose
    """Pose in the model's frame."""
    kind: BodyKind
    color: Color
    linear_damping: float
    angular_damping: float
    footprints: tuple[Footprint, ...]
    location: SourceLocation


@dataclass(frozen=True, slots=True)
class JointAnchor:
    """One end of a joint: a body's name and a point [m] in that body's frame."""

    body: str
    point: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Joint:
    name: str
    kind: Literal["revolute", "weld"]
    anchors: tuple[JointAnchor, JointAnchor]
    color: Color
    collide_connected: bool
    limits: tuple[float, float] | None
    """Revolute only: [rad]."""
    angle: float
    """Weld only: [rad]."""
    frequency: float
    """Weld only: Hz, 0 is rigid."""
    damping: float
    """Weld only: damping ratio."""
    location: SourceLocation


@dataclass(frozen=True, slots=True)
class LaserMount:
    """Where a laser is mounted and which layers it sees. A plugin whose ``params`` has an attribute ``mount`` of this
    type is a laser."""

    body: str
    """The body that carries it."""
    bits: int
    """It sees footprints and walls whose category shares one of these bits."""
    origin: Pose = Pose()
    """Pose of the laser in that body's frame."""


@dataclass(frozen=True, slots=True)
class PluginSpec:
    """One entry of ``plugins``. ``params`` is what the reader of its type made of the other keys."""

    name: str
    type: str
    params: object
    location: SourceLocation


@dataclass(frozen=True, slots=True)
class Model:
    name: str
    namespace: str
    pose: Pose
    file: Path
    bodies: tuple[Body, ...]
    """Enabled bodies only, at least one."""
    joints: tuple[Joint, ...]
    plugins: tuple[PluginSpec, ...]
    location: SourceLocation

    def topic(self, name: str) -> str:
        """A plugin's topic name, absolute: under the model's namespace unless it starts with ``/``."""
        if name.startswith("/"):
            return name
        return f"/{self.namespace}/{name}" if self.namespace else f"/{name}"

    def frame(self, name: str) -> str:
        """A plugin's frame name: prefixed by the namespace unless it starts with ``/``, which is dropped."""
        if name.startswith("/"):
            return name[1:]
        return f"{self.namespace}_{name}" if self.namespace else name

    @property
    def outer_points(self) -> list[tuple[float, float, float]]:
        """Corners and middles of its footprints in its own frame, and what lies around each: ``x y radius`` [m]."""
        return [
            (*body.pose.transform_point(*point), radius)
            for body in self.bodies
            for footprint in body.footprints
            for point, radius in footprint.shape.outer_points
        ]

    @property
    def width(self) -> float:
        """The shorter side of the rectangle around it [m]: it fits through no narrower gap. 0 without footprints."""
        points = self.outer_points
        sides = (
            max((point[axis] + point[2] for point in points), default=0.0)
            - min((point[axis] - point[2] for point in points), default=0.0)
            for axis in (0, 1)
        )
        return min(sides)


@dataclass(frozen=True, slots=True, repr=False)
class World:
    file: Path
    layers: tuple[Layer, ...] = ()
    models: tuple[Model, ...] = ()
    plugins: tuple[PluginSpec, ...] = ()
    velocity_iterations: int = 10
    position_iterations: int = 10
    layer_bits: Mapping[str, int] = field(default_factory=lambda: MappingProxyType({}))
    """Every layer name and its bit."""

    def __repr__(self) -> str:
        """``World(maps/maze/world.yaml: 1 layer, models serp)``"""
        models = ", ".join(model.name for model in self.models)
        return f"World({self.file}: {counted(len(self.layers), 'layer')}, models {models or 'none'})"

    @property
    def remarks(self) -> tuple[ReadingRemark, ...]:
        """How values were read that others may read otherwise, each once, in the order of the files."""
        readings = {
            remark for layer in self.layers if layer.walls is not None for remark in layer.walls.readings
        }
        bodies = {
            (body.location, f"{body.name} of {model.file.name}", body.pose.theta)
            for model in self.models
            for body in model.bodies
        }
        headings = [(model.location, model.name, model.pose.theta) for model in self.models]
        turns = (turn_remark(*turn) for turn in (*headings, *sorted(bodies)))
        return (*sorted(readings), *filter(None, turns))

    @property
    def wall_segments(self) -> FloatArray:
        """(n, 4) float64 ``x1 y1 x2 y2`` [m] of all its maps in world coordinates, those of a map once."""
        import numpy as np  # as above

        maps = {layer.walls.file: layer.walls for layer in self.layers if layer.walls is not None}
        return np.concatenate([np.empty((0, 4)), *(walls.segments for walls in maps.values())])
