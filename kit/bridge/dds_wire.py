"""The wire of ROS 2's middlewares for DDS, by the package cyclonedds (extra ``robot``): topics only.

Topics have the prefix ``rt/``; types are called as on Zenoh's wire; endpoints carry the hash of their type in their user
data, ``typehash=RIHS01_...;``. Services differ from one DDS middleware of ROS 2 to the next, and do not pass.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Final
from xml.sax.saxutils import quoteattr

from kit.bridge.rmw_zenoh import NO_TYPE_HASH, dds_type_name, ros_type_name
from kit.bridge.wire import (
    MAX_ENDPOINTS,
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
from kit.msg.fields import FieldKind, FixedArrayKind, MessageKind, ScalarKind, SequenceKind
from kit.msg.interfaces import fields_of, find_message
from kit.msg.message import Message
from kit.ros.node.qos import QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from cyclonedds.sub import DataReader

TOPIC_PREFIX: Final = "rt/"
MAX_TAKEN: Final = 100
WRITE_WAIT_S: Final = 0.1
"""How long a reliable writer may wait for a reader that is behind."""
UNREADABLE: Final = b""
"""Passed on in place of a message whose bytes are none, so that this is said."""
NO_SERVICES: Final = "services do not pass over DDS: each DDS middleware of ROS 2 implements them differently. Use topics, or kit bridge zenoh"


@dataclass(frozen=True, slots=True)
class DdsAddress:
    """The domain, network interface and machines at which to look for the robot."""

    domain: int = 0
    """``ROS_DOMAIN_ID``"""
    interface: str | None = None
    """The network interface, by name or address; by default Cyclone's choice, or ``$CYCLONEDDS_URI``'s."""
    peers: tuple[str, ...] = ()
    """Addresses of machines to look at, where multicast does not reach them."""

    def configuration(self) -> str | None:
        """Cyclone's configuration; None where it is to choose."""
        if self.interface is None and not self.peers:
            return None
        interface = 'autodetermine="true"' if self.interface is None else _interface_key(self.interface)
        peers = "".join(f"<Peer Address={quoteattr(peer)}/>" for peer in self.peers)
        multicast = "<AllowMulticast>false</AllowMulticast>" if self.peers else ""
        discovery = (
            f"<Discovery><ParticipantIndex>auto</ParticipantIndex><Peers>{peers}</Peers></Discovery>"
            if self.peers
            else ""
        )
        return (
            f'<CycloneDDS><Domain Id="any"><General><Interfaces><NetworkInterface {interface}/></Interfaces>'
            f"{multicast}</General>{discovery}</Domain></CycloneDDS>"
        )


def _interface_key(interface: str) -> str:
    is_address = interface[:1].isdigit() or ":" in interface
    return f"{'address' if is_address else 'name'}={quoteattr(interface)}"


class DdsWire:
    """Topics of a robot whose middleware speaks DDS. Takes part in the domain when it is made; one of them in a process
    for each domain. Raises BridgeError where cyclonedds is missing or the network cannot be used."""

    def __init__(self, address: DdsAddress) -> None:
        require_package("cyclonedds", "cyclonedds")
        from cyclonedds.builtin import (
            BuiltinDataReader,
            BuiltinTopicDcpsPublication,
            BuiltinTopicDcpsSubscription,
        )
        from cyclonedds.core import DDSException
        from cyclonedds.domain import Domain, DomainParticipant

        self._delays = DelayMeasure()
        self._open: list[Any] = []
        try:
            self._domain = None
            configuration = address.configuration()
            if configuration is not None:
                self._domain = Domain(address.domain, configuration)
            self._participant: Any = DomainParticipant(address.domain)
        except (DDSException, ValueError) as problem:
            raise BridgeError(f"DDS does not work here: {problem}") from None
        self._publications: Any = BuiltinDataReader(self._participant, BuiltinTopicDcpsPublication)
        self._subscriptions: Any = BuiltinDataReader(self._participant, BuiltinTopicDcpsSubscription)

    def endpoints(self) -> tuple[RemoteEndpoint, ...]:
        found: list[RemoteEndpoint] = []
        for reader, role in ((self._publications, "publisher"), (self._subscriptions, "subscription")):
            for sample in reader.read(MAX_ENDPOINTS):
                endpoint = self._remote_endpoint(sample, role)
                if endpoint is not None:
                    found.append(endpoint)
        return tuple(found)

    def open_publisher(self, name: str, interface: InterfaceId, qos: QoSProfile) -> SendBytes:
        from cyclonedds.core import DDSException
        from cyclonedds.pub import DataWriter

        struct, topic, policies = self._make_topic(name, interface, qos)
        writer: Any = DataWriter(self._participant, topic, qos=policies)
        self._open.append(writer)

        def send(data: bytes) -> None:
            with suppress(
                DDSException
            ):  # a reader that is behind: dropped, as a late command is worse than none
                writer.write(struct.deserialize(data))

        return send

    def open_subscription(
        self, name: str, interface: InterfaceId, qos: QoSProfile, on_message: OnMessage
    ) -> None:
        from cyclonedds.core import DDSException, Listener
        from cyclonedds.sub import DataReader

        delays = self._delays

        class Receiver(Listener):  # type: ignore[misc]  # an extra: its classes are Any here
            """Passes on what arrives."""

            def on_data_available(self, reader: DataReader[Any]) -> None:
                for _ in range(MAX_TAKEN):
                    try:
                        samples = reader.take(1)  # one by one: what cannot be read costs no other
                    except DDSException:
                        return
                    except Exception:  # noqa: BLE001  # whatever its bytes make cyclonedds raise
                        on_message(UNREADABLE, 0.0)
                        continue
                    if not samples:
                        return
                    info = samples[0].sample_info
                    if info.valid_data:
                        sender = str(info.publication_handle).encode()
                        late = delays.add(sender, info.source_timestamp, time.time_ns())
                        on_message(samples[0].serialize(use_version_2=False), late)

        _, topic, policies = self._make_topic(name, interface, qos)
        self._open.append(DataReader(self._participant, topic, qos=policies, listener=Receiver()))

    def open_service(
        self, name: str, interface: InterfaceId, on_request: Callable[[bytes, Reply], None]
    ) -> None:
        raise BridgeError(NO_SERVICES)

    def open_client(self, name: str, interface: InterfaceId) -> Callable[[bytes, OnAnswer], None]:
        raise BridgeError(NO_SERVICES)

    def close(self) -> None:
        for opened in reversed(self._open):
            opened.set_listener(None)
        self._open.clear()
        self._participant = self._publications = self._subscriptions = self._domain = None

    def _make_topic(self, name: str, interface: InterfaceId, qos: QoSProfile) -> tuple[Any, Any, Any]:
        """The type, the topic and the policies of an endpoint."""
        from cyclonedds.core import Policy, Qos
        from cyclonedds.topic import Topic
        from cyclonedds.util import duration

        is_reliable = qos.reliability != ReliabilityPolicy.BEST_EFFORT
        policies = [
            Policy.Reliability.Reliable(duration(seconds=WRITE_WAIT_S))
            if is_reliable
            else Policy.Reliability.BestEffort,
            Policy.Durability.TransientLocal if qos.is_transient_local else Policy.Durability.Volatile,
            Policy.History.KeepLast(qos.depth or 1),
            Policy.DataRepresentation(use_cdrv0_representation=True, use_xcdrv2_representation=False),
        ]
        if interface.type_hash != NO_TYPE_HASH:
            policies.append(Policy.Userdata(f"typehash={interface.type_hash};".encode()))
        struct = idl_struct(find_message(interface.name))
        return struct, Topic(self._participant, f"{TOPIC_PREFIX}{name.lstrip('/')}", struct), Qos(*policies)

    def _remote_endpoint(self, sample: Any, role: str) -> RemoteEndpoint | None:
        from cyclonedds.core import InstanceState, Policy

        if sample.sample_info.instance_state != InstanceState.Alive or not sample.sample_info.valid_data:
            return None
        if sample.participant_key == self._participant.guid or not sample.topic_name.startswith(TOPIC_PREFIX):
            return None
        try:
            type_name = ros_type_name(sample.type_name)
        except ValueError:  # no type of ROS
            return None
        told = sample.qos[Policy.Userdata]
        type_hash = _hash_in(told.data) if told is not None else ""
        return RemoteEndpoint(
            f"/{sample.topic_name.removeprefix(TOPIC_PREFIX)}",
            type_name,
            type_hash,
            role,
            f"participant {sample.participant_key}",
            sample.qos[Policy.Durability] == Policy.Durability.TransientLocal,
        )


def _hash_in(user_data: bytes) -> str:
    """The hash of its type that an endpoint tells; empty where it tells none, as on Humble."""
    entries = user_data.decode(errors="replace").split(";")
    return next((entry.partition("=")[2] for entry in entries if entry.startswith("typehash=")), "")


@cache
def idl_struct(cls: type[Message]) -> Any:
    """The type of a message as cyclonedds describes types: named as ROS 2's generators name it, fields with an underscore.

    Raises ValueError for a field that cannot pass.
    """
    from cyclonedds.idl import make_idl_struct
    from cyclonedds.idl.types import uint8

    fields = {f"{field.name}_": _idl_type(field.kind) for field in fields_of(cls)}
    package, section, name = cls.__ros_type__.split("/")
    return make_idl_struct(
        f"{package}_{section}_{name}",
        dds_type_name(cls.__ros_type__),
        fields or {"structure_needs_at_least_one_member_": uint8},
    )


def _idl_type(kind: FieldKind) -> Any:
    from cyclonedds.idl import types

    if isinstance(kind, MessageKind):
        inner: Any = kind.cls
        return idl_struct(inner)
    if isinstance(kind, FixedArrayKind):
        return types.array[_idl_type(kind.item), kind.length]
    if isinstance(kind, SequenceKind):
        item = _idl_type(kind.item)
        if kind.length is not None:
            return types.array[item, kind.length]
        return types.sequence[item] if kind.bound is None else types.sequence[item, kind.bound]
    assert isinstance(kind, ScalarKind)
    if kind.text.startswith("wstring"):
        raise ValueError("a wstring cannot pass")
    if kind.python_type is str:
        return str if kind.max_length is None else types.bounded_str[kind.max_length]
    if kind.python_type is bool:
        return bool
    return types.uint8 if kind.text in ("byte", "char") else getattr(types, kind.text)
