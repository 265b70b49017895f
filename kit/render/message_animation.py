"""Messages that move along the lines of a drawn graph, as dots."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

from kit.render.graph_data import GraphData, GraphItem
from kit.render.graph_drawing import GraphCell, GraphDrawing, GraphLink
from kit.ros.graph.topic_statistics import FlowStats, MessageFlow

FRAMES_PER_LEG: Final = 6
"""Frames that a dot takes from a node to a topic, and from there to the next node."""

MAX_DOTS: Final = 16
"""Dots that are under way at once; of more flows than that some have to wait."""


@dataclass(frozen=True, slots=True)
class _MovingDot:
    flow: MessageFlow
    legs: tuple[tuple[GraphLink, ...], tuple[GraphLink, ...]]
    """First one line, or none where the sender's is not drawn, then all that lead on."""
    is_response: bool
    """An answer: from the server to the client."""
    frame: int = 0

    @property
    def links(self) -> tuple[GraphLink, ...]:
        return self.legs[self.frame // FRAMES_PER_LEG]


class MessageAnimation:
    """The moving dots. Call ``advance`` at a steady rate while it ``is_active`` or message counts change."""

    def __init__(self) -> None:
        self._counts: dict[MessageFlow, int] | None = None
        self._waiting: dict[MessageFlow, None] = {}
        self._dots: list[_MovingDot] = []

    @property
    def is_active(self) -> bool:
        return bool(self._dots or self._waiting)

    def update_counts(self, flow_stats: Mapping[MessageFlow, FlowStats]) -> None:
        """Updates the message counts; those of the first call are the baseline."""
        counts = {flow: heard.count for flow, heard in flow_stats.items()}
        if self._counts is not None:
            news = (flow for flow, number in counts.items() if number != self._counts.get(flow))
            self._waiting |= dict.fromkeys(news)
        self._counts = counts

    def advance(self, graph: GraphData) -> None:
        """Moves each dot on, and lets new ones leave where the line is free."""
        moved = (replace(dot, frame=dot.frame + 1) for dot in self._dots)
        self._dots = [dot for dot in moved if dot.frame < 2 * FRAMES_PER_LEG and dot.links]
        items = {(item.name, item.is_service): item for item in graph.items}
        departing = {dot.flow for dot in self._dots if dot.frame < FRAMES_PER_LEG}
        waiting, self._waiting = self._waiting, {}
        for flow in waiting:
            item = items.get((flow.name, flow.is_service))
            if item is None:
                continue
            if flow in departing or len(self._dots) >= MAX_DOTS:
                self._waiting[flow] = None
            elif (dot := _new_dot(flow, item)) is not None:
                self._dots.append(dot)

    def cells(self, drawing: GraphDrawing) -> frozenset[GraphCell]:
        """Returns the cells of the dots."""
        return frozenset(
            cell
            for dot in self._dots
            for link in dot.links
            if (cell := _cell_of(dot, link, drawing)) is not None
        )


def _new_dot(flow: MessageFlow, item: GraphItem) -> _MovingDot | None:
    """Returns a dot for a new message; None if its sender is no longer linked."""
    if flow.response_to is not None:
        if flow.node not in item.receivers or flow.response_to not in item.senders:
            return None
        first, then = (
            GraphLink(flow.node, item.label, is_sender=False),
            GraphLink(flow.response_to, item.label, is_sender=True),
        )
        return _MovingDot(flow, ((first,), (then,)), is_response=True)
    if flow.node not in item.senders:
        return None
    heard = tuple(
        GraphLink(node, item.label, is_sender=False)
        for node in item.receivers
        if (flow.node, node) not in item.undelivered
    )
    return _MovingDot(flow, ((GraphLink(flow.node, item.label, is_sender=True),), heard), is_response=False)


def _cell_of(dot: _MovingDot, link: GraphLink, drawing: GraphDrawing) -> GraphCell | None:
    if link not in drawing.routes:  # it has left meanwhile
        return None
    cells = drawing.link_cells(link)
    position = (2 * (dot.frame % FRAMES_PER_LEG) + 1) * len(cells) // (2 * FRAMES_PER_LEG)
    return cells[-1 - position if dot.is_response else position]
