"""Converts messages to plain data and back: dicts, lists, numbers and strings, as in JSON and YAML.

Used wherever a message leaves the program as text: on a student process's pipe, by ``topic echo`` and ``pub``.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Mapping
from typing import Any, TypeVar

from kit.msg.fields import FieldError, FieldKind, FixedArrayKind, MessageKind, ScalarKind, SequenceKind
from kit.msg.message import Message
from kit.plain_text import nearest_name

M = TypeVar("M", bound=Message)


class ConversionError(ValueError):
    """Plain data does not fit the message type; the error names the field."""


def to_dict(message: Message) -> dict[str, Any]:
    """The message's fields by name; nested messages as dicts, arrays as lists, a byte as its number.

    NaN and infinities stay floats: Python's ``json`` writes and reads them.
    """
    return {field.name: _plain(getattr(message, field.slot)) for field in type(message).__ros_fields__}


def from_dict(cls: type[M], data: Mapping[str, Any]) -> M:
    """A message with these fields; fields that are not given keep their defaults.

    Whole numbers do for float fields. Raises ConversionError for a wrong name, type, range or length.
    """
    return _message(cls, data, "")


def _plain(value: Any) -> Any:
    if isinstance(value, Message):
        return to_dict(value)
    if isinstance(value, list):
        return [_plain(entry) for entry in value]
    if isinstance(value, bytes):
        return value[0]
    return value.tolist() if hasattr(value, "tolist") else value


def _message(cls: type[M], data: Any, path: str) -> M:
    name, where = cls.__ros_type__, f"{path}: " if path else ""
    if not isinstance(data, Mapping):
        raise ConversionError(f"{where}{name} needs its fields by name, not {_describe(data)}")
    kinds = {field.name: field.kind for field in cls.__ros_fields__}
    values = {}
    for key, value in data.items():
        if key not in kinds:
            near = nearest_name(str(key), kinds)
            hint = f"did you mean '{near}'?" if near else f"its fields are: {', '.join(kinds) or 'none'}"
            raise ConversionError(f"{where}{name} has no field '{key}'; {hint}")
        values[key] = _value(kinds[key], value, f"{path}.{key}" if path else key)
    return cls(**values)


def _value(kind: FieldKind, data: Any, path: str) -> Any:
    """The data as a value that a field of this kind takes."""
    if isinstance(kind, MessageKind):
        return _message(kind.cls, data, path)
    if isinstance(kind, (SequenceKind, FixedArrayKind)):
        if not isinstance(data, (list, tuple)):
            raise ConversionError(f"{path}: needs a list, not {_describe(data)}")
        packed = _packed(kind, data)
        data = (
            [_value(kind.item, entry, f"{path}[{i}]") for i, entry in enumerate(data)]
            if packed is None
            else packed
        )
    elif isinstance(kind, ScalarKind):
        data = _scalar(kind, data, path)
    try:
        return kind.check(data, path)
    except FieldError as problem:
        raise ConversionError(str(problem)) from None


_WANTED = {
    float: "a number",
    int: "a whole number",
    bool: "true or false",
    str: "a text",
    bytes: "a number, 0 to 255",
}


def _scalar(kind: ScalarKind, data: Any, path: str) -> Any:
    if type(data) is kind.python_type:
        return data
    if kind.python_type is float and type(data) is int:
        return float(data)
    if kind.python_type is bytes and type(data) is int and 0 <= data <= 255:
        return bytes([data])
    raise ConversionError(f"{path}: needs {_WANTED[kind.python_type]}, not {_describe(data)}")


def _packed(kind: SequenceKind | FixedArrayKind, data: list[Any] | tuple[Any, ...]) -> array[Any] | None:
    """Converts all numbers at once if they fit, instead of one by one; None if they do not."""
    if isinstance(kind, FixedArrayKind) or not kind.type_code or not isinstance(kind.item, ScalarKind):
        return None
    if not {kind.item.python_type}.issuperset(map(type, data)):
        return None
    try:
        packed = array(kind.type_code, data)
    except OverflowError:
        return None
    # A float32 overflows into an infinity that was not there before.
    overflowed = any(packed.count(edge) != data.count(edge) for edge in (math.inf, -math.inf))
    return None if overflowed else packed


def _describe(data: object) -> str:
    return "nothing" if data is None else f"{type(data).__name__} {data!r:.40}"
