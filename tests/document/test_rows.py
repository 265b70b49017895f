"""Rows that are joined and cut: never wider than their room, and a cut is seen."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from kit.document.rows import CUT, at_both_edges, broken, row, row_text, row_width, side_by_side

WORDS = st.text(st.sampled_from("ab 漢é"), max_size=12)


@given(st.lists(WORDS, max_size=4), WORDS, st.integers(1, 40))
def test_two_texts_share_a_row(left: list[str], right: str, width: int) -> None:
    beside = row((right, "dim"))
    made = at_both_edges(row(*left), beside, width)
    before = made[: -len(beside)]
    assert made[-1] == (right, "dim")
    fits = row_width(row(*left)) + row_width(beside) < width
    if row_width(beside) < width:
        assert row_width(made) == width
    if fits:
        assert row_text(before) == row_text(row(*left))
    elif width - row_width(beside) > 5:
        assert row_text(before).endswith("…")


def test_what_is_cut_says_so() -> None:
    made = at_both_edges(row("Lesson ", ("seed 0 of hallway", "bold")), row("2 of 5"), 24)
    assert row_text(made) == "Lesson seed 0 o…  2 of 5"
    assert (CUT, "") in made
    whole = at_both_edges(row("Lesson ", ("seed 0", "bold")), row("2 of 5"), 20)
    assert row_text(whole) == "Lesson seed 0 2 of 5"
    beside = side_by_side([row("a long entry of a list")], [row("b")], 10)
    assert row_text(beside[0]) == "a long …  b"


@given(st.lists(WORDS, max_size=6), st.integers(2, 24))
def test_what_is_broken_fits_and_loses_nothing(parts: list[str], width: int) -> None:
    whole = row(*((part, f"style {number}") for number, part in enumerate(parts)))
    made = broken(whole, width)
    assert all(row_width(each) <= width for each in made)
    kept = [(sign, style) for each in made for text, style in each for sign in text if sign != " "]
    assert kept == [(sign, style) for text, style in whole for sign in text if sign != " "]


def test_a_row_is_broken_between_its_words_and_goes_on_below_its_text() -> None:
    made = broken(row((" Ctrl-P      ", "bold"), "list all commands; type to find one 0.25 m away"), 36)
    assert [row_text(each) for each in made] == [
        " Ctrl-P      list all commands; type",
        "             to find one 0.25 m away",
    ]
    assert made[0][0] == (" Ctrl-P      ", "bold")
