"""launch.event_handlers.on_process_exit of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.event_handlers import EventHandler as _OnActionEventBase, OnProcessExit as OnProcessExit
    from kit.ros.launch.events import Event as Event, ProcessExited as ProcessExited
    from kit.ros.launch.normalization import SomeEntities as _SomeActionsType, SomeEntities as _SomeEntitiesType
    from kit.ros.launch.processes import ExecuteLocal as ExecuteLocal

    OnActionEventBase = _OnActionEventBase
    SomeActionsType = _SomeActionsType
    SomeEntitiesType = _SomeEntitiesType
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "Event": "kit.ros.launch.events:Event",
        "ExecuteLocal": "kit.ros.launch.processes:ExecuteLocal",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "OnActionEventBase": "kit.ros.launch.event_handlers:EventHandler",
        "OnProcessExit": "kit.ros.launch.event_handlers:OnProcessExit",
        "ProcessExited": "kit.ros.launch.events:ProcessExited",
        "SomeActionsType": "kit.ros.launch.normalization:SomeEntities",
        "SomeEntitiesType": "kit.ros.launch.normalization:SomeEntities",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
