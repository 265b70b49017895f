"""Encodes and decodes frames, and checks the exact types of what is in them; both ends of the pipe use this.

A frame is four bytes of length (big-endian) and that many bytes of JSON. Values are checked for exactly one
type each: a number is no text, true is no number, and NaN is nothing at all.
"""

from __future__ import annotations

import binascii
import json
import re
import struct
import sys
from array import array
from copy import copy
from math import isfinite
from typing import Any, Final, TypeAlias

Json: TypeAlias = Any
"""What JSON can express: None, bool, int, float, str, lists and dicts of these."""

HEADER: Final = struct.Struct(">I")
LOST_PIPE: Final = 70
"""Exit status of a child whose pipe was closed under it (EX_SOFTWARE of sysexits.h)."""
OVER_DISK_LIMIT: Final = 73
"""Exit status for a child that has written more than it may (EX_CANTCREAT of sysexits.h)."""
MAX_DEPTH: Final = 24
"""Arrays in arrays: a message in an event in a frame needs ten at most."""
MAX_RESULT_DEPTH: Final = 3
"""How deep lists may be nested that a student's function returns."""
MAX_ITEMS: Final = 1_000_000
MAX_NUMBERS: Final = 1_000_000
"""Most numbers in one array."""
MAX_TEXT: Final = 4_000
"""Characters of a line of log or of an error's text."""
MAX_NAME: Final = 255
"""Characters of a topic, node, type, function or file name."""
MAX_ID: Final = 2**53
"""Whole numbers above this are not exact in every JSON reader."""


class ProtocolError(Exception):
    """The other side sent something that this protocol does not allow; the message says what."""


def encode(content: Json) -> bytes:
    """Encodes a frame. Raises ValueError for NaN and infinity, which JSON does not know."""
    data = _ENCODER.encode(content).encode("ascii")
    return HEADER.pack(len(data)) + data


def decode(data: bytes) -> Json:
    """Decodes a frame without its header, whose length the reader has checked. Raises ProtocolError."""
    opening = data.count(b"[") + data.count(b"{")
    if opening + data.count(b",") > MAX_ITEMS:
        raise ProtocolError(f"a frame with more than {MAX_ITEMS} items")
    if opening > MAX_DEPTH and _nesting_depth(data) > MAX_DEPTH:
        raise ProtocolError(f"a frame nested deeper than {MAX_DEPTH}")
    try:
        return _DECODER.decode(data.decode("ascii"))
    except (ValueError, RecursionError) as problem:
        # ValueError covers broken JSON, bytes beyond ASCII and numbers of thousands of digits.
        raise ProtocolError(f"a frame that is not plain JSON ({type(problem).__name__})") from None


def _nesting_depth(data: bytes) -> int:
    depth = deepest = 0
    for bracket in _STRING.sub(b"", data).translate(None, _NO_BRACKETS):
        depth += 1 if bracket in b"[{" else -1
        deepest = max(deepest, depth)
    return deepest


def _refuse_constant(name: str) -> Json:
    raise ProtocolError(f"{name} is not a number")


_STRING: Final = re.compile(rb'"(?:[^"\\]|\\.)*+"')
_NO_BRACKETS: Final = bytes(byte for byte in range(256) if byte not in b"[]{}")
_ENCODER: Final = json.JSONEncoder(allow_nan=False, check_circular=False, separators=(",", ":"))
_DECODER: Final = json.JSONDecoder(parse_constant=_refuse_constant)


# JSON's true is a Python bool, and bool passes for int: hence `type(...) is` below.


def boolean(value: Json) -> bool:
    if type(value) is not bool:
        raise ProtocolError("neither true nor false")
    return value


def integer(value: Json, low: int = 0, high: int = MAX_ID) -> int:
    if type(value) is not int or not low <= value <= high:
        raise ProtocolError(f"not a whole number from {low} to {high}: {describe_value(value)}")
    return value


def number(value: Json) -> float:
    """Returns a finite number. Raises ProtocolError for anything else: 1e999 is JSON, and infinite."""
    if type(value) is int and -MAX_ID <= value <= MAX_ID:
        return float(value)
    if type(value) is not float or not isfinite(value):
        raise ProtocolError(f"not a finite number: {describe_value(value)}")
    return value


def text(value: Json, longest: int = MAX_TEXT) -> str:
    """Returns a text with control characters replaced. Raises ProtocolError for anything else, and if it is too long."""
    if type(value) is not str or len(value) > longest:
        raise ProtocolError(f"not a text of at most {longest} characters: {describe_value(value)}")
    return printable(value)


def items(value: Json, length: int | None = None) -> list[Json]:
    if type(value) is not list or (length is not None and len(value) != length):
        raise ProtocolError(f"not a list{'' if length is None else f' of {length}'}: {describe_value(value)}")
    return value


def numbers_to_text(numbers: array[Any]) -> str:
    """Encodes the bytes of an array of numbers (little-endian) in base64: exact, and faster than decimal digits."""
    if sys.byteorder == "big":
        numbers = copy(numbers)
        numbers.byteswap()
    return binascii.b2a_base64(numbers.tobytes(), newline=False).decode("ascii")


def text_to_numbers(value: Json, code: str, *, finite: bool) -> array[Any]:
    """Decodes an array with this type code from ``numbers_to_text``. Raises ProtocolError."""
    numbers: array[Any] = array(code)
    if type(value) is not str or len(value) > MAX_NUMBERS * numbers.itemsize * 4 // 3 + 4:
        raise ProtocolError(f"not an array of at most {MAX_NUMBERS} numbers: {describe_value(value)}")
    try:
        numbers.frombytes(binascii.a2b_base64(value, strict_mode=True))
    except ValueError:
        raise ProtocolError("an array that is not whole numbers of bytes in base64") from None
    if sys.byteorder == "big":
        numbers.byteswap()
    if finite and code in "fd" and not all(map(isfinite, numbers)):
        raise ProtocolError("an array with a number that is not finite")
    return numbers


def printable(value: str) -> str:
    """Replaces everything that could control a terminal, or is invisible, by a visible character."""
    if value.isprintable():
        return value
    return "".join(
        sign if sign.isprintable() else " " if sign in "\t\n" else "\N{REPLACEMENT CHARACTER}"
        for sign in value
    )


def memory_size(value: Json) -> int:
    """Returns about how many bytes a message with this content takes in memory: rather too many than too few."""
    if isinstance(value, (list, dict)):
        inner = value.values() if isinstance(value, dict) else value
        return 100 + sum(map(memory_size, inner))
    return 50 + (4 * len(value) if isinstance(value, str) else 0)


def describe_value(value: Json) -> str:
    """Describes a refused value for a message: short and printable."""
    if isinstance(value, (list, dict)):
        return f"a {type(value).__name__} of {len(value)}"
    # Not repr() first: a whole number of more than 4300 digits refuses to be written out.
    return (
        printable(f"{value!r}"[:60]) if not isinstance(value, int) or abs(value) < 10**50 else "a huge number"
    )
