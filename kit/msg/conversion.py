"""Converts messages to plain data and back: dicts, lists, numbers and strings, as in JSON and YAML.

Used wherever a message leaves the program as text: on a student process's pipe, by ``topic echo`` and ``pub``; and for
its numbers alone, by the paths of their fields, such as ``pose.pose.position.x`` or ``ranges[3]``.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Mapping, Sequence
from typing import Any, Final, TypeVar

from kit.msg.fields import FieldError, FieldKind, FixedArrayKind, MessageKind, ScalarKind, SequenceKind
from kit.msg.message import Message
from kit.plain_text import nearest_name

MAX_ITEMS: Final = 512
"""Most numbers of an array kept by ``field_values``: the beams of a laser, not the pixels of a picture."""
MAX_MESSAGES: Final = 16
"""And so many messages of a sequence of messages."""

FieldValue = float | Sequence[float]
"""A number, or the first numbers of an array. A truth value is 0 or 1."""

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
        try:
            return float(data)
        except OverflowError:
            raise ConversionError(f"{path}: a whole number too large for a float") from None
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


def field_values(message: Message) -> dict[str, FieldValue]:
    """The numeric fields of a message by path, nested ones too; arrays as a whole, in copies.

    >>> from kit.msg.geometry_msgs import Vector3
    >>> field_values(Vector3(x=0.5))
    {'x': 0.5, 'y': 0.0, 'z': 0.0}
    """
    found: dict[str, FieldValue] = {}
    _collect_values(message, "", found)
    return found


def number_at(values: Mapping[str, FieldValue], path: str) -> float | None:
    """The number at a path of ``field_values``, an item of an array by its index; None if there is none.

    >>> number_at({"ranges": [1.5, 2.5]}, "ranges[1]")
    2.5
    """
    name, opening, index = path.rpartition("[")
    value = values.get(path)
    if value is None and opening:
        value = values.get(name)
        if isinstance(value, (float, int)) or value is None:
            return None
        number = int(index.removesuffix("]"))
        return float(value[number]) if number < len(value) else None
    return float(value) if isinstance(value, (float, int)) else None


def _collect_values(message: Message, prefix: str, found: dict[str, FieldValue]) -> None:
    for field in type(message).__ros_fields__:
        value: Any = getattr(message, field.slot)
        path = prefix + field.name
        if isinstance(value, Message):
            _collect_values(value, f"{path}.", found)
        elif isinstance(value, bytes):
            found[path] = value[0]
        elif isinstance(value, (float, int)):
            found[path] = value
        elif not isinstance(value, list):
            if not isinstance(value, str):
                found[path] = value[:MAX_ITEMS].tolist()
        elif value and isinstance(value[0], Message):
            for number, entry in enumerate(value[:MAX_MESSAGES]):
                _collect_values(entry, f"{path}[{number}].", found)
        elif value and isinstance(value[0], (float, int, bytes)):
            found[path] = [entry[0] if isinstance(entry, bytes) else entry for entry in value[:MAX_ITEMS]]
