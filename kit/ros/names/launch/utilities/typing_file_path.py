"""launch.utilities.typing_file_path of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    FilePath: Any
else:
    _LATE_NAMES = {
        "FilePath": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
