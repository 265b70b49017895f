"""rclpy.logging of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.execution.client_library import (
    get_logger,
    get_logger_effective_level,
    get_logger_level,
    initialize_logging as initialize,
    set_logger_level,
    shutdown_logging as clear_config,
    shutdown_logging as shutdown,
)
from kit.ros.late_names import import_late_name
from kit.ros.log import LoggingSeverity, get_logging_directory, get_logging_severity_from_string

__all__ = [
    "LoggingSeverity",
    "clear_config",
    "get_logger",
    "get_logger_effective_level",
    "get_logger_level",
    "get_logging_directory",
    "get_logging_severity_from_string",
    "initialize",
    "set_logger_level",
    "shutdown",
]

if TYPE_CHECKING:
    from kit.ros.log import RcutilsLogger as RcutilsLogger
    from pathlib import Path as Path
else:
    _LATE_NAMES = {
        "Path": "pathlib:Path",
        "RcutilsLogger": "kit.ros.log:RcutilsLogger",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
