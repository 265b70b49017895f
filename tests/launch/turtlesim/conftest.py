"""turtlesim's node in a graph, stepped by hand, with a node of the test's beside it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from kit.launch.turtlesim.node import PERIOD_S, TurtlesimNode
from kit.msg.geometry_msgs import Twist
from kit.msg.turtlesim import Pose
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node


class Field:
    """The field, and what a node beside it can do."""

    def __init__(self, *words: str) -> None:
        self.said: list[str] = []
        self.graph = Graph(log_sink=lambda record: self.said.append(record.text))
        self.turtlesim = TurtlesimNode(self.graph, words)
        self.node = create_graph_node(self.graph, "tester")
        self.poses: dict[str, Any] = {}
        self.listen("turtle1")

    def listen(self, turtle: str) -> None:
        def keep(pose: Any) -> None:
            self.poses[turtle] = pose

        self.node.create_subscription(Pose, f"/{turtle}/pose", keep, 10)

    def advance(self, seconds: float) -> None:
        """Lets time pass."""
        end = self.graph.now_ns + round(seconds * 1e9)
        while self.graph.now_ns < end:
            self.graph.advance(self.graph.now_ns + round(PERIOD_S * 1e9))
            self.graph.run_due()

    def command(self, linear: float, angular: float, turtle: str = "turtle1", sideways: float = 0.0) -> None:
        message = Twist()
        message.linear.x, message.linear.y, message.angular.z = linear, sideways, angular
        publisher = self.node.create_publisher(Twist, f"/{turtle}/cmd_vel", 10)
        publisher.publish(message)
        self.graph.run_due()

    def call(self, srv_type: Any, service: str, /, **values: Any) -> Any:
        """Calls a service; returns the response."""
        future = self.node.create_client(srv_type, service).call_async(srv_type.Request(**values))
        self.graph.run_due()
        assert future.done(), f"{service} does not answer"
        return future.result()

    @property
    def pose(self) -> Any:
        return self.poses["turtle1"]


@pytest.fixture
def field() -> Callable[..., Field]:
    return Field
