"""launch_ros.remap_rule_type of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType, Substitution as Substitution

    SomeSubstitutionsType = _SomeSubstitutionsType
    RemapRule: Any
    RemapRules: Any
    SomeRemapRule: Any
    SomeRemapRules: Any
else:
    _LATE_NAMES = {
        "RemapRule": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "RemapRules": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeRemapRule": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeRemapRules": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
