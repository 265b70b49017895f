"""Times and durations: the interfaces of ROS 2's package builtin_interfaces."""

from kit.msg.fields import int32, uint32, zero
from kit.msg.message import Message


class Duration(Message):
    sec: int32 = zero
    nanosec: uint32 = zero


class Time(Message):
    sec: int32 = zero
    nanosec: uint32 = zero
