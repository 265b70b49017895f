"""launch_testing.legacy of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.actions import (
        EmitEvent as EmitEvent,
        RegisterEventHandler as RegisterEventHandler,
        Shutdown as Shutdown,
    )
    from kit.ros.launch.event_handlers import (
        OnExecutionComplete as OnExecutionComplete,
        OnProcessExit as OnProcessExit,
        OnProcessIO as OnProcessIO,
        OnShutdown as OnShutdown,
    )
    from kit.ros.launch.processes import ExecuteProcess as ExecuteProcess
    from launch_testing.legacy import output as output
    LaunchTestService: Any
else:
    _LATE_NAMES = {
        "EmitEvent": "kit.ros.launch.actions:EmitEvent",
        "ExecuteProcess": "kit.ros.launch.processes:ExecuteProcess",
        "LaunchTestService": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "OnExecutionComplete": "kit.ros.launch.event_handlers:OnExecutionComplete",
        "OnProcessExit": "kit.ros.launch.event_handlers:OnProcessExit",
        "OnProcessIO": "kit.ros.launch.event_handlers:OnProcessIO",
        "OnShutdown": "kit.ros.launch.event_handlers:OnShutdown",
        "RegisterEventHandler": "kit.ros.launch.actions:RegisterEventHandler",
        "Shutdown": "kit.ros.launch.actions:Shutdown",
        "output": "launch_testing.legacy.output",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
