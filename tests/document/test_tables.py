"""A list is a table with one chosen entry, which is in sight however many there are and however high they are."""

from __future__ import annotations

import pytest

from kit.document.blocks import CellStyle, Column, Table, Tone, labelled_table
from kit.document.layout import lines_of
from kit.document.rows import Row, row_text
from kit.document.tables import list_rows, table_columns, table_rows

NAMES = tuple(f"run-{number}/{'long-name/' * (number % 4)}end" for number in range(30))


def table(names: tuple[str, ...] = NAMES) -> Table:
    columns = (Column("run", CellStyle.TEXT), Column("steps"), Column("time", is_optional=True))
    return Table(
        "runs", "", columns, tuple((name, 1000 + place, "12.3 s") for place, name in enumerate(names))
    )


def chosen_text(rows: list[Row]) -> str:
    return "".join(text for row in rows for text, tone in row if tone == Tone.CHOSEN)


@pytest.mark.parametrize("height", [6, 9, 24])
@pytest.mark.parametrize("width", [24, 80])
@pytest.mark.parametrize("chosen", [0, 3, 15, 29])
def test_the_chosen_entry_is_in_sight(chosen: int, width: int, height: int) -> None:
    rows = list_rows(table(), width, height, chosen)
    assert len(rows) <= height
    assert all(len(row_text(each)) <= width for each in rows)
    assert chosen_text(rows).replace(" ", "") == NAMES[chosen]
    assert [row_text(each).split()[0] for each in rows if row_text(each).startswith(">")] == [">"]


def test_marked_entries_have_a_mark_and_optional_columns_are_left_out() -> None:
    wide = [row_text(each) for each in list_rows(table(), 80, 40, 1, marked=(0, 1))]
    assert [each[:2] for each in wide[1:4]] == [" *", ">*", "  "]
    assert wide[0].split() == ["run", "steps", "time"]
    narrow = [row_text(each) for each in list_rows(table(("a", "b")), 16, 5, 0)]
    letters = table(tuple("abcdefghijkl"))
    short = [row_text(list_rows(letters, width, 5, 0)[0]).split() for width in (50, 30)]
    assert [" ".join(each) for each in short] == [
        "run steps time lines 1 to 4 of 12",
        "run steps time 1-4/12",
    ]
    assert narrow == ["   run  steps", ">  a     1000", "   b     1001"]


def test_no_entry_is_chosen_where_there_is_none() -> None:
    assert [row_text(each) for each in list_rows(table(()), 40, 5, 0)] == ["   run  steps  time"]
    grouped = Table("none", "", (Column("", CellStyle.TEXT),), (), grouped=True)
    assert list_rows(grouped, 40, 5, 0) == []


def test_a_column_in_which_nothing_stands_takes_no_room() -> None:
    labelled = labelled_table([("Perception", "", "0 of 3"), ("Action", "", "1 of 2")])
    assert lines_of([labelled]) == ["Perception    0 of 3", "Action        1 of 2"]


@pytest.mark.parametrize(
    ("width", "lines"),
    [
        (39, ["case            timed out  side by side", "turn_right_180       0.50          0.25"]),
        (27, ["case            timed  side", "                  out    by", "                       side"]),
        (
            24,
            [
                "case         timed  side",
                "               out    by",
                "                    side",
                "turn_right_   0.50  0.25",
            ],
        ),
    ],
)
def test_heads_of_numbers_go_on_below_before_a_name_is_broken(width: int, lines: list[str]) -> None:
    columns = (Column("case", CellStyle.TEXT), Column("timed out"), Column("side by side"))
    placed = table_rows(Table("test", "", columns, (("turn_right_180", 0.5, 0.25),), is_ruled=False), width)
    assert [row_text(each) for each in (*placed.heads, *placed.entries[0])][: len(lines)] == lines


@pytest.mark.parametrize("width", [30, 80, 200])
@pytest.mark.parametrize("height", [5, 12, 40])
def test_parts_of_a_long_table_stand_beside_each_other_where_there_is_room(width: int, height: int) -> None:
    short = table(tuple(f"run-{number:02}" for number in range(30)))
    rows = [row_text(each) for each in table_columns(short, width, height)]
    assert all(len(each) <= width for each in rows)
    assert sorted(word for each in rows for word in each.split() if word.startswith("run-")) == [
        name for name, *_ in short.rows
    ]
    assert len(rows) <= len(table_columns(short, 30, height))
    if width == 200 and height == 12:
        assert len(rows) <= height


def test_a_group_stays_together_in_the_parts_of_a_table() -> None:
    columns = (Column("", CellStyle.TEXT), Column("", CellStyle.TEXT))
    rows = tuple((f"group {group}", f"{group}.{member}") for group in range(5) for member in range(3))
    shown = [row_text(each) for each in table_columns(Table("t", "", columns, rows, grouped=True), 80, 6)]
    assert len(shown) == 6
    assert [each.split() for each in shown[:2]] == [
        ["group", "0", "0.0", "group", "2", "2.0", "group", "4", "4.0"],
        ["0.1", "2.1", "4.1"],
    ]


def test_a_table_without_entries_has_only_its_heads() -> None:
    assert [row_text(each) for each in table_columns(table(()), 40, 5)][:1] == ["run  steps  time"]
