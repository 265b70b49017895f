"""rclpy.action.server of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.action.goal_states import GoalEvent
from kit.ros.action.server import (
    ActionServer,
    CancelResponse,
    GoalResponse,
    ServerGoalHandle,
    default_cancel_callback,
    default_goal_callback,
    default_handle_accepted_callback,
)
from kit.ros.late_names import import_late_name

__all__ = [
    "ActionServer",
    "CancelResponse",
    "GoalEvent",
    "GoalResponse",
    "ServerGoalHandle",
    "default_cancel_callback",
    "default_goal_callback",
    "default_handle_accepted_callback",
]

if TYPE_CHECKING:
    from enum import Enum as Enum
    from kit.msg.action_msgs import GoalInfo as GoalInfo, GoalStatus as GoalStatus
    from kit.ros.execution.task import Future as Future, await_or_execute as await_or_execute
    from kit.ros.node.qos import (
        QoSProfile as QoSProfile,
        qos_profile_action_status_default as qos_profile_action_status_default,
        qos_profile_services_default as qos_profile_services_default,
    )
    from kit.ros.node.waitable import NumberOfEntities as NumberOfEntities, Waitable as Waitable
    from kit.ros.type_support import check_for_type_support as check_for_type_support
    RCLError: Any
    ServerGoalHandleDict: Any
else:
    _LATE_NAMES = {
        "Enum": "enum:Enum",
        "Future": "kit.ros.execution.task:Future",
        "GoalInfo": "kit.msg.action_msgs:GoalInfo",
        "GoalStatus": "kit.msg.action_msgs:GoalStatus",
        "NumberOfEntities": "kit.ros.node.waitable:NumberOfEntities",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
        "RCLError": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "ServerGoalHandleDict": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "Waitable": "kit.ros.node.waitable:Waitable",
        "await_or_execute": "kit.ros.execution.task:await_or_execute",
        "check_for_type_support": "kit.ros.type_support:check_for_type_support",
        "qos_profile_action_status_default": "kit.ros.node.qos:qos_profile_action_status_default",
        "qos_profile_services_default": "kit.ros.node.qos:qos_profile_services_default",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
