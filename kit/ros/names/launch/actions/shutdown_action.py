"""launch.actions.shutdown_action of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.actions import EmitEvent as EmitEvent, Shutdown as Shutdown
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.events import ProcessExited as ProcessExited, Shutdown as _ShutdownEvent

    ShutdownEvent = _ShutdownEvent
    Entity: Any
    Parser: Any
    expose_action: Any
else:
    _LATE_NAMES = {
        "EmitEvent": "kit.ros.launch.actions:EmitEvent",
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ProcessExited": "kit.ros.launch.events:ProcessExited",
        "Shutdown": "kit.ros.launch.actions:Shutdown",
        "ShutdownEvent": "kit.ros.launch.events:Shutdown",
        "expose_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
