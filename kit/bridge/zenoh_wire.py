"""The wire of ROS 2's middleware for Zenoh, by the package eclipse-zenoh (extra ``robot``)."""

from __future__ import annotations

import json
import re
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from kit.bridge.rmw_zenoh import (
    Attachment,
    EntityKind,
    WireEndpoint,
    data_key,
    endpoint_token,
    make_gid,
    node_token,
    parse_token,
)
from kit.bridge.wire import (
    MAX_ENDPOINTS,
    MAX_MESSAGE_BYTES,
    BridgeError,
    DelayMeasure,
    InterfaceId,
    OnAnswer,
    OnMessage,
    RemoteEndpoint,
    Reply,
    SendBytes,
    require_package,
)
from kit.ros.node.qos import QoSProfile

if TYPE_CHECKING:
    import zenoh

DEFAULT_ENDPOINT: Final = "tcp/localhost:7447"
"""Where a robot's router listens, ``ros2 run rmw_zenoh_cpp rmw_zenohd``."""
ENDPOINT_PATTERN: Final = re.compile(r"tcp/\S+:\d+")
CONNECT_TIMEOUT_S: Final = 3.0
CALL_TIMEOUT_S: Final = 5.0
LEASE_MS: Final = 2000
"""A connection that has been silent for this long counts as cut, and is opened again."""
RETRY_MS: Final = 200
MAX_RETRY_MS: Final = 1000
_ROLES: Final = {
    EntityKind.PUBLISHER: "publisher",
    EntityKind.SUBSCRIPTION: "subscription",
    EntityKind.SERVICE: "service",
    EntityKind.CLIENT: "client",
}


@dataclass(frozen=True, slots=True)
class ZenohAddress:
    """The address of the robot's router or session, and its domain."""

    connect: tuple[str, ...] = (DEFAULT_ENDPOINT,)
    """Routers to connect to, ``tcp/192.168.1.7:7447``; the first one that answers is used."""
    listen: tuple[str, ...] = ()
    """Where to listen as a router instead, for robots that connect to this machine."""
    domain: int = 0
    """``ROS_DOMAIN_ID``"""
    connect_timeout_s: float = CONNECT_TIMEOUT_S

    def __post_init__(self) -> None:
        """Raises BridgeError for an endpoint that is not of TCP: over UDP a line that was cut for long did not come back."""
        for endpoint in (*self.connect, *self.listen):
            if ENDPOINT_PATTERN.fullmatch(endpoint) is None:
                raise BridgeError(
                    f"{endpoint}: write an endpoint as tcp/ADDRESS:PORT, such as tcp/192.168.1.7:7447"
                )


class ZenohWire:
    """Topics and services of a robot whose middleware is rmw_zenoh. Connects when it is made; a connection that is cut is
    opened again by itself.

    Announced are one node, ``node_name``, and what is opened here; nothing else of the world. Raises BridgeError where
    nobody answers.
    """

    def __init__(self, address: ZenohAddress, node_name: str = "/kit_bridge") -> None:
        self._zenoh = _import_zenoh()
        self._address = address
        self._node_name = node_name
        self._lock = threading.Lock()
        self._number = 0
        self._tokens: dict[str, RemoteEndpoint] = {}
        self._own_tokens: set[str] = set()
        self._open: list[Any] = []
        self._is_closed = False
        self._session = self._open_session()
        try:
            self._id = str(self._session.info.zid())
            self._watch_tokens()
            self._announce(node_token(address.domain, self._id, 0, node_name))
        except (
            BaseException
        ):  # Ctrl-C too: an open session has threads that the interpreter waits for at its end
            self._session.close()
            raise

    def endpoints(self) -> tuple[RemoteEndpoint, ...]:
        with self._lock:
            return tuple(self._tokens.values())

    # Topics

    def open_publisher(self, name: str, interface: InterfaceId, qos: QoSProfile) -> SendBytes:
        sender = self._new_endpoint(EntityKind.PUBLISHER, name, interface, qos)
        key = self._key(name, interface)
        if qos.is_transient_local:
            from zenoh.ext import CacheConfig, MissDetectionConfig, declare_advanced_publisher

            publisher: Any = declare_advanced_publisher(
                self._session,
                key,
                cache=CacheConfig(max_samples=qos.depth or 1),
                publisher_detection=True,
                sample_miss_detection=MissDetectionConfig(sporadic_heartbeat=0.5),
            )
        else:
            # Sent at once, and dropped rather than kept for later: an old command is worse than none.
            publisher = self._session.declare_publisher(
                key, express=True, congestion_control=self._zenoh.CongestionControl.DROP
            )
        self._open.append(publisher)
        return lambda data: publisher.put(data, attachment=sender.next_attachment())

    def open_subscription(
        self, name: str, interface: InterfaceId, qos: QoSProfile, on_message: OnMessage
    ) -> None:
        self._new_endpoint(EntityKind.SUBSCRIPTION, name, interface, qos)
        key = self._key(name, interface)

        delays = DelayMeasure()

        def receive(sample: zenoh.Sample) -> None:
            late = 0.0
            if sample.attachment is not None:
                with suppress(ValueError):  # no attachment of ROS
                    sent = Attachment.unpack(sample.attachment.to_bytes())
                    late = delays.add(sent.gid, sent.source_time_ns, time.time_ns())
            on_message(sample.payload.to_bytes(), late)

        if qos.is_transient_local:
            from zenoh.ext import HistoryConfig, declare_advanced_subscriber

            history = HistoryConfig(detect_late_publishers=True)
            self._open.append(declare_advanced_subscriber(self._session, key, receive, history=history))
        else:
            self._open.append(self._session.declare_subscriber(key, receive))

    # Services

    def open_service(
        self, name: str, interface: InterfaceId, on_request: Callable[[bytes, Reply], None]
    ) -> None:
        self._new_endpoint(EntityKind.SERVICE, name, interface, QoSProfile(depth=10))
        key = self._key(name, interface)

        def receive(query: zenoh.Query) -> None:
            payload, attachment = query.payload, query.attachment
            if payload is None or attachment is None:
                return  # no request of ROS
            try:
                asked = Attachment.unpack(attachment.to_bytes())
            except ValueError:  # likewise
                return

            def reply(data: bytes) -> None:
                answer = Attachment(asked.sequence_number, time.time_ns(), asked.gid)
                query.reply(key, data, attachment=answer.pack())
                query.drop()

            on_request(payload.to_bytes(), reply)

        self._open.append(self._session.declare_queryable(key, receive, complete=True))

    def open_client(self, name: str, interface: InterfaceId) -> Callable[[bytes, OnAnswer], None]:
        sender = self._new_endpoint(EntityKind.CLIENT, name, interface, QoSProfile(depth=10))
        querier = self._session.declare_querier(
            self._key(name, interface),
            target=self._zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=self._zenoh.ConsolidationMode.NONE,
            timeout=round(CALL_TIMEOUT_S * 1000),
        )
        self._open.append(querier)

        def call(data: bytes, on_answer: OnAnswer) -> None:
            answer = _OneAnswer(on_answer)
            handler = self._zenoh.handlers.Callback(answer.add, answer.end)
            querier.get(handler, payload=data, attachment=sender.next_attachment())

        return call

    def close(self) -> None:
        if self._is_closed:
            return
        self._is_closed = True
        try:
            for opened in reversed(self._open):
                opened.undeclare()
        finally:  # an open session has threads that the interpreter waits for at its end
            self._session.close()

    # The session

    def _open_session(self) -> zenoh.Session:
        address, settings = self._address, self._session_settings()
        self._zenoh.init_log_from_env_or("off")
        config = self._zenoh.Config()
        try:
            for path, value in settings.items():
                config.insert_json5(path, json.dumps(value))
            return self._zenoh.open(config)
        except self._zenoh.ZError as problem:
            if address.listen:
                raise BridgeError(f"Cannot listen at {', '.join(address.listen)}: {problem}") from None
            raise BridgeError(
                f"No router answers at {', '.join(address.connect)}. Start one on the robot, `ros2 run rmw_zenoh_cpp "
                "rmw_zenohd`, and name it: --connect tcp/ROBOT:7447. Nothing was sent."
            ) from None

    def _session_settings(self) -> dict[str, Any]:
        address = self._address
        retry = {"period_init_ms": RETRY_MS, "period_max_ms": MAX_RETRY_MS, "period_increase_factor": 2}
        return {
            "mode": "router" if address.listen else "client",
            "connect/endpoints": [] if address.listen else list(address.connect),
            "listen/endpoints": list(address.listen),
            "connect/timeout_ms": round(address.connect_timeout_s * 1000),
            "connect/retry": retry,
            "scouting/multicast/enabled": False,
            "timestamping/enabled": True,
            "transport/link/tx/lease": LEASE_MS,
            "transport/link/rx/max_message_size": 2 * MAX_MESSAGE_BYTES,
        }

    def _watch_tokens(self) -> None:
        def note(sample: zenoh.Sample) -> None:
            token = str(sample.key_expr)
            found = parse_token(token)
            with self._lock:
                if token in self._own_tokens or found is None:
                    return
                if sample.kind == self._zenoh.SampleKind.PUT:
                    if len(self._tokens) < MAX_ENDPOINTS:
                        self._tokens[token] = _remote_endpoint(found)
                else:
                    self._tokens.pop(token, None)

        pattern = f"@ros2_lv/{self._address.domain}/**"
        self._open.append(self._session.liveliness().declare_subscriber(pattern, note, history=True))

    def _new_endpoint(
        self, kind: EntityKind, name: str, interface: InterfaceId, qos: QoSProfile
    ) -> _MessageCounter:
        """Announces an endpoint."""
        with self._lock:
            self._number += 1
            number = self._number
        endpoint = WireEndpoint(kind, self._node_name, name, interface.name, interface.type_hash)
        token = endpoint_token(self._address.domain, self._id, 0, number, endpoint, qos)
        self._announce(token)
        return _MessageCounter(make_gid(token))

    def _announce(self, token: str) -> None:
        with self._lock:
            self._own_tokens.add(token)
        self._open.append(self._session.liveliness().declare_token(token))

    def _key(self, name: str, interface: InterfaceId) -> str:
        return data_key(self._address.domain, name, interface.name, interface.type_hash)


class _MessageCounter:
    """Numbers the messages of one endpoint."""

    def __init__(self, gid: bytes) -> None:
        self._gid = gid
        self._lock = threading.Lock()
        self._count = 0

    def next_attachment(self) -> bytes:
        with self._lock:
            self._count += 1
            return Attachment(self._count, time.time_ns(), self._gid).pack()


class _OneAnswer:
    """Hands over the first answer to a request, or None when there will be none."""

    def __init__(self, on_answer: OnAnswer) -> None:
        self._on_answer = on_answer
        self._is_done = False

    def add(self, reply: zenoh.Reply) -> None:
        if reply.ok is not None and not self._is_done:
            self._is_done = True
            self._on_answer(reply.ok.payload.to_bytes())

    def end(self) -> None:
        if not self._is_done:
            self._is_done = True
            self._on_answer(None)


def _remote_endpoint(found: WireEndpoint) -> RemoteEndpoint:
    durability = found.qos.split(":")[1] if found.qos.count(":") else ""
    return RemoteEndpoint(
        found.name, found.type_name, found.type_hash, _ROLES[found.kind], found.node, durability == "1"
    )


def _import_zenoh() -> Any:
    """The package. BridgeError where it is not installed."""
    require_package("zenoh", "eclipse-zenoh")
    import zenoh

    return zenoh
