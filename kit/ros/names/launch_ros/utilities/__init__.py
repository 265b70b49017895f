"""launch_ros.utilities of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from launch_ros.utilities.evaluate_parameters import evaluate_parameters as evaluate_parameters
from launch_ros.utilities.normalize_parameters import normalize_parameters as normalize_parameters
from launch_ros.utilities.normalize_remap_rule import normalize_remap_rule as normalize_remap_rule
from launch_ros.utilities.to_parameters_list import to_parameters_list as to_parameters_list

if TYPE_CHECKING:
    from kit.ros.launch.normalization import (
        is_namespace_absolute as is_namespace_absolute,
        is_root_namespace as is_root_namespace,
        make_namespace_absolute as make_namespace_absolute,
        prefix_namespace as prefix_namespace,
    )
    add_node_name: Any
    get_node_name_count: Any
    normalize_remap_rules: Any
else:
    _LATE_NAMES = {
        "add_node_name": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_node_name_count": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "is_namespace_absolute": "kit.ros.launch.normalization:is_namespace_absolute",
        "is_root_namespace": "kit.ros.launch.normalization:is_root_namespace",
        "make_namespace_absolute": "kit.ros.launch.normalization:make_namespace_absolute",
        "normalize_remap_rules": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "prefix_namespace": "kit.ros.launch.normalization:prefix_namespace",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
