from kit.ros.instants import ClockType

__all__ = ["ClockType"]
