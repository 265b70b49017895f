"""Parameters and log lines, as nodes exchange them: the interfaces of ROS 2's package rcl_interfaces."""

from typing import Annotated, ClassVar

from kit.msg.builtin_interfaces import Time
from kit.msg.fields import (
    MaxItems,
    boolean,
    byte,
    float64,
    float64_array,
    int64,
    int64_array,
    string,
    uint8,
    uint8_array,
    uint32,
    uint64,
    zero,
)
from kit.msg.message import Message, Service


class FloatingPointRange(Message):
    from_value: float64 = zero
    to_value: float64 = zero
    step: float64 = zero


class IntegerRange(Message):
    from_value: int64 = zero
    to_value: int64 = zero
    step: uint64 = zero


class ListParametersResult(Message):
    names: list[string] = zero
    prefixes: list[string] = zero


class Log(Message):
    DEBUG: ClassVar[uint8] = 10
    INFO: ClassVar[uint8] = 20
    WARN: ClassVar[uint8] = 30
    ERROR: ClassVar[uint8] = 40
    FATAL: ClassVar[uint8] = 50

    stamp: Time = zero
    level: uint8 = zero
    name: string = zero
    msg: string = zero
    file: string = zero
    function: string = zero
    line: uint32 = zero


class ParameterValue(Message):
    type: uint8 = zero
    bool_value: boolean = zero
    integer_value: int64 = zero
    double_value: float64 = zero
    string_value: string = zero
    byte_array_value: list[byte] = zero
    bool_array_value: list[boolean] = zero
    integer_array_value: int64_array = zero
    double_array_value: float64_array = zero
    string_array_value: list[string] = zero


class Parameter(Message):
    name: string = zero
    value: ParameterValue = zero


class ParameterDescriptor(Message):
    name: string = zero
    type: uint8 = zero
    description: string = zero
    additional_constraints: string = zero
    read_only: boolean = zero
    dynamic_typing: boolean = zero
    floating_point_range: Annotated[list[FloatingPointRange], MaxItems(1)] = zero
    integer_range: Annotated[list[IntegerRange], MaxItems(1)] = zero


class ParameterEvent(Message):
    stamp: Time = zero
    node: string = zero
    new_parameters: list[Parameter] = zero
    changed_parameters: list[Parameter] = zero
    deleted_parameters: list[Parameter] = zero


class ParameterEventDescriptors(Message):
    new_parameters: list[ParameterDescriptor] = zero
    changed_parameters: list[ParameterDescriptor] = zero
    deleted_parameters: list[ParameterDescriptor] = zero


class ParameterType(Message):
    PARAMETER_NOT_SET: ClassVar[uint8] = 0
    PARAMETER_BOOL: ClassVar[uint8] = 1
    PARAMETER_INTEGER: ClassVar[uint8] = 2
    PARAMETER_DOUBLE: ClassVar[uint8] = 3
    PARAMETER_STRING: ClassVar[uint8] = 4
    PARAMETER_BYTE_ARRAY: ClassVar[uint8] = 5
    PARAMETER_BOOL_ARRAY: ClassVar[uint8] = 6
    PARAMETER_INTEGER_ARRAY: ClassVar[uint8] = 7
    PARAMETER_DOUBLE_ARRAY: ClassVar[uint8] = 8
    PARAMETER_STRING_ARRAY: ClassVar[uint8] = 9


class SetParametersResult(Message):
    successful: boolean = zero
    reason: string = zero


class DescribeParameters(Service):
    class Request(Message):
        names: list[string] = zero

    class Response(Message):
        descriptors: list[ParameterDescriptor] = zero


class GetParameters(Service):
    class Request(Message):
        names: list[string] = zero

    class Response(Message):
        values: list[ParameterValue] = zero


class GetParameterTypes(Service):
    class Request(Message):
        names: list[string] = zero

    class Response(Message):
        types: uint8_array = zero


class ListParameters(Service):
    class Request(Message):
        DEPTH_RECURSIVE: ClassVar[uint64] = 0

        prefixes: list[string] = zero
        depth: uint64 = zero

    class Response(Message):
        result: ListParametersResult = zero


class SetParameters(Service):
    class Request(Message):
        parameters: list[Parameter] = zero

    class Response(Message):
        results: list[SetParametersResult] = zero


class SetParametersAtomically(Service):
    class Request(Message):
        parameters: list[Parameter] = zero

    class Response(Message):
        result: SetParametersResult = zero
