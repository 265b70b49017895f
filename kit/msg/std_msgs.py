"""Single values, the header, plain arrays: the interfaces of ROS 2's package std_msgs."""

from kit.msg.builtin_interfaces import Time
from kit.msg.fields import (
    boolean,
    byte,
    char,
    float32,
    float32_array,
    float64,
    float64_array,
    int8,
    int8_array,
    int16,
    int16_array,
    int32,
    int32_array,
    int64,
    int64_array,
    string,
    uint8,
    uint8_array,
    uint16,
    uint16_array,
    uint32,
    uint32_array,
    uint64,
    uint64_array,
    zero,
)
from kit.msg.message import Message


class Bool(Message):
    data: boolean = zero


class Byte(Message):
    data: byte = zero


class MultiArrayDimension(Message):
    label: string = zero
    size: uint32 = zero
    stride: uint32 = zero


class MultiArrayLayout(Message):
    dim: list[MultiArrayDimension] = zero
    data_offset: uint32 = zero


class ByteMultiArray(Message):
    layout: MultiArrayLayout = zero
    data: list[byte] = zero


class Char(Message):
    data: char = zero


class ColorRGBA(Message):
    r: float32 = zero
    g: float32 = zero
    b: float32 = zero
    a: float32 = zero


class Empty(Message):
    pass


class Float32(Message):
    data: float32 = zero


class Float32MultiArray(Message):
    layout: MultiArrayLayout = zero
    data: float32_array = zero


class Float64(Message):
    data: float64 = zero


class Float64MultiArray(Message):
    layout: MultiArrayLayout = zero
    data: float64_array = zero


class Header(Message):
    stamp: Time = zero
    frame_id: string = zero


class Int16(Message):
    data: int16 = zero


class Int16MultiArray(Message):
    layout: MultiArrayLayout = zero
    data: int16_array = zero


class Int32(Message):
    data: int32 = zero


class Int32MultiArray(Message):
    layout: MultiArrayLayout = zero
    data: int32_array = zero


class Int64(Message):
    data: int64 = zero


class Int64MultiArray(Message):
    layout: MultiArrayLayout = zero
    data: int64_array = zero


class Int8(Message):
    data: int8 = zero


class Int8MultiArray(Message):
    layout: MultiArrayLayout = zero
    data: int8_array = zero


class String(Message):
    data: string = zero


class UInt16(Message):
    data: uint16 = zero


class UInt16MultiArray(Message):
    layout: MultiArrayLayout = zero
    data: uint16_array = zero


class UInt32(Message):
    data: uint32 = zero


class UInt32MultiArray(Message):
    layout: MultiArrayLayout = zero
    data: uint32_array = zero


class UInt64(Message):
    data: uint64 = zero


class UInt64MultiArray(Message):
    layout: MultiArrayLayout = zero
    data: uint64_array = zero


class UInt8(Message):
    data: uint8 = zero


class UInt8MultiArray(Message):
    layout: MultiArrayLayout = zero
    data: uint8_array = zero
