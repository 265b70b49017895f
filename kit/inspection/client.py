"""A visit to a running world: a graph of one's own in which the world's nodes stand, as if they were here."""

from __future__ import annotations

import os
import select
import socket
import time
from collections.abc import Callable
from contextlib import suppress
from functools import cached_property
from types import TracebackType
from typing import Any, Final, Self

import kit
from kit.host.child_bridge import Embassy
from kit.host.waiter import LonePump
from kit.host.wire import Json, ProtocolError
from kit.inspection.framed_socket import Line
from kit.inspection.world_sockets import RunningWorld, connect
from kit.msg.message import Message, Service
from kit.ros.execution.executors import SingleThreadedExecutor
from kit.ros.execution.task import Future
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node

NODE_PREFIX: Final = "_ros2cli_"
"""Of the names of nodes that lists leave out, as ROS 2's own commands call theirs."""

FAREWELL_S: Final = 2.0
"""How long to wait until the world has taken in the last words."""


class WorldGone(Exception):
    """The world has ended, or has shown the visitor out."""


class NoAnswer(Exception):
    """A service has not answered in time. The visit is over with that."""


class Visit:
    """Comes in at once, and leaves by ``close`` or as a context manager; what was said last still arrives.

    ``graph`` has the time of the world: of the moment at which what arrives was said. Whatever waits in it
    raises WorldGone when the world ends. Raises WorldGone, OSError.
    """

    def __init__(self, world: RunningWorld) -> None:
        self._talk = _Talk(connect(world.path))
        try:
            start = self._talk.next_question()[1]
        except WorldGone:
            self._talk.hang_up()
            raise
        if start["version"] != kit.__version__:
            self._talk.hang_up()
            raise WorldGone(
                f"{world.name} runs with version {start['version']} of the kit, this is {kit.__version__}."
            )
        self.world: str = start["world"]
        self._embassy = Embassy(self._talk, start["now"], LonePump)
        self._embassy.hear(start["events"])

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def graph(self) -> Graph:
        return self._embassy.graph

    @cached_property
    def node(self) -> Node:
        """The visitor's own node, left out of lists."""
        return self.make_node(f"{NODE_PREFIX}{os.getpid()}")

    def make_node(self, name: str) -> Node:
        """A node without a node's usual publishers and services."""
        node = Node(
            name,
            context=self.graph.context,
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        for publisher in list(node.publishers):
            node.destroy_publisher(publisher)
        return node

    def call(
        self, srv_type: type[Service], name: str, request: Message, *, patience_s: float | None = None
    ) -> Any:
        """Asks a service and waits for its response. Raises NoAnswer after ``patience_s`` of wall clock."""
        client = self.node.create_client(srv_type, name)
        future = client.call_async(request)
        if patience_s is not None:
            self._talk.deadline = time.monotonic() + patience_s
        try:
            self.spin(self.node, future.done, future)
        except TimeoutError:
            raise NoAnswer(f"{name} has not answered within {patience_s:g} s") from None
        finally:
            self._talk.deadline = None
        self.node.destroy_client(client)
        return future.result()

    def spin(
        self, node: Node, until: Callable[[], object] = lambda: False, future: Future[Any] | None = None
    ) -> None:
        """Runs the node's callbacks until ``until()``, looked at after each of them."""
        with SingleThreadedExecutor(context=self.graph.context) as executor:
            executor.add_node(node)
            while not until():
                if future is None:
                    executor.spin_once()
                else:
                    executor.spin_once_until_future_complete(future)

    def catch_up(self) -> None:
        """Waits for the world's next tick: ``graph`` has its present time then, and not that of the last news."""
        self._embassy.turn(self.graph.now_ns)

    def close(self) -> None:
        """Leaves. May be called twice."""
        if self._talk.is_our_turn:
            with suppress(WorldGone, ProtocolError):
                self._embassy.end()
                self._talk.await_farewell()
        self._talk.hang_up()


class _Talk:
    """The visitor's half of the conversation."""

    def __init__(self, connection: socket.socket) -> None:
        self._connection = connection
        self._line = Line(connection)
        self._seq = 0
        self.is_our_turn = False
        self.deadline: float | None = None
        """Until when the world must have said something [monotonic s]; None: no matter when."""

    def answer(self, kind: str, *content: Json) -> None:
        self.is_our_turn = False
        try:
            self._line.send([kind, self._seq, *content])
        except (EOFError, OSError):
            raise WorldGone("The world has ended.") from None

    def next_question(self) -> list[Json]:
        """Raises WorldGone, and TimeoutError at the deadline."""
        if self.deadline is not None:
            left = max(0.0, self.deadline - time.monotonic())
            if not select.select([self._connection], [], [], left)[0]:
                raise TimeoutError
        try:
            kind, self._seq, *content = self._line.receive()
        except (EOFError, OSError):
            raise WorldGone("The world has ended.") from None
        self.is_our_turn = True
        return [kind, *content]

    def await_farewell(self) -> None:
        """Waits until the other end has hung up: by then it has taken in everything."""
        self._connection.settimeout(FAREWELL_S)
        self.next_question()

    def hang_up(self) -> None:
        self.is_our_turn = False
        self._line.close()
