"""Messages on the pipe: a list of the fields' values in order, and the check of what comes back.

Nested messages are lists in the list, arrays of numbers are their bytes (little-endian) in base64: exact to
the bit, NaN included, and an order of magnitude quicker than writing decimal digits. A single NaN or infinity,
which JSON has no sign for, is one of the words ``nan``, ``inf`` and ``-inf``.
"""

from __future__ import annotations

import binascii
import math
import sys
from array import array
from collections.abc import Callable
from typing import Any, Final

from kit.host import wire
from kit.host.wire import Json, ProtocolError
from kit.msg.fields import FieldError, Fixed, Kind, Many, Nested, Scalar
from kit.msg.message import Message

MAY_BE_INFINITE: Final = frozenset(
    {
        ("sensor_msgs/msg/LaserScan", "ranges"),
        ("sensor_msgs/msg/LaserScan", "intensities"),
        ("sensor_msgs/msg/Range", "range"),
    }
)
"""Fields in which a student's message may hold NaN or infinity: readings beyond range (REP 117)."""

MAX_ENTRIES: Final = 200_000
"""Numbers in one array of a student's message."""

Pack = Callable[[Any], Json]
Unpack = Callable[[Json], Any]


class NotFiniteError(ValueError):
    """A message holds NaN or infinity where that makes no sense; the message says in which field."""


class Codec:
    """Packs messages, and unpacks them with every value checked.

    ``in_child``: where the student's code runs. What it says must be finite (NotFiniteError there, so that it
    happens at the student's own line; ProtocolError at the other end); what it is told may be anything.
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
        """The message of type ``cls``. ProtocolError if the content does not fit it exactly."""
        if cls not in self._unpack:
            self._unpack[cls] = _unpacker(cls, not self._in_child)
        return self._unpack[cls](content)


def _must_be_finite(cls: type[Message], field: str, strict: bool) -> bool:
    return strict and (cls.__ros_type__, field) not in MAY_BE_INFINITE


def _packer(cls: type[Message], strict: bool) -> Pack:
    steps = [
        (field.slot, _packer_of(field.kind, strict, _must_be_finite(cls, field.name, strict)))
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


def _packer_of(kind: Kind, strict: bool, finite: bool) -> Pack:
    if isinstance(kind, Nested):
        return _packer(kind.cls, strict)
    if isinstance(kind, Fixed) or (isinstance(kind, Many) and kind.code):
        code = kind.item.code if isinstance(kind, Fixed) else kind.code
        return _finite_numbers_to_text if finite and code in "fd" else _numbers_to_text
    if isinstance(kind, Many):
        item = _packer_of(kind.item, strict, finite)
        return lambda values: [item(value) for value in values]
    assert isinstance(kind, Scalar)
    if kind.python is float:
        return _finite if finite else _number_or_word
    if kind.python is bytes:
        return lambda value: value[0]
    return lambda value: value


def _finite(value: float) -> Json:
    if value - value != 0:
        raise NotFiniteError("")
    return value


def _number_or_word(value: float) -> Json:
    return value if value - value == 0 else repr(value)


def _finite_numbers_to_text(values: Any) -> str:
    if not all(map(math.isfinite, values)):
        raise NotFiniteError("")
    return _numbers_to_text(values)


def _numbers_to_text(values: Any) -> str:
    if sys.byteorder == "big":
        values = values.byteswap() if hasattr(values, "dtype") else _swapped(values)
    return binascii.b2a_base64(values.tobytes(), newline=False).decode("ascii")


def _swapped(values: array[Any]) -> array[Any]:
    copy = values[:]
    copy.byteswap()
    return copy


def _unpacker(cls: type[Message], strict: bool) -> Unpack:
    names = [field.name for field in cls.__ros_fields__]
    steps = [
        _unpacker_of(field.kind, strict, _must_be_finite(cls, field.name, strict))
        for field in cls.__ros_fields__
    ]

    def unpack(content: Json) -> Any:
        values = wire.array(content, len(names))
        try:
            return cls(**{name: step(value) for name, step, value in zip(names, steps, values, strict=True)})
        except FieldError as problem:
            raise ProtocolError(f"{cls.__ros_type__}: {problem}") from None

    return unpack


def _unpacker_of(kind: Kind, strict: bool, finite: bool) -> Unpack:
    if isinstance(kind, Nested):
        return _unpacker(kind.cls, strict)
    if isinstance(kind, Fixed):
        return _numbers(kind.item.code, finite)
    if isinstance(kind, Many):
        if kind.code:
            return _numbers(kind.code, finite)
        item = _unpacker_of(kind.item, strict, finite)
        return lambda content: [item(value) for value in wire.array(content)]
    assert isinstance(kind, Scalar)
    if kind.python is float:
        return wire.number if finite else _any_number
    if kind.python is int:
        return lambda content: wire.integer(content, int(kind.low), int(kind.high))
    if kind.python is bytes:
        return lambda content: bytes((wire.integer(content, 0, 255),))
    return _truth if kind.python is bool else _words


def _any_number(content: Json) -> float:
    return float(content) if content in ("nan", "inf", "-inf") else wire.number(content)


def _truth(content: Json) -> bool:
    if type(content) is not bool:
        raise ProtocolError("neither true nor false")
    return content


def _words(content: Json) -> str:
    """Text as it is: a message may hold line breaks. Whoever shows it makes it printable."""
    if type(content) is not str or len(content) > MAX_ENTRIES:
        raise ProtocolError(f"not a text of at most {MAX_ENTRIES} characters")
    return content.encode("utf-8", "replace").decode("utf-8")


def _numbers(code: str, finite: bool) -> Unpack:
    finite_check = code in "fd" and finite
    size = array(code).itemsize

    def unpack(content: Json) -> array[Any]:
        if type(content) is not str or len(content) > MAX_ENTRIES * size * 4 // 3 + 4:
            raise ProtocolError(f"not an array of at most {MAX_ENTRIES} numbers")
        values = array(code)
        try:
            values.frombytes(binascii.a2b_base64(content, strict_mode=True))
        except ValueError:
            raise ProtocolError("an array that is not whole numbers of bytes in base64") from None
        if sys.byteorder == "big":
            values.byteswap()
        if finite_check and not all(map(math.isfinite, values)):
            raise ProtocolError("an array with a number that is not finite")
        return values

    return unpack
