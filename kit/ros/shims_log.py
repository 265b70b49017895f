"""What the packages in ``shims`` say of themselves, in the log of the program that imports them."""

from __future__ import annotations

from kit.ros.execution.context import get_default_context
from kit.ros.log import LoggingSeverity, LogRecord


def say(text: str, *, warning: bool = False) -> None:
    """One line: what was adapted, or what cannot be."""
    graph = get_default_context().graph
    severity = LoggingSeverity.WARN if warning else LoggingSeverity.INFO
    graph.log.sink(LogRecord(graph.now_ns, severity, "kit", text, "", "", 0))
