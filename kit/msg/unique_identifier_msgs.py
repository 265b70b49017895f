"""Unique identifiers: the interfaces of ROS 2's package unique_identifier_msgs."""

from kit.msg.fields import uint8_16, zero
from kit.msg.message import Message


class UUID(Message):
    uuid: uint8_16 = zero
