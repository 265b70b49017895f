"""launch.utilities.signal_management of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from contextlib import ExitStack as ExitStack
    AsyncSafeSignalManager: Any
else:
    _LATE_NAMES = {
        "AsyncSafeSignalManager": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ExitStack": "contextlib:ExitStack",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
