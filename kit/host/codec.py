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


class Codec:
    """Packs messages, and unpacks them with every value checked. ``trusting``: what comes may be NaN anywhere."""

    def __init__(self, *, trusting: bool) -> None:
        self._trusting = trusting
        self._pack: dict[type[Message], Pack] = {}
        self._unpack: dict[type[Message], Unpack] = {}

    def pack(self, message: Message) -> Json:
        cls = type(message)
        if cls not in self._pack:
            self._pack[cls] = _packer(cls)
        return self._pack[cls](message)

    def unpack(self, cls: type[Message], content: Json) -> Any:
        """The message of type ``cls``. ProtocolError if the content does not fit it exactly."""
        if cls not in self._unpack:
            self._unpack[cls] = _unpacker(cls, self._trusting)
        return self._unpack[cls](content)


def _packer(cls: type[Message]) -> Pack:
    steps = [(field.slot, _packer_of(field.kind)) for field in cls.__ros_fields__]

    def pack(message: Any) -> Json:
        return [step(getattr(message, slot)) for slot, step in steps]

    return pack


def _packer_of(kind: Kind) -> Pack:
    if isinstance(kind, Nested):
        return _packer(kind.cls)
    if isinstance(kind, Fixed) or (isinstance(kind, Many) and kind.code):
        return _numbers_to_text
    if isinstance(kind, Many):
        item = _packer_of(kind.item)
        return lambda values: [item(value) for value in values]
    assert isinstance(kind, Scalar)
    if kind.python is float:
        return lambda value: value if value - value == 0 else repr(value)
    if kind.python is bytes:
        return lambda value: value[0]
    return lambda value: value


def _numbers_to_text(values: Any) -> str:
    if sys.byteorder == "big":
        values = values.byteswap() if hasattr(values, "dtype") else _swapped(values)
    return binascii.b2a_base64(values.tobytes(), newline=False).decode("ascii")


def _swapped(values: array[Any]) -> array[Any]:
    copy = values[:]
    copy.byteswap()
    return copy


def _unpacker(cls: type[Message], trusting: bool) -> Unpack:
    names = [field.name for field in cls.__ros_fields__]
    steps = [
        _unpacker_of(field.kind, trusting, trusting or (cls.__ros_type__, field.name) in MAY_BE_INFINITE)
        for field in cls.__ros_fields__
    ]

    def unpack(content: Json) -> Any:
        values = wire.array(content, len(names))
        try:
            return cls(**{name: step(value) for name, step, value in zip(names, steps, values, strict=True)})
        except FieldError as problem:
            raise ProtocolError(f"{cls.__ros_type__}: {problem}") from None

    return unpack


def _unpacker_of(kind: Kind, trusting: bool, infinite: bool) -> Unpack:
    if isinstance(kind, Nested):
        return _unpacker(kind.cls, trusting)
    if isinstance(kind, Fixed):
        return _numbers(kind.item.code, infinite)
    if isinstance(kind, Many):
        if kind.code:
            return _numbers(kind.code, infinite)
        item = _unpacker_of(kind.item, trusting, infinite)
        return lambda content: [item(value) for value in wire.array(content)]
    assert isinstance(kind, Scalar)
    if kind.python is float:
        return _any_number if infinite else wire.number
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


def _numbers(code: str, infinite: bool) -> Unpack:
    finite_check = code in "fd" and not infinite
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
