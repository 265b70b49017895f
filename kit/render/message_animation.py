"""Messages on their way through the picture of a conversation: a few dots, each at one unhurried pace.

A dot stands for whatever was said on a line since the last dot left, so that ten messages a second and a thousand
look alike: traffic, not a flicker.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

from kit.render.graph import Cell, Link, Plan
from kit.render.graph_data import Conversation, Item
from kit.ros.graph.topic_stats import FlowStats, MessageFlow

FRAMES: Final = 6
"""In which a dot goes from a node to a topic, and in which from there to the next node."""

MOST: Final = 16
"""Dots that are under way at once; of more flows than that some have to wait."""


@dataclass(frozen=True, slots=True)
class _Journey:
    flow: MessageFlow
    legs: tuple[tuple[Link, ...], tuple[Link, ...]]
    """First one line, or none where the sender's is not drawn, then all that lead on."""
    backwards: bool
    """An answer: from the server to the client."""
    frame: int = 0

    @property
    def links(self) -> tuple[Link, ...]:
        return self.legs[self.frame // FRAMES]


class Travel:
    """Which dots are where. Call ``frame`` at a steady rate while it is ``busy`` or there is news."""

    def __init__(self) -> None:
        self._counts: dict[MessageFlow, int] | None = None
        self._waiting: dict[MessageFlow, None] = {}
        self._journeys: list[_Journey] = []

    @property
    def busy(self) -> bool:
        return bool(self._journeys or self._waiting)

    def hear(self, said: Mapping[MessageFlow, FlowStats]) -> None:
        """Takes note of what was said; what was said before the first time is over."""
        counts = {flow: heard.count for flow, heard in said.items()}
        if self._counts is not None:
            news = (flow for flow, number in counts.items() if number != self._counts.get(flow))
            self._waiting |= dict.fromkeys(news)
        self._counts = counts

    def frame(self, talk: Conversation) -> None:
        """Moves each dot on, and lets new ones leave where the line is free."""
        moved = (replace(journey, frame=journey.frame + 1) for journey in self._journeys)
        self._journeys = [journey for journey in moved if journey.frame < 2 * FRAMES and journey.links]
        items = {(item.name, item.is_service): item for item in talk.items}
        leaving = {journey.flow for journey in self._journeys if journey.frame < FRAMES}
        waiting, self._waiting = self._waiting, {}
        for flow in waiting:
            item = items.get((flow.name, flow.is_service))
            if item is None:
                continue
            if flow in leaving or len(self._journeys) >= MOST:
                self._waiting[flow] = None
            elif (journey := _journey(flow, item)) is not None:
                self._journeys.append(journey)

    def cells(self, plan: Plan) -> frozenset[Cell]:
        """Where the dots are."""
        return frozenset(
            cell
            for journey in self._journeys
            for link in journey.links
            if (cell := _reached(journey, link, plan)) is not None
        )


def _journey(flow: MessageFlow, item: Item) -> _Journey | None:
    """The way of what a node has said; None if it does not say it here any more."""
    if flow.response_to is not None:
        if flow.node not in item.receivers or flow.response_to not in item.senders:
            return None
        first, then = Link(flow.node, item.label, sends=False), Link(flow.response_to, item.label, sends=True)
        return _Journey(flow, ((first,), (then,)), backwards=True)
    if flow.node not in item.senders:
        return None
    heard = tuple(
        Link(node, item.label, sends=False) for node in item.receivers if (flow.node, node) not in item.broken
    )
    return _Journey(flow, ((Link(flow.node, item.label, sends=True),), heard), backwards=False)


def _reached(journey: _Journey, link: Link, plan: Plan) -> Cell | None:
    if link not in plan.ways:  # it has left meanwhile
        return None
    path = plan.path(link)
    place = (2 * (journey.frame % FRAMES) + 1) * len(path) // (2 * FRAMES)
    return path[-1 - place if journey.backwards else place]
