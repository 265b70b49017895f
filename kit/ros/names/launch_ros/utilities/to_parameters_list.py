"""launch_ros.utilities.to_parameters_list of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    EvaluatedParameters: Any
    evaluate_parameter_dict: Any
    normalize_parameter_dict: Any
    to_parameters_list: Any
else:
    _LATE_NAMES = {
        "EvaluatedParameters": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "evaluate_parameter_dict": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "normalize_parameter_dict": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "to_parameters_list": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
