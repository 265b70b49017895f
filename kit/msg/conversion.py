"""Messages as plain data, and back: dicts, lists, numbers, texts, as JSON and YAML hold them.

Used wherever a message leaves the program as text: on a student process's pipe, by ``topic echo`` and ``pub``.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Mapping
from typing import Any, TypeVar

from kit.msg.fields import FieldError, Fixed, Kind, Many, Nested, Scalar
from kit.msg.message import Message
from kit.plain_text import nearest_name

M = TypeVar("M", bound=Message)


class ConversionError(ValueError):
    """Plain data that does not fit the message; the message says where in it."""


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


def _value(kind: Kind, data: Any, path: str) -> Any:
    """The data as a value that a field of this kind takes."""
    if isinstance(kind, Nested):
        return _message(kind.cls, data, path)
    if isinstance(kind, (Many, Fixed)):
        if not isinstance(data, (list, tuple)):
            raise ConversionError(f"{path}: needs a list, not {_describe(data)}")
        packed = _packed(kind, data)
        data = (
            [_value(kind.item, entry, f"{path}[{i}]") for i, entry in enumerate(data)]
            if packed is None
            else packed
        )
    elif isinstance(kind, Scalar):
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


def _scalar(kind: Scalar, data: Any, path: str) -> Any:
    if type(data) is kind.python:
        return data
    if kind.python is float and type(data) is int:
        return float(data)
    if kind.python is bytes and type(data) is int and 0 <= data <= 255:
        return bytes([data])
    raise ConversionError(f"{path}: needs {_WANTED[kind.python]}, not {_describe(data)}")


def _packed(kind: Many | Fixed, data: list[Any] | tuple[Any, ...]) -> array[Any] | None:
    """All numbers at once, if they plainly fit; one look instead of one per item."""
    if isinstance(kind, Fixed) or not kind.code or not isinstance(kind.item, Scalar):
        return None
    if not {kind.item.python}.issuperset(map(type, data)):
        return None
    try:
        packed = array(kind.code, data)
    except OverflowError:
        return None
    # A float32 overflows into an infinity that was not there before.
    overflowed = any(packed.count(edge) != data.count(edge) for edge in (math.inf, -math.inf))
    return None if overflowed else packed


def _describe(data: object) -> str:
    return "nothing" if data is None else f"{type(data).__name__} {data!r:.40}"
