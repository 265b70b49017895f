"""rclpy.action.client of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.action.client import ActionClient, ClientGoalHandle
from kit.ros.late_names import import_late_name

__all__ = ["ActionClient", "ClientGoalHandle"]

if TYPE_CHECKING:
    from kit.msg.action_msgs import CancelGoal as CancelGoal, GoalStatus as GoalStatus
    from kit.msg.unique_identifier_msgs import UUID as UUID
    from kit.ros.execution.task import Future as Future, await_or_execute as await_or_execute
    from kit.ros.node.qos import (
        QoSProfile as QoSProfile,
        qos_profile_action_status_default as qos_profile_action_status_default,
        qos_profile_services_default as qos_profile_services_default,
    )
    from kit.ros.node.waitable import NumberOfEntities as NumberOfEntities, Waitable as Waitable
    from kit.ros.type_support import check_for_type_support as check_for_type_support
    ClientGoalHandleDict: Any
else:
    _LATE_NAMES = {
        "CancelGoal": "kit.msg.action_msgs:CancelGoal",
        "ClientGoalHandleDict": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "Future": "kit.ros.execution.task:Future",
        "GoalStatus": "kit.msg.action_msgs:GoalStatus",
        "NumberOfEntities": "kit.ros.node.waitable:NumberOfEntities",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
        "UUID": "kit.msg.unique_identifier_msgs:UUID",
        "Waitable": "kit.ros.node.waitable:Waitable",
        "await_or_execute": "kit.ros.execution.task:await_or_execute",
        "check_for_type_support": "kit.ros.type_support:check_for_type_support",
        "qos_profile_action_status_default": "kit.ros.node.qos:qos_profile_action_status_default",
        "qos_profile_services_default": "kit.ros.node.qos:qos_profile_services_default",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
