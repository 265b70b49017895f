"""Checks of what a world's layers make of it: what collides, what lasers see, how many layers there are."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from grader.check import Check, NoParams, check
from grader.evidence.contract import EvidenceRecord
from grader.kinds.world.facts import PluginFacts, WorldFacts
from grader.kinds.world.faults import WorldContents, world_check
from kit.plain_text import quoted, suggestion


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
    """A laser sees something other than the task asks:"""
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


LAYER_CHECKS: Final[tuple[Check, ...]] = (collisions, sights, few_layers)
