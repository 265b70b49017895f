"""launch.events.process.process_stdin of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.events import ProcessIO as ProcessIO, ProcessIO as _ProcessStdin

    ProcessStdin = _ProcessStdin
else:
    _LATE_NAMES = {
        "ProcessIO": "kit.ros.launch.events:ProcessIO",
        "ProcessStdin": "kit.ros.launch.events:ProcessIO",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
