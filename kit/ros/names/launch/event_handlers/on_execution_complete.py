"""launch.event_handlers.on_execution_complete of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.event_handlers import (
        EventHandler as _OnActionEventBase,
        OnExecutionComplete as OnExecutionComplete,
    )
    from kit.ros.launch.events import Event as Event, ExecutionComplete as ExecutionComplete
    from kit.ros.launch.normalization import SomeEntities as _SomeActionsType, SomeEntities as _SomeEntitiesType

    OnActionEventBase = _OnActionEventBase
    SomeActionsType = _SomeActionsType
    SomeEntitiesType = _SomeEntitiesType
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "Event": "kit.ros.launch.events:Event",
        "ExecutionComplete": "kit.ros.launch.events:ExecutionComplete",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "OnActionEventBase": "kit.ros.launch.event_handlers:EventHandler",
        "OnExecutionComplete": "kit.ros.launch.event_handlers:OnExecutionComplete",
        "SomeActionsType": "kit.ros.launch.normalization:SomeEntities",
        "SomeEntitiesType": "kit.ros.launch.normalization:SomeEntities",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
