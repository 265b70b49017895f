"""Two sides of a wire on loopback: kits with a bridge each, a router, and a line between them that can fail."""

from __future__ import annotations

import json
import random
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import TracebackType
from typing import Any, Self

import pytest

from kit.bridge.bridge import Bridge, BridgeSettings
from kit.bridge.wire import BridgeRoute, Direction, Wire
from kit.bridge.zenoh_wire import ZenohAddress, ZenohWire
from kit.msg.geometry_msgs import Twist
from kit.ros.execution.context import context_of
from kit.ros.execution.executors import SingleThreadedExecutor
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node

zenoh = pytest.importorskip("zenoh", reason="needs eclipse-zenoh, of the extras robot and test")


def routes(**texts: str) -> tuple[BridgeRoute, ...]:
    """Routes by direction: ``routes(send="/cmd_vel", receive="/scan /odom")``."""
    return tuple(
        BridgeRoute.parse(Direction(direction), text)
        for direction, several in texts.items()
        for text in several.split()
    )


def twist(forward: float, turn: float = 0.0) -> Twist:
    message = Twist()
    message.linear.x, message.angular.z = forward, turn
    return message


def free_port() -> int:
    """A port of loopback that nobody listens at."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@contextmanager
def router() -> Iterator[int]:
    """A Zenoh router, as rmw_zenohd is one; yields its port."""
    for _ in range(5):
        port = free_port()
        config = zenoh.Config()
        for path, value in {
            "mode": "router",
            "listen/endpoints": [f"tcp/127.0.0.1:{port}"],
            "scouting/multicast/enabled": False,
        }.items():
            config.insert_json5(path, json.dumps(value))
        with suppress(zenoh.ZError):  # somebody else has taken the port meanwhile
            session = zenoh.open(config)
            break
    else:
        raise AssertionError("no router could be started")
    try:
        yield port
    finally:
        session.close()


def wire_to(port: int, domain: int = 0) -> ZenohWire:
    return ZenohWire(ZenohAddress((f"tcp/127.0.0.1:{port}",), domain=domain))


class Side:
    """A kit on one side: a graph on the wall's clock with a node of the test's, and a bridge. Spun in a thread."""

    def __init__(self, wire: Wire, allowed: tuple[BridgeRoute, ...], **settings: Any) -> None:
        self.graph = Graph(None, log_sink=lambda record: None)
        self.node = create_graph_node(self.graph, "mine")
        self.lines: list[str] = []
        """What the bridge has reported."""
        self.bridge = Bridge(
            create_graph_node(self.graph, "kit_bridge"),
            wire,
            BridgeSettings(allowed, **settings),
            self.lines.append,
        )
        self._executor = SingleThreadedExecutor(context=context_of(self.graph))
        self._executor.add_node(self.node)
        self._executor.add_node(self.bridge._node)
        self._is_over = False
        self._thread = threading.Thread(target=self._spin, daemon=True)

    def __enter__(self) -> Self:
        self.bridge.__enter__()
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._is_over = True
        self._thread.join()
        self.bridge.close()
        self._executor.shutdown()

    def heard(self, cls: type[Any], topic: str) -> list[Any]:
        """A list that grows with the messages of a topic, each with the time of the wall."""
        found: list[Any] = []
        self.node.create_subscription(
            cls, topic, lambda message: found.append((time.monotonic(), message)), 50
        )
        return found

    def repeat(self, topic: str, message: Any, period_s: float = 0.02) -> Callable[[], None]:
        """Publishes a message again and again, until the returned function is called."""
        publisher = self.node.create_publisher(type(message), topic, 10)
        timer = self.node.create_timer(period_s, lambda: publisher.publish(message))

        def stop() -> None:
            timer.cancel()

        return stop

    def _spin(self) -> None:
        while not self._is_over:
            self._executor.spin_once(timeout_sec=0.05)


class Line:
    """A TCP line to a port of loopback, with delay and loss, which can be cut. As TCP shows a loss to programs: bytes come
    late, all of them, in order."""

    def __init__(self, port: int, *, delay_s: float = 0.0, loss: float = 0.0, seed: int = 0) -> None:
        self._target = port
        self._delay_s = delay_s
        self._loss = loss
        self._random = random.Random(seed)
        self._flows = threading.Event()
        self._flows.set()
        self._is_refusing = False
        self._sockets: list[socket.socket] = []
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._listener.getsockname()[1]
        self._threads: list[threading.Thread] = []
        self._run(self._accept)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.cut()
        self._flows.set()
        with suppress(OSError):
            self._listener.shutdown(socket.SHUT_RDWR)
        for thread in self._threads:
            thread.join()
        self._listener.close()

    def hold(self) -> None:
        """Nothing gets through any more, and nobody is told: a cable is pulled."""
        self._flows.clear()

    def cut(self) -> None:
        """Ends all connections and refuses new ones."""
        self._is_refusing = True
        for each in self._sockets:
            with suppress(OSError):
                each.shutdown(socket.SHUT_RDWR)
        self._sockets.clear()

    def mend(self) -> None:
        """Everything gets through again: what was held first."""
        self._is_refusing = False
        self._flows.set()

    def _run(self, target: Callable[..., None], *arguments: Any) -> None:
        thread = threading.Thread(target=target, args=arguments, daemon=True)
        self._threads.append(thread)
        thread.start()

    def _accept(self) -> None:
        with suppress(OSError):  # closed
            while True:
                near, _ = self._listener.accept()  # shut down at the end
                if self._is_refusing:
                    near.close()
                    continue
                far = socket.create_connection(("127.0.0.1", self._target))
                self._sockets += [near, far]
                self._run(self._pump, near, far)
                self._run(self._pump, far, near)

    def _pump(self, source: socket.socket, target: socket.socket) -> None:
        with suppress(OSError):
            while data := source.recv(1 << 16):
                late = self._delay_s + (0.1 if self._random.random() < self._loss else 0.0)
                if late:
                    time.sleep(late)
                self._flows.wait()
                target.sendall(data)
        with suppress(OSError):
            target.shutdown(socket.SHUT_RDWR)
        source.close()
