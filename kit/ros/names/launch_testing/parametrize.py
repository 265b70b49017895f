"""launch_testing.parametrize of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.testing.marks import parametrize as parametrize
else:
    _LATE_NAMES = {
        "parametrize": "kit.ros.launch.testing.marks:parametrize",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
