"""launch_testing.event_handlers.stdout_ready_listener of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.event_handlers import OnProcessIO as OnProcessIO
    from kit.ros.launch.normalization import SomeEntities as _SomeActionsType, SomeEntities as _SomeEntitiesType
    from kit.ros.launch.processes import ExecuteProcess as ExecuteProcess

    SomeActionsType = _SomeActionsType
    SomeEntitiesType = _SomeEntitiesType
    StdoutReadyListener: Any
else:
    _LATE_NAMES = {
        "ExecuteProcess": "kit.ros.launch.processes:ExecuteProcess",
        "OnProcessIO": "kit.ros.launch.event_handlers:OnProcessIO",
        "SomeActionsType": "kit.ros.launch.normalization:SomeEntities",
        "SomeEntitiesType": "kit.ros.launch.normalization:SomeEntities",
        "StdoutReadyListener": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
