"""launch.conditions.unless_condition of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import IfCondition as IfCondition, UnlessCondition as UnlessCondition
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType

    SomeSubstitutionsType = _SomeSubstitutionsType
else:
    _LATE_NAMES = {
        "IfCondition": "kit.ros.launch.entity:IfCondition",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "UnlessCondition": "kit.ros.launch.entity:UnlessCondition",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
