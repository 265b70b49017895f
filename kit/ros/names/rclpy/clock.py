from kit.ros.node.clock import Clock, ROSClock
from kit.ros.node.time import ClockType

__all__ = ["Clock", "ClockType", "ROSClock"]
