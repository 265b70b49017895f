"""Parameters: names with typed values."""

from __future__ import annotations

from array import array
from collections.abc import Iterable
from enum import Enum
from typing import Any, NamedTuple

from kit.msg.rcl_interfaces import Parameter as ParameterMessage
from kit.msg.rcl_interfaces import ParameterType, ParameterValue

PARAMETER_SEPARATOR_STRING = "."


class GivenParameters(NamedTuple):
    """Parameter values for the nodes that match a pattern: ``/**`` any node, ``/robot/*`` all in a namespace."""

    node: str
    parameters: tuple[Parameter, ...]


class Parameter:
    """A name, a type and a value; the type is derived from the value if it is not given."""

    class Type(Enum):
        """The types of parameter values."""

        NOT_SET = ParameterType.PARAMETER_NOT_SET
        BOOL = ParameterType.PARAMETER_BOOL
        INTEGER = ParameterType.PARAMETER_INTEGER
        DOUBLE = ParameterType.PARAMETER_DOUBLE
        STRING = ParameterType.PARAMETER_STRING
        BYTE_ARRAY = ParameterType.PARAMETER_BYTE_ARRAY
        BOOL_ARRAY = ParameterType.PARAMETER_BOOL_ARRAY
        INTEGER_ARRAY = ParameterType.PARAMETER_INTEGER_ARRAY
        DOUBLE_ARRAY = ParameterType.PARAMETER_DOUBLE_ARRAY
        STRING_ARRAY = ParameterType.PARAMETER_STRING_ARRAY

        @classmethod
        def from_parameter_value(cls, parameter_value: Any) -> Parameter.Type:
            """The type of a Python value; an empty list is a BYTE_ARRAY, as in ROS 2. TypeError if there is none."""
            if parameter_value is None:
                return cls.NOT_SET
            for kind, (single, _) in _TYPES_BY_PYTHON_TYPE.items():
                if single is not None and isinstance(parameter_value, kind):
                    return single
            if not isinstance(parameter_value, (list, tuple, array)):
                raise TypeError(
                    f"The given value is not one of the allowed types '{parameter_value}': a parameter can be a bool, "
                    f"an int, a float, a str or a list of these, not {type(parameter_value).__name__}"
                )
            for kind, (_, many) in _TYPES_BY_PYTHON_TYPE.items():
                if all(isinstance(entry, kind) for entry in parameter_value):
                    return many
            found = ", ".join(sorted({type(entry).__name__ for entry in parameter_value}))
            raise TypeError(
                f"A parameter's list must hold values of one type (bool, int, float, str), not {found}"
            )

        def check(self, parameter_value: Any) -> bool:
            """True if the value is of this type."""
            if self is Parameter.Type.NOT_SET:
                return parameter_value is None
            if isinstance(parameter_value, (list, tuple)) and not parameter_value:
                return self.name.endswith("_ARRAY")
            try:
                return Parameter.Type.from_parameter_value(parameter_value) is self
            except TypeError:
                return False

    __slots__ = ("_name", "_type", "_value")

    def __init__(self, name: str, type_: Parameter.Type | None = None, value: Any = None) -> None:
        if type_ is None:
            type_ = Parameter.Type.from_parameter_value(value)
        if not isinstance(type_, Parameter.Type):
            raise TypeError("type must be an instance of `Parameter.Type`")
        if not type_.check(value):
            raise ValueError(f"Type '{type_.name}' and value '{value}' do not agree")
        self._name = name
        self._type = type_
        self._value = value

    @property
    def name(self) -> str:
        return self._name

    @property
    def type_(self) -> Parameter.Type:
        return self._type

    @property
    def value(self) -> Any:
        """None, bool, int, float, str, or a list of bytes, bools, ints, floats or strs."""
        return self._value

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Parameter):
            return NotImplemented
        return (self._name, self._type, self._value) == (other._name, other._type, other._value)

    __hash__ = None  # type: ignore[assignment]  # the idiom for "unhashable": a value may be a list

    def __repr__(self) -> str:
        return f"Parameter({self._name!r}, {self._type.name}, {self._value!r})"

    def get_parameter_value(self) -> ParameterValue:
        """The value as a message."""
        if self._type is Parameter.Type.NOT_SET:
            return ParameterValue(type=self._type.value)
        value = list(self._value) if isinstance(self._value, (tuple, array)) else self._value
        message = ParameterValue(type=self._type.value)
        setattr(message, _MESSAGE_FIELDS[self._type], value)
        return message

    def to_parameter_msg(self) -> ParameterMessage:
        return ParameterMessage(name=self._name, value=self.get_parameter_value())

    @classmethod
    def from_parameter_msg(cls, param_msg: ParameterMessage) -> Parameter:
        return cls(
            param_msg.name, Parameter.Type(param_msg.value.type), parameter_value_to_python(param_msg.value)
        )


_TYPES_BY_PYTHON_TYPE: dict[type, tuple[Parameter.Type | None, Parameter.Type]] = {
    bytes: (None, Parameter.Type.BYTE_ARRAY),
    bool: (Parameter.Type.BOOL, Parameter.Type.BOOL_ARRAY),
    int: (Parameter.Type.INTEGER, Parameter.Type.INTEGER_ARRAY),
    float: (Parameter.Type.DOUBLE, Parameter.Type.DOUBLE_ARRAY),
    str: (Parameter.Type.STRING, Parameter.Type.STRING_ARRAY),
}
"""The types of one value and of a list of values, by Python type; the first match counts."""

_MESSAGE_FIELDS = {
    Parameter.Type.BOOL: "bool_value",
    Parameter.Type.INTEGER: "integer_value",
    Parameter.Type.DOUBLE: "double_value",
    Parameter.Type.STRING: "string_value",
    Parameter.Type.BYTE_ARRAY: "byte_array_value",
    Parameter.Type.BOOL_ARRAY: "bool_array_value",
    Parameter.Type.INTEGER_ARRAY: "integer_array_value",
    Parameter.Type.DOUBLE_ARRAY: "double_array_value",
    Parameter.Type.STRING_ARRAY: "string_array_value",
}
"""The field of a ParameterValue message that holds a value of each type."""


def parameter_value_to_python(parameter_value: ParameterValue) -> Any:
    """The value in a message, as Python holds it. Raises RuntimeError for an unknown type number."""
    try:
        type_ = Parameter.Type(parameter_value.type)
    except ValueError:
        raise RuntimeError(f"unexpected parameter type {parameter_value.type}") from None
    if type_ is Parameter.Type.NOT_SET:
        return None
    value = getattr(parameter_value, _MESSAGE_FIELDS[type_])
    return list(value) if isinstance(value, Iterable) and not isinstance(value, str) else value
