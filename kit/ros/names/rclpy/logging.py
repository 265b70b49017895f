from kit.ros.execution.client_library import (
    get_logger,
    get_logger_effective_level,
    get_logger_level,
    set_logger_level,
)
from kit.ros.log import LoggingSeverity, get_logging_severity_from_string

__all__ = [
    "LoggingSeverity",
    "get_logger",
    "get_logger_effective_level",
    "get_logger_level",
    "get_logging_severity_from_string",
    "set_logger_level",
]
