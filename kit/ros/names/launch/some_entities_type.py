"""launch.some_entities_type of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.entity import LaunchDescriptionEntity as LaunchDescriptionEntity
    from kit.ros.launch.normalization import (
        ENTITY_TYPES as _SomeEntitiesType_types_tuple,
        SomeEntities as _SomeEntitiesType,
    )

    SomeEntitiesType = _SomeEntitiesType
    SomeEntitiesType_types_tuple = _SomeEntitiesType_types_tuple
else:
    _LATE_NAMES = {
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
        "SomeEntitiesType": "kit.ros.launch.normalization:SomeEntities",
        "SomeEntitiesType_types_tuple": "kit.ros.launch.normalization:ENTITY_TYPES",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
