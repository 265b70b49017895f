"""Going through the picture of a conversation with the arrow keys."""

from __future__ import annotations

from kit.render.graph import Column, Link, Plan, Spot

_COLUMNS: tuple[Column, ...] = ("sender", "item", "receiver")


def first_choice(plan: Plan) -> Spot | None:
    """What to look at first: something that is wrong, else the topmost topic, else a node."""
    broken = [Spot("item", item.label) for item in plan.talk.items if item.broken]
    rows = plan.spots()
    return min(broken or rows, key=lambda spot: (spot.column != "item", rows[spot]), default=None)


def still_there(plan: Plan, spot: Spot | None, row: int) -> Spot | None:
    """The same choice, or whatever is nearest to its row now that it has gone."""
    rows = plan.spots()
    if spot is None or not rows:
        return first_choice(plan)
    if spot in rows:
        return spot
    return min(rows, key=lambda other: (other.column != spot.column, abs(rows[other] - row)))


def along(plan: Plan, spot: Spot, steps: int) -> Spot:
    """So many places further down its column, or up."""
    rows = plan.spots()
    column = sorted((other for other in rows if other.column == spot.column), key=lambda other: rows[other])
    return column[min(max(column.index(spot) + steps, 0), len(column) - 1)]


def across(plan: Plan, spot: Spot, steps: int) -> Spot:
    """One column to the right, or left: along a line if there is one, to the nearest row."""
    number = _COLUMNS.index(spot.column) + steps
    if not 0 <= number < len(_COLUMNS):
        return spot
    rows = plan.spots()
    beside = [other for other in rows if other.column == _COLUMNS[number]]
    if not beside:
        return spot
    return min(beside, key=lambda other: (not _joined(plan, spot, other), abs(rows[other] - rows[spot])))


def _joined(plan: Plan, one: Spot, other: Spot) -> bool:
    node, item = (other, one) if one.column == "item" else (one, other)
    return Link(node.name, item.name, sends=node.column == "sender") in plan.ways
