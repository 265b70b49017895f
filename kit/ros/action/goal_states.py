"""The states of a goal, and the events that lead from one to another."""

from __future__ import annotations

from enum import Enum
from types import MappingProxyType
from typing import Final

from kit.msg.action_msgs import GoalStatus
from kit.msg.unique_identifier_msgs import UUID
from kit.ros.node.qos import QoSProfile


class GoalEvent(Enum):
    """What changes the state of a goal."""

    EXECUTE = 1
    CANCEL_GOAL = 2
    SUCCEED = 3
    ABORT = 4
    CANCELED = 5


STATUS_NAMES: Final = MappingProxyType(
    {
        GoalStatus.STATUS_UNKNOWN: "UNKNOWN",
        GoalStatus.STATUS_ACCEPTED: "ACCEPTED",
        GoalStatus.STATUS_EXECUTING: "EXECUTING",
        GoalStatus.STATUS_CANCELING: "CANCELING",
        GoalStatus.STATUS_SUCCEEDED: "SUCCEEDED",
        GoalStatus.STATUS_CANCELED: "CANCELED",
        GoalStatus.STATUS_ABORTED: "ABORTED",
    }
)

ENDED: Final = frozenset({GoalStatus.STATUS_SUCCEEDED, GoalStatus.STATUS_CANCELED, GoalStatus.STATUS_ABORTED})
"""The states that a goal never leaves."""

TRANSITIONS: Final = MappingProxyType(
    {
        (GoalStatus.STATUS_ACCEPTED, GoalEvent.EXECUTE): GoalStatus.STATUS_EXECUTING,
        (GoalStatus.STATUS_ACCEPTED, GoalEvent.CANCEL_GOAL): GoalStatus.STATUS_CANCELING,
        (GoalStatus.STATUS_EXECUTING, GoalEvent.CANCEL_GOAL): GoalStatus.STATUS_CANCELING,
        (GoalStatus.STATUS_EXECUTING, GoalEvent.SUCCEED): GoalStatus.STATUS_SUCCEEDED,
        (GoalStatus.STATUS_EXECUTING, GoalEvent.ABORT): GoalStatus.STATUS_ABORTED,
        (GoalStatus.STATUS_CANCELING, GoalEvent.SUCCEED): GoalStatus.STATUS_SUCCEEDED,
        (GoalStatus.STATUS_CANCELING, GoalEvent.ABORT): GoalStatus.STATUS_ABORTED,
        (GoalStatus.STATUS_CANCELING, GoalEvent.CANCELED): GoalStatus.STATUS_CANCELED,
    }
)
"""The state that follows a state and an event; no other pair is allowed."""

FEEDBACK_QOS_PROFILE: Final = QoSProfile(depth=10)
"""The quality of service of an action's feedback."""


def uuid_bytes(goal_id: UUID) -> bytes:
    """The 16 bytes of a goal's identifier, without loading numpy as reading the field would."""
    return bytes(goal_id._uuid)  # type: ignore[attr-defined]  # the field's slot
