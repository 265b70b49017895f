"""Publishes the keys that are pressed and released as messages in a world's graph."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from kit.msg.std_msgs import Float32, String
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node

KEYS_TOPIC: Final = "/teleopkeys"
STRENGTH_TOPIC: Final = f"{KEYS_TOPIC}/strength"


class KeystrokePublisher:
    """Publishes ``p_up``, ``r_up`` and so on (pressed, released) on ``/teleopkeys``.

    A terminal that reports no key release leaves open for a while whether a key is still down; how strongly
    the keys push meanwhile, 0 to 1, goes to ``/teleopkeys/strength``.
    """

    def __init__(self, graph: Graph, *, is_hidden: bool = False) -> None:
        """``is_hidden``: its names are hidden ones, for a world in which no program expects keys."""
        self._graph = graph
        mark = "_" if is_hidden else ""
        node = create_graph_node(graph, f"{mark}TeleOpKeys")
        self._topic = KEYS_TOPIC.replace("/", f"/{mark}", 1)
        self._keys = node.create_publisher(String, self._topic, 10)
        self._strengths = node.create_publisher(Float32, STRENGTH_TOPIC.replace("/", f"/{mark}", 1), 10)
        self._strength = 1.0
        self._held: list[str] = []
        self._listeners = 0

    @property
    def has_listener(self) -> bool:
        """Whether a node listens to the keys."""
        return self._graph.subscription_count(self._topic) > 0

    def publish(self, messages: Iterable[str], strength: float = 1.0) -> None:
        if strength != self._strength:
            self._strength = strength
            self._strengths.publish(Float32(data=float(strength)))
        for message in messages:
            self._keys.publish(String(data=message))
            event, _, key = message.partition("_")
            self._held = [held for held in self._held if held != key]
            if event == "p":
                self._held.append(key)

    def resend_held_keys(self) -> None:
        """Publishes the keys that are down to a listener that has just started: it missed when they went down."""
        listeners = self._graph.subscription_count(self._topic)
        if listeners > self._listeners:
            self.publish([f"p_{key}" for key in self._held], self._strength)
        self._listeners = listeners
