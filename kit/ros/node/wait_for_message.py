"""Waiting for one message."""

from __future__ import annotations

from typing import Any, TypeVar

from kit.msg.message import Message
from kit.ros.node.node import Node
from kit.ros.node.qos import QoSProfile
from kit.ros.node.time import S_TO_NS

M = TypeVar("M", bound=Message)


def wait_for_message(
    msg_type: type[M],
    node: Node,
    topic: str,
    *,
    qos_profile: QoSProfile | int = 1,
    time_to_wait: float = -1,
) -> tuple[bool, M | None]:
    """The next message on a topic, without spinning the node: ``(True, message)``.

    ``(False, None)`` after ``time_to_wait`` seconds of the graph's time, negative for as long as it takes, or
    after a shutdown.
    """
    context, graph = node.context, node.handle.graph
    received: list[Any] = []

    def arrived() -> bool:
        # Taken out of the queue right here: nobody may be spinning the node.
        return bool(received) or subscription.has_waiting or not context.ok()

    subscription = node.create_subscription(msg_type, topic, received.append, qos_profile)
    try:
        until = None if time_to_wait < 0 else graph.now_ns + int(time_to_wait * S_TO_NS)
        graph.wait(arrived, until, what=f"wait_for_message() on '{subscription.topic_name}'")
        received += subscription.take_waiting()
    finally:
        node.destroy_subscription(subscription)
    return (True, received[0]) if received else (False, None)
