"""The layout of a graph drawing: senders on the left, items in the middle, receivers on the right."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import count

from kit.render.graph_data import GraphData, GraphItem

RowNumbers = Mapping[str, int]


@dataclass(frozen=True, slots=True)
class LayoutSide:
    """The nodes of one side."""

    rows: RowNumbers = field(default_factory=dict)
    """The row of each node."""
    lanes: Mapping[str, int] = field(default_factory=dict)
    """Lanes are numbered from the nodes on; a node with a single topic on its own row has none."""


@dataclass(frozen=True, slots=True)
class GraphLayout:
    """Rows count from 0 at the top."""

    items: RowNumbers = field(default_factory=dict)
    """The row of each topic and service, by its label."""
    senders: LayoutSide = field(default_factory=LayoutSide)
    receivers: LayoutSide = field(default_factory=LayoutSide)

    @property
    def height(self) -> int:
        taken = (*self.items.values(), *self.senders.rows.values(), *self.receivers.rows.values())
        return max(taken, default=-1) + 1


def arrange_graph(graph: GraphData, before: GraphLayout | None = None) -> GraphLayout:
    """Places for all that is there; those of ``before`` are kept."""
    sent = {node: items for node in graph.nodes if (items := graph.items_sent_by(node))}
    received = {node: items for node in graph.nodes if (items := graph.items_received_by(node))}
    alone = [node for node in graph.nodes if node not in sent and node not in received]
    if before is None:
        before = _initial_layout(graph, sent, received)
        rows = before.items
    else:
        rows = _extend_rows(graph, before)
    senders = _assign_rows({**sent, **dict.fromkeys(alone, ())}, rows, before.senders.rows)
    receivers = _assign_rows(received, rows, before.receivers.rows)
    return GraphLayout(
        rows,
        LayoutSide(senders, _assign_lanes(sent, rows, senders, before.senders.lanes)),
        LayoutSide(receivers, _assign_lanes(received, rows, receivers, before.receivers.lanes)),
    )


def _initial_layout(
    graph: GraphData, sent: Mapping[str, Sequence[GraphItem]], received: Mapping[str, Sequence[GraphItem]]
) -> GraphLayout:
    """Each sender's topics below one another; where not every node can have the row of a topic of its own, an
    empty row for it; and the rows of the nodes matched with an item."""
    item_order = {item.label: position for position, item in enumerate(_order_items(graph))}
    matched = [_match_nodes_to_items(side, item_order) for side in (sent, received)]
    extra_rows = dict.fromkeys(item_order, 0)
    for side, matches in zip((sent, received), matched, strict=True):
        unmatched = [
            min(item_order[item.label] for item in side[node]) for node in side if node not in matches
        ]
        for label, position in item_order.items():
            extra_rows[label] = max(extra_rows[label], unmatched.count(position))
    rows: dict[str, int] = {}
    row = 0
    for label in item_order:
        rows[label] = row
        row += 1 + extra_rows[label]
    senders, receivers = ({node: rows[label] for node, label in matches.items()} for matches in matched)
    return GraphLayout(rows, LayoutSide(senders), LayoutSide(receivers))


def _match_nodes_to_items(
    used: Mapping[str, Sequence[GraphItem]], order: Mapping[str, int]
) -> dict[str, str]:
    """Gives as many nodes as possible an item that no other node has: a maximum matching by augmenting
    paths (Kuhn 1955), which leaves a node on its first item where it can."""
    node_of_item: dict[str, str] = {}

    def match(node: str, tried: set[str]) -> bool:
        for label in sorted((item.label for item in used[node]), key=order.__getitem__):
            if label not in tried:
                tried.add(label)
                if label not in node_of_item or match(node_of_item[label], tried):
                    node_of_item[label] = node
                    return True
        return False

    for node in sorted(used, key=lambda node: (len(used[node]), node)):
        match(node, set())
    return {node: label for label, node in node_of_item.items()}


def _order_items(graph: GraphData) -> list[GraphItem]:
    """The items by their first sender, so that few lines cross: senders and items are moved towards the middle of
    their receivers a few times (the barycentre method of Sugiyama, Tagawa and Toda 1981)."""
    order = sorted(graph.items, key=lambda item: (_first_sender(graph, item), item.is_service, item.label))
    for _ in range(4):
        rank = {item.label: place for place, item in enumerate(order)}
        middle = {
            node: _mean(rank[item.label] for item in graph.items_received_by(node)) for node in graph.nodes
        }
        pull = {
            item.label: _mean(middle[node] for node in item.receivers) if item.receivers else rank[item.label]
            for item in order
        }
        groups: dict[int, list[GraphItem]] = {}
        for item in order:
            groups.setdefault(_first_sender(graph, item), []).append(item)
        weight = {sender: _mean(pull[item.label] for item in group) for sender, group in groups.items()}
        order = sorted(
            order,
            key=lambda item: (
                weight[_first_sender(graph, item)],
                _first_sender(graph, item),
                pull[item.label],
                item.label,
            ),
        )
    return order


def _first_sender(graph: GraphData, item: GraphItem) -> int:
    """The number of the node it comes from; one more than there are if it has no sender."""
    return graph.nodes.index(item.senders[0]) if item.senders else len(graph.nodes)


def _mean(values: Iterable[float]) -> float:
    listed = list(values)
    return sum(listed) / len(listed) if listed else 0.0


def _extend_rows(graph: GraphData, before: GraphLayout) -> RowNumbers:
    rows = {item.label: before.items[item.label] for item in graph.items if item.label in before.items}
    for item in graph.items:
        if item.label not in rows:
            near = [
                row
                for side, nodes in ((before.senders, item.senders), (before.receivers, item.receivers))
                for node in nodes
                if (row := side.rows.get(node)) is not None
            ]
            taken = set(rows.values()) | _rows_of_other_nodes(graph, before, item)
            rows[item.label] = _nearest_free_row(near[0] if near else before.height, taken)
    return rows


def _rows_of_other_nodes(graph: GraphData, before: GraphLayout, item: GraphItem) -> set[int]:
    """Returns rows of nodes that do not use the item."""
    return {
        row
        for side, nodes in ((before.senders, item.senders), (before.receivers, item.receivers))
        for node, row in side.rows.items()
        if node in graph.nodes and node not in nodes
    }


def _nearest_free_row(row: int, taken: set[int]) -> int:
    """The free row nearest to a row; of two the lower."""
    return next(r for step in count() for r in (row + step, row - step) if r >= 0 and r not in taken)


def _assign_rows(used: Mapping[str, Sequence[GraphItem]], rows: RowNumbers, before: RowNumbers) -> RowNumbers:
    """Assigns a row to each node, by the items it uses (rules 1 and 2)."""
    labels = {row: label for label, row in rows.items()}
    sharing = _nodes_by_item(used)
    node_rows: dict[str, int] = {}
    nearer_pairs: list[tuple[str, str]] = []
    """Pairs of nodes of which the first needs the lane nearer to the nodes than the second's."""

    def is_allowed(node: str, row: int) -> bool:
        if row in node_rows.values():
            return False
        label = labels.get(row)
        if label is None:
            return True
        if all(item.label != label for item in used[node]):
            return False
        return len(used[node]) == 1 or not any(
            _is_reachable(nearer_pairs, other, node) for other in sharing[label] if other != node
        )

    def place_node(node: str, row: int) -> None:
        node_rows[node] = row
        if row in labels and len(used[node]) > 1:
            nearer_pairs.extend((node, other) for other in sharing[labels[row]] if other != node)

    for node in used:
        if node in before and is_allowed(node, before[node]):
            place_node(node, before[node])
    bottom = max((*rows.values(), *before.values()), default=-1) + len(used) + 1
    for node in sorted(
        (node for node in used if node not in node_rows),
        key=lambda node: (
            len(used[node]) != 1,
            min((rows[item.label] for item in used[node]), default=bottom),
        ),
    ):
        own = sorted(rows[item.label] for item in used[node])
        start = own[0] if own else bottom - len(used)
        near = sorted(range(bottom + 1), key=lambda row: (abs(row - start), -row))
        place_node(node, next(row for row in (*own, *near) if is_allowed(node, row)))
    return node_rows


def _nodes_by_item(used: Mapping[str, Sequence[GraphItem]]) -> dict[str, list[str]]:
    """The nodes that use each item."""
    sharing: dict[str, list[str]] = {}
    for node, items in used.items():
        for item in items:
            sharing.setdefault(item.label, []).append(node)
    return sharing


def _is_reachable(pairs: Sequence[tuple[str, str]], start: str, end: str) -> bool:
    """Returns whether the pairs, followed from ``start`` on, come to ``end``."""
    seen, frontier = {start}, [start]
    while frontier:
        current = frontier.pop()
        for first, second in pairs:
            if first == current and second not in seen:
                seen.add(second)
                frontier.append(second)
    return end in seen


def _assign_lanes(
    used: Mapping[str, Sequence[GraphItem]],
    rows: RowNumbers,
    node_rows: RowNumbers,
    before: Mapping[str, int],
) -> Mapping[str, int]:
    """A lane for each node that needs one: its own, where it stretches."""
    spans: dict[str, tuple[int, int]] = {}
    for node, items in used.items():
        stops = [node_rows[node], *(rows[item.label] for item in items)]
        if min(stops) < max(stops):
            spans[node] = min(stops), max(stops)
    nearer = {node: _nodes_nearer_than(node, used, rows, node_rows) & spans.keys() for node in spans}
    kept = {node: before[node] for node in spans if node in before}
    return _fit_lanes(spans, nearer, kept) or _fit_lanes(spans, nearer, {}) or {}


def _nodes_nearer_than(
    node: str, used: Mapping[str, Sequence[GraphItem]], rows: RowNumbers, node_rows: RowNumbers
) -> set[str]:
    """Returns the nodes on the row of an item that this node uses too (rule 2)."""
    own = {rows[item.label] for item in used[node]}
    return {other for other in used if other != node and node_rows[other] in own}


def _fit_lanes(
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
                lanes[other] == lane and _spans_overlap(spans[node], spans[other]) for other in lanes
            ):
                lanes[node] = lane
                break
        else:
            return None
    return lanes


def _spans_overlap(one: tuple[int, int], other: tuple[int, int]) -> bool:
    return one[0] <= other[1] and other[0] <= one[1]
