"""launch_testing.tools.process of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.normalization import ensure_argument_type as ensure_argument_type
    from kit.ros.launch.testing.records import (
        ActiveIoHandler as ActiveIoHandler,
        ActiveProcInfoHandler as ActiveProcInfoHandler,
    )
    ProcessProxy: Any
    launch_process: Any
else:
    _LATE_NAMES = {
        "ActiveIoHandler": "kit.ros.launch.testing.records:ActiveIoHandler",
        "ActiveProcInfoHandler": "kit.ros.launch.testing.records:ActiveProcInfoHandler",
        "ProcessProxy": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
        "launch_process": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
