"""Rows that are joined and cut: never wider than their room, and a cut is seen."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from kit.document.rows import CUT, at_both_edges, row, row_text, row_width, side_by_side

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
