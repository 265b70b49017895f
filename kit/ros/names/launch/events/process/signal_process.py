"""launch.events.process.signal_process of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.events import (
        ProcessMatchingEvent as _ProcessTargetedEvent,
        SignalProcess as SignalProcess,
    )
    from kit.ros.launch.normalization import ensure_argument_type as ensure_argument_type
    from kit.ros.launch.processes import ExecuteLocal as ExecuteLocal, ExecuteProcess as ExecuteProcess

    ProcessTargetedEvent = _ProcessTargetedEvent
else:
    _LATE_NAMES = {
        "ExecuteLocal": "kit.ros.launch.processes:ExecuteLocal",
        "ExecuteProcess": "kit.ros.launch.processes:ExecuteProcess",
        "ProcessTargetedEvent": "kit.ros.launch.events:ProcessMatchingEvent",
        "SignalProcess": "kit.ros.launch.events:SignalProcess",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
