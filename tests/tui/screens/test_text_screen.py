"""A long text over the whole screen."""

from __future__ import annotations

from textual.pilot import Pilot

from kit.tui.screens.message_dialog import TextScreen
from kit.tui.widgets.text_rows import row
from tests.tui.lesson_stage import rows, seen, stage


def test_a_long_row_goes_on_below_and_is_counted() -> None:
    long = "".join(f"/folder{number}" for number in range(30))

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "/folder29")
        assert "".join(line.strip() for line in rows(pilot)[1:6]).startswith(long)
        await pilot.press("end")
        await seen(pilot, "the last")
        assert "lines 5 to 26 of 26" in rows(pilot)[0]

    several = [row((long, "bold")), *(row("short") for _ in range(21)), row("the last")]
    stage(lambda theme: TextScreen("Printed", several), scene, size=(80, 24))
