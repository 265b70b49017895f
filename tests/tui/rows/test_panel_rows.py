"""Panels as rows of text: what does not fit is left out or cut, and says so."""

from __future__ import annotations

from kit.dialogue.dialogue import Panel
from kit.document.blocks import Text
from kit.document.rows import row_text
from kit.tui.rows.panel_rows import LEAST_PANEL, panel_rows

LIST = Panel("list", tuple(Text(f"entry {number}", is_tight=True) for number in range(9)))
PARTS = Panel("parts", tuple(Text(f"part {number}") for number in range(9)))
WHOLE = 2 + 9


def texts(panels: list[Panel], room: int, *, upwards: bool = False) -> list[str]:
    rows = [row_text(each) for each in panel_rows(panels, 20, room, upwards=upwards)]
    assert len(rows) <= room
    return rows


def test_a_list_that_is_cut_says_so_and_parts_stay_whole() -> None:
    assert "..." not in texts([LIST], WHOLE)
    for room in range(LEAST_PANEL, WHOLE):
        assert texts([LIST], room)[-1] == "..."
        assert texts([PARTS], room)[-1].startswith("part")
    assert texts([LIST], LEAST_PANEL - 1) == []


def test_a_panel_is_not_cut_at_an_empty_row_that_leaves_out_most_of_it() -> None:
    led = Panel(
        "led", (Text("four parts:"), *(Text(f"part {number}", is_tight=number > 0) for number in range(9)))
    )
    assert texts([led], 10)[-2:] == ["part 4", "..."]


def test_the_first_panel_is_the_lowest_of_those_at_the_bottom() -> None:
    for room in range(WHOLE, 2 * WHOLE):
        rows = texts([LIST, PARTS], room, upwards=True)
        assert rows[-WHOLE:] == texts([LIST], WHOLE), "it stays where it is"
        assert any("parts" in line for line in rows) is (room - WHOLE >= LEAST_PANEL)
