"""What a dialog does with the keys that come while it closes."""

from __future__ import annotations

import asyncio

from textual import events
from textual.app import App
from textual.pilot import Pilot
from textual.screen import Screen

from kit.tui.screens.message_dialog import MessageDialog, TextScreen
from kit.tui.widgets.text_rows import row
from tests.tui.lesson_stage import rows, seen, stage


class KeyNotes(Screen[None]):
    """Notes the keys that reach it."""

    def __init__(self) -> None:
        super().__init__()
        self.keys: list[str] = []

    def on_key(self, event: events.Key) -> None:
        self.keys.append(event.key)


def test_keys_that_come_at_once_with_the_one_that_closes_reach_the_screen_below() -> None:
    notes = KeyNotes()

    async def run() -> None:
        app = App[None]()
        async with app.run_test() as pilot:
            await app.push_screen(notes)
            await app.push_screen(MessageDialog("Title", []))
            await pilot.pause()
            for key in ("space", "m", "w"):
                app.post_message(events.Key(key, None))
            while notes.keys[-1:] != ["w"]:
                await pilot.pause(0.001)

    asyncio.run(asyncio.wait_for(run(), 20))
    assert notes.keys == ["m", "w"]


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
