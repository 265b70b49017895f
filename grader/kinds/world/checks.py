"""Every check of a world, by name: what it contains, what collides and sees, how it runs; and what loses points."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Final

from grader.check import Check, NoParams, check
from grader.evidence.contract import EvidenceRecord
from grader.kinds.world.facts import BodyFacts, Box, PluginFacts, WorldFacts
from grader.kinds.world.faults import (
    UNSPECIFIED,
    NotInWorld,
    WorldContents,
    WorldRun,
    find_model,
    format_metres,
    measure_run,
    run_check,
    world_check,
)
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
        yield f"{name} has {len(part.shapes)} footprints, not {params.footprints}"
    if params.shape and (other := [each.kind for each in part.shapes if each.kind != params.shape]):
        yield f"{name} has a {other[0]} for a footprint, not a {params.shape}"
    if part.box is None:
        yield f"{name} has no footprint, so it is nowhere"
        return
    left, bottom, right, top = part.box
    for what, actual, expected in (
        ("is so long", right - left, params.length),
        ("is so wide", top - bottom, params.width),
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


MODEL_CHECKS: Final = (body, joint, publishes, subscribes, laser)


@dataclass(frozen=True, slots=True)
class PublishRateParams:
    topic: str = "/scan"
    rate: float = 10.0
    """Messages a second."""
    within: float = 0.05
    """A share."""


@run_check(PublishRateParams)
def rate(run: WorldRun, params: PublishRateParams) -> Iterator[str]:
    """A plugin publishes too often or too rarely:"""
    count = {statistics.topic: statistics.count for statistics in run.run.topics}.get(params.topic, 0)
    actual = count / run.run.seconds if run.run.seconds else 0.0
    if not count:
        yield f"nothing came on {params.topic}"
    elif abs(actual - params.rate) > params.within * params.rate:
        yield f"{params.topic} came {actual:.3g} times a second, not {params.rate:g}"


@dataclass(frozen=True, slots=True)
class NoiseParams:
    topic: str = "/scan"
    deviation: float = 0.02
    """m"""
    within: float = 0.1
    """A share."""


@run_check(NoiseParams)
def noise(run: WorldRun, params: NoiseParams) -> Iterator[str]:
    """The noise, measured while the world stood still, is not what was asked ({where}):"""
    spread = {statistics.topic: statistics.spread for statistics in run.run.topics}.get(params.topic)
    if spread is None:
        yield f"nothing came on {params.topic}"
    elif abs(spread - params.deviation) > params.within * params.deviation:
        yield f"on {params.topic} what stands still spreads by {spread:.4g} m, not {params.deviation:g} m"


@dataclass(frozen=True, slots=True)
class DrivesParams:
    start_x: float = UNSPECIFIED
    start_y: float = UNSPECIFIED
    """Where the robot must begin: from its target there is no way left."""
    within: float = 0.3
    """m"""


@run_check(DrivesParams)
def drives(run: WorldRun, params: DrivesParams) -> Iterator[str]:
    """Our driver does not reach its target in your world ({where}):"""
    for wanted, actual, axis in zip((params.start_x, params.start_y), run.run.start, "xy", strict=False):
        if abs(actual - wanted) > params.within:
            yield f"the robot begins at {axis} = {format_metres(actual)}; {format_metres(wanted)} is wanted"
    if run.run.reached_s is not None and run.run.distance < LEAST_WAY:
        yield "the robot is at its target before it has driven"
    if run.run.undriven >= LEAST_WAY:
        yield f"the robot moves by {run.run.undriven:.1f} m while nobody drives it"
    if run.run.reached_s is None:
        away = "" if run.run.target_distance is None else f"it ended {run.run.target_distance:.1f} m away"
        yield ", ".join(
            part
            for part in (
                away,
                f"after {run.run.distance:.1f} m of way" if run.run.distance > 0.05 else "and never moved",
                f"with {counted(run.run.bumps, 'bump')}" if run.run.bumps else "",
            )
            if part
        )


LEAST_WAY: Final = 0.1
"""A robot that drove less did not drive to its target [m]."""


@check(none=1, full=0, unit="bumps")
def bumps(evidence: EvidenceRecord, params: NoParams) -> float:
    """While our driver drove, the robot touched something: {actual} ({where})."""
    return measure_run(evidence, lambda run: run.bumps)


@check(none=0, full=1, words=("not stopped", "stopped"))
def stopped(evidence: EvidenceRecord, params: NoParams) -> float:
    """Our driver went straight at where something solid should be, and nothing stopped it ({where})."""
    return measure_run(evidence, lambda run: run.bumps > 0)


@run_check()
def reachable(run: WorldRun, params: NoParams) -> Iterator[str]:
    """No path from the robot's start to the target is wide enough for it ({where})."""
    if not run.run.is_reachable:
        yield "Look for a wall too many, a gap too narrow, or a start inside a wall"


@run_check()
def closed(run: WorldRun, params: NoParams) -> Iterator[str]:
    """The walls do not hold the robot in: somewhere it can leave."""
    if not run.run.is_enclosed:
        yield "Look for two walls that should meet and do not"


def _gap(run: WorldRun, params: NoParams) -> Iterator[str]:
    if run.run.joint_gap > 0.0:
        yield f"The joint {run.run.widest_joint} was {run.run.joint_gap * 1000:.0f} mm apart"


@check(none=0.05, full=0.01, unit="m", faults=_gap)
def together(evidence: EvidenceRecord, params: NoParams) -> float:
    """While it drove the model came apart by {actual} ({where}); at most {full} is allowed."""
    return measure_run(evidence, lambda run: run.joint_gap)


DRIVEN_CHECKS: Final = (rate, noise, drives, bumps, stopped, reachable, closed, together)


@dataclass(frozen=True, slots=True)
class CollisionParams:
    collide: tuple[str, ...] = ()
    """Each two things with `` - `` between: models, or maps by their file's name. All others must not collide."""
    free: tuple[str, ...] = ()
    """Pairs that may or may not collide."""
    split: tuple[str, ...] = ()
    """Models whose bodies are checked one by one, as ``model/body``."""


def _thing_name(thing: tuple[str, str], split: tuple[str, ...]) -> str:
    model, name = thing
    return name if not model else f"{model}/{name}" if model in split else model


def _sorted_pair(a: str, b: str) -> tuple[str, str]:
    return (a, b) if a <= b else (b, a)


@world_check(CollisionParams)
def collisions(world: WorldFacts, params: CollisionParams) -> Iterator[str]:
    """Some things collide, or do not, against what the task asks:"""
    expected, free = (
        {_sorted_pair(*each.split(" - ")) for each in names} for names in (params.collide, params.free)
    )
    why: dict[tuple[str, str], tuple[bool, str]] = {}
    for meeting in world.collisions:
        pair = _sorted_pair(_thing_name(meeting.a, params.split), _thing_name(meeting.b, params.split))
        if pair not in why or (meeting.collides and not why[pair][0]):
            why[pair] = meeting.collides, meeting.why
    known = {name for pair in why for name in pair} | {each.name for each in world.models}
    known |= {each.map for each in world.walls}
    for name in sorted({name for pair in expected for name in pair} - known):
        yield f"there is no {quoted(name)} in this world: {suggestion(name, known)}"
    for pair, (collides, reason) in why.items():
        if pair in free or collides == (pair in expected):
            continue
        a, b = pair
        if collides:
            yield f"{a} and {b} collide ({reason}), and should not"
        else:
            yield f"{a} and {b} do not collide ({reason}), and should"


@dataclass(frozen=True, slots=True)
class SightParams:
    sees: tuple[str, ...] = ()
    """Each a laser and all that it must see: ``robot/lidar: hall, crate``."""
    split: tuple[str, ...] = ()
    looks_at: tuple[str, ...] = ()
    """Each a laser and the layers in its own list, no more and no fewer: ``robot/lidar: seen``."""


@world_check(SightParams)
def sights(world: WorldFacts, params: SightParams) -> Iterator[str]:
    """A laser sees something else than the task asks:"""
    for each in params.sees:
        name, expected = _split_laser(each)
        views: dict[str, tuple[bool, str]] = {}
        for view in world.sights:
            thing = _thing_name(view.thing, params.split)
            if view.laser == name and (thing not in views or (view.sees and not views[thing][0])):
                views[thing] = view.sees, view.why
        if not views:
            yield f"there is no laser {quoted(name)}"
            continue
        for thing in sorted(expected - views.keys()):
            yield f"there is no {quoted(thing)} in this world: {suggestion(thing, tuple(views))}"
        for thing, (sees, why) in views.items():
            if sees != (thing in expected):
                whom = "itself" if thing == name.partition("/")[0] else thing
                yield (
                    f"{name} sees {whom} ({why}), and should not"
                    if sees
                    else f"{name} does not see {whom} ({why}), and should"
                )
    for each in params.looks_at:
        name, wanted = _split_laser(each)
        found = next((plugin.layers for plugin in _lasers(world, name)), None)
        if found is None:
            yield f"there is no laser {quoted(name)}"
        elif set(found) != wanted:
            yield f"{name} looks at {', '.join(found) or 'no layer'}, not at {', '.join(sorted(wanted))}"


def _split_laser(text: str) -> tuple[str, set[str]]:
    """Splits ``robot/lidar: hall, crate`` into the laser and the names."""
    name, _, names_text = text.partition(":")
    return name, {part.strip() for part in names_text.split(",") if part.strip()}


def _lasers(world: WorldFacts, name: str) -> Iterator[PluginFacts]:
    """Yields the laser of this name, ``model/plugin``, if there is one."""
    model_name, _, plugin_name = name.partition("/")
    model = world.model(model_name)
    if model is not None:
        yield from (each for each in model.plugins if each.name == plugin_name and each.rays)


def _layer_names(contents: WorldContents, params: NoParams) -> Iterator[str]:
    yield f"Every name in a layer's list counts: {', '.join(contents.world.layers)}"


@check(none=17, full=16, unit="layers", faults=_layer_names)
def few_layers(evidence: EvidenceRecord, params: NoParams) -> float:
    """The world has {actual}; {full} would do."""
    world: WorldFacts = evidence.content.world
    return math.nan if world.problems else float(len(world.layers))


LAYER_CHECKS: Final = (collisions, sights, few_layers)


@check(none=0, full=1, words=("does not load", "loads"))
def loads(evidence: EvidenceRecord, params: NoParams) -> float:
    """The world does not load. Each line says what is wrong, in which file, and where:"""
    return 0.0 if evidence.content.world.problems else 1.0


@dataclass(frozen=True, slots=True)
class ContentParams:
    layers: tuple[str, ...] = ()
    """Required layer names."""
    maps: tuple[str, ...] = ()
    """Required map files, without their ending."""
    models: tuple[str, ...] = ()
    plugins: tuple[str, ...] = ()
    """Each a model and a type, such as ``robot Laser``."""


@world_check(ContentParams)
def has(world: WorldFacts, params: ContentParams) -> Iterator[str]:
    """Something that the task asks for is not there:"""
    models = [model.name for model in world.models]
    for what, expected, present in (
        ("layer", params.layers, world.layers),
        ("map", params.maps, tuple(walls.map for walls in world.walls)),
        ("model", params.models, tuple(models)),
    ):
        for name in expected:
            if name not in present:
                yield f"there is no {what} {quoted(name)} ({', '.join(present) or 'none at all'})"
    for each in params.plugins:
        name, _, kind = each.partition(" ")
        try:
            model = find_model(world, name)
        except NotInWorld as missing:
            yield str(missing)
            continue
        if kind not in (types := [device.type for device in model.plugins]):
            yield f"{name} has no {kind} ({', '.join(types) or 'no plugins at all'})"


@dataclass(frozen=True, slots=True)
class WallParams:
    map: str = ""
    """By default every wall."""
    source: str = ""
    """The picture's name."""
    left: float = UNSPECIFIED
    bottom: float = UNSPECIFIED
    width: float = UNSPECIFIED
    height: float = UNSPECIFIED
    """m"""
    within: float = 0.02


@world_check(WallParams)
def walls(world: WorldFacts, params: WallParams) -> Iterator[str]:
    """The walls are not where they should be:"""
    selected = [walls for walls in world.walls if params.map in ("", walls.map)]
    boxes = [walls.box for walls in selected if walls.box is not None]
    if not boxes:
        yield f"no layer shows the walls of {params.map or 'a map'}"
        return
    if params.source and (wrong := [walls.source for walls in selected if walls.source != params.source]):
        yield f"its walls come from {wrong[0]}, not from {params.source}"
    left, bottom, right, top = bounding_box(boxes)
    for what, actual, expected in (
        ("wide", right - left, params.width),
        ("high", top - bottom, params.height),
    ):
        if abs(actual - expected) > params.within:
            yield f"it is {format_metres(actual)} {what}, not {format_metres(expected)}"
    for what, actual, expected in (
        ("x of its left side", left, params.left),
        ("y of its lower side", bottom, params.bottom),
    ):
        if abs(actual - expected) > params.within:
            yield f"the {what} is {format_metres(actual)}, not {format_metres(expected)}"


def bounding_box(boxes: list[Box]) -> Box:
    left, bottom, right, top = zip(*boxes, strict=True)
    return min(left), min(bottom), max(right), max(top)


@dataclass(frozen=True, slots=True)
class ModelPoseParams:
    model: str = "robot"
    x: float = 0.0
    y: float = 0.0
    theta: float = UNSPECIFIED
    within: float = 0.01
    """m, and ten times as much in rad"""


@world_check(ModelPoseParams)
def stands(world: WorldFacts, params: ModelPoseParams) -> Iterator[str]:
    """A model does not stand where it should:"""
    x, y, theta = find_model(world, params.model).pose
    if math.hypot(x - params.x, y - params.y) > params.within:
        yield f"{params.model} stands at [{x:g}, {y:g}], not at [{params.x:g}, {params.y:g}]"
    if abs(math.remainder(theta - params.theta, math.tau)) > 10 * params.within:
        yield f"{params.model} looks towards {theta:g} rad, not {params.theta:g}"


CONTENT_CHECKS: Final = (loads, has, walls, stands)


def explain(content: WorldContents | WorldRun, name: str, params: Any) -> str:
    """Explains what a check found wrong with a world, in words that help to correct it."""
    problems = content.world.problems
    if name == "loads":
        return "\n".join(problems if len(problems) == 1 else number_problems(problems))
    if problems:
        return "The world cannot be read yet."
    if isinstance(content, WorldRun) and content.run.problem:
        return content.run.problem
    faults = CHECKS[name].faults
    return "" if faults is None else join_faults(faults(content, params))


def number_problems(problems: Sequence[str]) -> Iterator[str]:
    """Numbers the problems, so that they stay distinct within one paragraph."""
    return (f"({number}) {problem}" for number, problem in enumerate(problems, 1))


def join_faults(faults: Iterable[str]) -> str:
    """Joins faults into one sentence; of many only the first."""
    every_fault = tuple(faults)
    more = f"; and {len(every_fault) - MAX_FAULTS_SHOWN} more" if len(every_fault) > MAX_FAULTS_SHOWN else ""
    text = "; ".join(every_fault[:MAX_FAULTS_SHOWN]) + more
    return text if not text or text[-1] in ".?" else f"{text}."


MAX_FAULTS_SHOWN: Final = 4
"""Faults of one check."""


CHECKS: Final[Mapping[str, Check]] = MappingProxyType(
    {each.name: each for each in (*CONTENT_CHECKS, *MODEL_CHECKS, *LAYER_CHECKS, *DRIVEN_CHECKS)}
)
"""Every check of a world, by name."""

RUN_CHECKS: Final = frozenset(each.name for each in DRIVEN_CHECKS)
"""Names of those that need a run."""
