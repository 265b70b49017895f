"""launch.events.process of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

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
