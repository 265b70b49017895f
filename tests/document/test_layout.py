"""Texts in rows of a width: what belongs together stays together, and nothing is wider than the page."""

from __future__ import annotations

import pytest

from kit.document.blocks import Choice, Choices, Code, Picture, Text, Tone, labelled_table
from kit.document.layout import Page, lines_of, rows_of
from kit.document.rows import MARGIN, row_text


@pytest.mark.parametrize("width", [12, 20, 30])
@pytest.mark.parametrize(
    "text", ["short", "words of a title", "https://example.org/a/long/address/of/a/page"]
)
def test_the_tail_stays_with_the_last_word(text: str, width: int) -> None:
    block = Text(text, lead="[no]", lead_tone=Tone.BAD, tail=": 2 of 4", hang=2)
    lines = lines_of([block], Page(width=width))
    assert all(len(line) <= width for line in lines)
    assert "".join("".join(lines).split()) == "".join(f"[no] {text}: 2 of 4".split())
    assert lines[-1].endswith(": 2 of 4")
    assert rows_of([block], Page(width=width))[-1][-1] == (": 2 of 4", Tone.DIM)


def test_a_text_cannot_command_the_terminal_nor_leave_its_indent() -> None:
    lines = lines_of([Text("one\n::set-output\x1b[2J\r\nx\0y", indent=3)])
    assert all(line.startswith("   ") for line in lines)
    assert all(line.isprintable() for line in lines)


def test_the_rows_of_a_table_stand_below_its_title() -> None:
    table = labelled_table([("a", "what a is"), ("long", "x " * 60)], "Title", indent=2)
    lines = lines_of([table], Page(width=40))
    assert lines[:2] == ["Title", "  a     what a is"]
    assert all(line.startswith("  ") and len(line) <= 40 for line in lines[1:])


def test_a_picture_has_its_tone() -> None:
    assert rows_of([Picture(("| x",), 5, Tone.DIM)], Page()) == [(("     | x", Tone.DIM),)]


def test_a_picture_as_wide_as_the_screen_has_no_margin() -> None:
    page = Page(width=20, margin=2)
    assert lines_of([Picture(("x" * 20,), indent=0)], page) == [" " * 2 + "x" * 20]
    assert lines_of([Picture(("short", "x" * 24), indent=0)], page) == ["short", "x" * 24]


@pytest.mark.parametrize("width", [14, 40])
def test_code_in_a_sentence_has_its_tone_on_a_screen_and_its_marks_where_there_are_no_tones(
    width: int,
) -> None:
    text = "Try `kit task show turn` first."
    for block in (Text(text, Tone.DIM), Choices((Choice("1", text),))):
        coded = [
            part for each in rows_of([block], Page(width=width)) for part in each if part[1] is Tone.CODE
        ]
        assert "".join("".join(part for part, _ in coded).split()) == "kittaskshowturn"
        assert "`" not in "".join(lines_of([block], Page(width=width)))
        assert "`kit" in "".join(lines_of([block], Page(width=width, is_heard=True)))


def test_a_single_mark_is_a_character_as_others() -> None:
    assert rows_of([Text("the key ` is free")], Page()) == [(("the key ` is free", Tone.PLAIN),)]


def test_a_long_path_is_broken_behind_a_slash_and_goes_on_in_the_margin_only_where_it_can_be_copied() -> None:
    path = "~/robot-kit/lessons/09-your-own-controller/follow/follow.py"
    code = Code((f"kit drive simple --controller {path}",))
    for is_beside in (False, True):
        rows = [row_text(each) for each in rows_of([code], Page(40, MARGIN, is_beside=is_beside))]
        *_, begin, end = rows
        assert begin.endswith("/\\")
        assert begin.strip().removesuffix("\\") + end.strip() == path
        assert end.startswith(" " * MARGIN) is is_beside


def test_a_path_on_three_rows_beside_something_else_keeps_its_indentation() -> None:
    code = Code(
        ("kit drive simple --controller ~/robot-kit/lessons/09-your-own-controller/circle/circle.py",), 4
    )
    rows = [row_text(each) for each in rows_of([code], Page(36, MARGIN, is_beside=True))]
    path = rows[next(number for number, each in enumerate(rows) if "~/" in each) :]
    assert len(path) >= 3
    assert all(len(each) - len(each.lstrip()) > MARGIN for each in path)
    assert all(len(each) <= 36 + 2 * MARGIN for each in path)


def test_a_word_beside_something_else_may_reach_into_the_right_margin() -> None:
    code = Code(("kit drive " + "x" * 42,))
    whole = [row_text(each) for each in rows_of([code], Page(40, MARGIN, is_beside=True))]
    assert whole[-1].strip() == "x" * 42
    assert max(map(len, whole)) <= 40 + 2 * MARGIN
