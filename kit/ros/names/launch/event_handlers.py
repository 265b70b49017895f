"""launch.event_handlers of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.event_handlers import (
    OnExecutionComplete,
    OnProcessExit,
    OnProcessIO,
    OnProcessStart,
    OnShutdown,
)

__all__ = ["OnExecutionComplete", "OnProcessExit", "OnProcessIO", "OnProcessStart", "OnShutdown"]
