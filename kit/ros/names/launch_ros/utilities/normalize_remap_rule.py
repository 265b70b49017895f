"""launch_ros.utilities.normalize_remap_rule of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.normalization import (
        ensure_argument_type as ensure_argument_type,
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
    )
    RemapRule: Any
    RemapRules: Any
    SomeRemapRule: Any
    SomeRemapRules: Any
    normalize_remap_rule: Any
    normalize_remap_rules: Any
else:
    _LATE_NAMES = {
        "RemapRule": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "RemapRules": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeRemapRule": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeRemapRules": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
        "normalize_remap_rule": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "normalize_remap_rules": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
