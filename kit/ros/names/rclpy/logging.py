from kit.ros.execution.client_library import (
    get_logger,
    get_logger_effective_level,
    get_logger_level,
    set_logger_level,
)
from kit.ros.execution.client_library import initialize_logging as initialize
from kit.ros.execution.client_library import shutdown_logging as clear_config
from kit.ros.execution.client_library import shutdown_logging as shutdown
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
