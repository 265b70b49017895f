"""launch_testing.tools.process of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.normalization import ensure_argument_type as ensure_argument_type
    ActiveIoHandler: Any
    ActiveProcInfoHandler: Any
    ProcessProxy: Any
    launch_process: Any
else:
    _LATE_NAMES = {
        "ActiveIoHandler": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "ActiveProcInfoHandler": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "ProcessProxy": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
        "launch_process": "!the test runner of launch_testing; `kit launch` runs the launch file, and `pytest` tests of its programs",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
