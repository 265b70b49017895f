from kit.ros.node.time import ClockType

__all__ = ["ClockType"]
