"""rclpy.signals of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.execution.client_library import SignalHandlerOptions
from kit.ros.late_names import import_late_name

__all__ = ["SignalHandlerOptions"]

if TYPE_CHECKING:
    from kit.ros.exceptions import InvalidHandle as InvalidHandle
    from kit.ros.execution.context import Context as Context
    from kit.ros.node.waitable import WaitableGuardCondition as _GuardCondition

    GuardCondition = _GuardCondition
    SignalHandlerGuardCondition: Any
    get_current_signal_handlers_options: Any
    install_signal_handlers: Any
    uninstall_signal_handlers: Any
else:
    _LATE_NAMES = {
        "Context": "kit.ros.execution.context:Context",
        "GuardCondition": "kit.ros.node.waitable:WaitableGuardCondition",
        "InvalidHandle": "kit.ros.exceptions:InvalidHandle",
        "SignalHandlerGuardCondition": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "get_current_signal_handlers_options": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "install_signal_handlers": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "uninstall_signal_handlers": "!rclpy's library in C, in whose place the kit has a graph of its own",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
