"""launch.actions.timer_action of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.actions import (
        OpaqueFunction as OpaqueFunction,
        Shutdown as Shutdown,
        TimerAction as TimerAction,
    )
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action, LaunchDescriptionEntity as LaunchDescriptionEntity
    from kit.ros.launch.event_handlers import EventHandler as EventHandler
    from kit.ros.launch.normalization import (
        SomeEntities as _SomeActionsType,
        SomeEntities as _SomeEntitiesType,
        TEXT_TYPES as _SomeSubstitutionsType_types_tuple,
        ensure_argument_type as ensure_argument_type,
        is_a_subclass as is_a_subclass,
    )
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType
    from launch.frontend import type_utils as type_utils

    SomeActionsType = _SomeActionsType
    SomeEntitiesType = _SomeEntitiesType
    SomeSubstitutionsType = _SomeSubstitutionsType
    SomeSubstitutionsType_types_tuple = _SomeSubstitutionsType_types_tuple
    Entity: Any
    Parser: Any
    TimerEvent: Any
    create_future: Any
    expose_action: Any
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "EventHandler": "kit.ros.launch.event_handlers:EventHandler",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
        "OpaqueFunction": "kit.ros.launch.actions:OpaqueFunction",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Shutdown": "kit.ros.launch.actions:Shutdown",
        "SomeActionsType": "kit.ros.launch.normalization:SomeEntities",
        "SomeEntitiesType": "kit.ros.launch.normalization:SomeEntities",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "SomeSubstitutionsType_types_tuple": "kit.ros.launch.normalization:TEXT_TYPES",
        "TimerAction": "kit.ros.launch.actions:TimerAction",
        "TimerEvent": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "create_future": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
        "expose_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "is_a_subclass": "kit.ros.launch.normalization:is_a_subclass",
        "type_utils": "launch.frontend.type_utils",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
