"""The inspection client: a local graph that mirrors the nodes of a world running in another terminal."""

from __future__ import annotations

import os
import select
import socket
import time
from collections.abc import Callable
from contextlib import suppress
from functools import cached_property
from typing import Any, Final, Self

import kit
from kit.host.graph_bridge import ChildBridge
from kit.host.waiter import SingleThreadWaiter
from kit.host.wire import Json, ProtocolError
from kit.inspection.sockets import FramedSocket, RunningWorld, connect
from kit.msg.message import Message, Service
from kit.ros.execution.context import context_of
from kit.ros.execution.executors import SingleThreadedExecutor
from kit.ros.execution.task import Future
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node

NODE_PREFIX: Final = "_ros2cli_"
"""Prefix of the names of nodes that lists leave out, as in ROS 2's own commands."""

CLOSE_TIMEOUT_S: Final = 2.0
"""How long ``close`` waits until the world has received the last messages [s]."""


CHECK_INTERVAL_S: Final = 0.2
"""How often a call looks whether there is still a node that answers [s, simulated]."""


class WorldDisconnected(Exception):
    """The world has ended, or has closed the connection."""


class ServiceTimeout(Exception):
    """A service has not answered in time; the connection is not usable afterwards."""


class InspectionClient:
    """Connects when it is made. Close it, or use it as a context manager; what was sent last still arrives.

    ``graph`` has the time of the world: that at which the messages that arrive were sent. Whatever waits in it
    raises WorldDisconnected when the world ends. Raises WorldDisconnected, OSError.
    """

    def __init__(self, world: RunningWorld) -> None:
        self._connection = _ServerConnection(connect(world.path))
        try:
            start = self._connection.next_command()[1]
        except WorldDisconnected:
            self._connection.close()
            raise
        if start["version"] != kit.__version__:
            self._connection.close()
            raise WorldDisconnected(
                f"{world.name} runs version {start['version']} of the kit; this is version {kit.__version__}."
            )
        self.world: str = start["world"]
        self._bridge = ChildBridge(self._connection, start["now"], SingleThreadWaiter, shares_interfaces=True)
        self._bridge.apply_events(start["events"])

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def graph(self) -> Graph:
        return self._bridge.graph

    @cached_property
    def node(self) -> Node:
        """The client's own node, which lists leave out."""
        return self.create_node(f"{NODE_PREFIX}{os.getpid()}")

    def create_node(self, name: str) -> Node:
        """Makes a node without the usual publishers and services (``/rosout``, parameter services)."""
        node = Node(
            name,
            context=context_of(self.graph),
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        for publisher in list(node.publishers):
            node.destroy_publisher(publisher)
        return node

    def call(
        self, srv_type: type[Service], name: str, request: Message, *, timeout_s: float | None = None
    ) -> Any:
        """Calls a service and waits for its response.

        Raises ServiceTimeout after ``timeout_s`` of wall clock, and if no node serves it, or none does any more.
        """
        client = self.node.create_client(srv_type, name)
        future = client.call_async(request)
        if timeout_s is not None:
            self._connection.deadline = time.monotonic() + timeout_s
        try:
            self.spin(
                self.node,
                lambda: future.done() or not client.pending_count,
                future,
                check_interval_s=CHECK_INTERVAL_S,
            )
        except TimeoutError:
            raise ServiceTimeout(f"{name} did not answer within {timeout_s:g} s") from None
        finally:
            self._connection.deadline = None
        if not future.done():
            raise ServiceTimeout(f"{name} did not answer: no node serves it any more")
        self.node.destroy_client(client)
        return future.result()

    def spin(
        self,
        node: Node,
        until: Callable[[], object] = lambda: False,
        future: Future[Any] | None = None,
        *,
        check_interval_s: float | None = None,
    ) -> None:
        """Runs the node's callbacks until ``until()``, which is checked after each of them.

        Also checked after ``check_interval_s`` seconds of simulated time, and when ``future`` is done.
        """
        with SingleThreadedExecutor(context=context_of(self.graph)) as executor:
            executor.add_node(node)
            while not until():
                if future is None:
                    executor.spin_once(check_interval_s)
                else:
                    executor.spin_once_until_future_complete(future, check_interval_s)

    def hold_time(self) -> None:
        """Waits for the world's present time. The world stands still then until ``graph`` is waited in again."""
        self._bridge.next_held_tick()

    def wait_for_tick(self) -> None:
        """Waits for the world's next tick, so that ``graph`` has the present time, not that of the last message."""
        self._bridge.next_tick(self.graph.now_ns)

    def close(self) -> None:
        """Disconnects. May be called twice."""
        if self._connection.may_answer or self._bridge.pending:
            with suppress(WorldDisconnected, ProtocolError, TimeoutError):
                if not self._connection.may_answer:  # who waited for the world was interrupted
                    self._connection.deadline = time.monotonic() + CLOSE_TIMEOUT_S
                    self._connection.next_command()
                self._bridge.end()
                self._connection.wait_until_closed()
        self._connection.close()


class _ServerConnection:
    """The client's side of the protocol: receives questions, sends answers."""

    def __init__(self, connection: socket.socket) -> None:
        self._connection = connection
        self._framed_socket = FramedSocket(connection)
        self._seq = 0
        self.may_answer = False
        self.deadline: float | None = None
        """When the world must have sent something [s, monotonic]; None: no limit."""

    def answer(self, kind: str, *content: Json) -> None:
        self.may_answer = False
        try:
            self._framed_socket.send([kind, self._seq, *content])
        except (EOFError, OSError):
            raise WorldDisconnected("The world has ended.") from None

    def next_command(self) -> list[Json]:
        """Raises WorldDisconnected, and TimeoutError at the deadline."""
        if self.deadline is not None:
            left = max(0.0, self.deadline - time.monotonic())
            if not select.select([self._connection], [], [], left)[0]:
                raise TimeoutError
        try:
            kind, self._seq, *content = self._framed_socket.receive()
        except (EOFError, OSError):
            raise WorldDisconnected("The world has ended.") from None
        if kind == "refused":
            raise WorldDisconnected(f"The world closed the connection because it received {content[0]}.")
        self.may_answer = True
        return [kind, *content]

    def wait_until_closed(self) -> None:
        """Waits until the world closes the connection: by then it has received everything."""
        self._connection.settimeout(CLOSE_TIMEOUT_S)
        self.next_command()

    def close(self) -> None:
        self.may_answer = False
        self._framed_socket.close()
