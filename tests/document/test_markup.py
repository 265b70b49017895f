"""The markup of lessons' texts."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.document.markup import MarkupError, TextStyle, parse_markup, plain_text, wrap_blocks


def shown(text: str, width: int = 40) -> list[str]:
    return [plain_text(row) for row in wrap_blocks(parse_markup(text), width)]


def test_paragraphs_lists_and_code() -> None:
    text = "One\ntwo.\n\n- first\n  goes on\n- second\n\n    x = 1\n      y\n\nEnd"
    assert shown(text) == [
        "One two.",
        "",
        "- first goes on",
        "- second",
        "",
        "    x = 1",
        "      y",
        "",
        "End",
    ]


def test_code_that_fits_only_without_its_indentation_gives_it_up() -> None:
    text = "    if a:\n        f(a)  # 1"
    assert shown(text, 17) == ["    if a:", "        f(a)  # 1"]
    assert shown(text, 14) == [" if a:", "     f(a)  # 1"]
    assert shown(text, 12) == ["    if a:", "        f(a)  # 1"], "a line is broken all the same"


def test_styles_survive_wrapping() -> None:
    (first, second) = wrap_blocks(parse_markup("aaa `bb cc` **dd ee** ff"), 12)
    assert [(piece.text, piece.style) for piece in first] == [
        ("aaa ", TextStyle.PLAIN),
        ("bb cc", TextStyle.CODE),
        (" ", TextStyle.PLAIN),
        ("dd", TextStyle.BOLD),
    ] or plain_text(first) == "aaa bb cc"
    assert plain_text(second).endswith("ff")


@pytest.mark.parametrize("text", ["a ` b", "a ** b"])
def test_what_is_not_closed_is_refused(text: str) -> None:
    with pytest.raises(MarkupError):
        parse_markup(text)


@given(
    st.lists(st.text(alphabet="abc de-", min_size=1, max_size=30).filter(str.strip), min_size=1, max_size=6),
    st.integers(10, 76),
)
def test_no_row_is_wider_than_asked_and_no_word_is_lost(words: list[str], width: int) -> None:
    text = " ".join(
        f"`{word.strip()}`" if index % 2 else word.strip() for index, word in enumerate(words)
    ).lstrip("- ")
    made = wrap_blocks(parse_markup(text), width)
    assert all(len(plain_text(row)) <= width for row in made)
    assert "".join("".join(map(plain_text, made)).split()) == "".join(text.replace("`", "").split())


def test_code_longer_than_a_row_is_broken_at_its_blanks() -> None:
    text = "Type `kit train hallway --on doors --seed 4` and  wait for `runs/one/two/three/four/five`."
    rows = wrap_blocks(parse_markup(text), 24)
    assert [plain_text(row) for row in rows] == [
        "Type kit train hallway",
        "--on doors --seed 4 and",
        "wait for",
        "runs/one/two/three/four/",
        "five.",
    ]
    code = [piece.text for row in rows for piece in row if piece.style is TextStyle.CODE]
    assert code == ["kit train hallway", "--on doors --seed 4", "runs/one/two/three/four/", "five"]
