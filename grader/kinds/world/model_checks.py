"""Checks of the parts of a world's models: bodies, joints, topics of plugins, lasers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from grader.check import Check
from grader.kinds.world.facts import BodyFacts, PluginFacts, WorldFacts
from grader.kinds.world.faults import UNSPECIFIED, NotInWorld, find_model, format_metres, world_check
from kit.plain_text import counted, quoted, suggestion


@dataclass(frozen=True, slots=True)
class BodyParams:
    model: str = "robot"
    body: str = "base"
    kind: str = ""
    """dynamic, static or kinematic"""
    shape: str = ""
    """circle or polygon"""
    footprints: int = 0
    """How many; 0: any number."""
    x: float = UNSPECIFIED
    y: float = UNSPECIFIED
    """Where it is in the model."""
    length: float = UNSPECIFIED
    width: float = UNSPECIFIED
    front: float = UNSPECIFIED
    """x of its foremost point, in its own frame"""
    collision: str = ""
    sensor: str = ""
    """yes or no, of all its footprints"""
    within: float = 0.003


def _find_body(world: WorldFacts, model_name: str, body: str) -> BodyFacts:
    bodies = {part.name: part for part in find_model(world, model_name).bodies}
    if body not in bodies:
        raise NotInWorld(f"{model_name} has no body {quoted(body)}: {suggestion(body, [*bodies])}")
    return bodies[body]


@world_check(BodyParams)
def body(world: WorldFacts, params: BodyParams) -> Iterator[str]:
    """A body is not as the task asks:"""
    part = _find_body(world, params.model, params.body)
    name = f"{params.model}/{part.name}"
    if params.kind and part.kind != params.kind:
        yield f"{name} is {part.kind}, not {params.kind}"
    if params.footprints and len(part.shapes) != params.footprints:
        yield f"{name} has {counted(len(part.shapes), 'footprint')}, not {params.footprints}"
    if params.shape and (other := [each.kind for each in part.shapes if each.kind != params.shape]):
        yield f"{name} has a {other[0]} for a footprint, not a {params.shape}"
    if part.box is None:
        yield f"{name} has no footprint, so it is nowhere"
        return
    left, bottom, right, top = part.box
    for what, actual, expected in (
        ("is this long", right - left, params.length),
        ("is this wide", top - bottom, params.width),
        ("has its front at x", right, params.front),
        ("is at x", part.pose[0], params.x),
        ("is at y", part.pose[1], params.y),
    ):
        if abs(actual - expected) > params.within:
            yield f"{name} {what}: {format_metres(actual)}; {format_metres(expected)} is wanted"
    for what, flags, setting in (
        ("collision", [each.collision for each in part.shapes], params.collision),
        ("sensor", [each.sensor for each in part.shapes], params.sensor),
    ):
        if setting and any(flag != (setting == "yes") for flag in flags):
            yield f"{name} has {what}: {str(setting != 'yes').lower()}"


@dataclass(frozen=True, slots=True)
class JointParams:
    model: str = "robot"
    a: str = "base"
    b: str = "wheel"
    kind: str = ""
    """weld or revolute"""
    x: float = UNSPECIFIED
    y: float = UNSPECIFIED
    """Where both ends are, in the model's frame."""
    within: float = 0.005


@world_check(JointParams)
def joint(world: WorldFacts, params: JointParams) -> Iterator[str]:
    """A joint is not as the task asks:"""
    ends = {params.a, params.b}
    joint = next((each for each in find_model(world, params.model).joints if set(each.bodies) == ends), None)
    if joint is None:
        raise NotInWorld(f"no joint joins {params.a} and {params.b} of {params.model}")
    if params.kind and joint.kind != params.kind:
        yield f"the joint {joint.name} is {joint.kind}, not {params.kind}"
    for name, (x, y) in zip(joint.bodies, joint.ends, strict=True):
        if abs(x - params.x) > params.within or abs(y - params.y) > params.within:
            yield (
                f"the joint {joint.name} holds {name} at [{x:.3g}, {y:.3g}] of the model, "
                f"not at [{params.x:g}, {params.y:g}]: an anchor counts from its own body"
            )


@dataclass(frozen=True, slots=True)
class PluginTopicsParams:
    model: str = ""
    """By default any."""
    topics: tuple[str, ...] = ()
    """Each a name, perhaps with the type of its messages after a space."""


def _wrong_topics(world: WorldFacts, params: PluginTopicsParams, *, publishes: bool) -> Iterator[str]:
    types = {
        end.topic: end.type
        for end in world.endpoints
        if end.publishes is publishes and params.model in ("", end.model)
    }
    others = {end.topic for end in world.endpoints if end.publishes is not publishes}
    does, other = ("publishes", "subscribed") if publishes else ("subscribes", "published")
    for each in params.topics:
        topic, _, kind = each.partition(" ")
        if topic in types:
            if kind and types[topic] != kind:
                yield f"{topic} carries {types[topic]}, not {kind}"
        elif topic in others:
            yield f"{topic} is only {other} by a plugin: nothing {does} it"
        else:
            yield f"no plugin {does} {topic}: {suggestion(topic, tuple(types))}"


@world_check(PluginTopicsParams)
def publishes(world: WorldFacts, params: PluginTopicsParams) -> Iterator[str]:
    """The world's plugins do not publish what the task asks:"""
    return _wrong_topics(world, params, publishes=True)


@world_check(PluginTopicsParams)
def subscribes(world: WorldFacts, params: PluginTopicsParams) -> Iterator[str]:
    """The world's plugins do not subscribe to what the task asks:"""
    return _wrong_topics(world, params, publishes=False)


@dataclass(frozen=True, slots=True)
class LaserCheckParams:
    laser: str = "robot/lidar"
    """Model and plugin."""
    body: str = ""
    rays: int = 0
    first: float = UNSPECIFIED
    last: float = UNSPECIFIED
    """rad"""
    range: float = UNSPECIFIED
    within: float = 0.01


@world_check(LaserCheckParams)
def laser(world: WorldFacts, params: LaserCheckParams) -> Iterator[str]:
    """The laser is not as the task asks:"""
    device = _find_laser(world, params.laser)
    if params.body and device.body != params.body:
        yield f"{params.laser} sits on {device.body}, not on {params.body}"
    if params.rays and device.rays != params.rays:
        yield (
            f"{params.laser} has {device.rays} rays, not {params.rays}: there are (max - min) / increment + 1"
        )
    for what, actual, expected in (
        ("first ray points to", device.first, params.first),
        ("last ray points to", device.last, params.last),
        ("range is", device.range, params.range),
    ):
        if abs(actual - expected) > params.within:
            yield f"the {what} {actual:.4g}, not {expected:.4g}"


def _find_laser(world: WorldFacts, name: str) -> PluginFacts:
    model_name, _, plugin = name.partition("/")
    devices = {device.name: device for device in find_model(world, model_name).plugins}
    if plugin not in devices:
        raise NotInWorld(f"{model_name} has no plugin {quoted(plugin)}: {suggestion(plugin, [*devices])}")
    if not devices[plugin].rays:
        raise NotInWorld(f"{name} is a {devices[plugin].type}, not a Laser")
    return devices[plugin]


MODEL_CHECKS: Final[tuple[Check, ...]] = (body, joint, publishes, subscribes, laser)
