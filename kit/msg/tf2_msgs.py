"""Transforms on their way: the interfaces of ROS 2's package tf2_msgs."""

from typing import ClassVar

from kit.msg.fields import string, uint8, zero
from kit.msg.geometry_msgs import TransformStamped
from kit.msg.message import Message


class TF2Error(Message):
    NO_ERROR: ClassVar[uint8] = 0
    LOOKUP_ERROR: ClassVar[uint8] = 1
    CONNECTIVITY_ERROR: ClassVar[uint8] = 2
    EXTRAPOLATION_ERROR: ClassVar[uint8] = 3
    INVALID_ARGUMENT_ERROR: ClassVar[uint8] = 4
    TIMEOUT_ERROR: ClassVar[uint8] = 5
    TRANSFORM_ERROR: ClassVar[uint8] = 6

    error: uint8 = zero
    error_string: string = zero


class TFMessage(Message):
    transforms: list[TransformStamped] = zero
