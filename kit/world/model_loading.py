"""Flatland's model files, read into records: bodies, footprints and joints."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Literal

from kit.geometry import Pose, convex_hull, polygon_area
from kit.plain_text import quoted, suggestion
from kit.world.plugin_reader import (
    ModelScope,
    PluginReader,
    read_layer_names,
    read_named,
    read_plugins,
)
from kit.world.records import (
    Body,
    BodyKind,
    Circle,
    Color,
    Footprint,
    Joint,
    JointAnchor,
    Model,
    Polygon,
    SourceLocation,
)
from kit.world.yaml_section import Section

DEFAULT_COLOR: Color = (1.0, 1.0, 1.0, 0.5)

MAX_CORNERS = 8
"""Box2D's limit for a polygon."""

MIN_AREA = 1e-8
"""m^2: a polygon must be larger than a tenth of a millimetre squared, or it is a line."""


@dataclass(frozen=True, slots=True)
class ModelPlacement:
    """Name, namespace, pose and file of a model, from a world file or a spawn request."""

    name: str
    namespace: str
    pose: Pose
    file: Path
    location: SourceLocation


def read_model(
    section: Section,
    entry: ModelPlacement,
    layer_bits: Mapping[str, int],
    plugin_readers: Mapping[str, PluginReader] | None,
) -> Model:
    """The model that a model file's mapping describes. What is wrong is noted.

    ================================= ============================================================================
    bodies                            what it is made of
    bodies[].name                     its name, which no other body of the model has
    bodies[].enabled                  false: the entry is not read
    bodies[].pose                     where it stands in the model [m, m, rad]
    bodies[].type                     ``dynamic`` moves and is pushed, ``kinematic`` moves and is not pushed,
                                      ``static`` stands
    bodies[].color                    its colour
    bodies[].linear_damping           how fast it slows down by itself [1/s]
    bodies[].angular_damping          how fast its turning slows down by itself [1/s]
    bodies[].footprints               its shapes
    bodies[].footprints[].type        its shape
    bodies[].footprints[].center      the circle's middle in the body's frame [m]
    bodies[].footprints[].radius      the circle's radius [m]
    bodies[].footprints[].points      corners in the body's frame [m]; their convex hull is taken
    bodies[].footprints[].density     mass per area [kg/m^2]
    bodies[].footprints[].friction    coefficient of friction
    bodies[].footprints[].restitution how much of its speed it keeps when it bounces
    bodies[].footprints[].sensor      true: it feels what overlaps it, and nothing bounces off it
    bodies[].footprints[].collision   false: nothing collides with it, lasers still see it
    bodies[].footprints[].layers      it touches, and is seen by, what shares one of these layers; all: everything
    joints                            what holds two bodies together
    joints[].name                     its name, which no other joint of the model has
    joints[].enabled                  false: the entry is not read
    joints[].type                     ``revolute`` turns, ``weld`` does not
    joints[].bodies                   its two ends
    joints[].bodies[].name            the body at this end
    joints[].bodies[].anchor          the point of that body that is held [m]
    joints[].color                    its colour
    joints[].collide_connected        whether the two bodies collide with each other
    joints[].limits                   lowest and highest angle [rad]; without it none
    joints[].angle                    angle of the second body to the first [rad]
    joints[].frequency                how fast it swings back [Hz]; 0: it is rigid
    joints[].damping                  damping ratio of that swing
    plugins                           its devices
    plugins[].name                    its name, which no other plugin of the model has
    plugins[].type                    its type; the other keys are those of the type
    plugins[].enabled                 false: the entry is not read
    ================================= ============================================================================
    """
    sections = section.sections("bodies", at_least=1)
    bodies = read_named(sections, "body", partial(_read_body, layer_bits=layer_bits))
    if sections and not bodies:
        section.error("a model needs an enabled body", "bodies")
    names = [body.name for body in bodies]
    model = Model(
        name=entry.name,
        namespace=entry.namespace,
        pose=entry.pose,
        file=entry.file,
        bodies=bodies,
        joints=read_named(section.sections("joints", ()), "joint", partial(_read_joint, bodies=names)),
        plugins=(),
        location=entry.location,
    )
    scope = ModelScope(model, layer_bits)
    plugins = read_plugins(section.sections("plugins", ()), scope, plugin_readers)
    section.finish()
    return replace(model, plugins=plugins)


def _read_body(section: Section, layer_bits: Mapping[str, int]) -> Body:
    return Body(
        name=section.name("name"),
        pose=section.pose("pose", Pose()),
        kind=section.choice("type", _BODY_KINDS, "dynamic"),
        color=section.color("color", DEFAULT_COLOR),
        linear_damping=section.number("linear_damping", 0.0, minimum=0),
        angular_damping=section.number("angular_damping", 0.0, minimum=0),
        footprints=tuple(
            _read_footprint(footprint, layer_bits) for footprint in section.sections("footprints")
        ),
        location=section.location,
    )


def _read_footprint(section: Section, layer_bits: Mapping[str, int]) -> Footprint:
    read_shape = section.choice("type", _SHAPES)
    layers, category = read_layer_names(section, "layers", layer_bits)
    footprint = Footprint(
        shape=_UNKNOWN_SHAPE if read_shape is None else read_shape(section),
        density=section.number("density", minimum=0),
        friction=section.number("friction", 0.0, minimum=0),
        restitution=section.number("restitution", 0.0, minimum=0),
        sensor=section.flag("sensor", False),
        collision=section.flag("collision", True),
        layers=layers,
        category=category,
        location=section.location,
    )
    if read_shape is None:
        section.remaining_values()
    section.finish()
    return footprint


def _read_circle(section: Section) -> Circle:
    return Circle(section.point("center", (0.0, 0.0)), section.number("radius", above=0))


def _read_polygon(section: Section) -> Polygon:
    points = section.points("points", at_least=3, at_most=MAX_CORNERS)
    corners = convex_hull(points)
    if len(points) >= 3 and polygon_area(corners) < MIN_AREA:
        section.error("the points of a polygon must not all lie on one line", "points")
    return Polygon(corners)


def _read_joint(section: Section, bodies: Collection[str]) -> Joint:
    kind = section.choice("type", _JOINT_KINDS)
    ends = section.sections("bodies", length=2)
    anchors = [_read_anchor(end, bodies) for end in ends] or [JointAnchor("", (0.0, 0.0))] * 2
    if anchors[0].body and anchors[0].body == anchors[1].body:
        section.error(f"a joint needs two bodies, not {quoted(anchors[0].body)} twice", "bodies")
    joint = Joint(
        name=section.name("name"),
        kind=kind or "revolute",
        anchors=(anchors[0], anchors[1]),
        color=section.color("color", DEFAULT_COLOR),
        collide_connected=section.flag("collide_connected", False),
        limits=_read_joint_limits(section) if kind == "revolute" else None,
        angle=section.number("angle", 0.0) if kind == "weld" else 0.0,
        frequency=section.number("frequency", 0.0, minimum=0) if kind == "weld" else 0.0,
        damping=section.number("damping", 0.0, minimum=0) if kind == "weld" else 0.0,
        location=section.location,
    )
    if kind is None:
        section.remaining_values()
    return joint


def _read_anchor(section: Section, bodies: Collection[str]) -> JointAnchor:
    body = section.name("name")
    if body and body not in bodies:
        section.error(f"no body has the name {quoted(body)}: {suggestion(body, bodies)}", "name")
    anchor = JointAnchor(body, section.point("anchor"))
    section.finish()
    return anchor


def _read_joint_limits(section: Section) -> tuple[float, float] | None:
    if not section.has("limits"):
        return None
    low, high = section.numbers("limits", length=2)
    if low > high:
        section.error('"limits" must be [lowest, highest]', "limits")
    return low, high


_BODY_KINDS: Mapping[str, BodyKind] = MappingProxyType(
    {"dynamic": "dynamic", "kinematic": "kinematic", "static": "static"}
)

_JOINT_KINDS: Mapping[str, Literal["revolute", "weld"]] = MappingProxyType(
    {"revolute": "revolute", "weld": "weld"}
)

_SHAPES: Mapping[str, Callable[[Section], Circle | Polygon]] = MappingProxyType(
    {"circle": _read_circle, "polygon": _read_polygon}
)
_UNKNOWN_SHAPE = Circle((0.0, 0.0), 1.0)
