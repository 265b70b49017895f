"""Publishers: they deliver copies of each message to the matching subscriptions."""

from __future__ import annotations

from collections import deque
from typing import Any, Generic, NoReturn, TypeVar

from kit.msg.message import Message, check_message
from kit.ros.execution.callback_groups import CallbackGroup
from kit.ros.graph.directory import TopicSubscription
from kit.ros.node.endpoint import Destroyable, EntityOwner
from kit.ros.node.events import DeadlineWatch, EndpointEvents, EventHandler, PublisherEventCallbacks
from kit.ros.node.qos import LivelinessPolicy, QoSProfile
from kit.ros.node.time import Duration

M = TypeVar("M", bound=Message)

_NO_TIMEOUT = Duration(seconds=-1)


class Publisher(Destroyable, Generic[M]):
    """Sends messages of one type to a topic. ``Node.create_publisher`` makes one."""

    def __init__(
        self,
        handle: EntityOwner,
        msg_type: type[M],
        topic: str,
        qos_profile: QoSProfile,
        event_callbacks: PublisherEventCallbacks | None = None,
        callback_group: CallbackGroup | None = None,
    ) -> None:
        self._handle = handle
        self._graph = handle.graph
        self.msg_type = msg_type
        self.topic_name = topic
        """Absolute, after remapping."""
        self.qos_profile = qos_profile
        self.routes: tuple[TopicSubscription, ...] = ()
        """The subscriptions that receive the messages."""
        self.number = self._graph.next_number()
        self.events = EndpointEvents(
            handle, event_callbacks, callback_group, qos_profile, f"the publisher of {topic}"
        )
        self._deadline = self.events.deadline
        # A transient-local publisher keeps messages for subscriptions that are made later.
        self._history: deque[tuple[int, M]] | None = None
        """Each with the time at which it was published [ns]."""
        if qos_profile.is_transient_local:
            self._history = deque(maxlen=qos_profile.queue_length)
        self.has_lease = (
            qos_profile.liveliness == LivelinessPolicy.MANUAL_BY_TOPIC
            and qos_profile.liveliness_lease_duration.nanoseconds > 0
        )
        """Whether it must show again and again that it is alive."""
        self.is_alive: bool | None = None if self.has_lease else True
        """False if its lease has run out; None before it has ever shown that it is alive."""
        self._lease = self._make_lease() if self.has_lease else None
        self._is_observed = any(each is not None for each in (self._history, self._deadline, self._lease))
        """True if a message matters even when nobody receives it."""
        with self._graph.lock:
            self._graph.directory.get_or_create_topic(topic).add_publisher(self)

    def _make_lease(self) -> DeadlineWatch | None:
        period = self.qos_profile.liveliness_lease_duration
        return self.events.watch(self._lose_lease, period, f"liveliness of {self}")

    def __repr__(self) -> str:
        return f"publisher of {self.topic_name}"

    @property
    def event_handlers(self) -> list[EventHandler]:
        """The handlers of its event callbacks."""
        return self.events.handlers

    @property
    def topic(self) -> str:
        return self.topic_name

    def publish(self, msg: M | bytes) -> None:
        """Sends the message, also a serialized one. It may be changed and published again afterwards."""
        if type(msg) is not self.msg_type or self._destroyed:
            if isinstance(msg, bytes):
                msg = self._deserialize(msg)
            self._check(msg)
        if self.routes or self._graph.message_listeners or self._is_observed:
            self._send(msg, first=0)

    def publish_without_copy(self, msg: M) -> None:
        """Sends a message that the caller will not change again: saves one copy."""
        if type(msg) is not self.msg_type or self._destroyed:
            self._check(msg)
        if self.routes or self._graph.message_listeners or self._is_observed:
            self._send(msg, first=1)

    def _send(self, msg: M, first: int) -> None:
        """Delivers copies; with ``first`` 1, the first subscription gets the message itself."""
        graph = self._graph
        with graph.lock:
            if self._deadline is not None:
                self._deadline.restart()
            if self._lease is not None:
                self._renew_lease(self._lease)
            if graph.message_listeners:
                graph.notify_message_listeners(self._handle.node, self.topic_name, msg)
            try:
                if self._history is not None:
                    self._history.append((graph.now_ns, msg.__deepcopy__(None)))
                for subscription in self.routes[first:]:
                    subscription.enqueue(msg.__deepcopy__(None))
            except AttributeError:
                self._raise_field_error(msg)
            # Last: from here on the message belongs to that subscription.
            if first and self.routes:
                self.routes[0].enqueue(msg)
            graph.count_change()

    def get_subscription_count(self) -> int:
        """The number of subscriptions that receive its messages."""
        self._check_not_destroyed()
        self._graph.count_read()
        return len(self.routes)

    def wait_for_all_acked(self, timeout: Duration = _NO_TIMEOUT) -> bool:
        """Returns True: delivery to the subscriptions' queues is immediate."""
        self._check_not_destroyed()
        return True

    def assert_liveliness(self) -> None:
        """Shows that it is alive, as each message does."""
        self._check_not_destroyed()
        if self._lease is not None:
            with self._graph.lock:
                self._renew_lease(self._lease)

    def _renew_lease(self, lease: DeadlineWatch) -> None:
        lease.restart()
        self.set_alive(True)

    def _lose_lease(self) -> None:
        if self.is_alive:
            self.events.count_lost_liveliness()
            self.set_alive(False)

    def set_alive(self, is_alive: bool) -> None:
        """Tells the subscriptions whether it is alive. With the graph's lock held."""
        if self.is_alive is not is_alive:
            self.is_alive = is_alive
            self._graph.directory.note_liveliness(self)

    def send_history_to(self, subscription: TopicSubscription) -> None:
        """Sends the kept messages to a new transient-local subscription, but for those that are too old."""
        if self._history is not None and subscription.qos_profile.is_transient_local:
            lifespan = self.qos_profile.lifespan.nanoseconds
            oldest_ns = self._graph.now_ns - lifespan if lifespan else 0
            for msg in [msg for sent_ns, msg in self._history if sent_ns >= oldest_ns]:
                subscription.enqueue(msg.__deepcopy__(None))

    def _deserialize(self, data: bytes) -> M:
        from kit.ros.serialization import deserialize_message  # loads numpy, which few programs need for this

        return deserialize_message(data, self.msg_type)

    def _check(self, msg: M) -> None:
        if self._destroyed:
            self._check_not_destroyed()
        if not isinstance(msg, self.msg_type):
            name, fields = self.msg_type.__name__, self.msg_type.__ros_fields__
            if isinstance(msg, type):
                hint = f"; write {name}()"
            elif fields and not isinstance(msg, Message):
                hint = f"; a topic carries messages, not bare values: write {name}({fields[0].name}=...)"
            else:
                hint = ""
            raise TypeError(
                f"Expected {self.msg_type}, got {type(msg)}, to publish on '{self.topic_name}'{hint}"
            )

    def _raise_field_error(self, msg: Any) -> NoReturn:
        """Raises FieldError with the path of the field that made copying the message fail."""
        check_message(msg)
        raise

    def _unregister(self) -> None:
        self.events.destroy()
        self._graph.directory.remove_endpoint(self)
