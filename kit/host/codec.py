"""Encodes messages as lists of their fields' values in order, and checks what comes back.

Nested messages are lists in the list, arrays of numbers are their bytes (little-endian) in base64: exact to
the bit, NaN included, and an order of magnitude quicker than writing decimal digits. A single NaN or infinity,
which JSON has no sign for, is one of the words ``nan``, ``inf`` and ``-inf``.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable
from functools import partial
from typing import Any, Final

from kit.host import wire
from kit.host.wire import Json, ProtocolError
from kit.msg.fields import FieldError, FieldKind, FixedArrayKind, MessageKind, ScalarKind, SequenceKind
from kit.msg.message import Message

MAY_BE_INFINITE: Final = ("sensor_msgs/", "std_msgs/", "example_interfaces/", "rcl_interfaces/")
"""The packages in whose messages' own fields a student may write NaN or infinity: readings beyond range (REP 117), what was not
measured (as sensor_msgs says of batteries, pressures and positions), plain numbers, such as the least of no readings, and
parameters, where infinity means no limit. A command, a pose and a path are of others."""

Pack = Callable[[Any], Json]
Unpack = Callable[[Json], Any]


class NotFiniteError(ValueError):
    """A ROS message holds NaN or infinity where that makes no sense; the text names the field."""


class Codec:
    """Packs messages, and unpacks them with every value checked.

    ``in_child``: where the student's code runs. What it sends must be finite (NotFiniteError there, so that it
    happens at the student's own line; ProtocolError at the other end); what it receives need not be.
    """

    def __init__(self, *, in_child: bool) -> None:
        self._in_child = in_child
        self._pack: dict[type[Message], Pack] = {}
        self._unpack: dict[type[Message], Unpack] = {}

    def pack(self, message: Message) -> Json:
        cls = type(message)
        if cls not in self._pack:
            self._pack[cls] = _packer(cls, self._in_child)
        return self._pack[cls](message)

    def unpack(self, cls: type[Message], content: Json) -> Any:
        """Returns the message of type ``cls``. Raises ProtocolError if the content does not fit it exactly."""
        if cls not in self._unpack:
            self._unpack[cls] = _unpacker(cls, not self._in_child)
        return self._unpack[cls](content)


def _must_be_finite(cls: type[Message], strict: bool) -> bool:
    return strict and not cls.__ros_type__.startswith(MAY_BE_INFINITE)


def _packer(cls: type[Message], strict: bool) -> Pack:
    steps = [
        (field.slot, _kind_packer(field.kind, strict, _must_be_finite(cls, strict)))
        for field in cls.__ros_fields__
    ]

    def pack(message: Any) -> Json:
        slot = ""
        try:
            content = []
            for slot, step in steps:
                content.append(step(getattr(message, slot)))
            return content
        except NotFiniteError as problem:
            raise NotFiniteError(f"{slot[1:]}.{problem}".removesuffix(".")) from None

    return pack


def _kind_packer(kind: FieldKind, strict: bool, finite: bool) -> Pack:
    if isinstance(kind, MessageKind):
        return _packer(kind.cls, strict)
    if isinstance(kind, FixedArrayKind) or (isinstance(kind, SequenceKind) and kind.type_code):
        code = kind.item.type_code if isinstance(kind, FixedArrayKind) else kind.type_code
        return _finite_numbers_to_text if finite and code in "fd" else _numbers_to_text
    if isinstance(kind, SequenceKind):
        item = _kind_packer(kind.item, strict, finite)
        return lambda values: [item(value) for value in values]
    assert isinstance(kind, ScalarKind)
    if kind.python_type is float:
        return _encode_float if finite else _number_or_word
    if kind.python_type is bytes:
        return lambda value: value[0]
    return lambda value: value


def _encode_float(value: float) -> Json:
    if value - value != 0:
        raise NotFiniteError("")
    return value


def _number_or_word(value: float) -> Json:
    return value if value - value == 0 else repr(value)


def _numbers_to_text(values: Any) -> str:
    if type(values) is not array:  # a fixed one that somebody has looked at: numpy's
        values = array(values.dtype.char, values.tobytes())
    return wire.numbers_to_text(values)


def _finite_numbers_to_text(values: Any) -> str:
    if not all(map(math.isfinite, values)):
        raise NotFiniteError("")
    return _numbers_to_text(values)


def _unpacker(cls: type[Message], strict: bool) -> Unpack:
    names = [field.name for field in cls.__ros_fields__]
    steps = [_kind_unpacker(field.kind, strict, _must_be_finite(cls, strict)) for field in cls.__ros_fields__]

    def unpack(content: Json) -> Any:
        values = wire.items(content, len(names))
        try:
            return cls(**{name: step(value) for name, step, value in zip(names, steps, values, strict=True)})
        except FieldError as problem:
            raise ProtocolError(f"{cls.__ros_type__}: {problem}") from None

    return unpack


def _kind_unpacker(kind: FieldKind, strict: bool, finite: bool) -> Unpack:
    if isinstance(kind, MessageKind):
        return _unpacker(kind.cls, strict)
    if isinstance(kind, FixedArrayKind):
        return partial(wire.text_to_numbers, code=kind.item.type_code, finite=finite)
    if isinstance(kind, SequenceKind):
        if kind.type_code:
            return partial(wire.text_to_numbers, code=kind.type_code, finite=finite)
        item = _kind_unpacker(kind.item, strict, finite)
        return lambda content: [item(value) for value in wire.items(content)]
    assert isinstance(kind, ScalarKind)
    if kind.python_type is float:
        return wire.number if finite else _any_number
    if kind.python_type is int:
        return lambda content: wire.integer(content, int(kind.low), int(kind.high))
    if kind.python_type is bytes:
        return lambda content: bytes((wire.integer(content, 0, 255),))
    return wire.boolean if kind.python_type is bool else _any_text


def _any_number(content: Json) -> float:
    return float(content) if content in ("nan", "inf", "-inf") else wire.number(content)


def _any_text(content: Json) -> str:
    """Returns a text unchanged: a message may hold line breaks. It is made printable where it is shown."""
    if type(content) is not str or len(content) > wire.MAX_NUMBERS:
        raise ProtocolError(f"not a text of at most {wire.MAX_NUMBERS} characters")
    return content.encode("utf-8", "replace").decode("utf-8")
