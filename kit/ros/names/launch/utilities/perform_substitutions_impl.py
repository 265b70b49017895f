"""launch.utilities.perform_substitutions_impl of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.normalization import perform as _perform_substitutions
    from kit.ros.launch.substitutions import Substitution as Substitution

    perform_substitutions = _perform_substitutions
else:
    _LATE_NAMES = {
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
