"""The report of ``kit world check`` on a valid world: its parts, contacts and what lasers see."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from itertools import combinations, combinations_with_replacement
from typing import TypeVar

import numpy as np

from kit.plain_text import INDENT, WIDTH, counted, grouped_table, indent_lines, join_names, table
from kit.world.collision_rules import CollisionBody, CollisionRules, ContactKind, LaserPlugin, RuleReason
from kit.world.records import MAX_LAYERS, Layer, Model, World

T = TypeVar("T")

ReportRow = tuple[str, str, str, str]
"""Subject, verb, object, reason."""


def world_report(world: World) -> str:
    """The world in plain text, 80 columns wide. What behaves alike shares its lines, so a world of many models stays short."""
    rules = CollisionRules(world)
    # Those that move first: "robot collides with walls" reads better than the other way round.
    ordered = sorted(rules.bodies, key=lambda body: (not body.is_dynamic, body.model is None))
    groups = _group_by(ordered, lambda body: (body.model is None, body.is_dynamic, body.filters))
    inner = WIDTH - len(INDENT)
    names, plugins = len(world.layer_bits), [(plugin.name, plugin.type) for plugin in world.plugins]
    sections = (
        (f"World {world.file}", [f"size: {_size_text(world)}"]),
        ("How it was read", [line for each in world.remarks for line in textwrap.wrap(str(each), inner)]),
        (f"Layers ({names} of {MAX_LAYERS} names)", table([*map(_layer_row, world.layers)], inner)),
        (f"Models ({len(world.models)})", table([*map(_model_row, _models_by_file(world))], inner)),
        (f"Plugins of the world ({len(plugins)})", table(plugins, inner)),
        ("Who collides with whom", grouped_table(_merge_rows(_collision_rows(rules, groups)), inner)),
        *(
            (textwrap.fill(f"Within {join_names(models)}", WIDTH), grouped_table(rows, inner))
            for models, rows in _rows_within_models(world, rules)
        ),
        ("Which laser sees whom", grouped_table(_merge_rows(_laser_rows(rules, groups)), inner)),
    )
    return "\n\n".join("\n".join([title, *indent_lines(lines)]) for title, lines in sections if lines)


def world_report_data(world: World) -> dict[str, object]:
    """The same as data for a program: every pair by itself. Serialisable as JSON."""
    rules = CollisionRules(world)
    return {
        "file": str(world.file),
        "size": _wall_extent(world),
        "remarks": [str(each) for each in world.remarks],
        "layers": [
            {
                "names": layer.names,
                "segments": None if layer.walls is None else len(layer.walls.local_segments),
                "map": None if layer.walls is None else str(layer.walls.file),
                "source": None if layer.walls is None else str(layer.walls.drawing_file),
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
            {"a": a.name, "b": b.name, "touch": rule.kind.name.lower(), "why": rule.explanation}
            for a, b, rule in rules.contact_rules()
        ],
        "views": [
            {
                "laser": laser.name,
                "body": thing.name,
                "sees": visibility.is_visible,
                "why": visibility.explanation,
            }
            for laser, thing, visibility in rules.visibilities()
        ],
    }


def _wall_extent(world: World) -> tuple[float, float] | None:
    """Width and height [m] of the rectangle around all walls."""
    walls = [layer.walls.segments for layer in world.layers if layer.walls is not None]
    points = np.concatenate(walls).reshape(-1, 2) if walls else np.empty((0, 2))
    if not len(points):
        return None
    width, height = np.ptp(points, axis=0)
    return float(width), float(height)


def _size_text(world: World) -> str:
    extent = _wall_extent(world)
    return "no walls" if extent is None else f"{extent[0]:.2f} m x {extent[1]:.2f} m"


def _layer_row(layer: Layer) -> tuple[str, str, str]:
    if layer.walls is None:
        return ", ".join(layer.names), "no walls", ""
    source = f"{layer.walls.file.name} ({layer.walls.drawing_file.name})"
    return ", ".join(layer.names), counted(len(layer.walls.local_segments), "wall segment"), source


def _model_row(models: Sequence[Model]) -> tuple[str, str, str, str]:
    model = models[0]
    parts = ", ".join(
        counted(count, what)
        for count, what in ((len(model.bodies), "body"), (len(model.joints), "joint"))
        if count
    )
    types = Counter(plugin.type for plugin in model.plugins)
    plugins = ", ".join(name if count == 1 else f"{count} {name}" for name, count in types.items())
    return join_names([model.name for model in models]), model.file.name, parts, plugins


def _collision_rows(rules: CollisionRules, groups: Sequence[Sequence[CollisionBody]]) -> Iterator[ReportRow]:
    """The rows of collisions between walls and models, and between one model and another."""
    for one, other in combinations_with_replacement(groups, 2):
        pair = next(
            ((a, b) for a in one for b in other if a != b and (a.model is None or a.model != b.model)), None
        )
        if pair is None:
            continue
        rule = rules.contact_rule(*pair)
        whom = "one another" if one is other else _joined_names(other)
        if rule.reason is not RuleReason.NEITHER_MOVES:
            yield _joined_names(one), rule.kind.value, whom, rule.explanation
    resting = [body.name for group in groups for body in group if not body.is_dynamic]
    if len(resting) > 1:
        yield join_names(resting), ContactKind.PASSES.value, "one another", RuleReason.NEITHER_MOVES.value


def _rows_within_models(world: World, rules: CollisionRules) -> Iterator[tuple[list[str], list[ReportRow]]]:
    """Yields, for the models of each file, rows for its bodies with one another."""
    for models in _models_by_file(world):
        bodies = [body for body in rules.bodies if body.model == models[0].name]
        rows = ((a.body, rules.contact_rule(a, b), b.body) for a, b in combinations(bodies, 2))
        merged = _merge_rows((a, rule.kind.value, b, rule.explanation) for a, rule, b in rows)
        if merged:
            yield [model.name for model in models], merged


def _laser_rows(rules: CollisionRules, groups: Sequence[Sequence[CollisionBody]]) -> Iterator[ReportRow]:
    def rows(laser: LaserPlugin) -> tuple[tuple[bool, str, str], ...]:
        return tuple(_visibility_of_groups(rules, laser, groups))

    for lasers in _group_by(rules.lasers, rows):
        for sees, whom, why in rows(lasers[0]):
            yield join_names([laser.name for laser in lasers]), "sees" if sees else "does not see", whom, why


def _visibility_of_groups(
    rules: CollisionRules, laser: LaserPlugin, groups: Sequence[Sequence[CollisionBody]]
) -> Iterator[tuple[bool, str, str]]:
    own = (laser.model, laser.mount.body)
    for group in groups:
        others = [body for body in group if (body.model, body.body) != own]
        for some, label in (
            (
                others,
                _joined_names(group) if len(others) == len(group) else f"others of {_joined_names(group)}",
            ),
            ([body for body in group if body not in others], "its own body"),
        ):
            if some:
                visibility = rules.visibility(laser, some[0])
                yield visibility.is_visible, label, visibility.explanation


def _merge_rows(rows: Iterable[ReportRow]) -> list[ReportRow]:
    """Merges rows that differ in their object only."""
    alike = _group_by(rows, lambda row: (row[0], row[1], row[3]))
    return [
        (who, does, ", ".join(row[2] for row in rows), why)
        for rows in alike
        for who, does, _, why in rows[:1]
    ]


def _models_by_file(world: World) -> list[list[Model]]:
    return _group_by(world.models, lambda model: model.file)


def _group_by(items: Iterable[T], key: Callable[[T], Hashable]) -> list[list[T]]:
    """The items with equal keys together, in the order of the first of each."""
    groups: dict[Hashable, list[T]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return list(groups.values())


def _joined_names(bodies: Iterable[CollisionBody]) -> str:
    return join_names([body.name for body in bodies])
