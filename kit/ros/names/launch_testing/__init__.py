"""launch_testing of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from launch_testing.parametrize import parametrize as parametrize
from launch_testing.ready_to_test_action_timeout import (
    ready_to_test_action_timeout as ready_to_test_action_timeout,
)

if TYPE_CHECKING:
    from kit.ros.launch.testing.marks import post_shutdown_test as post_shutdown_test
    from kit.ros.launch.testing.records import (
        ActiveIoHandler as ActiveIoHandler,
        ActiveProcInfoHandler as ActiveProcInfoHandler,
        IoHandler as IoHandler,
        ProcInfoHandler as ProcInfoHandler,
    )
    from launch_testing import tools as tools
    ReadyAggregator: Any
else:
    _LATE_NAMES = {
        "ActiveIoHandler": "kit.ros.launch.testing.records:ActiveIoHandler",
        "ActiveProcInfoHandler": "kit.ros.launch.testing.records:ActiveProcInfoHandler",
        "IoHandler": "kit.ros.launch.testing.records:IoHandler",
        "ProcInfoHandler": "kit.ros.launch.testing.records:ProcInfoHandler",
        "ReadyAggregator": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "post_shutdown_test": "kit.ros.launch.testing.marks:post_shutdown_test",
        "tools": "launch_testing.tools",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
