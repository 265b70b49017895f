"""rclpy, the client library of ROS 2, as this project offers it."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from kit.ros.execution.client_library import (
    InitContextManager,
    SignalHandlerOptions,
    create_node,
    get_global_executor,
    get_rmw_implementation_identifier,
    init,
    ok,
    shutdown,
    spin,
    spin_once,
    spin_until_future_complete,
    try_shutdown,
)
from kit.ros.execution.context import Context, get_default_context
from kit.ros.execution.task import Future
from kit.ros.parameters.parameter import Parameter

__all__ = [
    "Context",
    "Future",
    "InitContextManager",
    "Parameter",
    "SignalHandlerOptions",
    "create_node",
    "get_default_context",
    "get_global_executor",
    "get_rmw_implementation_identifier",
    "init",
    "ok",
    "shutdown",
    "spin",
    "spin_once",
    "spin_until_future_complete",
    "try_shutdown",
]


def __getattr__(name: str) -> Any:
    """Imports a submodule at its first use, so that ``rclpy.qos`` works after ``import rclpy`` alone.

    ROS 2's own rclpy imports most of its submodules itself; here that would slow every program's start.
    """
    module = f"{__name__}.{name}"
    try:
        if not name.startswith("_"):
            return import_module(module)
    except ModuleNotFoundError as problem:
        if problem.name != module:
            raise
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
