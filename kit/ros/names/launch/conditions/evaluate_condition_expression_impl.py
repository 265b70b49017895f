"""launch.conditions.evaluate_condition_expression_impl of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import (
        LaunchContext as LaunchContext,
        LaunchError as _InvalidConditionExpressionError,
    )
    from kit.ros.launch.normalization import (
        VALID_FALSE_EXPRESSIONS as VALID_FALSE_EXPRESSIONS,
        VALID_TRUE_EXPRESSIONS as VALID_TRUE_EXPRESSIONS,
        evaluate_condition_expression as evaluate_condition_expression,
        perform as _perform_substitutions,
    )
    from kit.ros.launch.substitutions import Substitution as Substitution

    InvalidConditionExpressionError = _InvalidConditionExpressionError
    perform_substitutions = _perform_substitutions
else:
    _LATE_NAMES = {
        "InvalidConditionExpressionError": "kit.ros.launch.context:LaunchError",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "VALID_FALSE_EXPRESSIONS": "kit.ros.launch.normalization:VALID_FALSE_EXPRESSIONS",
        "VALID_TRUE_EXPRESSIONS": "kit.ros.launch.normalization:VALID_TRUE_EXPRESSIONS",
        "evaluate_condition_expression": "kit.ros.launch.normalization:evaluate_condition_expression",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
