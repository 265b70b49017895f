"""Publishers."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any, Generic, NoReturn, TypeVar

from kit.msg.message import Message, check_message
from kit.ros.node.endpoint import Destroyable, IncompatibilityReporter
from kit.ros.node.event_handler import PublisherEventCallbacks
from kit.ros.node.time import Duration

if TYPE_CHECKING:
    from kit.ros.graph.node_handle import NodeHandle
    from kit.ros.node.qos import QoSProfile
    from kit.ros.node.subscription import Subscription

M = TypeVar("M", bound=Message)

_FOR_EVER = Duration(seconds=-1)


class Publisher(Destroyable, Generic[M]):
    """Sends messages of one type to a topic. ``Node.create_publisher`` makes one."""

    def __init__(
        self,
        handle: NodeHandle,
        msg_type: type[M],
        topic: str,
        qos_profile: QoSProfile,
        event_callbacks: PublisherEventCallbacks | None = None,
    ) -> None:
        self._handle = handle
        self._graph = handle.graph
        self.msg_type = msg_type
        self.topic_name = topic
        """Absolute, after remapping."""
        self.qos_profile = qos_profile
        self.routes: tuple[Subscription[M], ...] = ()
        """The subscriptions that what is published reaches."""
        self.number = self._graph.next_number()
        self.incompatibility_reporter = IncompatibilityReporter(handle, event_callbacks)
        # What a transient-local publisher keeps for subscriptions that come later.
        self._history: deque[M] | None = None
        if qos_profile.is_transient_local:
            self._history = deque(maxlen=qos_profile.queue_length)
        with self._graph.lock:
            self._graph.directory.get_or_create_topic(topic).add_publisher(self)

    def __repr__(self) -> str:
        return f"publisher of {self.topic_name}"

    @property
    def topic(self) -> str:
        return self.topic_name

    def publish(self, msg: M) -> None:
        """Sends the message. It may be changed and published again afterwards."""
        self._check(msg)
        if self.routes or self._graph.message_listeners or self._history is not None:
            self._send(msg, first=0)

    def publish_without_copy(self, msg: M) -> None:
        """Sends a message that the caller will not touch again: saves copying it."""
        self._check(msg)
        if self.routes or self._graph.message_listeners or self._history is not None:
            self._send(msg, first=1)

    def _send(self, msg: M, first: int) -> None:
        """Delivers copies; with ``first`` 1, the first subscription gets the message itself."""
        graph = self._graph
        with graph.lock:
            if graph.message_listeners:
                graph.notify_message_listeners(self._handle.node, self.topic_name, msg)
            try:
                if self._history is not None:
                    self._history.append(msg.__deepcopy__(None))
                for subscription in self.routes[first:]:
                    subscription.enqueue(msg.__deepcopy__(None))
            except AttributeError:
                self._explain(msg)
            # Last: from here on the message is somebody else's.
            if first and self.routes:
                self.routes[0].enqueue(msg)
            graph.notify()

    def get_subscription_count(self) -> int:
        """How many subscriptions it reaches."""
        self._check_not_destroyed()
        return len(self.routes)

    def wait_for_all_acked(self, timeout: Duration = _FOR_EVER) -> bool:
        """True: whatever was published has arrived in the subscriptions' queues by now."""
        self._check_not_destroyed()
        return True

    def assert_liveliness(self) -> None:
        """Says that the publisher is alive; nobody doubts it here."""
        self._check_not_destroyed()

    def send_history_to(self, subscription: Subscription[M]) -> None:
        """Sends what was kept to a transient-local subscription that was not there yet."""
        if self._history is not None and subscription.qos_profile.is_transient_local:
            for msg in self._history:
                subscription.enqueue(msg.__deepcopy__(None))

    def _check(self, msg: M) -> None:
        if self._destroyed:
            self._check_not_destroyed()
        if not isinstance(msg, self.msg_type):
            hint = f"; write {self.msg_type.__name__}()" if isinstance(msg, type) else ""
            raise TypeError(
                f"Expected {self.msg_type}, got {type(msg)}, to publish on '{self.topic_name}'{hint}"
            )

    def _explain(self, msg: Any) -> NoReturn:
        """A message that cannot be copied holds something that is no message: says where."""
        check_message(msg)
        raise

    def _unregister(self) -> None:
        self._graph.directory.remove_endpoint(self)
