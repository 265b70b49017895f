"""launch.conditions.if_condition of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Condition as Condition, IfCondition as IfCondition
    from kit.ros.launch.normalization import (
        evaluate_condition_expression as evaluate_condition_expression,
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
    )
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType

    SomeSubstitutionsType = _SomeSubstitutionsType
else:
    _LATE_NAMES = {
        "Condition": "kit.ros.launch.entity:Condition",
        "IfCondition": "kit.ros.launch.entity:IfCondition",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "evaluate_condition_expression": "kit.ros.launch.normalization:evaluate_condition_expression",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
