"""rclpy.wait_for_message of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.execution.client_library import wait_for_message
from kit.ros.late_names import import_late_name

__all__ = ["wait_for_message"]

if TYPE_CHECKING:
    from kit.ros.execution.client_library import timeout_sec_to_nsec as timeout_sec_to_nsec
    from kit.ros.node.node import Node as Node
    from kit.ros.node.qos import QoSProfile as QoSProfile
    from kit.ros.type_support import MsgT as MsgT
    SignalHandlerGuardCondition: Any
else:
    _LATE_NAMES = {
        "MsgT": "kit.ros.type_support:MsgT",
        "Node": "kit.ros.node.node:Node",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
        "SignalHandlerGuardCondition": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "timeout_sec_to_nsec": "kit.ros.execution.client_library:timeout_sec_to_nsec",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
