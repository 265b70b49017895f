"""Bridges a node of a graph to a wire, by an allow-list, under speed limits, a watchdog, and a stop at once.

Another terminal can stop it too: each bridge has a socket, beside those of the running worlds.
"""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final, Self

from kit.bridge.channels import (
    CHANNEL_OF_DIRECTION,
    SERVICE_CHANNELS,
    Channel,
    ChannelContext,
    Report,
    WireCodec,
)
from kit.bridge.motion_guard import STOP_REPEATS, USUAL_LIMIT, MotionGuard, SpeedLimit, moves_robots
from kit.bridge.wire import (
    BridgeError,
    BridgeRoute,
    Direction,
    InterfaceId,
    RemoteEndpoint,
    Wire,
    check_routes,
)
from kit.inspection.sockets import connect, listen, running_worlds, sockets_folder
from kit.msg.interfaces import DefinitionError, UnknownInterface, find_message, find_service
from kit.msg.message import Message, Service
from kit.plain_text import escape_controls
from kit.ros.execution.callback_groups import ReentrantCallbackGroup
from kit.ros.graph.snapshot import EndpointState, GraphState, snapshot
from kit.ros.node.node import Node
from kit.ros.node.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from kit.ros.serialization import Distro

POLL_S: Final = 0.02
"""How often what has arrived is passed on, in the world's time."""
LOOK_S: Final = 0.2
"""How often types are looked for that were not known yet."""
JOIN_S: Final = 2.0
"""How long the end waits for a thread of its own, which ends with the process anyway [s]."""
MAX_REPORTS: Final = 30
"""Lines on what has become of one route."""
MAX_LINE: Final = 1000
"""Characters of a line."""
STOP_PAUSE_S: Final = 0.02
"""Between the repeats of a stop."""


@dataclass(frozen=True, slots=True)
class BridgeSettings:
    """What may pass a bridge, and how fast robots may be told to move."""

    routes: tuple[BridgeRoute, ...]
    limit: SpeedLimit = USUAL_LIMIT
    watchdog_s: float = 0.5
    """A robot whose commands stay away for this long is told to stop."""
    distro: Distro = "jazzy"
    """The robot's ROS 2: a few types differ, and Humble knows no hashes of types."""
    is_dry: bool = False
    """Show what would be sent."""

    def __post_init__(self) -> None:
        """Raises BridgeError for routes that do not fit together."""
        check_routes(self.routes)


class Bridge:
    """Joins ``node`` to ``wire``. Use it as a context manager: at the end every robot is told to stop.

    A route opens when its type is known, from either side. Everything that touches the graph happens in the thread that
    spins the node; the watchdog has a thread and a clock of its own, the wall's, so that it works while the world stands
    still. ``report`` gets lines for people, from any of the threads.
    """

    def __init__(self, node: Node, wire: Wire, settings: BridgeSettings, report: Report) -> None:
        self._node = node
        self._wire = wire
        self._settings = settings
        self._report = report = partial(_report_plainly, report)
        self._channels: dict[BridgeRoute, Channel] = {}
        self._told: dict[BridgeRoute, set[str]] = {route: set() for route in settings.routes}
        self._wire_names = {route.wire_name for route in settings.routes}
        self._looked_s = float("-inf")
        self._is_stopped = False
        self._lock = threading.Lock()
        self._has_ended = threading.Event()
        self._watcher = threading.Thread(target=self._watch, name="bridge-watchdog", daemon=True)
        group = ReentrantCallbackGroup()
        self._context = ChannelContext(
            node, wire, WireCodec(settings.distro), report, group, is_dry=settings.is_dry
        )
        node.create_timer(POLL_S, self.poll, callback_group=group)

    def __enter__(self) -> Self:
        self._watcher.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def is_stopped(self) -> bool:
        """Whether ``stop`` is in force."""
        return self._is_stopped

    @property
    def open_routes(self) -> tuple[BridgeRoute, ...]:
        """The routes whose types are known, on which something may pass now."""
        return tuple(self._channels)

    # In the graph's thread

    def poll(self) -> None:
        """Opens what can be opened, and passes on what has arrived."""
        if time.monotonic() - self._looked_s >= LOOK_S:
            self._looked_s = time.monotonic()
            # A robot may announce thousands of others.
            remote = tuple(each for each in self._wire.endpoints() if each.name in self._wire_names)
            if len(self._channels) < len(self._settings.routes):
                self._open_known_routes(remote)
            self._name_strangers(remote)
        for channel in tuple(self._channels.values()):
            channel.deliver()

    def close(self) -> None:
        """Tells every robot to stop, and takes everything back. May be called twice."""
        if self._has_ended.is_set():
            return
        self._has_ended.set()
        try:
            self.stop()  # before anything is waited for
            if self._watcher.is_alive():
                self._watcher.join(JOIN_S)
            for channel in tuple(self._channels.values()):
                channel.deliver()
        finally:  # a wire that stays open has threads that the interpreter waits for at its end
            self._wire.close()

    def _name_strangers(self, remote: tuple[RemoteEndpoint, ...]) -> None:
        """Reports endpoints on the robot's side that share an open route's name and not its type: nothing passes to or
        from them, for the type is a part of the key."""
        for route, channel in self._channels.items():
            for endpoint in remote:
                theirs = InterfaceId(endpoint.type_name, endpoint.type_hash or channel.interface.type_hash)
                if _matches_route(endpoint, route) and theirs != channel.interface:
                    what = endpoint.type_name
                    if what == channel.interface.name:
                        what = f"another definition of {what}"
                    self._report_route(
                        route, f"{route}: {endpoint.node} has {what}; nothing passes to or from it"
                    )

    def _open_known_routes(self, remote: tuple[RemoteEndpoint, ...]) -> None:
        state = snapshot(self._node.handle.graph)
        for route in self._settings.routes:
            if route in self._channels:
                continue
            try:
                channel = self._open_route(route, state, remote)
            except BridgeError as problem:
                self._report_route(route, str(problem))
                continue
            if channel is None:
                self._report_route(route, f"{route}: waiting until its type is known; no node uses it yet")
                continue
            with self._lock:
                self._channels[route] = channel
                if self._is_stopped and channel.guard is not None:
                    channel.guard.stop()

    def _open_route(
        self, route: BridgeRoute, state: GraphState, remote: tuple[RemoteEndpoint, ...]
    ) -> Channel | None:
        """Opens a route; None while its type is not known. BridgeError for a type that cannot pass."""
        there = [each for each in remote if _matches_route(each, route)]
        here = tuple(_types_here(route, state, self._node.get_fully_qualified_name()))
        names = tuple(dict.fromkeys([*here, *(each.type_name for each in there)]))
        if not names:
            return None
        if len(names) > 1:
            raise BridgeError(f"{route}: it has more than one type, {' and '.join(names)}; nothing passes")
        try:
            return self._open_topic(route, names[0], state, there) or self._open_service(
                route, names[0], there
            )
        except (UnknownInterface, DefinitionError) as problem:
            raise BridgeError(
                f"{route}: {problem}. Put the package that defines {names[0]} beside your own, in src or in the workspace; "
                "nothing passes until then"
            ) from None
        except ValueError as problem:  # a type that cannot be serialized
            raise BridgeError(f"{route}: {problem}; nothing passes") from None

    def _open_topic(
        self, route: BridgeRoute, type_name: str, state: GraphState, there: list[RemoteEndpoint]
    ) -> Channel | None:
        if not route.direction.is_topic:
            return None
        cls = find_message(type_name)
        interface = self._context.codec.topic_interface(cls)
        self._check_hashes(route, interface, there)
        guard, qos = self._make_guard(cls), _route_qos(route, state, there)
        channel = CHANNEL_OF_DIRECTION[route.direction](route, interface, self._context, cls, qos, guard)
        limits = self._settings.limit
        about = (
            f"at most {limits.linear:g} m/s and {limits.angular:g} rad/s, stopped after {self._settings.watchdog_s:g} s "
            "of silence"
        )
        self._report_route(route, f"{route}: {type_name}" + (f", {about}" if guard is not None else ""))
        return channel

    def _open_service(self, route: BridgeRoute, type_name: str, there: list[RemoteEndpoint]) -> Channel:
        cls: type[Service] = find_service(type_name)
        interface = self._context.codec.service_interface(cls)
        self._check_hashes(route, interface, there)
        channel = SERVICE_CHANNELS[route.direction](route, interface, self._context, cls)
        self._report_route(route, f"{route}: {type_name}")
        return channel

    def _check_hashes(self, route: BridgeRoute, interface: InterfaceId, there: list[RemoteEndpoint]) -> None:
        for endpoint in there:
            if endpoint.type_hash not in ("", interface.type_hash):
                raise BridgeError(
                    f"{route}: {endpoint.node} has another definition of {endpoint.type_name} than the kit "
                    f"({endpoint.type_hash[:16]}..., here {interface.type_hash[:16]}...); nothing passes. For a robot with "
                    "Humble give --distro humble"
                )

    def _make_guard(self, cls: type[Message]) -> MotionGuard | None:
        if not moves_robots(cls):
            return None
        return MotionGuard(cls, self._settings.limit, self._settings.watchdog_s)

    def _report_route(self, route: BridgeRoute, text: str) -> None:
        """Reports what has become of a route, each state once. A robot that announces ever new types does not fill the screen."""
        told = self._told[route]
        if text in told or len(told) > MAX_REPORTS:
            return
        told.add(text)
        self._report(text if len(told) <= MAX_REPORTS else f"{route}: further changes are not shown")

    # In any thread

    def stop(self) -> tuple[str, ...]:
        """Tells every robot to stop, at once, and lets no command pass until ``resume``. Returns the topics."""
        with self._lock:
            self._is_stopped = True
            guarded = [
                (channel, channel.guard) for channel in self._channels.values() if channel.guard is not None
            ]
        for _, guard in guarded:
            guard.stop()
        for repeat in range(STOP_REPEATS):
            for channel, _ in guarded:
                self._send_stop(channel)
            if guarded and repeat < STOP_REPEATS - 1:
                time.sleep(STOP_PAUSE_S)
        return tuple(channel.route.name for channel, _ in guarded)

    def _send_stop(self, channel: Channel) -> None:
        """Sends a stop; a wire that refuses it keeps neither the next robot from its stop nor the watchdog from its work."""
        try:
            channel.send_stop()
        except Exception as problem:  # noqa: BLE001 - each wire's package has errors of its own
            self._report(f"{channel.route}: the stop could not be sent: {problem}")

    def resume(self) -> None:
        """Lets commands pass again, unless the end has begun."""
        with self._lock:
            if self._has_ended.is_set():
                return
            self._is_stopped = False
            for channel in self._channels.values():
                if channel.guard is not None:
                    channel.guard.resume()

    def status_lines(self) -> list[str]:
        """A line for each route: messages and bytes per second since the last call, and what has become of them."""
        return [self._status_of(route) for route in self._settings.routes]

    def _status_of(self, route: BridgeRoute) -> str:
        channel = self._channels.get(route)
        if channel is None:
            return f"{route}: waits"
        rate, size = channel.traffic.take_rates()
        parts = [f"{route}: {rate:.1f}/s", f"{size / 1000:.1f} KB/s", f"{channel.traffic.count} in all"]
        guard = channel.guard
        if guard is not None:
            parts += [f"{guard.limited_count} slowed down"] * bool(guard.limited_count)
            parts += ["STOPPED"] * guard.is_stopped + ["silent, robot stopped"] * guard.is_silent
        parts += [f"{channel.traffic.dropped} dropped"] * bool(channel.traffic.dropped)
        return ", ".join(parts)

    def _watch(self) -> None:
        """Stops robots whose commands stay away; in a thread of its own."""
        period_s = min(0.05, self._settings.watchdog_s / 10)
        silent: set[BridgeRoute] = set()
        while not self._has_ended.wait(period_s):
            for route, channel in tuple(self._channels.items()):
                guard = channel.guard
                if guard is None:
                    continue
                if guard.is_stop_due(time.monotonic()):
                    self._send_stop(channel)
                if guard.is_silent and route not in silent:
                    silent.add(route)
                    self._report(
                        f"{route}: no command for {self._settings.watchdog_s:g} s; stopping the robot"
                    )
                elif not guard.is_silent and route in silent:
                    silent.remove(route)
                    self._report(f"{route}: commands resumed")


def _report_plainly(report: Report, text: str) -> None:
    """Reports a line, in which a robot may have names and texts, without anything that a terminal would obey."""
    shown = escape_controls(" ".join(text.splitlines()))
    report(shown if len(shown) <= MAX_LINE else f"{shown[:MAX_LINE]}...")


def _matches_route(endpoint: RemoteEndpoint, route: BridgeRoute) -> bool:
    is_topic = endpoint.role in ("publisher", "subscription")
    return endpoint.name == route.wire_name and is_topic == route.direction.is_topic


def _types_here(route: BridgeRoute, state: GraphState, own: str) -> Iterator[str]:
    """Types that others in the graph give a route's topic or service."""
    if route.direction.is_topic:
        for topic in state.topics:
            if topic.name == route.name:
                endpoints = (*topic.publishers, *topic.subscriptions)
                yield from dict.fromkeys(each.type for each in endpoints if each.node != own)
        return
    for service in state.services:
        if service.name == route.name and any(node != own for node in (*service.servers, *service.clients)):
            yield from service.types


def _route_qos(route: BridgeRoute, state: GraphState, there: list[RemoteEndpoint]) -> QoSProfile:
    """The quality of service of a route: it keeps what its publishers keep, and asks no more than they give."""
    publishers: list[EndpointState] = []
    for topic in state.topics:
        if topic.name == route.name:
            publishers += topic.publishers
    if route.direction is Direction.SEND:
        keeps = bool(publishers) and all(each.qos.is_transient_local for each in publishers)
        reliable = all(each.qos.reliability != ReliabilityPolicy.BEST_EFFORT for each in publishers)
    else:
        senders = [each for each in there if each.role == "publisher"]
        keeps, reliable = bool(senders) and all(each.is_transient_local for each in senders), True
    return QoSProfile(
        depth=10,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if keeps else DurabilityPolicy.VOLATILE,
    )


STOP: Final = b"stop\n"
ANSWER_TIMEOUT_S: Final = 5.0
MAX_ANSWER: Final = 1 << 16
"""Bytes of a bridge's answer that are shown."""


def bridges_folder(workspace: Path) -> Path:
    """This machine's folder of the bridges' sockets in a workspace."""
    return sockets_folder(workspace) / "bridges"


class StopSocket:
    """Stops ``bridge`` when ``stop_bridges`` asks, in a thread of its own, whatever the bridge's world does meanwhile.

    Opening raises OSError where the folder cannot hold a socket. Use it as a context manager.
    """

    def __init__(self, bridge: Bridge, workspace: Path, name: str, on_stop: Callable[[str], object]) -> None:
        self._bridge = bridge
        self._on_stop = on_stop
        self._is_closed = False
        self._listener, self.path = listen(bridges_folder(workspace), name)
        self._thread = threading.Thread(target=self._serve, name="bridge-stop", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._is_closed = True
        with suppress(OSError):
            connect(self.path).close()  # wakes the thread
        self._thread.join(JOIN_S)  # it may be in a stop that a wire does not take
        self._listener.close()
        with suppress(FileNotFoundError):
            self.path.unlink()

    def _serve(self) -> None:
        while True:
            connection, _ = self._listener.accept()
            with connection, suppress(OSError):  # the other end has gone
                if self._is_closed:
                    return
                connection.settimeout(ANSWER_TIMEOUT_S)
                if connection.recv(len(STOP)) == STOP:
                    topics = self._bridge.stop()
                    self._on_stop("stopped by `kit bridge stop`")
                    connection.sendall((", ".join(topics) or "no topic that moves a robot").encode())


def stop_bridges(workspace: Path) -> list[tuple[str, str]]:
    """Stops every running bridge of a workspace; returns the names, and which topics were told to stop, or why not."""
    answers = []
    for found in running_worlds(bridges_folder(workspace)):
        try:
            with connect(found.path) as connection:
                connection.settimeout(ANSWER_TIMEOUT_S)
                connection.sendall(STOP)
                connection.shutdown(socket.SHUT_WR)
                with connection.makefile("rb") as received:  # all of it: one recv may return only a part
                    data = received.read(MAX_ANSWER + 1)
                answer = (
                    data[:MAX_ANSWER].decode(errors="replace") or "it has just ended, and stopped its robots"
                )
                if len(data) > MAX_ANSWER:
                    answer += "... and more"
        except OSError as problem:
            answer = f"it does not answer ({problem}): end its process, or use the robot's emergency stop"
        answers.append((found.name, answer))
    return answers
