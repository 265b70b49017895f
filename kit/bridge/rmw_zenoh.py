"""Formats and reads the wire format of ROS 2's middleware for Zenoh (rmw_zenoh_cpp): keys, tokens, attachments.

A topic or service has a key, ``<domain>/<name>/<DDS type>/<type hash>``; its messages are CDR, with an attachment that
says who has sent them and when. Nodes and their endpoints are announced by liveliness tokens below ``@ros2_lv``
(github.com/ros2/rmw_zenoh, docs/design.md and rmw_zenoh_cpp/src/detail/liveliness_utils.cpp).
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import Enum
from hashlib import blake2b
from typing import Final

from kit.ros.node.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

ADMIN_SPACE: Final = "@ros2_lv"
SLASH: Final = "%"
"""Stands for a slash within a part of a token."""
NO_TYPE_HASH: Final = "TypeHashNotSupported"
"""What Humble, which knows no hashes of types, writes in their place."""
DEFAULT_DEPTH: Final = 42
"""The depth that rmw_zenoh leaves out, ``RMW_ZENOH_DEFAULT_HISTORY_DEPTH``."""
GID_LENGTH: Final = 16
MAX_TOKEN: Final = 2000
"""Characters of a token that is read: names have at most 255 each."""
_ATTACHMENT: Final = struct.Struct("<qqB16s")


class EntityKind(Enum):
    """The kind of entity that a token announces."""

    NODE = "NN"
    PUBLISHER = "MP"
    SUBSCRIPTION = "MS"
    SERVICE = "SS"
    CLIENT = "SC"


@dataclass(frozen=True, slots=True)
class WireEndpoint:
    """A publisher, subscription, service or client, as its liveliness token describes it."""

    kind: EntityKind
    node: str
    """The full name of its node."""
    name: str
    """Absolute name of the topic or service."""
    type_name: str
    """``std_msgs/msg/String``"""
    type_hash: str
    qos: str = ""


def dds_type_name(ros_type: str) -> str:
    """The name of a type on the wire.

    >>> dds_type_name("std_msgs/msg/String")
    'std_msgs::msg::dds_::String_'
    """
    package, section, name = ros_type.split("/")
    return f"{package}::{section}::dds_::{name}_"


def ros_type_name(dds_type: str) -> str:
    """The type's name in ROS. Raises ValueError for what is none.

    >>> ros_type_name("std_msgs::msg::dds_::String_")
    'std_msgs/msg/String'
    """
    parts = dds_type.split("::")
    if len(parts) != 4 or parts[2] != "dds_" or not parts[3].endswith("_"):
        raise ValueError(f"{dds_type!r} is no type of ROS")
    return f"{parts[0]}/{parts[1]}/{parts[3][:-1]}"


def data_key(domain: int, name: str, ros_type: str, type_hash: str) -> str:
    """The key of a topic's messages or a service's requests.

    >>> data_key(0, "/chatter", "std_msgs/msg/String", "RIHS01_df66")
    '0/chatter/std_msgs::msg::dds_::String_/RIHS01_df66'
    """
    return f"{domain}/{name.strip('/')}/{dds_type_name(ros_type)}/{type_hash}"


def node_token(domain: int, session: str, node_number: int, node: str) -> str:
    """The token of a node, by its full name."""
    namespace, _, name = node.rpartition("/")
    parts = (
        ADMIN_SPACE,
        str(domain),
        session,
        str(node_number),
        str(node_number),
        EntityKind.NODE.value,
        SLASH,
        (namespace or "/").replace("/", SLASH),
        name,
    )
    return "/".join(parts)


def endpoint_token(
    domain: int, session: str, node_number: int, number: int, endpoint: WireEndpoint, qos: QoSProfile
) -> str:
    """The token of an endpoint; ``number`` is its own within the session."""
    of_node = node_token(domain, session, node_number, endpoint.node).split("/")
    of_node[4], of_node[5] = str(number), endpoint.kind.value
    name, dds_type = endpoint.name.replace("/", SLASH), dds_type_name(endpoint.type_name)
    return "/".join([*of_node, name, dds_type, endpoint.type_hash, encode_qos(qos)])


def parse_token(token: str) -> WireEndpoint | None:
    """The endpoint that a token announces; None for a node's, and for what is no such token."""
    parts = token.split("/")
    if len(token) > MAX_TOKEN or len(parts) != 13 or parts[0] != ADMIN_SPACE:
        return None
    _, _, _, _, _, kind, _, namespace, node, name, dds_type, type_hash, qos = parts
    try:
        known_kind, ros_type = EntityKind(kind), ros_type_name(dds_type)
    except ValueError:
        return None
    if known_kind is EntityKind.NODE:  # has no topic or service
        return None
    full_node = f"{namespace.replace(SLASH, '/').rstrip('/')}/{node.replace(SLASH, '/')}"
    return WireEndpoint(known_kind, full_node, name.replace(SLASH, "/"), ros_type, type_hash, qos)


def encode_qos(qos: QoSProfile) -> str:
    """Quality of service as tokens carry it: what is usual is left out.

    ``reliability:durability:history,depth:deadline:lifespan:liveliness``; the last three are always the usual ones here.
    """
    reliability = "2" if qos.reliability == ReliabilityPolicy.BEST_EFFORT else ""
    durability = "1" if qos.durability == DurabilityPolicy.TRANSIENT_LOCAL else ""
    history = "2" if qos.history == HistoryPolicy.KEEP_ALL else ""
    depth = "" if qos.depth == DEFAULT_DEPTH else str(qos.depth)
    return f"{reliability}:{durability}:{history},{depth}:,:,:,,"


@dataclass(frozen=True, slots=True)
class Attachment:
    """A message's sender, its sequence number, and when it was sent."""

    sequence_number: int
    source_time_ns: int
    """Nanoseconds since the epoch, by the sender's clock."""
    gid: bytes
    """16 bytes of the sender's own."""

    def pack(self) -> bytes:
        """Serializes two int64 and 16 bytes with their length, as Zenoh does."""
        return _ATTACHMENT.pack(self.sequence_number, self.source_time_ns, GID_LENGTH, self.gid)

    @classmethod
    def unpack(cls, data: bytes) -> Attachment:
        """Raises ValueError for anything else."""
        if len(data) != _ATTACHMENT.size:
            raise ValueError(f"an attachment of {len(data)} bytes; it has {_ATTACHMENT.size}")
        sequence_number, source_time_ns, length, gid = _ATTACHMENT.unpack(data)
        if length != GID_LENGTH:
            raise ValueError(f"an attachment with an id of {length} bytes")
        return cls(sequence_number, source_time_ns, gid)


def make_gid(token: str) -> bytes:
    """16 bytes that no other endpoint has. rmw_zenoh hashes the token by XXH128; any hash of it is as unique."""
    return blake2b(token.encode(), digest_size=GID_LENGTH).digest()
