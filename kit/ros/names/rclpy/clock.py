from kit.ros.clock import Clock, ROSClock
from kit.ros.instants import ClockType

__all__ = ["Clock", "ClockType", "ROSClock"]
