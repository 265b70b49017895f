"""What ``get_publishers_info_by_topic`` and its like tell of an end of a topic."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any

from kit.msg.message import type_name

if TYPE_CHECKING:
    from kit.ros.node.publisher import Publisher
    from kit.ros.node.qos import QoSProfile
    from kit.ros.node.subscription import Subscription


class TopicEndpointTypeEnum(IntEnum):
    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


@dataclass(frozen=True, slots=True)
class TopicEndpointInfo:
    node_name: str
    node_namespace: str
    topic_type: str
    endpoint_type: TopicEndpointTypeEnum
    endpoint_gid: list[int]
    """16 numbers that no other end in the graph has."""
    qos_profile: QoSProfile

    @classmethod
    def of(cls, end: Publisher[Any] | Subscription[Any], kind: TopicEndpointTypeEnum) -> TopicEndpointInfo:
        return cls(
            end.handle.name,
            end.handle.namespace,
            type_name(end.msg_type),
            kind,
            list(end.number.to_bytes(16, "big")),
            end.qos_profile,
        )
