"""Checks of what a world contains: its layers, walls and models, and where they are."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from grader.check import Check, NoParams, check
from grader.evidence.contract import EvidenceRecord
from grader.kinds.world.facts import Box, WorldFacts
from grader.kinds.world.faults import UNSPECIFIED, NotInWorld, find_model, format_metres, world_check
from kit.plain_text import quoted


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


CONTENT_CHECKS: Final[tuple[Check, ...]] = (loads, has, walls, stands)
