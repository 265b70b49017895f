"""Choosing one thing from a list."""

from __future__ import annotations

import asyncio

import pytest
from textual.app import App

from kit.tui.screens.picker import LINE, Picker, PickerItem

LONG = "one word after the other, " * 8
CHOICES = (
    PickerItem("a", "alpha", "the first [one]"),
    PickerItem("b", "beta", LONG),
    PickerItem("c", "gamma"),
)


def pick(*keys: str) -> tuple[str, str | None]:
    """What the list looks like before the last key, and what is chosen then."""
    chosen: list[str | None] = []

    async def run() -> str:
        app = App[None]()
        async with app.run_test(size=(80, 24)) as pilot:
            app.push_screen(Picker("Things", CHOICES, "b"), chosen.append)
            await pilot.pause()
            await pilot.press(*keys[:-1])
            await pilot.pause()
            text = "\n".join(
                "".join(part.text for part in strip) for strip in app.screen._compositor.render_strips()
            )
            await pilot.press(keys[-1])
            await pilot.pause()
            return text

    return asyncio.run(run()), chosen[0] if chosen else None


@pytest.mark.sampled(6)
@pytest.mark.parametrize(
    ("keys", "chosen"),
    [
        (["enter"], "b"),
        (["up", "enter"], "a"),
        (["down", "down", "enter"], "c"),
        (["pagedown", "pageup", "enter"], "a"),
        ([*"amm", "enter"], "c"),
        ([*"FIRST", "enter"], "a"),
        (["escape"], None),
    ],
)
def test_keys_choose(keys: list[str], chosen: str | None) -> None:
    assert pick(*keys)[1] == chosen


@pytest.mark.long
def test_nothing_is_chosen_where_nothing_is_left() -> None:
    assert pick(*"zzz", "enter")[1] is None


@pytest.mark.long
def test_a_long_text_goes_on_below_its_beginning() -> None:
    text, _ = pick("down", "enter")
    assert "[one]" in text
    lines = [line for line in text.splitlines() if "one word" in line or "the other" in line]
    assert len(lines) > 1
    first = lines[0].index("one word")
    assert {len(line) - len(line.lstrip("│ ")) for line in lines[1:]} == {first}
    assert all(len(line.strip(" │")) <= LINE for line in lines)
