"""rclpy.utilities of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.execution.client_library import (
    get_available_rmw_implementations,
    get_rmw_implementation_identifier,
    ok,
    remove_ros_args,
    shutdown,
    timeout_sec_to_nsec,
    try_shutdown,
)
from kit.ros.execution.context import get_default_context
from kit.ros.late_names import import_late_name

__all__ = [
    "get_available_rmw_implementations",
    "get_default_context",
    "get_rmw_implementation_identifier",
    "ok",
    "remove_ros_args",
    "shutdown",
    "timeout_sec_to_nsec",
    "try_shutdown",
]

if TYPE_CHECKING:
    from kit.ros.execution.context import Context as Context
    from kit.ros.node.time import S_TO_NS as S_TO_NS
    g_context_lock: Any
    g_default_context: Any
else:
    _LATE_NAMES = {
        "Context": "kit.ros.execution.context:Context",
        "S_TO_NS": "kit.ros.node.time:S_TO_NS",
        "g_context_lock": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "g_default_context": "!rclpy's library in C, in whose place the kit has a graph of its own",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
