"""Loggers: levels, filters, and the sink that receives the log lines."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol

from kit.ros.node.time import S_TO_NS, Time

if TYPE_CHECKING:
    from pathlib import Path


class LoggingSeverity(IntEnum):
    UNSET = 0
    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50


class LogRecord(NamedTuple):
    """One line of a log."""

    time_ns: int
    """The time of the graph; simulated in a simulation."""
    severity: LoggingSeverity
    name: str
    """The name of the logger: the full name of its node with dots."""
    text: str
    file: str
    function: str
    line: int

    def __str__(self) -> str:
        """The line as ROS 2 prints it: ``[INFO] [12.340000000] [node]: text``."""
        seconds, nanoseconds = divmod(self.time_ns, S_TO_NS)
        return f"[{self.severity.name}] [{seconds}.{nanoseconds:09d}] [{self.name}]: {self.text}"

    def formatted(self, template: str) -> str:
        """The line by a template of ROS 2's, as ``{severity} {time} {name}: {message}``; unknown names stay."""
        seconds, nanoseconds = divmod(self.time_ns, S_TO_NS)
        values = {
            "severity": self.severity.name,
            "name": self.name,
            "time": f"{seconds}.{nanoseconds:09d}",
            "time_as_nanoseconds": str(self.time_ns),
            "function_name": self.function,
            "file_name": self.file,
            "line_number": str(self.line),
        }
        text = template.replace("\\n", "\n").replace("\\t", "\t")
        for name, value in values.items():
            text = text.replace(f"{{{name}}}", value)
        return text.replace("{message}", self.text)  # last: what a program says is no template


LogSink = Callable[[LogRecord], None]
"""A function that receives log lines, called in the thread that logs."""


FORMAT_VARIABLE: Final = "RCUTILS_CONSOLE_OUTPUT_FORMAT"
"""Environment variable with the template of log lines."""

STDOUT_VARIABLE: Final = "RCUTILS_LOGGING_USE_STDOUT"
"""Environment variable that is 1 where log lines are to go to standard output."""


def log_to_stderr(record: LogRecord) -> None:
    """The sink of a program that runs without the kit. ROS 2's environment variables choose another form or stream."""
    template = os.environ.get(FORMAT_VARIABLE)
    stream = sys.stdout if os.environ.get(STDOUT_VARIABLE) == "1" else sys.stderr
    stream.write(f"{record.formatted(template) if template else record}\n")
    stream.flush()


@dataclass
class LoggerSettings:
    """The state that the loggers of a graph share: levels by logger name, clock and sink."""

    now_ns: Callable[[], int]
    sink: LogSink = log_to_stderr
    levels: dict[str, LoggingSeverity] = field(default_factory=dict)
    level: LoggingSeverity = LoggingSeverity.INFO
    """The level of loggers without a level of their own or of an ancestor."""

    def effective_level(self, name: str) -> LoggingSeverity:
        while name:
            if name in self.levels:
                return self.levels[name]
            name = name.rpartition(".")[0]
        return self.level

    def set_level(self, name: str, level: LoggingSeverity) -> None:
        """Sets the level of the logger ``name``. UNSET: its parent's level holds."""
        if level is LoggingSeverity.UNSET:
            self.levels.pop(name, None)
        else:
            self.levels[name] = level

    def warning(self, name: str, text: str) -> None:
        """Logs a warning of the library itself."""
        if self.effective_level(name) <= LoggingSeverity.WARN:
            self.sink(LogRecord(self.now_ns(), LoggingSeverity.WARN, name, text, "", "", 0))


@dataclass(slots=True)
class _CallSite:
    """How often, and when last, one line of code has logged."""

    count: int = 0
    last_ns: int | None = None


class TimeSource(Protocol):
    """A clock that throttles log lines."""

    def now(self) -> Time: ...


class RcutilsLogger:
    """A named logger: ``node.get_logger().info("text", throttle_duration_sec=1.0)``.

    ``once``, ``skip_first`` and ``throttle_duration_sec`` count per line of code that calls.
    """

    def __init__(self, name: str, log: LoggerSettings, publish: LogSink | None = None) -> None:
        self.name = name
        self._log = log
        self.publish = publish
        """A second receiver of its lines: the node's ``/rosout`` publisher."""
        self._sites: dict[tuple[str, int], _CallSite] = {}

    def get_child(self, name: str) -> RcutilsLogger:
        """The logger ``parent.name``; it has its parent's level until it is given its own."""
        if not name:
            raise ValueError("Child logger name must not be empty.")
        return RcutilsLogger(f"{self.name}.{name}" if self.name else name, self._log, self.publish)

    def set_level(self, level: LoggingSeverity | int) -> None:
        """Drops lines below this level. UNSET: the parent's level holds."""
        self._log.set_level(self.name, LoggingSeverity(level))

    def get_effective_level(self) -> LoggingSeverity:
        return self._log.effective_level(self.name)

    def is_enabled_for(self, severity: LoggingSeverity | int) -> bool:
        return severity >= self.get_effective_level()

    def log(self, message: str, severity: LoggingSeverity | int, **kwargs: Any) -> bool:
        """Logs a line if level and filters admit it; returns whether they did."""
        return self._write(message, LoggingSeverity(severity), kwargs)

    def debug(self, message: str, **kwargs: Any) -> bool:
        return self._write(message, LoggingSeverity.DEBUG, kwargs)

    def info(self, message: str, **kwargs: Any) -> bool:
        return self._write(message, LoggingSeverity.INFO, kwargs)

    def warning(self, message: str, **kwargs: Any) -> bool:
        return self._write(message, LoggingSeverity.WARN, kwargs)

    warn = warning

    def error(self, message: str, **kwargs: Any) -> bool:
        return self._write(message, LoggingSeverity.ERROR, kwargs)

    def fatal(self, message: str, **kwargs: Any) -> bool:
        return self._write(message, LoggingSeverity.FATAL, kwargs)

    def _write(self, message: str, severity: LoggingSeverity, filters: dict[str, Any]) -> bool:
        if severity < self.get_effective_level():
            return False
        caller = sys._getframe(2)
        call_site = caller.f_code.co_filename, caller.f_lineno
        if filters and not self._passes(call_site, **filters):
            return False
        record = LogRecord(
            self._log.now_ns(),
            severity,
            self.name,
            str(message),
            call_site[0],
            caller.f_code.co_name,
            call_site[1],
        )
        self._log.sink(record)
        if self.publish is not None:
            self.publish(record)
        return True

    def _passes(
        self,
        call_site: tuple[str, int],
        *,
        once: bool = False,
        skip_first: bool = False,
        throttle_duration_sec: float | None = None,
        throttle_time_source_type: TimeSource | None = None,
    ) -> bool:
        site = self._sites.setdefault(call_site, _CallSite())
        site.count += 1
        if once and site.count > 1:
            return False
        if skip_first and site.count == 1:
            return False
        if throttle_duration_sec is None:
            return True
        clock = throttle_time_source_type
        now = self._log.now_ns() if clock is None else clock.now().nanoseconds
        last = site.last_ns
        # A clock that went backwards starts the wait again.
        if last is not None and last <= now < last + int(throttle_duration_sec * S_TO_NS):
            return False
        site.last_ns = now
        return True


def get_logging_directory() -> Path:
    """The folder where ROS programs keep their log files: $ROS_LOG_DIR, or $ROS_HOME/log, or ~/.ros/log.

    The kit writes none there; launch files and tools ask for it.
    """
    from pathlib import Path  # imported here: it takes a fifth of a node's start-up, and few programs need it

    folder = os.environ.get("ROS_LOG_DIR")
    if folder:
        return Path(folder).expanduser()
    return Path(os.environ.get("ROS_HOME") or "~/.ros").expanduser() / "log"


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    """The severity of this name: ``debug``, ``INFO``, ... Raises RuntimeError if there is none."""
    try:
        return LoggingSeverity[log_severity.upper()]
    except KeyError:
        names = ", ".join(level.name.lower() for level in LoggingSeverity)
        raise RuntimeError(f"there is no log level '{log_severity}'; available: {names}") from None
