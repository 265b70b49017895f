"""launch.conditions of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.launch.entity import (
    IfCondition,
    LaunchConfigurationEquals,
    LaunchConfigurationNotEquals,
    UnlessCondition,
)

__all__ = ["IfCondition", "LaunchConfigurationEquals", "LaunchConfigurationNotEquals", "UnlessCondition"]

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchError as _InvalidConditionExpressionError
    from kit.ros.launch.normalization import evaluate_condition_expression as evaluate_condition_expression

    InvalidConditionExpressionError = _InvalidConditionExpressionError
else:
    _LATE_NAMES = {
        "InvalidConditionExpressionError": "kit.ros.launch.context:LaunchError",
        "evaluate_condition_expression": "kit.ros.launch.normalization:evaluate_condition_expression",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
