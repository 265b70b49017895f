"""Derives a map's charges from its walls (dissertation, section 4.1.3.2)."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import Final

from kit.fields.charges import Charge, CompositeCharge, LineCharge, PointCharge, iter_members
from kit.fields.occupancy_grid import OccupancyGrid

Point = tuple[float, float]

SAME_DECIMALS: Final = 6
"""Decimals [m] to which ends that meet agree."""

MIN_CORNER_ANGLE: Final = 1e-3
"""A corner that turns by less [rad] is none."""

SAME_DISTANCE: Final = 0.005
"""Lines of two layouts whose ends are nearer [m] are the same."""

MATCH_DISTANCE: Final = 0.05
"""Lines whose ends are nearer than this [m] are meant to be the same."""


def derive_charges(grid: OccupancyGrid) -> tuple[Charge, ...]:
    """Charges of strength 1 for all walls that the floor's inside ends at."""
    faces: list[list[float]] = grid.wall_faces().tolist()
    meeting: dict[Point, list[int]] = defaultdict(list)
    for number, (ax, ay, bx, by) in enumerate(faces):
        meeting[_rounded_point(ax, ay)].append(number)
        meeting[_rounded_point(bx, by)].append(number)
    group = list(range(len(faces)))
    corners: dict[Point, int] = {}
    for place, numbers in meeting.items():
        if _is_convex_corner(place, [faces[number] for number in numbers], grid):
            for number in numbers[1:]:
                _merge_groups(group, numbers[0], number)
            corners[place] = numbers[0]
    return tuple(
        _build_charges(faces, [_find_root(group, number) for number in range(len(faces))], corners, group)
    )


def layout_differences(charges: Sequence[Charge], derived: Sequence[Charge]) -> tuple[str, ...]:
    """Describes each difference between a layout and the one derived from the walls."""
    own, others = list(iter_members(charges)), list(iter_members(derived))
    found = []
    for charge in own:
        nearest = min(others, key=lambda other: _charge_distance(charge, other), default=None)
        gap = math.inf if nearest is None else _charge_distance(charge, nearest)
        if nearest is None or gap > MATCH_DISTANCE:
            found.append(f"{_describe_charge(charge)} is not at a wall")
        elif gap > SAME_DISTANCE:
            found.append(f"{_describe_charge(charge)} is {gap:.3f} m off {_describe_charge(nearest)}")
    found += [
        f"{_describe_charge(other)} has no charge"
        for other in others
        if min((_charge_distance(charge, other) for charge in own), default=math.inf) > MATCH_DISTANCE
    ]
    return tuple(found)


def _build_charges(
    faces: list[list[float]], heads: list[int], corners: dict[Point, int], group: list[int]
) -> Iterator[Charge]:
    points: dict[int, list[Point]] = defaultdict(list)
    for place, number in corners.items():
        points[_find_root(group, number)].append(place)
    lines: dict[int, list[LineCharge]] = defaultdict(list)
    for (ax, ay, bx, by), head in zip(faces, heads, strict=True):
        lines[head].append(LineCharge(*_rounded_point(ax, ay), *_rounded_point(bx, by)))
    for head, those in lines.items():
        if points[head]:
            yield CompositeCharge(tuple(those), tuple(PointCharge(*place) for place in points[head]))
        else:
            yield from those


def _is_convex_corner(place: Point, walls: list[list[float]], grid: OccupancyGrid) -> bool:
    """Whether more than half a turn around the place is free, and floor."""
    directions = sorted(_direction_from(place, wall) for wall in walls)
    gaps = [
        (after - before, before)
        for before, after in zip(directions, [*directions[1:], directions[0] + math.tau], strict=True)
    ]
    widest, before = max(gaps)
    if widest <= math.pi + MIN_CORNER_ANGLE:
        return False
    middle = before + 0.5 * widest
    aside = 2.0 * grid.cell_size
    return bool(
        grid.inside[grid.cell_at(place[0] + aside * math.cos(middle), place[1] + aside * math.sin(middle))]
    )


def _direction_from(place: Point, wall: list[float]) -> float:
    """The direction [rad] in which a wall leaves one of its ends."""
    ax, ay, bx, by = wall
    if _rounded_point(ax, ay) == place:
        return math.atan2(by - ay, bx - ax)
    return math.atan2(ay - by, ax - bx)


def _rounded_point(x: float, y: float) -> Point:
    return round(x, SAME_DECIMALS) + 0.0, round(y, SAME_DECIMALS) + 0.0


def _find_root(group: list[int], number: int) -> int:
    while group[number] != number:
        number = group[number]
    return number


def _merge_groups(group: list[int], one: int, other: int) -> None:
    group[_find_root(group, other)] = _find_root(group, one)


def _charge_distance(one: PointCharge | LineCharge, other: PointCharge | LineCharge) -> float:
    """How far apart [m] two charges of a kind are: the larger distance of their ends."""
    if isinstance(one, PointCharge) and isinstance(other, PointCharge):
        return math.hypot(one.x - other.x, one.y - other.y)
    if isinstance(one, LineCharge) and isinstance(other, LineCharge):
        (a, b), (c, d) = one.ends, other.ends
        return min(max(math.dist(a, c), math.dist(b, d)), max(math.dist(a, d), math.dist(b, c)))
    return math.inf


def _describe_charge(charge: PointCharge | LineCharge) -> str:
    if isinstance(charge, PointCharge):
        return f"the point ({charge.x:g}, {charge.y:g})"
    return f"the line ({charge.ax:g}, {charge.ay:g})-({charge.bx:g}, {charge.by:g})"
