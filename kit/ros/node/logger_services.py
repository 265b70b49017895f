"""Services by which other programs read and set the log levels of a node's loggers."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from kit.msg.interfaces import find_message, find_service
from kit.ros.log import LoggingSeverity

if TYPE_CHECKING:
    from kit.ros.log import LoggerSettings


class LoggerServices:
    """``~/get_logger_levels`` and ``~/set_logger_levels``, for nodes made with ``enable_logger_service``."""

    def __init__(self, log: LoggerSettings, create_service: Callable[..., object]) -> None:
        self._log = log
        self._level = find_message("rcl_interfaces/msg/LoggerLevel")
        self._result = find_message("rcl_interfaces/msg/SetLoggerLevelsResult")
        create_service(
            find_service("rcl_interfaces/srv/GetLoggerLevels"), "~/get_logger_levels", self._get_levels
        )
        create_service(
            find_service("rcl_interfaces/srv/SetLoggerLevels"), "~/set_logger_levels", self._set_levels
        )

    def _get_levels(self, request: Any, response: Any) -> Any:
        response.levels = [
            self._level(name=name, level=int(self._log.levels.get(name, LoggingSeverity.UNSET)))
            for name in request.names
        ]
        return response

    def _set_levels(self, request: Any, response: Any) -> Any:
        response.results = [self._set_level(entry.name, entry.level) for entry in request.levels]
        return response

    def _set_level(self, name: str, level: int) -> Any:
        try:
            self._log.set_level(name, LoggingSeverity(level))
        except ValueError:
            return self._result(successful=False, reason=f"there is no log level {level}")
        return self._result(successful=True)
