"""Events: what happens to processes, and the end of it all."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


class Event:
    """Something that happened, or is to happen."""

    name = "launch.Event"


class Shutdown(Event):
    """Everything ends."""

    name = "launch.events.Shutdown"

    def __init__(self, *, reason: str = "reason not given", due_to_sigint: bool = False) -> None:
        self.reason = reason
        self.due_to_sigint = due_to_sigint


class RunningProcessEvent(Event):
    """Something about a process that a launch file has started."""

    name = "launch.events.process.RunningProcessEvent"

    def __init__(self, *, action: Any, name: str, pid: int = 0) -> None:
        self.action = action
        """The one that started it."""
        self.process_name = name
        self.pid = pid


class ProcessStarted(RunningProcessEvent):
    name = "launch.events.process.ProcessStarted"


class ProcessExited(RunningProcessEvent):
    name = "launch.events.process.ProcessExited"

    def __init__(self, *, returncode: int, **about: Any) -> None:
        super().__init__(**about)
        self.returncode = returncode


class ProcessIO(RunningProcessEvent):
    """Something that a process has printed."""

    name = "launch.events.process.ProcessIO"

    def __init__(self, *, text: bytes, from_stdout: bool, **about: Any) -> None:
        super().__init__(**about)
        self.text = text
        self.from_stdout = from_stdout

    @property
    def from_stderr(self) -> bool:
        return not self.from_stdout


class ProcessMatchingEvent(Event):
    """Meant for the processes whose action a function picks."""

    def __init__(self, *, process_matcher: Callable[[Any], bool]) -> None:
        self.process_matcher = process_matcher


class ShutdownProcess(ProcessMatchingEvent):
    """Has a process ended."""

    name = "launch.events.process.ShutdownProcess"


class SignalProcess(ProcessMatchingEvent):
    """Has a signal sent to a process; here any signal ends it."""

    name = "launch.events.process.SignalProcess"

    def __init__(self, *, signal_number: Any, process_matcher: Callable[[Any], bool]) -> None:
        super().__init__(process_matcher=process_matcher)
        self.signal = signal_number


def matches_action(action: Any) -> Callable[[Any], bool]:
    """Picks the process that this action has started."""
    return lambda other: other is action
