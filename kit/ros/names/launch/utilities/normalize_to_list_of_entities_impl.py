"""launch.utilities.normalize_to_list_of_entities_impl of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.entity import LaunchDescriptionEntity as LaunchDescriptionEntity
    from kit.ros.launch.normalization import (
        SomeEntities as _SomeEntitiesType,
        normalize_to_list_of_entities as normalize_to_list_of_entities,
    )

    SomeEntitiesType = _SomeEntitiesType
else:
    _LATE_NAMES = {
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
        "SomeEntitiesType": "kit.ros.launch.normalization:SomeEntities",
        "normalize_to_list_of_entities": "kit.ros.launch.normalization:normalize_to_list_of_entities",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
