"""launch.substitutions.not_equals_substitution of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.substitutions import (
        EqualsSubstitution as EqualsSubstitution,
        NotEqualsSubstitution as NotEqualsSubstitution,
    )
    expose_substitution: Any
else:
    _LATE_NAMES = {
        "EqualsSubstitution": "kit.ros.launch.substitutions:EqualsSubstitution",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "NotEqualsSubstitution": "kit.ros.launch.substitutions:NotEqualsSubstitution",
        "expose_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
