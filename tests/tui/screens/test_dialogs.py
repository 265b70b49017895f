"""What a dialog does with the keys that come while it closes."""

from __future__ import annotations

import asyncio

import pytest
from textual import events
from textual.app import App
from textual.pilot import Pilot
from textual.screen import Screen

from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.play import PlayScreen
from tests.tui.lesson_stage import seen, stage, text, until
from tests.tui.screens.test_start import House
from tests.tui.screens.test_start import house as house  # the fixture


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


@pytest.mark.parametrize(
    ("passes_keys", "key", "reached"), [(True, "r", ["r"]), (True, "escape", []), (False, "r", [])]
)
def test_the_key_that_closes_what_asks_nothing_is_for_the_screen_below_too(
    passes_keys: bool, key: str, reached: list[str]
) -> None:
    notes = KeyNotes()

    async def run() -> None:
        async with App[None]().run_test() as pilot:
            await pilot.app.push_screen(notes)
            await pilot.app.push_screen(MessageDialog("Title", [], passes_keys=passes_keys))
            await pilot.press(key)
            await until(pilot, lambda: pilot.app.screen is notes, "the screen below")
            await pilot.press("x")
            await until(pilot, lambda: notes.keys[-1:] == ["x"], "the next key")

    asyncio.run(asyncio.wait_for(run(), 20))
    assert notes.keys == [*reached, "x"]


LONG = "one word after the other, " * 8


@pytest.mark.long
def test_the_help_of_a_drive_names_esc_for_going_back_only_where_that_goes_back(house: House) -> None:
    workspace = house.workspace

    async def alone(pilot: Pilot[None]) -> None:
        await pilot.press("question_mark")
        await seen(pilot, "Ctrl-C           quit the kit")
        assert "go back" not in text(pilot)

    async def above_another(pilot: Pilot[None]) -> None:
        await pilot.press("3")
        await until(pilot, lambda: type(pilot.app.screen) is PlayScreen, "the drive")
        await pilot.press("question_mark")
        await seen(pilot, "Esc q Backspace  go back")

    stage(
        lambda theme: PlayScreen(
            theme, "simple", "teleop", folder=workspace.controllers, runs=workspace.runs
        ),
        alone,
    )
    house.play(above_another)
