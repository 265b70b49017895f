"""The health of a robot's parts: the interfaces of ROS 2's package diagnostic_msgs."""

from typing import ClassVar

from kit.msg.fields import byte, string, zero
from kit.msg.message import Message
from kit.msg.std_msgs import Header


class KeyValue(Message):
    key: string = zero
    value: string = zero


class DiagnosticStatus(Message):
    OK: ClassVar[byte] = b"\x00"
    WARN: ClassVar[byte] = b"\x01"
    ERROR: ClassVar[byte] = b"\x02"
    STALE: ClassVar[byte] = b"\x03"

    level: byte = zero
    name: string = zero
    message: string = zero
    hardware_id: string = zero
    values: list[KeyValue] = zero


class DiagnosticArray(Message):
    header: Header = zero
    status: list[DiagnosticStatus] = zero
