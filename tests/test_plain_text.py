"""Plain text: what numbers look like."""

from __future__ import annotations

import ast
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

import kit
from kit.plain_text import format_percent, format_size, holds_text, suggestion, wrap


def test_a_size_has_the_unit_that_suits_it() -> None:
    shown = [format_size(size) for size in (0, 1023, 1024, 45_568, 2**20 - 1, 2**20, 3 * 2**30)]
    assert shown == ["0.0 B", "1023.0 B", "1.0 KiB", "44.5 KiB", "1.0 MiB", "1.0 MiB", "3.0 GiB"]


def test_a_size_up_to_a_tebibyte_fits_a_column_of_ten() -> None:
    for exponent in range(40):
        for size in (2**exponent - 1, 2**exponent, 1000 * 2**exponent // 999):
            assert len(format_size(size)) <= 10, size


def test_a_share_reads_as_all_none_or_what_it_is_compared_with_only_where_it_is() -> None:
    assert [format_percent(each / 3) for each in range(4)] == ["0 %", "33 %", "67 %", "100 %"]
    assert format_percent(float("inf")) == format_percent(12.0) == "more than 1000 %"
    for many in range(1, 1000):
        shown = format_percent(many / 1000, beside=0.9)
        assert shown not in ("0 %", "100 %")
        assert (shown == "90 %") is (many == 900)
        assert len(shown) <= len("99.9 %")


def test_a_command_is_whole_where_it_fits_a_line() -> None:
    text = "Then `kit run maze --seed 4`, or (`kit drive`). It's ` alone"
    assert wrap(text, 26) == ["Then", "`kit run maze --seed 4`,", "or (`kit drive`). It's `", "alone"]
    assert wrap("a `kit run maze --seed 4` b", 12) == ["a `kit run", "maze --seed", "4` b"]


def test_a_first_word_is_whole_where_it_fits_on_a_later_line() -> None:
    assert wrap("a-long-word b", 14, "[broken] ", "  ") == ["[broken]", "  a-long-word", "  b"]
    assert wrap("ab cd", 14, "[broken] ", "  ") == ["[broken] ab cd"]
    assert "".join(wrap("runs/" * 6, 14, "[broken] ", "  ")).replace(" ", "") == "[broken]" + "runs/" * 6


@given(st.text("ab `/,-\n", max_size=60), st.integers(4, 30))
def test_wrapping_loses_nothing(text: str, width: int) -> None:
    lines = wrap(text, width, "  ", " ")
    assert "".join("".join(lines).split()) == "".join(text.split())
    assert all(len(line) <= width for line in lines)
    words = [word for line in lines for word in line.split()]
    assert [word for word in text.split() if len(word) <= width - 2 and word not in words] == []


def test_a_suggestion_is_the_end_of_its_message() -> None:
    """It may be a question: what follows would read ``did you mean "lidar"?. More.``"""
    assert suggestion("lidra", ("imu", "lidar")).endswith("?")
    root = Path(kit.__file__).parents[1]
    followed = [
        f"{file}:{node.lineno}"
        for file in (*root.glob("kit/**/*.py"), *root.glob("grader/**/*.py"))
        if "suggestion(" in (text := file.read_text(encoding="utf-8"))
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.JoinedStr)
        for part, after in zip(node.values, node.values[1:], strict=False)
        if isinstance(part, ast.FormattedValue) and ast.unparse(part.value).startswith("suggestion(")
        if isinstance(after, ast.Constant) and str(after.value).startswith(".")
    ]
    assert not followed


def test_a_part_that_ends_with_a_number_is_no_part_of_a_longer_one() -> None:
    text = "should be 0.1, and is 0.3."
    assert all(holds_text(text, each) for each in ("", "SHOULD be 0.1", "is 0.3", "is 0.3."))
    assert not any(holds_text(text, each) for each in ("is 0", "is 0.", "should be 0."))
