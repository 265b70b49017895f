"""Screens of text: long rows go on below and are counted; a long text stands in columns where there is room."""

from __future__ import annotations

import asyncio

from textual.pilot import Pilot

from kit.document.blocks import Picture, Text
from kit.document.rows import in_columns, row, row_text
from kit.tui.app import KitApp
from kit.tui.screens.text_screen import TextScreen, page_screen
from kit.tui.terminal import TerminalFacts, TerminalOptions, decide_terminal
from tests.tui.lesson_stage import rows, seen, stage, text, until
from tests.tui.screens.test_start import house as house  # the fixture


def test_a_long_row_goes_on_below_and_is_counted() -> None:
    long = "".join(f"/folder{number}" for number in range(30))

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "/folder29")
        assert "".join(line.strip() for line in rows(pilot)[1:6]).startswith(long)
        await pilot.press("end")
        await seen(pilot, "the last")
        assert "lines 6 to 26 of 26" in rows(pilot)[0]
        assert "scroll" in rows(pilot)[-1]
        await pilot.resize_terminal(80, 40)
        await seen(pilot, "/folder0")
        assert "scroll" not in rows(pilot)[-1], "all is shown: the keys would do nothing"

    several = [row((long, "bold")), *(row("short") for _ in range(21)), row("the last")]
    stage(lambda theme: TextScreen("Printed", several), scene, size=(80, 24))


def test_a_long_text_stands_in_columns_where_there_is_room_and_need() -> None:
    blocks = [
        block
        for number in range(30)
        for block in (Text(f"term {number}"), Text("what it means", is_tight=True), Picture((f"<{number}>",)))
    ]

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "term 29")
        assert "lines" not in rows(pilot)[0], "all is shown"
        for number in range(30):
            (named,) = [line for line in rows(pilot) if f"term {number} " in f"{line} "]
            column = named.index(f"term {number}")
            below = rows(pilot)[rows(pilot).index(named) + 3]
            assert below[column:].strip().startswith(f"<{number}>"), "a picture stays below its term"
        await pilot.resize_terminal(80, 24)
        await seen(pilot, "lines 1 to")

    stage(lambda theme: page_screen("Terms", blocks), scene, size=(200, 55))


def test_no_column_is_much_longer_than_another_and_none_is_too_narrow() -> None:
    lengths = (5, 1, 1, 9, 2, 2, 4)
    parts = [[row(f"{part}.{line}") for line in range(length)] for part, length in enumerate(lengths)]
    for width, columns in ((39, 1), (40, 2), (60, 3)):
        shown = [row_text(each) for each in in_columns(lambda _: parts, width, 3, 20)]
        assert max(len(each.split()) for each in shown) == columns
        assert sum(len(each.split()) for each in shown) == sum(lengths)
        assert len(shown) < sum(lengths) / columns + max(lengths)


def test_nothing_stands_beside_the_message_of_a_terminal_that_is_too_small() -> None:
    async def play() -> None:
        app = KitApp(decide_terminal({"TERM": "xterm-256color"}, TerminalFacts(), TerminalOptions()))
        async with app.run_test(size=(80, 24), notifications=True) as pilot:
            await app.push_screen(TextScreen("Full", [row("#" * 200)] * 50))
            for size in ((40, 12), (20, 5), (30, 8)):
                await pilot.resize_terminal(*size)
                await seen(pilot, f"{size[0]}x{size[1]} is too")
                await until(pilot, lambda: "60x18." in text(pilot), "the whole message")
                told = [line for line in rows(pilot) if "too" in line or "60x18." in line]
                assert told
                assert not any("#" in line for line in told)

    asyncio.run(play())


def test_an_empty_row_is_between_a_long_text_and_the_keys() -> None:
    async def scene(pilot: Pilot[None]) -> None:
        *_, last, blank, keys = rows(pilot)
        assert last
        assert not blank
        assert "Esc back" in keys

    stage(lambda theme: TextScreen("Full", [row("text")] * 50), scene)
