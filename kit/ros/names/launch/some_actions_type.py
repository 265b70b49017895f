"""launch.some_actions_type of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.entity import LaunchDescriptionEntity as LaunchDescriptionEntity
    from kit.ros.launch.normalization import (
        ENTITY_TYPES as _SomeActionsType_types_tuple,
        SomeEntities as _SomeActionsType,
    )

    SomeActionsType = _SomeActionsType
    SomeActionsType_types_tuple = _SomeActionsType_types_tuple
else:
    _LATE_NAMES = {
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
        "SomeActionsType": "kit.ros.launch.normalization:SomeEntities",
        "SomeActionsType_types_tuple": "kit.ros.launch.normalization:ENTITY_TYPES",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
