"""A screen of text: long rows go on below and are counted."""

from __future__ import annotations

from textual.pilot import Pilot

from kit.document.rows import row
from kit.tui.screens.text_screen import TextScreen
from tests.tui.lesson_stage import rows, seen, stage
from tests.tui.screens.test_start import house as house  # the fixture


def test_a_long_row_goes_on_below_and_is_counted() -> None:
    long = "".join(f"/folder{number}" for number in range(30))

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "/folder29")
        assert "".join(line.strip() for line in rows(pilot)[1:6]).startswith(long)
        await pilot.press("end")
        await seen(pilot, "the last")
        assert "lines 5 to 26 of 26" in rows(pilot)[0]
        assert "scroll" in rows(pilot)[-1]
        await pilot.resize_terminal(80, 40)
        await seen(pilot, "/folder0")
        assert "scroll" not in rows(pilot)[-1], "all is shown: the keys would do nothing"

    several = [row((long, "bold")), *(row("short") for _ in range(21)), row("the last")]
    stage(lambda theme: TextScreen("Printed", several), scene, size=(80, 24))
