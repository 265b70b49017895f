"""What a student reads off a level's map for ``map_program.py``: the points of the shortest way that keeps clear of walls."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final

import numpy as np

from kit.learning.environment.distance_field import CELL, DistanceField, compute_distance_field
from kit.run.scenario import BEACON, Scenario
from kit.school.game.levels import GameLevel
from kit.sim.plugins.tricycle_drive import TricycleDriveParams

MAP_PROGRAM: Final = Path(__file__).with_name("map_program.py")
CLEARANCE, WIDE_CLEARANCE, WALL_PRICE = 0.22, 0.3, 8.0
"""Ways of a robot keep so far from walls [m] where they can, those of a tricycle and among carts farther."""
LANES: Final = {
    "every-tile": [
        (0.62, 0.5),
        (0.62, 1.1),
        (0.28, 1.25),
        (0.28, 2.72),
        (0.62, 2.72),
        (0.62, 1.85),
        (0.62, 2.3),
        (0.97, 2.72),
        (0.97, 0.28),
        (0.28, 0.28),
        (0.28, 1.1),
        (0.97, 1.2),
    ]
}
"""Lanes that are drawn by hand, where a floor is to be covered [m]."""

Place = tuple[float, float]


def write_program(level: GameLevel, folder: Path) -> Path:
    """Writes the program with what it needs to know of the level."""
    text = MAP_PROGRAM.read_text()
    for name, value in plan(level).items():
        before, start, rest = text.partition(f"\n{name} = ")
        assert start, name
        text = "".join((before, start, repr(value), *rest.partition("\n")[1:]))
    program = folder / MAP_PROGRAM.name
    program.write_text(text)
    return program


def plan(level: GameLevel) -> dict[str, Any]:
    """The program's constants, by name."""
    scenario = level.find_scenario()
    tricycles = [
        plugin.params
        for model in scenario.world.models
        for plugin in model.plugins
        if isinstance(plugin.params, TricycleDriveParams)
    ]
    others = {model.name for model in scenario.world.models} - {*scenario.partners, BEACON, level.leader}
    found: dict[str, Any] = {
        "HAS_CARTS": bool(others),
        "ACCELERATION": level.conditions.acceleration,
        "STEERING": tricycles[0].max_steering if tricycles else 0.0,
    }
    if level.conditions.wheel_error:
        found["WALLS"] = scenario.world.wall_segments.tolist()
    if level.id in LANES:
        found["WAY"] = [_points(LANES[level.id])]
    elif not level.leader:
        found |= _ways(level, scenario, WIDE_CLEARANCE if tricycles or others else CLEARANCE)
    return found


def _ways(level: GameLevel, scenario: Scenario, clearance: float) -> dict[str, Any]:
    """The ways to all targets, over the docks where a charge would not last."""
    starts = [(pose.x, pose.y) for pose in scenario.starts]
    if len(starts) > 1:
        clearance += 0.5 * math.dist(*starts)
    start = (sum(x for x, _ in starts) / len(starts), sum(y for _, y in starts) / len(starts))
    assert scenario.case is not None
    targets = list(level.goal.route(level.targets)) if level.goal.is_route else [scenario.case.target]
    docks = level.conditions.docks
    lanes = [(*cart.start[:2], *cart.start.compose(cart.delta)[:2]) for cart in level.conditions.carts]
    walls = SimpleNamespace(walls=np.vstack([scenario.world.wall_segments, *lanes]))
    fields = {
        place: compute_distance_field.__wrapped__(walls, place, clearance, WALL_PRICE)
        for place in {*targets, *docks}
    }
    if level.any_order:
        targets = list(
            min(
                itertools.permutations(targets),
                key=lambda order: sum(_cost(fields[b], a) for a, b in itertools.pairwise((start, *order))),
            )
        )
    ways: list[list[list[float]]] = []
    docked: list[int] = []
    here, charge = start, level.conditions.charge
    for number, target in enumerate(targets):
        way = _way(fields[target], here)
        if docks:
            onwards = [_length(_way(fields[dock], target)) for dock in docks if number + 1 < len(targets)]
            if _length(way) + min(onwards, default=0.0) > 0.95 * charge:
                dock = min(docks, key=lambda each: _cost(fields[each], here))
                docked.append(len(ways))
                ways.append(_way(fields[dock], here))
                charge = level.conditions.charge
                way = _way(fields[target], dock)
        charge -= _length(way)
        ways.append(way)
        here = target
    return {"WAY": ways, "DOCKED": docked}


def _way(field: DistanceField, start: Place) -> list[list[float]]:
    """Points every second cell from ``start`` to the target of a field."""
    row, column = _cell(field, start)
    points = [start]
    while True:
        window = field.values[max(0, row - 1) : row + 2, max(0, column - 1) : column + 2]
        r, c = np.unravel_index(int(window.argmin()), window.shape)
        r, c = int(r) + max(0, row - 1), int(c) + max(0, column - 1)
        if (r, c) == (row, column):
            return [[round(x, 3), round(y, 3)] for x, y in (*points[::2], points[-1])]
        row, column = r, c
        points.append((field.origin[0] + CELL * column, field.origin[1] + CELL * row))


def _points(corners: Sequence[Sequence[float]]) -> list[list[float]]:
    """Points 5 cm apart on the straight lines between corners."""
    points = []
    for a, b in itertools.pairwise(corners):
        count = max(1, round(math.dist(a, b) / 0.05))
        points += [
            [round(p + (q - p) * k / count, 3) for p, q in zip(a, b, strict=True)] for k in range(count)
        ]
    return [*points, list(corners[-1])]


def _cell(field: DistanceField, place: Place) -> tuple[int, int]:
    rows, columns = field.values.shape
    column = min(max(round((place[0] - field.origin[0]) / CELL), 0), columns - 1)
    return min(max(round((place[1] - field.origin[1]) / CELL), 0), rows - 1), column


def _cost(field: DistanceField, place: Place) -> float:
    return float(field.values[_cell(field, place)])


def _length(way: Sequence[Sequence[float]]) -> float:
    return sum(math.dist(a, b) for a, b in itertools.pairwise(way))
