"""launch.events.process of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.launch.events import (
    ProcessExited,
    ProcessIO,
    ProcessStarted,
    RunningProcessEvent,
    ShutdownProcess,
    SignalProcess,
    matches_executable,
    matches_name,
    matches_pid,
)

__all__ = [
    "ProcessExited",
    "ProcessIO",
    "ProcessStarted",
    "RunningProcessEvent",
    "ShutdownProcess",
    "SignalProcess",
    "matches_executable",
    "matches_name",
    "matches_pid",
]

if TYPE_CHECKING:
    from kit.ros.launch.events import (
        ProcessIO as _ProcessStderr,
        ProcessIO as _ProcessStdin,
        ProcessIO as _ProcessStdout,
        ProcessMatchingEvent as _ProcessTargetedEvent,
    )

    ProcessStderr = _ProcessStderr
    ProcessStdin = _ProcessStdin
    ProcessStdout = _ProcessStdout
    ProcessTargetedEvent = _ProcessTargetedEvent
else:
    _LATE_NAMES = {
        "ProcessStderr": "kit.ros.launch.events:ProcessIO",
        "ProcessStdin": "kit.ros.launch.events:ProcessIO",
        "ProcessStdout": "kit.ros.launch.events:ProcessIO",
        "ProcessTargetedEvent": "kit.ros.launch.events:ProcessMatchingEvent",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
