"""The simulation clock: the interfaces of ROS 2's package rosgraph_msgs."""

from kit.msg.builtin_interfaces import Time
from kit.msg.fields import zero
from kit.msg.message import Message


class Clock(Message):
    clock: Time = zero
