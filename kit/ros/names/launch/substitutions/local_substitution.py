"""launch.substitutions.local_substitution of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.normalization import ensure_argument_type as ensure_argument_type
    from kit.ros.launch.substitutions import LocalSubstitution as LocalSubstitution, Substitution as Substitution
else:
    _LATE_NAMES = {
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LocalSubstitution": "kit.ros.launch.substitutions:LocalSubstitution",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
