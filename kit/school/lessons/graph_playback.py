"""Plays a lesson's graph scene: nodes and topics with messages on their way, as the screen of nodes draws them."""

from __future__ import annotations

import math
from typing import Final

from kit.plain_text import counted
from kit.render.encode import AsciiEncoder, Encoder, Frame
from kit.render.frame_text import paste_frame, write_text
from kit.render.graph import GraphView, draw_graph
from kit.render.graph_data import GraphData, GraphItem
from kit.render.graph_drawing import GraphDrawing
from kit.render.graph_glyphs import ASCII_LINES, UNICODE_LINES
from kit.render.graph_layout import arrange_graph
from kit.render.message_animation import MessageAnimation
from kit.ros.graph.topic_statistics import FlowStats, MessageFlow
from kit.school.lessons.records import GraphChannel, GraphScene

FRAME_S: Final = 0.125
"""Between two places of a message [s]."""
MAX_COLUMNS: Final = 100
"""A wider picture only has longer lines."""
PLAIN_COLUMNS: Final = 79
"""Columns of plain text: the usual names fit, and no line breaks on 80 columns."""


class GraphPlayback:
    """Advances the messages of a scene. The same scene plays the same each time."""

    def __init__(self, scene: GraphScene) -> None:
        self.scene = scene
        self.time_s = 0.0
        self._frames = 0
        self._animation = MessageAnimation()
        self._animation.update_counts(self._flow_stats(0.0))

    @property
    def is_over(self) -> bool:
        """Whether the scene has been shown to its end."""
        return self.time_s >= self.scene.seconds

    @property
    def height(self) -> int:
        """Rows of the drawing and of the words below it."""
        return arrange_graph(self._graph()).height + 1 + len(self.scene.channels)

    def advance_to(self, time_s: float) -> None:
        """Moves every message to where it is ``time_s`` seconds after the beginning."""
        self.time_s = min(max(time_s, self.time_s), self.scene.seconds)
        graph = self._graph()
        while (self._frames + 1) * FRAME_S <= self.time_s:
            self._frames += 1
            self._animation.update_counts(self._flow_stats(self._frames * FRAME_S))
            self._animation.advance(graph)

    def step(self) -> None:
        """Moves every message on by one frame."""
        self.advance_to((self._frames + 1) * FRAME_S)

    def frame(self, columns: int, rows: int, encoder: Encoder) -> Frame:
        """The graph as it is now; what was sent in words below it, once the scene has begun, where there is room."""
        frame, graph = Frame.empty(columns, rows), self._graph()
        drawing = GraphDrawing(graph, arrange_graph(graph), min(columns, MAX_COLUMNS))
        rates = {item.label: each.rate for item, each in self._items() if each.rate is not None}
        view = GraphView(rates, message_cells=self._animation.cells(drawing))
        lines = ASCII_LINES if isinstance(encoder, AsciiEncoder) else UNICODE_LINES
        paste_frame(frame, draw_graph(drawing, view, rows, lines), 0, 0)
        words = self.describe() if self.time_s else []
        for number, line in enumerate(words, drawing.layout.height + 1):
            if number < rows:
                write_text(frame, number, 1, line[: columns - 1])
        return frame

    def describe(self) -> list[str]:
        """The messages sent so far, and who received them: one line for each topic and service."""
        return [_described(each, _sent(each, self.time_s)) for each in self.scene.channels]

    def _graph(self) -> GraphData:
        items = tuple(item for item, _ in self._items())
        nodes = dict.fromkeys(node for item in items for node in (*item.senders, *item.receivers))
        return GraphData(tuple(nodes), items)

    def _items(self) -> list[tuple[GraphItem, GraphChannel]]:
        """Each channel as the drawing has it: until the scene begins, by the name that is asked for."""
        return [(_item(each, has_begun=self.time_s > 0), each) for each in self.scene.channels]

    def _flow_stats(self, time_s: float) -> dict[MessageFlow, FlowStats]:
        stats: dict[MessageFlow, FlowStats] = {}
        for each in self.scene.channels:
            count = FlowStats(_sent(each, time_s), each.rate)
            stats[MessageFlow(each.sender, each.name, each.is_service)] = count
            if each.is_service:
                for server in each.receivers:
                    answer = MessageFlow(server, each.name, is_service=True, response_to=each.sender)
                    stats[answer] = FlowStats(_sent(each, time_s - ANSWER_S), each.rate)
        return stats


ANSWER_S: Final = 1.5
"""From a request's departure to its answer's [s]: then its message has arrived in the picture."""


def graph_rows(scene: GraphScene, *, at_end: bool) -> list[str]:
    """The scene as rows of ASCII, without motion: at its beginning, or at its end with what was sent in words."""
    playback = GraphPlayback(scene)
    if at_end:
        playback.advance_to(scene.seconds)
    rows = [row.rstrip() for row in playback.frame(PLAIN_COLUMNS, playback.height, AsciiEncoder()).rows()]
    while rows and not rows[-1]:
        rows.pop()
    return [*rows, f"That is after {scene.seconds:g} s."] if at_end else rows


def _item(channel: GraphChannel, *, has_begun: bool) -> GraphItem:
    name = channel.name if has_begun else channel.asked or channel.name
    label = f"{name}()" if channel.is_service else name
    lost = frozenset((channel.sender, node) for node in channel.undelivered) if has_begun else frozenset()
    return GraphItem(label, name, (channel.sender,), channel.receivers, lost)


def _sent(channel: GraphChannel, time_s: float) -> int:
    """Messages that have left ``time_s`` seconds after the beginning."""
    if channel.rate is not None:
        return max(0, math.floor(channel.rate * time_s + 1e-6))
    return sum(time <= time_s for time in channel.times)


def _described(channel: GraphChannel, count: int) -> str:
    heard_by = [node for node in channel.receivers if node not in channel.undelivered]
    ends, each = " and ".join(heard_by), "" if count == 1 else "each "
    if channel.is_service:
        return f"{channel.name}: {counted(count, 'request')}, {each}answered by {ends}"
    heard = f"{each}to {ends}" if ends else "no subscriber"
    if channel.undelivered:
        lost = f"none to {' or '.join(channel.undelivered)}"
        heard = f"{heard}, {lost}" if ends else lost
    return f"{channel.name}: {counted(count, 'message')}, {heard}"
