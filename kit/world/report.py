"""What ``kit world check`` says of a world that can be used: its parts, and who meets whom."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from itertools import combinations, combinations_with_replacement
from typing import TypeVar

import numpy as np

from kit.plain_text import INDENT, WIDTH, blocks, indented, listed, table
from kit.world.collision_rules import Cause, Laser, Thing, Touch, Touching
from kit.world.records import MAX_LAYERS, Layer, Model, World

T = TypeVar("T")

Row = tuple[str, str, str, str]
"""Who, does what, to whom, why."""


def summary(world: World) -> str:
    """The world in plain text, 80 columns wide. What behaves alike shares its lines, so many models stay few."""
    touching = Touching(world)
    # Those that move first: "robot collides with walls" reads better than the other way round.
    ordered = sorted(touching.things, key=lambda thing: (not thing.dynamic, thing.model is None))
    groups = _grouped(ordered, lambda thing: (thing.model is None, thing.dynamic, thing.surfaces))
    inner = WIDTH - len(INDENT)
    names, plugins = len(world.layer_bits), [(plugin.name, plugin.type) for plugin in world.plugins]
    sections = (
        (f"World {world.file}", [f"size: {_size(world)}"]),
        (f"Layers ({names} of {MAX_LAYERS} names)", table([*map(_layer, world.layers)], inner)),
        (f"Models ({len(world.models)})", table([*map(_models, _by_file(world))], inner)),
        (f"Plugins of the world ({len(plugins)})", table(plugins, inner)),
        ("Who collides with whom", blocks(_merged(_collisions(touching, groups)), inner)),
        *(
            (textwrap.fill(f"Within {listed(models)}", WIDTH), blocks(rows, inner))
            for models, rows in _within(world, touching)
        ),
        ("Which laser sees whom", blocks(_merged(_views(touching, groups)), inner)),
    )
    return "\n\n".join("\n".join([title, *indented(lines)]) for title, lines in sections if lines)


def details(world: World) -> dict[str, object]:
    """The same as data for a program: every pair by itself. Serialisable as JSON."""
    touching = Touching(world)
    return {
        "file": str(world.file),
        "size": _extent(world),
        "layers": [
            {
                "names": layer.names,
                "segments": None if layer.walls is None else len(layer.walls.local),
                "map": None if layer.walls is None else str(layer.walls.file),
                "source": None if layer.walls is None else str(layer.walls.source),
            }
            for layer in world.layers
        ],
        "models": [
            {
                "name": model.name,
                "namespace": model.namespace,
                "file": str(model.file),
                "pose": model.pose,
                "bodies": [body.name for body in model.bodies],
                "joints": [joint.name for joint in model.joints],
                "plugins": [{"name": plugin.name, "type": plugin.type} for plugin in model.plugins],
            }
            for model in world.models
        ],
        "plugins": [{"name": plugin.name, "type": plugin.type} for plugin in world.plugins],
        "meetings": [
            {"a": a.name, "b": b.name, "touch": verdict.touch.name.lower(), "why": verdict.why}
            for a, b, verdict in touching.pairs()
        ],
        "views": [
            {"laser": laser.name, "body": thing.name, "sees": seeing.sees, "why": seeing.why}
            for laser, thing, seeing in touching.views()
        ],
    }


def _extent(world: World) -> tuple[float, float] | None:
    """Width and height [m] of the rectangle around all walls."""
    walls = [layer.walls.segments for layer in world.layers if layer.walls is not None]
    points = np.concatenate(walls).reshape(-1, 2) if walls else np.empty((0, 2))
    if not len(points):
        return None
    width, height = np.ptp(points, axis=0)
    return float(width), float(height)


def _size(world: World) -> str:
    extent = _extent(world)
    return "no walls" if extent is None else f"{extent[0]:.2f} m x {extent[1]:.2f} m"


def _layer(layer: Layer) -> tuple[str, str, str]:
    if layer.walls is None:
        return ", ".join(layer.names), "no walls", ""
    source = f"{layer.walls.file.name} ({layer.walls.source.name})"
    return ", ".join(layer.names), _count(len(layer.walls.local), "wall segment"), source


def _models(models: Sequence[Model]) -> tuple[str, str, str, str]:
    model = models[0]
    parts = ", ".join(
        _count(count, what)
        for count, what in ((len(model.bodies), "body"), (len(model.joints), "joint"))
        if count
    )
    types = Counter(plugin.type for plugin in model.plugins)
    plugins = ", ".join(name if count == 1 else f"{count} {name}" for name, count in types.items())
    return listed([model.name for model in models]), model.file.name, parts, plugins


def _collisions(touching: Touching, groups: Sequence[Sequence[Thing]]) -> Iterator[Row]:
    """Between walls and models, and between one model and another."""
    for one, other in combinations_with_replacement(groups, 2):
        pair = next(
            ((a, b) for a in one for b in other if a != b and (a.model is None or a.model != b.model)), None
        )
        if pair is None:
            continue
        verdict = touching.between(*pair)
        whom = "one another" if one is other else _names(other)
        if verdict.cause is not Cause.NEITHER_MOVES:
            yield _names(one), verdict.touch.value, whom, verdict.why
    resting = [thing.name for group in groups for thing in group if not thing.dynamic]
    if len(resting) > 1:
        yield listed(resting), Touch.PASSES.value, "one another", Cause.NEITHER_MOVES.value


def _within(world: World, touching: Touching) -> Iterator[tuple[list[str], list[Row]]]:
    """For the models of each file: its bodies with one another."""
    for models in _by_file(world):
        bodies = [thing for thing in touching.things if thing.model == models[0].name]
        rows = ((a.body, touching.between(a, b), b.body) for a, b in combinations(bodies, 2))
        merged = _merged((a, verdict.touch.value, b, verdict.why) for a, verdict, b in rows)
        if merged:
            yield [model.name for model in models], merged


def _views(touching: Touching, groups: Sequence[Sequence[Thing]]) -> Iterator[Row]:
    def rows(laser: Laser) -> tuple[tuple[bool, str, str], ...]:
        return tuple(_looks(touching, laser, groups))

    for lasers in _grouped(touching.lasers, rows):
        for sees, whom, why in rows(lasers[0]):
            yield listed([laser.name for laser in lasers]), "sees" if sees else "does not see", whom, why


def _looks(
    touching: Touching, laser: Laser, groups: Sequence[Sequence[Thing]]
) -> Iterator[tuple[bool, str, str]]:
    own = (laser.model, laser.sight.body)
    for group in groups:
        others = [thing for thing in group if (thing.model, thing.body) != own]
        for some, label in (
            (others, _names(group) if len(others) == len(group) else f"others of {_names(group)}"),
            ([thing for thing in group if thing not in others], "its own body"),
        ):
            if some:
                seeing = touching.seeing(laser, some[0])
                yield seeing.sees, label, seeing.why


def _merged(rows: Iterable[Row]) -> list[Row]:
    """Rows that differ in whom only, as one."""
    alike = _grouped(rows, lambda row: (row[0], row[1], row[3]))
    return [
        (who, does, ", ".join(row[2] for row in rows), why)
        for rows in alike
        for who, does, _, why in rows[:1]
    ]


def _by_file(world: World) -> list[list[Model]]:
    return _grouped(world.models, lambda model: model.file)


def _grouped(items: Iterable[T], key: Callable[[T], Hashable]) -> list[list[T]]:
    """The items with equal keys together, in the order of the first of each."""
    groups: dict[Hashable, list[T]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return list(groups.values())


def _names(things: Iterable[Thing]) -> str:
    return listed([thing.name for thing in things])


def _count(count: int, what: str) -> str:
    plural = f"{what.removesuffix('y')}ies" if what.endswith("y") else f"{what}s"
    return f"{count} {what if count == 1 else plural}"
