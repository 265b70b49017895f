"""What scalars mean."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.world.records import SourceLocation
from kit.world.yaml_tree import (
    ListNode,
    MapEntry,
    MapNode,
    ScalarNode,
    parse_bool,
    parse_integer,
    parse_number,
    to_python,
)
from tests.cases import every_case

PLACE = SourceLocation(Path("a.yaml"))


@every_case(
    ("text", "value"),
    [
        ("no", "no"),
        ("on", "on"),
        ("true", True),
        ("FALSE", False),
        ("~", None),
        ("", None),
        ("null", None),
        ("1e-3", 0.001),
        ("-5e-2", -0.05),
        (".5", 0.5),
        ("5.", 5.0),
        ("12", 12),
        ("-12", -12),
        ("007", 7),
        ("0x1F", 31),
        ("0o17", 15),
        (".inf", math.inf),
        ("-.INF", -math.inf),
        ("1_000", "1_000"),
        ("12:30", "12:30"),
        ("0x", "0x"),
        ("0xg", "0xg"),
        ("1e", "1e"),
        ("١٢", "١٢"),
        ("2024-05-07", "2024-05-07"),
        ("nan", "nan"),
    ],
)
def test_plain_scalars_follow_yaml_1_2(text: str, value: object) -> None:
    found = to_python(ScalarNode(text, True, PLACE))
    assert found == value
    assert type(found) is type(value)


@pytest.mark.parametrize("text", ["1", "true", "~", ""])
def test_a_quoted_scalar_is_text(text: str) -> None:
    assert to_python(ScalarNode(text, False, PLACE)) == text


@given(st.floats(allow_nan=False))
def test_every_float_is_read_as_it_is_written(number: float) -> None:
    text = repr(number) if math.isfinite(number) else f"{'-' * (number < 0)}.inf"
    assert parse_number(text) == number


@given(st.integers(-(10**18), 10**18))
def test_every_integer_is_read_as_it_is_written(number: int) -> None:
    assert parse_integer(str(number)) == number
    assert parse_number(str(number)) == float(number)


@given(st.text(max_size=12))
def test_any_text_is_a_number_or_is_not(text: str) -> None:
    number = parse_number(text)
    assert number is None or isinstance(number, float)
    assert parse_integer(text) is None or number == parse_integer(text)


def test_a_number_of_any_length_is_no_trouble() -> None:
    assert parse_integer("9" * 10_000) is None
    assert parse_number("9" * 10_000) == math.inf
    assert parse_number("1" + "0" * 400_000 + "x") is None


@pytest.mark.parametrize(
    ("words", "flag"),
    [
        (["true", "Yes", "ON", "y"], True),
        (["false", "No", "OFF", "n"], False),
        (["1", "tRue", "", "nope"], None),
    ],
)
def test_flags_take_flatlands_words(words: list[str], flag: bool | None) -> None:
    assert [parse_bool(word) for word in words] == [flag] * len(words)


def test_plain_values_cannot_be_changed() -> None:
    entry = MapEntry(PLACE, ListNode((ScalarNode("1", True, PLACE),), PLACE, 1))
    value = to_python(MapNode({"a": entry}, PLACE, 2))
    assert value == {"a": (1,)}
    with pytest.raises(TypeError):
        value["b"] = 2
