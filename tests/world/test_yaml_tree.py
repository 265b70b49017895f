"""What scalars mean."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.world.documents import AllowedRoot, WorldDocuments
from kit.world.problems import ProblemCollector, WorldError
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


def message_of(folder: Path, text: str) -> str:
    """What is said of a file with this text, without its folder."""
    file = folder / "a.yaml"
    file.write_text(text)
    problems = ProblemCollector()
    WorldDocuments(AllowedRoot.of_folder(folder), {}, problems).section(file, SourceLocation(file))
    with pytest.raises(WorldError) as refused:
        problems.raise_if_any()
    return str(refused.value).replace(f"{folder}/", "")


@pytest.mark.parametrize(
    ("text", "place", "cure"),
    [
        ("# mine\npressed:/keys\ntold: /cmd_vel\n", "a.yaml:2:8", 'a space is missing after the colon: write "pressed: /keys"'),
        ("told: /x\npressed:/keys\nback: /y\n", "a.yaml:2:8", 'write "pressed: /keys"'),
        ("told: /x\npressed:/keys\n", "a.yaml:2:8", 'write "pressed: /keys"'),
        ("pressed:/keys\n", "a.yaml:1:1", 'write "pressed: /keys"'),
        ("told: /x\nlist:\n  - name:hall\n    map: /y\n", "a.yaml:3:9", 'write "- name: hall"'),
        ("a:\n\tb: 1\n", "a.yaml:2:1", "indented with a tab"),
        ("a: 1\n\tb: 2\n", "a.yaml:2:1", "indented with a tab"),
        ("a: [1, 2\nb: 3\nc: 4\n", "a.yaml:1:4", 'this "[" is not closed: a "]" is missing'),
        ("a: [1, 2\n", "a.yaml:1:4", 'a "]" is missing'),
        ("a: {x: 1\nb: 2\n", "a.yaml:1:4", 'a "}" is missing'),
        ("a: 'x\nb: 1\nc: 2\n", "a.yaml:1:4", "quotation mark that opens here is not closed"),
        ("a: b: c\n", "a.yaml:1:5", "second colon in one line"),
        ("a: 1\n  b: 2\n", "a.yaml:2:1", "indented further than the one above"),
        ("a:\n  b: 1\n c: 2\n", "a.yaml:3:2", "different column"),
        ("a: @x\n", "a.yaml:1:4", '"@" cannot start a value'),
    ],
)  # fmt: skip
def test_a_slip_is_reported_in_its_own_line_with_its_cure(
    tmp_path: Path, text: str, place: str, cure: str
) -> None:
    message = message_of(tmp_path, text)
    assert message.startswith(f"{place}: "), message
    assert cure in message


def test_an_address_is_no_slip(tmp_path: Path) -> None:
    assert "blank" not in message_of(tmp_path, "http://example.org\n")


def test_what_is_no_common_slip_keeps_the_parser_s_words(tmp_path: Path) -> None:
    assert "not valid YAML" in message_of(tmp_path, "- a\nb: 1\n")
