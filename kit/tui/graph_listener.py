"""GraphListener to a running world's graph for a screen: what happens in the world's thread, and no Textual."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kit.msg.message import Message
from kit.ros.graph.snapshot import FlowStats, GraphState, MessageFlow, TopicStats, snapshot

if TYPE_CHECKING:
    from kit.run.session import Session


@dataclass(frozen=True, slots=True)
class GraphUpdate:
    """A graph at one instant. Safe to hand over."""

    state: GraphState
    flow_stats: Mapping[MessageFlow, FlowStats]
    chosen: str | None
    """The topic or service whose newest message this is."""
    newest: Message | None
    paused: bool


class GraphListener:
    """Calls ``deliver`` with what there is to know, each time it is shown the session; in that very thread.

    Costs the world nothing before the first time, and nothing after ``stop``.
    """

    def __init__(self, deliver: Callable[[GraphUpdate], None]) -> None:
        self._deliver = deliver
        self._topic_stats: TopicStats | None = None
        self._state: GraphState | None = None
        self.chosen: str | None = None
        """Set from any thread; heeded the next time."""

    def __call__(self, session: Session) -> None:
        graph = session.graph
        if self._topic_stats is None or self._topic_stats.graph is not graph:
            self.stop()
            self._topic_stats = TopicStats(graph)
        self._topic_stats.select(self.chosen)
        if self._state is None or self._state.version != graph.directory.version:
            self._state = snapshot(graph)
        flow_stats, newest = self._topic_stats.flow_stats(), self._topic_stats.latest_message
        self._deliver(GraphUpdate(self._state, flow_stats, self.chosen, newest, session.runner.paused))

    def stop(self) -> None:
        """In the world's thread too."""
        if self._topic_stats is not None:
            self._topic_stats.stop()
        self._topic_stats = self._state = None
