"""rclpy.impl.rcutils_logger of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from kit.ros.log import RcutilsLogger

__all__ = ["RcutilsLogger"]

if TYPE_CHECKING:
    from kit.ros.log import LoggingSeverity as LoggingSeverity
    from kit.ros.node.clock import Clock as Clock
    CallerId: Any
    LoggingArgs: Any
    LoggingFilter: Any
    LoggingFilterArgs: Any
    LoggingFilterParams: Any
    Once: Any
    OnceContext: Any
    RcutilsLoggerContext: Any
    SkipFirst: Any
    SkipFirstContext: Any
    SupportedFiltersKeys: Any
    Throttle: Any
    ThrottleContext: Any
    get_filters_from_kwargs: Any
    supported_filters: Any
else:
    _LATE_NAMES = {
        "CallerId": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "Clock": "kit.ros.node.clock:Clock",
        "LoggingArgs": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "LoggingFilter": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "LoggingFilterArgs": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "LoggingFilterParams": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "LoggingSeverity": "kit.ros.log:LoggingSeverity",
        "Once": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "OnceContext": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "RcutilsLoggerContext": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "SkipFirst": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "SkipFirstContext": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "SupportedFiltersKeys": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "Throttle": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "ThrottleContext": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "get_filters_from_kwargs": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "supported_filters": "!rclpy's library in C, in whose place the kit has a graph of its own",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
