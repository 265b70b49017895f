"""launch_ros.utilities.namespace_utils of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.normalization import (
        is_namespace_absolute as is_namespace_absolute,
        is_root_namespace as is_root_namespace,
        make_namespace_absolute as make_namespace_absolute,
        prefix_namespace as prefix_namespace,
    )
    OptionalText: Any
else:
    _LATE_NAMES = {
        "OptionalText": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "is_namespace_absolute": "kit.ros.launch.normalization:is_namespace_absolute",
        "is_root_namespace": "kit.ros.launch.normalization:is_root_namespace",
        "make_namespace_absolute": "kit.ros.launch.normalization:make_namespace_absolute",
        "prefix_namespace": "kit.ros.launch.normalization:prefix_namespace",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
