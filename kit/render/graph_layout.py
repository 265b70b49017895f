"""Where nodes, topics and services stand: senders on the left, what they say in the middle, receivers on the right.

Every topic and service has a row of its own; a node sits on a row of its side. From its seat a level line goes to
the node's *lane*, an upright line of its own, from which a level line branches off on the row of each topic it
sends. Two rules keep all lines apart that do not belong together:

    1  a node sits on the row of one of its own topics, or on a row that no topic has;
    2  where it shares that topic with others, its lane is nearer to the nodes than theirs.

What has a place keeps it as long as it is there, whoever comes and goes: nothing jumps.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import count

from kit.render.graph_data import Conversation, Item

Rows = Mapping[str, int]


@dataclass(frozen=True, slots=True)
class Side:
    """The nodes of one side."""

    seats: Rows = field(default_factory=dict)
    """The row of each node."""
    lanes: Mapping[str, int] = field(default_factory=dict)
    """Lanes are numbered from the nodes on; a node with a single topic on its own row has none."""


@dataclass(frozen=True, slots=True)
class Places:
    """Rows count from 0 at the top."""

    items: Rows = field(default_factory=dict)
    """The row of each topic and service, by its label."""
    senders: Side = field(default_factory=Side)
    receivers: Side = field(default_factory=Side)

    @property
    def height(self) -> int:
        taken = (*self.items.values(), *self.senders.seats.values(), *self.receivers.seats.values())
        return max(taken, default=-1) + 1


def arrange(talk: Conversation, before: Places | None = None) -> Places:
    """Places for all that is there; those of ``before`` are kept."""
    sent = {node: items for node in talk.nodes if (items := talk.sent_by(node))}
    received = {node: items for node in talk.nodes if (items := talk.received_by(node))}
    alone = [node for node in talk.nodes if node not in sent and node not in received]
    if before is None:
        before = _fresh(talk, sent, received)
        rows = before.items
    else:
        rows = _kept_rows(talk, before)
    senders = _seats({**sent, **dict.fromkeys(alone, ())}, rows, before.senders.seats)
    receivers = _seats(received, rows, before.receivers.seats)
    return Places(
        rows,
        Side(senders, _lanes(sent, rows, senders, before.senders.lanes)),
        Side(receivers, _lanes(received, rows, receivers, before.receivers.lanes)),
    )


# Rows of topics and services


def _fresh(
    talk: Conversation, sent: Mapping[str, Sequence[Item]], received: Mapping[str, Sequence[Item]]
) -> Places:
    """Each sender's topics below one another; where not every node can sit on the row of a topic of its own, an
    empty row for it; and the seats that this is meant for."""
    order = {item.label: place for place, item in enumerate(_ordered(talk))}
    seated = [_distinct(side, order) for side in (sent, received)]
    guests = dict.fromkeys(order, 0)
    for side, homes in zip((sent, received), seated, strict=True):
        without = [min(order[item.label] for item in side[node]) for node in side if node not in homes]
        for label, place in order.items():
            guests[label] = max(guests[label], without.count(place))
    rows: dict[str, int] = {}
    row = 0
    for label in order:
        rows[label] = row
        row += 1 + guests[label]
    senders, receivers = ({node: rows[label] for node, label in homes.items()} for homes in seated)
    return Places(rows, Side(senders), Side(receivers))


def _distinct(used: Mapping[str, Sequence[Item]], order: Mapping[str, int]) -> dict[str, str]:
    """For as many nodes as can be an item of their own that no other node has: a maximum matching by augmenting
    paths (Kuhn 1955), which leaves a node on its first item where it can."""
    holder: dict[str, str] = {}

    def find(node: str, tried: set[str]) -> bool:
        for label in sorted((item.label for item in used[node]), key=order.__getitem__):
            if label not in tried:
                tried.add(label)
                if label not in holder or find(holder[label], tried):
                    holder[label] = node
                    return True
        return False

    for node in sorted(used, key=lambda node: (len(used[node]), node)):
        find(node, set())
    return {node: label for label, node in holder.items()}


def _ordered(talk: Conversation) -> list[Item]:
    """The items by their first sender, so that few lines cross: senders and items are moved towards the middle of
    their receivers a few times (the barycentre method of Sugiyama, Tagawa and Toda 1981)."""
    order = sorted(talk.items, key=lambda item: (_first_sender(talk, item), item.is_service, item.label))
    for _ in range(4):
        rank = {item.label: place for place, item in enumerate(order)}
        middle = {node: _mean(rank[item.label] for item in talk.received_by(node)) for node in talk.nodes}
        pull = {
            item.label: _mean(middle[node] for node in item.receivers) if item.receivers else rank[item.label]
            for item in order
        }
        groups: dict[int, list[Item]] = {}
        for item in order:
            groups.setdefault(_first_sender(talk, item), []).append(item)
        weight = {sender: _mean(pull[item.label] for item in group) for sender, group in groups.items()}
        order = sorted(
            order,
            key=lambda item: (
                weight[_first_sender(talk, item)],
                _first_sender(talk, item),
                pull[item.label],
                item.label,
            ),
        )
    return order


def _first_sender(talk: Conversation, item: Item) -> int:
    """The number of the node it comes from; one more than there are if from nobody."""
    return talk.nodes.index(item.senders[0]) if item.senders else len(talk.nodes)


def _mean(values: Iterable[float]) -> float:
    listed = list(values)
    return sum(listed) / len(listed) if listed else 0.0


def _kept_rows(talk: Conversation, before: Places) -> Rows:
    rows = {item.label: before.items[item.label] for item in talk.items if item.label in before.items}
    for item in talk.items:
        if item.label not in rows:
            near = [
                row
                for side, nodes in ((before.senders, item.senders), (before.receivers, item.receivers))
                for node in nodes
                if (row := side.seats.get(node)) is not None
            ]
            taken = set(rows.values()) | _foreign_seats(talk, before, item)
            rows[item.label] = _nearest_free(near[0] if near else before.height, taken)
    return rows


def _foreign_seats(talk: Conversation, before: Places, item: Item) -> set[int]:
    """Rows on which somebody sits who does not share in the item."""
    return {
        row
        for side, nodes in ((before.senders, item.senders), (before.receivers, item.receivers))
        for node, row in side.seats.items()
        if node in talk.nodes and node not in nodes
    }


def _nearest_free(row: int, taken: set[int]) -> int:
    """The free row nearest to a row; of two the lower."""
    return next(r for step in count() for r in (row + step, row - step) if r >= 0 and r not in taken)


# Seats


def _seats(used: Mapping[str, Sequence[Item]], rows: Rows, before: Rows) -> Rows:
    """A seat for each node, by the items it uses."""
    labels = {row: label for label, row in rows.items()}
    sharing = _sharing(used)
    seats: dict[str, int] = {}
    later: list[tuple[str, str]] = []
    """Pairs of nodes of which the first needs the lane nearer to the nodes."""

    def sits_well(node: str, row: int) -> bool:
        if row in seats.values():
            return False
        label = labels.get(row)
        if label is None:
            return True
        if all(item.label != label for item in used[node]):
            return False
        return len(used[node]) == 1 or not any(
            _leads_to(later, other, node) for other in sharing[label] if other != node
        )

    def sit(node: str, row: int) -> None:
        seats[node] = row
        if row in labels and len(used[node]) > 1:
            later.extend((node, other) for other in sharing[labels[row]] if other != node)

    for node in used:
        if node in before and sits_well(node, before[node]):
            sit(node, before[node])
    bottom = max((*rows.values(), *before.values()), default=-1) + len(used) + 1
    for node in sorted(
        (node for node in used if node not in seats),
        key=lambda node: (
            len(used[node]) != 1,
            min((rows[item.label] for item in used[node]), default=bottom),
        ),
    ):
        own = sorted(rows[item.label] for item in used[node])
        start = own[0] if own else bottom - len(used)
        near = sorted(range(bottom + 1), key=lambda row: (abs(row - start), -row))
        sit(node, next(row for row in (*own, *near) if sits_well(node, row)))
    return seats


def _sharing(used: Mapping[str, Sequence[Item]]) -> dict[str, list[str]]:
    """The nodes that use each item."""
    sharing: dict[str, list[str]] = {}
    for node, items in used.items():
        for item in items:
            sharing.setdefault(item.label, []).append(node)
    return sharing


def _leads_to(pairs: Sequence[tuple[str, str]], start: str, end: str) -> bool:
    """Whether the pairs, followed from ``start`` on, come to ``end``."""
    seen, open_ends = {start}, [start]
    while open_ends:
        here = open_ends.pop()
        for first, second in pairs:
            if first == here and second not in seen:
                seen.add(second)
                open_ends.append(second)
    return end in seen


# Lanes


def _lanes(
    used: Mapping[str, Sequence[Item]], rows: Rows, seats: Rows, before: Mapping[str, int]
) -> Mapping[str, int]:
    """A lane for each node that needs one: its own, where it stretches."""
    spans: dict[str, tuple[int, int]] = {}
    for node, items in used.items():
        stops = [seats[node], *(rows[item.label] for item in items)]
        if min(stops) < max(stops):
            spans[node] = min(stops), max(stops)
    nearer = {node: _must_be_nearer(node, used, rows, seats) & spans.keys() for node in spans}
    kept = {node: before[node] for node in spans if node in before}
    return _fitted_lanes(spans, nearer, kept) or _fitted_lanes(spans, nearer, {}) or {}


def _must_be_nearer(node: str, used: Mapping[str, Sequence[Item]], rows: Rows, seats: Rows) -> set[str]:
    """The nodes that sit on the row of an item which this one uses too (rule 2)."""
    own = {rows[item.label] for item in used[node]}
    return {other for other in used if other != node and seats[other] in own}


def _fitted_lanes(
    spans: Mapping[str, tuple[int, int]], nearer: Mapping[str, set[str]], kept: Mapping[str, int]
) -> Mapping[str, int] | None:
    """Lanes that keep both rules, the kept ones unchanged; None if that cannot be."""
    lanes: dict[str, int] = {}
    waiting = sorted(spans, key=lambda node: (node not in kept, spans[node][1] - spans[node][0], spans[node]))
    while waiting:
        node = next(node for node in waiting if not nearer[node] & set(waiting))
        waiting.remove(node)
        least = max((lanes[other] + 1 for other in nearer[node]), default=0)
        for lane in (kept[node],) if node in kept else count(least):
            if lane >= least and not any(
                lanes[other] == lane and _overlap(spans[node], spans[other]) for other in lanes
            ):
                lanes[node] = lane
                break
        else:
            return None
    return lanes


def _overlap(one: tuple[int, int], other: tuple[int, int]) -> bool:
    return one[0] <= other[1] and other[0] <= one[1]
