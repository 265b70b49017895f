"""launch.events.process.process_stderr of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.events import ProcessIO as ProcessIO, ProcessIO as _ProcessStderr

    ProcessStderr = _ProcessStderr
else:
    _LATE_NAMES = {
        "ProcessIO": "kit.ros.launch.events:ProcessIO",
        "ProcessStderr": "kit.ros.launch.events:ProcessIO",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
