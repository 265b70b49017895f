"""Keys in texts: what arrives in one read is done in the order in which it was pressed."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest
from textual import events
from textual.app import App, ComposeResult
from textual.widget import Widget

from kit.tui.widgets.program_editor import ProgramTextArea
from kit.tui.widgets.text_field import AnswerField, KitInput, KitTextArea

FIELDS: dict[str, Any] = {
    "a line": KitInput,
    "a text": KitTextArea,
    "a program": ProgramTextArea,
    "an answer": AnswerField,
}


@pytest.mark.parametrize("name", FIELDS)
@pytest.mark.parametrize(
    ("keys", "text"),
    [
        ("a b c backspace backspace d", "ad"),
        ("a b left left c", "cab"),
        ("a b c home delete d", "dbc"),
        ("backspace a", "a"),
    ],
)
def test_keys_that_arrive_at_once_are_done_in_their_order(name: str, keys: str, text: str) -> None:
    field: Widget = FIELDS[name]()

    class Page(App[None]):
        def compose(self) -> ComposeResult:
            yield field

    async def run() -> None:
        app = Page()
        async with app.run_test() as pilot:
            field.focus()
            await pilot.pause()
            for key in keys.split():
                app.post_message(events.Key(key, key if len(key) == 1 else None))
            for _ in range(100):
                await pilot.pause(0.02)
                if written(field) == text:
                    break
            await pilot.pause()
            assert written(field) == text

    asyncio.run(run())


def written(field: Any) -> str:
    """What stands in a field."""
    value: str = field.value if isinstance(field, KitInput) else field.text
    return value
