"""launch_ros.event_handlers.on_state_transition of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.event_handlers import (
        EventHandler as EventHandler,
        OnStateTransition as OnStateTransition,
    )
    from kit.ros.launch.events import Event as Event, StateTransition as StateTransition
    from kit.ros.launch.normalization import SomeEntities as _SomeActionsType, SomeEntities as _SomeEntitiesType
    from kit.ros.launch.processes import LifecycleNode as LifecycleNode
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType

    SomeActionsType = _SomeActionsType
    SomeEntitiesType = _SomeEntitiesType
    SomeSubstitutionsType = _SomeSubstitutionsType
else:
    _LATE_NAMES = {
        "Event": "kit.ros.launch.events:Event",
        "EventHandler": "kit.ros.launch.event_handlers:EventHandler",
        "LifecycleNode": "kit.ros.launch.processes:LifecycleNode",
        "OnStateTransition": "kit.ros.launch.event_handlers:OnStateTransition",
        "SomeActionsType": "kit.ros.launch.normalization:SomeEntities",
        "SomeEntitiesType": "kit.ros.launch.normalization:SomeEntities",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "StateTransition": "kit.ros.launch.events:StateTransition",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
