"""Lifecycle nodes of a launch: requests their transitions, one after the other, and reports those that they make."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from kit.host.wire import Json
from kit.launch.requests import TransitionRequest
from kit.msg.lifecycle_msgs import ChangeState, Transition, TransitionEvent
from kit.ros.exceptions import InvalidServiceNameException, InvalidTopicNameException
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node, create_graph_node


class _Call(NamedTuple):
    request: TransitionRequest
    client: Any
    future: Any


class LifecycleTransitions:
    """The transitions that a launch file wants, each made as soon as its node is there.

    ``log`` receives what went wrong, ``report`` the event of each transition of a watched node.
    """

    def __init__(
        self, graph: Graph, log: Callable[[str, str], object], report: Callable[[list[Json]], object]
    ) -> None:
        self._graph, self._log, self._report = graph, log, report
        self._node: Node | None = None
        self._waiting: list[TransitionRequest] = []
        self._call: _Call | None = None

    def add(self, request: TransitionRequest) -> None:
        """Requests one more, after those before it."""
        self._waiting.append(request)

    def watch(self, node: str) -> None:
        """Reports every transition of a node from now on."""

        def on_event(event: Any) -> None:
            labels = (event.transition.label, event.start_state.label, event.goal_state.label)
            self._report(["transitioned", node, *labels])

        try:
            self._own_node().create_subscription(TransitionEvent, f"{node}/transition_event", on_event, 10)
        except InvalidTopicNameException as problem:
            self._log(str(problem), "ERROR")

    def poll(self) -> None:
        """Goes on with what has become possible; never waits."""
        if self._call is not None and self._call.future.done():
            request, client, future = self._call
            assert self._node is not None
            self._node.destroy_client(client)
            self._call = None
            response = future.result()
            if response is None or not response.success:
                self._log(f"{request.node} has refused transition {request.transition}", "ERROR")
                self._waiting = [each for each in self._waiting if each.node != request.node]
        if self._call is None and self._waiting:
            self._begin(self._waiting[0])

    def close(self) -> None:
        """Leaves the graph."""
        if self._node is not None:
            self._node.destroy_node()
            self._node = None

    def _own_node(self) -> Node:
        if self._node is None:
            self._node = create_graph_node(self._graph, "launch_ros", "/")
        return self._node

    def _begin(self, request: TransitionRequest) -> None:
        service = f"{request.node}/change_state"
        if service not in self._graph.directory.services:
            return  # the node is not there yet
        try:
            client = self._own_node().create_client(ChangeState, service)
        except InvalidServiceNameException as problem:
            self._log(str(problem), "ERROR")
            self._waiting.pop(0)
            return
        wanted = ChangeState.Request(transition=Transition(id=request.transition))
        self._call = _Call(request, client, client.call_async(wanted))
        self._waiting.pop(0)
