"""What ``kit ros param`` prints: values, types and descriptions of parameters."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from types import MappingProxyType
from typing import Any, Final

from kit.msg.rcl_interfaces import FloatingPointRange, IntegerRange, ParameterDescriptor, ParameterValue
from kit.ros.parameters.parameter import PARAMETER_SEPARATOR_STRING, Parameter, parameter_value_to_python

_NAMES: Final = MappingProxyType(
    {
        Parameter.Type.NOT_SET: ("not set", "Parameter not set."),
        Parameter.Type.BOOL: ("boolean", "Boolean value is:"),
        Parameter.Type.INTEGER: ("integer", "Integer value is:"),
        Parameter.Type.DOUBLE: ("double", "Double value is:"),
        Parameter.Type.STRING: ("string", "String value is:"),
        Parameter.Type.BYTE_ARRAY: ("byte array", "Byte values are:"),
        Parameter.Type.BOOL_ARRAY: ("boolean array", "Boolean values are:"),
        Parameter.Type.INTEGER_ARRAY: ("integer array", "Integer values are:"),
        Parameter.Type.DOUBLE_ARRAY: ("double array", "Double values are:"),
        Parameter.Type.STRING_ARRAY: ("string array", "String values are:"),
    }
)
"""The name of each type, and the label before its value."""


def type_name_of(number: int) -> str:
    """The name of a type."""
    return _NAMES[Parameter.Type(number)][0]


def format_value(value: ParameterValue, *, hide_type: bool = False) -> str:
    """A parameter's value, as ``param get`` prints it."""
    found = parameter_value_to_python(value)
    if hide_type:
        return str(found)
    words = _NAMES[Parameter.Type(value.type)][1]
    return words if found is None else f"{words} {found}"


def description(descriptor: ParameterDescriptor) -> Iterator[str]:
    """The lines of ``param describe``."""
    yield f"Parameter name: {descriptor.name}"
    yield f"  Type: {type_name_of(descriptor.type)}"
    if descriptor.description:
        yield f"  Description: {descriptor.description}"
    yield "  Constraints:"
    if descriptor.read_only:
        yield "    Read only: true"
    ranges: list[FloatingPointRange | IntegerRange] = [
        *descriptor.floating_point_range,
        *descriptor.integer_range,
    ]
    for allowed in ranges[:1]:
        yield f"    Min value: {allowed.from_value}"
        yield f"    Max value: {allowed.to_value}"
        if allowed.step:
            yield f"    Step: {allowed.step}"
    if descriptor.additional_constraints:
        yield f"    Additional constraints: {descriptor.additional_constraints}"


def nest_by_name(values: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """Nests values by the parts of their names: ``a.b`` becomes ``{a: {b: ...}}``."""
    tree: dict[str, Any] = {}
    for name, value in values:
        *groups, last = name.split(PARAMETER_SEPARATOR_STRING)
        branch = tree
        for group in groups:
            branch = branch.setdefault(group, {})
        branch[last] = value
    return tree
