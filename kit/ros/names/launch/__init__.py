"""launch of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from kit.ros.launch.context import LaunchContext
from kit.ros.launch.description_sources import LaunchDescriptionSource
from kit.ros.launch.entity import Action, Condition, LaunchDescription, LaunchDescriptionEntity
from kit.ros.launch.event_handlers import EventHandler
from kit.ros.launch.events import Event
from kit.ros.launch.substitutions import SomeText as SomeSubstitutionsType, Substitution

__all__ = [
    "Action",
    "Condition",
    "Event",
    "EventHandler",
    "LaunchContext",
    "LaunchDescription",
    "LaunchDescriptionEntity",
    "LaunchDescriptionSource",
    "SomeSubstitutionsType",
    "Substitution",
]

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchError as _InvalidLaunchFileError
    from kit.ros.launch.introspection import LaunchIntrospector as LaunchIntrospector
    from kit.ros.launch.normalization import (
        ENTITY_TYPES as _SomeActionsType_types_tuple,
        ENTITY_TYPES as _SomeEntitiesType_types_tuple,
        SomeEntities as _SomeActionsType,
        SomeEntities as _SomeEntitiesType,
        TEXT_TYPES as _SomeSubstitutionsType_types_tuple,
    )
    from launch import (
        actions as actions,
        conditions as conditions,
        descriptions as descriptions,
        events as events,
        frontend as frontend,
        logging as logging,
        substitutions as substitutions,
    )

    InvalidLaunchFileError = _InvalidLaunchFileError
    SomeActionsType = _SomeActionsType
    SomeActionsType_types_tuple = _SomeActionsType_types_tuple
    SomeEntitiesType = _SomeEntitiesType
    SomeEntitiesType_types_tuple = _SomeEntitiesType_types_tuple
    SomeSubstitutionsType_types_tuple = _SomeSubstitutionsType_types_tuple
    LaunchService: Any
else:
    _LATE_NAMES = {
        "InvalidLaunchFileError": "kit.ros.launch.context:LaunchError",
        "LaunchIntrospector": "kit.ros.launch.introspection:LaunchIntrospector",
        "LaunchService": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeActionsType": "kit.ros.launch.normalization:SomeEntities",
        "SomeActionsType_types_tuple": "kit.ros.launch.normalization:ENTITY_TYPES",
        "SomeEntitiesType": "kit.ros.launch.normalization:SomeEntities",
        "SomeEntitiesType_types_tuple": "kit.ros.launch.normalization:ENTITY_TYPES",
        "SomeSubstitutionsType_types_tuple": "kit.ros.launch.normalization:TEXT_TYPES",
        "actions": "launch.actions",
        "conditions": "launch.conditions",
        "descriptions": "launch.descriptions",
        "events": "launch.events",
        "frontend": "launch.frontend",
        "logging": "launch.logging",
        "substitutions": "launch.substitutions",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
