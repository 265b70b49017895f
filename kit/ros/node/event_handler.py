"""What publishers and subscriptions are told beside messages: a partner whose quality of service does not fit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from kit.ros.node.qos import QoSPolicyKind


@dataclass(frozen=True, slots=True)
class QoSIncompatibility:
    """What an ``incompatible_qos`` callback is given."""

    last_policy_kind: QoSPolicyKind
    total_count: int
    """Partners that did not fit so far."""
    total_count_change: int = 1


QoSRequestedIncompatibleQoSInfo = QoSIncompatibility
QoSOfferedIncompatibleQoSInfo = QoSIncompatibility

EventCallback = Callable[[Any], Any]


@dataclass(kw_only=True)
class PublisherEventCallbacks:
    """Callbacks for a publisher's events. ``incompatible_qos`` is called; the others never happen here:
    a simulation misses no deadline and loses no publisher."""

    deadline: EventCallback | None = None
    liveliness: EventCallback | None = None
    incompatible_qos: EventCallback | None = None
    incompatible_type: EventCallback | None = None
    matched: EventCallback | None = None
    use_default_callbacks: bool = True


@dataclass(kw_only=True)
class SubscriptionEventCallbacks:
    """Callbacks for a subscription's events. ``incompatible_qos`` is called; the others never happen here."""

    deadline: EventCallback | None = None
    liveliness: EventCallback | None = None
    message_lost: EventCallback | None = None
    incompatible_qos: EventCallback | None = None
    incompatible_type: EventCallback | None = None
    matched: EventCallback | None = None
    use_default_callbacks: bool = True
