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
