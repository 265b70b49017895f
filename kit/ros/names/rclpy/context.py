"""rclpy.context of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.execution.context import Context
from kit.ros.late_names import import_late_name

__all__ = ["Context"]

if TYPE_CHECKING:
    from inspect import ismethod as ismethod
    from kit.ros.node.node import Node as Node
    from weakref import WeakMethod as WeakMethod
    ContextHandle: Any
    DestroyableType: Any
    g_logging_configure_lock: Any
    g_logging_ref_count: Any
else:
    _LATE_NAMES = {
        "ContextHandle": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "DestroyableType": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "Node": "kit.ros.node.node:Node",
        "WeakMethod": "weakref:WeakMethod",
        "g_logging_configure_lock": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "g_logging_ref_count": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "ismethod": "inspect:ismethod",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
