"""launch_testing of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from launch_testing.parametrize import parametrize as parametrize
from launch_testing.ready_to_test_action_timeout import (
    ready_to_test_action_timeout as ready_to_test_action_timeout,
)

if TYPE_CHECKING:
    from kit.ros.launch.testing import post_shutdown_test as post_shutdown_test
    from launch_testing import tools as tools
    ActiveIoHandler: Any
    ActiveProcInfoHandler: Any
    IoHandler: Any
    ProcInfoHandler: Any
    ReadyAggregator: Any
else:
    _LATE_NAMES = {
        "ActiveIoHandler": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "ActiveProcInfoHandler": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "IoHandler": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "ProcInfoHandler": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "ReadyAggregator": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "post_shutdown_test": "kit.ros.launch.testing:post_shutdown_test",
        "tools": "launch_testing.tools",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
