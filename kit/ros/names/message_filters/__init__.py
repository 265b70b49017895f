"""message_filters of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.message_filters import (
    ApproximateTimeSynchronizer,
    Cache,
    SimpleFilter,
    Subscriber,
    TimeSynchronizer,
)

__all__ = ["ApproximateTimeSynchronizer", "Cache", "SimpleFilter", "Subscriber", "TimeSynchronizer"]

if TYPE_CHECKING:
    from functools import reduce as reduce
    from kit.ros.log import LoggingSeverity as LoggingSeverity
    from kit.ros.node.clock import ROSClock as ROSClock
    from kit.ros.node.time import Duration as Duration, Time as Time
else:
    _LATE_NAMES = {
        "Duration": "kit.ros.node.time:Duration",
        "LoggingSeverity": "kit.ros.log:LoggingSeverity",
        "ROSClock": "kit.ros.node.clock:ROSClock",
        "Time": "kit.ros.node.time:Time",
        "reduce": "functools:reduce",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
