"""launch_ros.descriptions.composable_node of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.entity import (
        Condition as Condition,
        IfCondition as IfCondition,
        UnlessCondition as UnlessCondition,
    )
    from kit.ros.launch.normalization import (
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
    )
    from kit.ros.launch.processes import ComposableNode as ComposableNode
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType, Substitution as Substitution
    from launch_ros.utilities.normalize_parameters import normalize_parameters as normalize_parameters

    SomeSubstitutionsType = _SomeSubstitutionsType
    Entity: Any
    Parameters: Any
    Parser: Any
    RemapRules: Any
    SomeParameters: Any
    SomeRemapRules: Any
    normalize_remap_rules: Any
else:
    _LATE_NAMES = {
        "ComposableNode": "kit.ros.launch.processes:ComposableNode",
        "Condition": "kit.ros.launch.entity:Condition",
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "IfCondition": "kit.ros.launch.entity:IfCondition",
        "Parameters": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "RemapRules": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeParameters": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeRemapRules": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "UnlessCondition": "kit.ros.launch.entity:UnlessCondition",
        "normalize_parameters": "launch_ros.utilities.normalize_parameters:normalize_parameters",
        "normalize_remap_rules": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
