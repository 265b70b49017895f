"""rclpy, the client library of ROS 2, as this project offers it."""

from kit.ros.execution.client_library import (
    InitContextManager,
    SignalHandlerOptions,
    create_node,
    get_global_executor,
    init,
    ok,
    shutdown,
    spin,
    spin_once,
    spin_until_future_complete,
    try_shutdown,
)
from kit.ros.execution.context import Context, get_default_context

__all__ = [
    "Context",
    "InitContextManager",
    "SignalHandlerOptions",
    "create_node",
    "get_default_context",
    "get_global_executor",
    "init",
    "ok",
    "shutdown",
    "spin",
    "spin_once",
    "spin_until_future_complete",
    "try_shutdown",
]
