"""Frames and the exact types in them."""

from __future__ import annotations

import json
import math
from array import array
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kit.host import wire
from kit.host.wire import HEADER, ProtocolError, decode, encode
from tests.cases import every_case

PLAIN = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**60), 2**60)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(),
    lambda inner: st.lists(inner, max_size=4),
    max_leaves=20,
)


@pytest.mark.long
@given(PLAIN)
def test_what_goes_in_comes_out(content: object) -> None:
    frame = encode(content)
    assert HEADER.unpack_from(frame) == (len(frame) - HEADER.size,)
    assert decode(frame[HEADER.size :]) == content


@pytest.mark.long
@settings(max_examples=300)
@given(
    st.binary(max_size=200)
    | st.text(alphabet='[]{}",:0123456789eE.-+nulltrefasNI\\', max_size=200).map(str.encode)
)
def test_any_bytes_are_json_or_refused(data: bytes) -> None:
    with suppress(ProtocolError):
        decode(data)


@every_case(
    "data",
    [
        b"",
        b"nonsense",
        b"[1,2",
        b"[1]x",
        b"\xff\xfe",
        '"ü"'.encode(),
        b"[NaN]",
        b"[Infinity]",
        b"[-Infinity]",
        b"[" + b"9" * 5000 + b"]",
        b"[" * 200_000,
        b"[" * 30 + b"]" * 30,
        b'{"a":' * 30 + b"1" + b"}" * 30,
        b"[" + b"0," * wire.MAX_ITEMS + b"0]",
    ],
    ids=lambda data: repr(data[:12]),
)
def test_hostile_frames_are_refused(data: bytes) -> None:
    with pytest.raises(ProtocolError):
        decode(data)


def test_brackets_in_a_text_are_not_depth() -> None:
    text = '[{\\"' * 100
    assert decode(json.dumps([text]).encode()) == [text]


def test_nan_is_not_sent() -> None:
    with pytest.raises(ValueError, match="JSON compliant"):
        encode([math.nan])


@every_case("value", [True, 1.0, "1", None, [1], -1, 2**53 + 1])
def test_only_a_whole_number_is_an_integer(value: object) -> None:
    with pytest.raises(ProtocolError):
        wire.integer(value)


@every_case("value", [True, False, "1.0", None, [], math.inf, -math.inf, math.nan, 10**400])
def test_only_a_finite_number_is_a_number(value: object) -> None:
    with pytest.raises(ProtocolError):
        wire.number(value)


def test_a_whole_number_is_a_number_and_becomes_a_float() -> None:
    number = wire.number(3)
    assert type(number) is float
    assert number == 3.0
    assert math.copysign(1.0, wire.number(-0.0)) == -1.0


def test_what_overflows_a_float_is_refused() -> None:
    with pytest.raises(ProtocolError):
        wire.number(decode(b"1e999"))


def test_text_cannot_steer_a_terminal() -> None:
    text = wire.text("red \x1b[31m bell \x07 \x9b31m \u202e backwards\ttab\nline \ud800")
    assert text.isprintable()
    assert text.startswith("red \N{REPLACEMENT CHARACTER}[31m bell")
    assert "\ttab" not in text
    assert wire.text("Grüße, 世界") == "Grüße, 世界"


def test_text_has_a_length() -> None:
    assert wire.text("x" * 10, 10) == "x" * 10
    with pytest.raises(ProtocolError):
        wire.text("x" * 11, 10)


def test_texts_and_arrays_are_taken_up_to_their_limits() -> None:
    assert wire.text("x" * 4_000) == "x" * 4_000
    with pytest.raises(ProtocolError, match="4000 characters"):
        wire.text("x" * 4_001)
    most = wire.numbers_to_text(array("b", bytes(1_000_000)))
    assert len(wire.text_to_numbers(most, "b", finite=False)) == 1_000_000
    with pytest.raises(ProtocolError, match="1000000 numbers"):
        wire.text_to_numbers(wire.numbers_to_text(array("b", bytes(1_000_010))), "b", finite=False)
