"""QoS events of publishers and subscriptions: what has happened, how often, and the callbacks for them.

An event becomes an item of its node's ready queue and runs in the callback group of its publisher or subscription.
Events that come before the callback runs are counted together, as a middleware does.

A simulation loses no message: ``message_lost`` never happens. A subscription's ``liveliness`` follows the publishers that
come and go, and those of ``MANUAL_BY_TOPIC`` whose lease runs out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, NamedTuple

from kit.ros.execution.callback_groups import NO_WORK, CallbackGroup, ReentrantCallbackGroup
from kit.ros.node.endpoint import CallbackEntity, EntityOwner, accepted_argument_count
from kit.ros.node.qos import QoSPolicyKind, QoSProfile
from kit.ros.node.time import Duration

EventCallback = Callable[[Any], Any]


class UnsupportedEventTypeError(Exception):
    """The middleware does not know this kind of event. Never raised here; programs catch it."""


class QoSPublisherEventType(IntEnum):
    RCL_PUBLISHER_OFFERED_DEADLINE_MISSED = 0
    RCL_PUBLISHER_LIVELINESS_LOST = 1
    RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS = 2
    RCL_PUBLISHER_INCOMPATIBLE_TYPE = 3
    RCL_PUBLISHER_MATCHED = 4


class QoSSubscriptionEventType(IntEnum):
    RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED = 0
    RCL_SUBSCRIPTION_LIVELINESS_CHANGED = 1
    RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS = 2
    RCL_SUBSCRIPTION_MESSAGE_LOST = 3
    RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE = 4
    RCL_SUBSCRIPTION_MATCHED = 5


class CountStatus(NamedTuple):
    """The argument of the callbacks of events that are only counted."""

    total_count: int = 0
    """The number of such events so far."""
    total_count_change: int = 0
    """How many of them are new since the callback was last called."""


QoSRequestedDeadlineMissedInfo = CountStatus
QoSOfferedDeadlineMissedInfo = CountStatus
QoSLivelinessLostInfo = CountStatus
QoSMessageLostInfo = CountStatus
IncompatibleTypeInfo = CountStatus


class QoSIncompatibility(NamedTuple):
    """The argument of an ``incompatible_qos`` callback."""

    last_policy_kind: QoSPolicyKind = QoSPolicyKind.INVALID
    total_count: int = 0
    """The number of incompatible endpoints so far."""
    total_count_change: int = 0


QoSRequestedIncompatibleQoSInfo = QoSIncompatibility
QoSOfferedIncompatibleQoSInfo = QoSIncompatibility


class MatchedStatus(NamedTuple):
    """The argument of a ``matched`` callback: the endpoints of the other kind that match this one."""

    total_count: int = 0
    """All that have ever matched."""
    total_count_change: int = 0
    current_count: int = 0
    current_count_change: int = 0
    """Negative if fewer match than before."""


QoSSubscriptionMatchedInfo = MatchedStatus
QoSPublisherMatchedInfo = MatchedStatus


class LivelinessChangedStatus(NamedTuple):
    """The argument of a subscription's ``liveliness`` callback."""

    alive_count: int = 0
    not_alive_count: int = 0
    alive_count_change: int = 0
    not_alive_count_change: int = 0


QoSLivelinessChangedInfo = LivelinessChangedStatus


@dataclass(kw_only=True)
class PublisherEventCallbacks:
    """Callbacks for a publisher's events. Without ``incompatible_qos`` and ``incompatible_type``, a warning is logged
    in their place, unless ``use_default_callbacks`` is False."""

    deadline: EventCallback | None = None
    liveliness: EventCallback | None = None
    incompatible_qos: EventCallback | None = None
    incompatible_type: EventCallback | None = None
    matched: EventCallback | None = None
    use_default_callbacks: bool = True


@dataclass(kw_only=True)
class SubscriptionEventCallbacks:
    """Callbacks for a subscription's events; see ``PublisherEventCallbacks``."""

    deadline: EventCallback | None = None
    liveliness: EventCallback | None = None
    message_lost: EventCallback | None = None
    incompatible_qos: EventCallback | None = None
    incompatible_type: EventCallback | None = None
    matched: EventCallback | None = None
    use_default_callbacks: bool = True


class EventHandler(CallbackEntity):
    """Calls one event callback with the status, and counts what happens until then."""

    def __init__(
        self,
        handle: EntityOwner,
        callback: EventCallback,
        callback_group: CallbackGroup,
        status: Any,
        what: str,
    ) -> None:
        accepted_argument_count(callback, (1,), what)
        self._handle = handle
        self.callback = callback
        self.callback_group = callback_group
        self.status = status
        """Of the type of the callback's argument, counted since the callback was last called."""
        self._what = what
        self._is_queued = False
        callback_group.add_entity(self)

    def __str__(self) -> str:
        return self._what

    def update(self, **changes: Any) -> None:
        """Sets fields of the status; adds to those whose name ends in ``_change``. With the graph's lock held."""
        for name in changes:
            if name.endswith("_change"):
                changes[name] += getattr(self.status, name)
        self.status = self.status._replace(**changes)
        if not self._is_queued and not self._destroyed:
            self._is_queued = True
            self._handle.ready_queue.put(self)

    def count(self, **changes: Any) -> None:
        """Counts one event more."""
        self.update(total_count=self.status.total_count + 1, total_count_change=1, **changes)

    def take(self) -> Any:
        if not self._is_queued:
            return NO_WORK
        self._is_queued = False
        taken = self.status
        zero = {name: 0 for name in taken._fields if name.endswith("_change")}
        self.status = taken._replace(**zero)
        return taken

    def run(self, taken: Any) -> Any:
        return self.callback(taken)

    def _unregister(self) -> None:
        self._is_queued = False


class DeadlineWatch(CallbackEntity):
    """Calls a function for each deadline in which no message came. Begins with the first message."""

    def __init__(
        self,
        on_missed: Callable[[], object],
        callback_group: CallbackGroup,
        handle: EntityOwner,
        period_ns: int,
        what: str,
    ) -> None:
        """``on_missed`` is called with the graph's lock held."""
        self._on_missed = on_missed
        self._handle = handle
        self.callback_group = callback_group
        self.number = handle.graph.next_number()
        self._period_ns = period_ns
        self._what = what
        self.due_ns = -1
        """When the next deadline ends [ns]; -1 before the first message and when it is destroyed."""

    def __str__(self) -> str:
        return self._what

    def restart(self) -> None:
        """Begins a deadline now: a message has come. With the graph's lock held."""
        if not self._destroyed:
            self.due_ns = self._handle.graph.now_ns + self._period_ns
            self._handle.ready_queue.add_timer(self)

    def take(self) -> Any:
        if not 0 <= self.due_ns <= self._handle.graph.now_ns:
            return NO_WORK
        self.restart()
        return True

    def run(self, taken: Any) -> None:
        with self._handle.graph.lock:
            self._on_missed()

    def rewind(self) -> None:
        """Begins a new deadline after a jump back in time."""
        if self.due_ns >= 0:
            self.restart()

    def _unregister(self) -> None:
        self.due_ns = -1


class EndpointEvents:
    """The events of one publisher or subscription. What the directory reports goes to callbacks or into the log."""

    def __init__(
        self,
        handle: EntityOwner,
        callbacks: PublisherEventCallbacks | SubscriptionEventCallbacks | None,
        callback_group: CallbackGroup | None,
        qos_profile: QoSProfile,
        what: str,
    ) -> None:
        self._handle = handle
        self._warns = callbacks is None or callbacks.use_default_callbacks
        self._matched_count = self._alive_count = self._not_alive_count = 0
        self.handlers: list[EventHandler] = []
        self.deadline: DeadlineWatch | None = None
        """Restarted with every message; None without a callback for missed deadlines."""
        self.watches: list[DeadlineWatch] = []
        """This one, and a publisher's lease."""
        is_subscription = isinstance(callbacks, SubscriptionEventCallbacks)
        self._group = group = callback_group if callback_group is not None else ReentrantCallbackGroup()

        def handler(name: str, status: Any) -> EventHandler | None:
            callback = getattr(callbacks, name, None)
            if callback is None:
                return None
            made = EventHandler(handle, callback, group, status, f"event '{name}' of {what}")
            self.handlers.append(made)
            return made

        self._incompatible_qos = handler("incompatible_qos", QoSIncompatibility())
        self._incompatible_type = handler("incompatible_type", CountStatus())
        self._matched = handler("matched", MatchedStatus())
        self._liveliness = handler(
            "liveliness", LivelinessChangedStatus() if is_subscription else CountStatus()
        )
        handler("message_lost", CountStatus())
        self._follows_liveliness = is_subscription and self._liveliness is not None
        missed = handler("deadline", CountStatus())
        if missed is not None and qos_profile.deadline.nanoseconds > 0:
            self.deadline = self.watch(missed.count, qos_profile.deadline, f"deadline of {what}")

    def watch(self, on_missed: Callable[[], object], period: Duration, what: str) -> DeadlineWatch:
        """Makes a watch that ends with these events."""
        made = DeadlineWatch(on_missed, self._group, self._handle, period.nanoseconds, what)
        self.watches.append(made)
        return made

    def report_incompatible_qos(self, policy: QoSPolicyKind, warning: str) -> None:
        """Calls the event callback; without one, warns. With the graph's lock held, as the others."""
        if self._incompatible_qos is not None:
            self._incompatible_qos.count(last_policy_kind=policy)
        elif self._warns:
            self._handle.logger.warning(warning)

    def report_incompatible_type(self, warning: str) -> None:
        """Calls the event callback; without one, warns."""
        if self._incompatible_type is not None:
            self._incompatible_type.count()
        elif self._warns:
            self._handle.logger.warning(warning)

    def count_lost_liveliness(self) -> None:
        """Counts that a publisher's lease has run out."""
        if self._liveliness is not None:
            self._liveliness.count()

    def set_alive_counts(self, alive: int, not_alive: int) -> None:
        """Records how many of a subscription's publishers are alive, and of how many the lease has run out."""
        changes = (alive - self._alive_count, not_alive - self._not_alive_count)
        self._alive_count, self._not_alive_count = alive, not_alive
        if any(changes) and self._liveliness is not None and self._follows_liveliness:
            self._liveliness.update(
                alive_count=alive,
                alive_count_change=changes[0],
                not_alive_count=not_alive,
                not_alive_count_change=changes[1],
            )

    def set_matched_count(self, count: int) -> None:
        """Records how many endpoints match now."""
        change, self._matched_count = count - self._matched_count, count
        if change and self._matched is not None:
            new = max(change, 0)
            self._matched.update(
                total_count=self._matched.status.total_count + new,
                total_count_change=new,
                current_count=count,
                current_count_change=change,
            )

    def destroy(self) -> None:
        """Ends all events. With the graph's lock held."""
        for handler in self.handlers:
            handler.destroy()
        for watch in self.watches:
            watch.destroy()
