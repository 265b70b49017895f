"""launch.conditions.invalid_condition_expression_error of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchError as _InvalidConditionExpressionError
    from kit.ros.launch.substitutions import Substitution as Substitution

    InvalidConditionExpressionError = _InvalidConditionExpressionError
else:
    _LATE_NAMES = {
        "InvalidConditionExpressionError": "kit.ros.launch.context:LaunchError",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
