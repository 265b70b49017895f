from kit.ros.launch.events import ExecutionComplete, IncludeLaunchDescription, Shutdown, matches_action

__all__ = [
    "ExecutionComplete",
    "IncludeLaunchDescription",
    "Shutdown",
    "matches_action",
]
