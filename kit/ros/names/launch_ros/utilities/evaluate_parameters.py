"""launch_ros.utilities.evaluate_parameters of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.normalization import (
        ensure_argument_type as ensure_argument_type,
        perform as _perform_substitutions,
    )
    from kit.ros.launch.parameters import ParameterFile as ParameterFile
    from kit.ros.launch.substitutions import Substitution as Substitution

    perform_substitutions = _perform_substitutions
    EvaluatedParameterValue: Any
    EvaluatedParameters: Any
    ParameterDescription: Any
    ParameterValueDescription: Any
    Parameters: Any
    ParametersDict: Any
    evaluate_parameter_dict: Any
    evaluate_parameters: Any
else:
    _LATE_NAMES = {
        "EvaluatedParameterValue": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "EvaluatedParameters": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "ParameterDescription": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ParameterFile": "kit.ros.launch.parameters:ParameterFile",
        "ParameterValueDescription": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Parameters": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ParametersDict": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
        "evaluate_parameter_dict": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "evaluate_parameters": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
