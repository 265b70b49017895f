"""Subscriptions: they queue messages and pass them to their callback."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from enum import Enum
from typing import Any, Generic, TypedDict, TypeVar

from kit.msg.message import Message
from kit.ros.execution.callback_groups import NO_WORK, CallbackGroup
from kit.ros.node.endpoint import CallbackEntity, EntityOwner, accepted_argument_count
from kit.ros.node.events import EndpointEvents, EventHandler, SubscriptionEventCallbacks
from kit.ros.node.qos import QoSProfile

M = TypeVar("M", bound=Message)


class MessageInfo(TypedDict):
    """The second argument of a callback that takes two."""

    source_timestamp: int
    received_timestamp: int
    publication_sequence_number: int | None
    reception_sequence_number: int | None


class Subscription(CallbackEntity, Generic[M]):
    """Receives messages of one type from a topic. ``Node.create_subscription`` makes one.

    Its queue holds as many messages as its quality of service says; when it is full, the oldest one is dropped.
    """

    class CallbackType(Enum):
        MessageOnly = 0
        WithMessageInfo = 1

    def __init__(
        self,
        handle: EntityOwner,
        msg_type: type[M],
        topic: str,
        callback: Callable[..., Any],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        *,
        raw: bool = False,
    ) -> None:
        self._handle = handle
        self._graph = handle.graph
        self.msg_type = msg_type
        self.topic_name = topic
        """Absolute, after remapping."""
        self.callback = callback
        self.callback_group = callback_group
        self.qos_profile = qos_profile
        self.raw = raw
        """True if the callback gets the serialized message."""
        self.number = self._graph.next_number()
        self._with_info = accepted_argument_count(callback, (1, 2), f"the subscription of {topic}") == 2
        self.events = EndpointEvents(
            handle, event_callbacks, callback_group, qos_profile, f"the subscription of {topic}"
        )
        self._deadline = self.events.deadline
        self._queue: deque[M] = deque(maxlen=qos_profile.queue_length)
        with self._graph.lock:
            self._graph.directory.get_or_create_topic(topic).add_subscription(self)

    def __repr__(self) -> str:
        return f"subscription of {self.topic_name}"

    def __str__(self) -> str:
        return self.topic_name

    @property
    def event_handlers(self) -> list[EventHandler]:
        """The handlers of its event callbacks."""
        return self.events.handlers

    @property
    def topic(self) -> str:
        return self.topic_name

    def get_publisher_count(self) -> int:
        """The number of publishers whose messages it receives."""
        self._check_not_destroyed()
        self._graph.count_read()
        return sum(
            self in publisher.routes for publisher in self._graph.directory.publishers(self.topic_name)
        )

    def enqueue(self, msg: M) -> None:
        """Queues a message, which the subscription owns from now on. With the graph's lock held."""
        if self._deadline is not None:
            self._deadline.restart()
        queue = self._queue
        if len(queue) != queue.maxlen:
            # One entry in the ready queue per queued message: a message that replaces another uses its entry.
            self._handle.ready_queue.items.append(self)
        queue.append(msg)

    @property
    def has_messages(self) -> bool:
        """True if messages wait in its queue."""
        return bool(self._queue)

    def take_messages(self) -> list[M]:
        """Removes and returns all queued messages; the callback is not called for them."""
        with self._graph.lock:
            waiting = list(self._queue)
            self._queue.clear()
            return waiting

    def take(self) -> Any:
        return self._queue.popleft() if self._queue else NO_WORK

    def run(self, taken: Any) -> Any:
        if self.raw:
            from kit.ros.serialization import (
                serialize_message,  # loads numpy, which few programs need for this
            )

            taken = serialize_message(taken)
        if self._with_info:
            now = self._graph.now_ns
            info = MessageInfo(
                source_timestamp=now,
                received_timestamp=now,
                publication_sequence_number=None,
                reception_sequence_number=None,
            )
            return self.callback(taken, info)
        return self.callback(taken)

    def discard_queue(self) -> None:
        self._queue.clear()

    def _unregister(self) -> None:
        self.events.destroy()
        self._queue.clear()
        self._graph.directory.remove_endpoint(self)
