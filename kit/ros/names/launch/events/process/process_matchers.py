"""launch.events.process.process_matchers of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.events import (
        matches_executable as matches_executable,
        matches_name as matches_name,
        matches_pid as matches_pid,
    )
    from kit.ros.launch.processes import ExecuteProcess as ExecuteProcess
else:
    _LATE_NAMES = {
        "ExecuteProcess": "kit.ros.launch.processes:ExecuteProcess",
        "matches_executable": "kit.ros.launch.events:matches_executable",
        "matches_name": "kit.ros.launch.events:matches_name",
        "matches_pid": "kit.ros.launch.events:matches_pid",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
