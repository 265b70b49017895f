"""The numbers of a message by the paths of their fields, such as ``pose.pose.position.x`` or ``ranges[3]``.

What is kept is small whatever the message is: long arrays are cut, texts are left out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

from kit.msg.message import Message

MAX_ITEMS: Final = 512
"""So many numbers of an array are kept: the beams of a laser, not the pixels of a picture."""
MAX_MESSAGES: Final = 16
"""So many messages of a sequence of messages are kept."""

FieldValue = float | Sequence[float]
"""A number, or the first numbers of an array. A truth value is 0 or 1."""


def field_values(message: Message) -> dict[str, FieldValue]:
    """The numeric fields of a message by path, nested ones too; arrays as a whole, in copies.

    >>> from kit.msg.geometry_msgs import Vector3
    >>> field_values(Vector3(x=0.5))
    {'x': 0.5, 'y': 0.0, 'z': 0.0}
    """
    found: dict[str, FieldValue] = {}
    _collect(message, "", found)
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


def _collect(message: Message, prefix: str, found: dict[str, FieldValue]) -> None:
    for field in type(message).__ros_fields__:
        value: Any = getattr(message, field.slot)
        path = prefix + field.name
        if isinstance(value, Message):
            _collect(value, f"{path}.", found)
        elif isinstance(value, bytes):
            found[path] = value[0]
        elif isinstance(value, (float, int)):
            found[path] = value
        elif not isinstance(value, list):
            if not isinstance(value, str):
                found[path] = value[:MAX_ITEMS].tolist()
        elif value and isinstance(value[0], Message):
            for number, entry in enumerate(value[:MAX_MESSAGES]):
                _collect(entry, f"{path}[{number}].", found)
        elif value and isinstance(value[0], (float, int, bytes)):
            found[path] = [entry[0] if isinstance(entry, bytes) else entry for entry in value[:MAX_ITEMS]]
