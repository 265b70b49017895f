"""A list to choose from: keys, the filter, the mark, small terminals."""

from __future__ import annotations

import asyncio

import pytest
from textual.app import App
from textual.pilot import Pilot
from textual.screen import Screen

from kit.tui.screens.picker import LIST_WIDTH, NOTHING_FOUND, WAY_ON, Picker, PickerItem
from tests.tui.lesson_stage import rows, stage, text
from tests.tui.screens.test_dialogs import LONG
from tests.tui.screens.test_start import house as house  # the fixture

CHOICES = (
    PickerItem("a", "alpha", "the first [one]"),
    PickerItem("b", "beta", LONG),
    PickerItem("c", "gamma", "", "colours settings"),
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
        (["end", "enter"], "c"),
        (["end", "home", "enter"], "a"),
        ([*"amm", "enter"], "c"),
        ([*"FIRST", "enter"], "a"),
        ([*"settings", "enter"], "c"),
        ([*"one first", "enter"], "a"),
        (["escape"], None),
    ],
)
def test_keys_choose(keys: list[str], chosen: str | None) -> None:
    assert pick(*keys)[1] == chosen


@pytest.mark.long
def test_nothing_is_chosen_where_nothing_is_left() -> None:
    shown, chosen = pick(*"zzz", "enter")
    assert chosen is None
    assert NOTHING_FOUND in shown
    assert WAY_ON in shown
    assert NOTHING_FOUND not in pick(*"zzz", *["backspace"] * 3, "enter")[0]


@pytest.mark.long
def test_a_long_text_goes_on_below_its_beginning() -> None:
    text, _ = pick("down", "enter")
    assert "[one]" in text
    lines = [line for line in text.splitlines() if "one word" in line or "the other" in line]
    assert len(lines) > 1
    first = lines[0].index("one word")
    assert {len(line) - len(line.lstrip("│ ")) for line in lines[1:]} == {first}
    assert all(len(line.strip(" │")) <= LIST_WIDTH for line in lines)


@pytest.mark.parametrize(
    "environ", [{}, {"NO_COLOR": "1"}, {"KIT_THEME": "light", "COLORTERM": "truecolor"}], ids=str
)
def test_the_chosen_line_is_marked_without_colours_and_the_list_stays_while_one_types(
    environ: dict[str, str],
) -> None:
    choices = [PickerItem(name, name, "text") for name in ("alpha", "beta", "gamma")]

    def marked(pilot: Pilot[None]) -> list[str]:
        """Lines with a mark, and those in reverse."""
        lines = [line.split("│")[1] for line in rows(pilot) if line.count("│") == 2]
        reverse = [
            segment.text
            for strip in pilot.app.screen._compositor.render_strips()
            for segment in strip
            if segment.style is not None and segment.style.reverse and "text" in segment.text
        ]
        return [line.strip() for line in lines if line.startswith(" > ")] + reverse

    async def scene(pilot: Pilot[None]) -> None:
        top = next(number for number, line in enumerate(rows(pilot)) if "Things" in line)
        for key, name in (("down", "gamma"), ("up", "beta"), ("g", "gamma"), ("backspace", "beta")):
            await pilot.press(key)
            await pilot.pause()
            first, second = marked(pilot)
            assert first.startswith(f"> {name}")
            assert second.startswith(name)
            assert "Things" in rows(pilot)[top], "the list stays where it is"

    stage(lambda theme: Picker("Things", choices, "beta"), scene, environ=environ)


@pytest.mark.long
@pytest.mark.parametrize("size", [(60, 18), (40, 12)], ids=str)
def test_a_list_fits_a_small_terminal_with_the_chosen_line_in_sight(size: tuple[int, int]) -> None:
    choices = [PickerItem(str(number), f"thing {number}", LONG) for number in range(20)]

    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("pagedown")
        await pilot.pause()
        assert "> thing 10" in text(pilot)
        assert rows(pilot)[-1].startswith("└"), "the whole list is in sight"
        inside = [line.strip(" │▁▂▃▄▅▆▇█") for line in rows(pilot)[2:-1]]
        assert all(
            line.startswith(("thing", "> thing", "one", "word", "after", "the", "other")) for line in inside
        )
        places = {
            line.index(word) for line in rows(pilot)[2:-1] for word in ("word", "other") if word in line[:25]
        }
        assert min(places) >= len("│   thing 10  "), "what goes on below is indented"

    stage(lambda theme: Picker("Things", choices), scene, size=size)


@pytest.mark.long
def test_a_large_screen_shows_more_entries_and_breaks_no_line_that_fits() -> None:
    longest = f"begins {'x' * 80} ends"
    choices = [PickerItem(str(number), f"thing {number}", longest) for number in range(60)]

    async def scene(pilot: Pilot[None]) -> None:
        whole = [line for line in rows(pilot) if "begins" in line and "ends" in line]
        assert len(whole) == sum("begins" in line for line in rows(pilot))
        assert len(whole) > pilot.app.size.height // 2

    stage(lambda theme: Picker("Things", choices), scene, size=(200, 50))


@pytest.mark.parametrize(("columns", "is_narrow"), [(80, True), (120, False)])
def test_on_80_columns_one_long_name_takes_no_columns_from_the_texts_of_the_others(
    columns: int, is_narrow: bool
) -> None:
    choices = [PickerItem("a", "a name of many letters", "long"), PickerItem("b", "short", "its text")]

    async def run() -> str:
        app = App[None]()
        async with app.run_test(size=(columns, 24)) as pilot:
            app.push_screen(Picker("Things", choices))
            await pilot.pause()
            shown = app.screen._compositor.render_strips()
            return next(
                line for strip in shown if "its text" in (line := "".join(part.text for part in strip))
            )

    line = asyncio.run(run())
    gap = line.index("its text") - line.index("short")
    assert (gap <= 18) is is_narrow


def test_while_more_is_read_nothing_is_said_to_be_missing() -> None:
    async def scene(pilot: Pilot[None]) -> None:
        picker = Picker("Things", CHOICES)
        picker.reads_more = True
        pilot.app.push_screen(picker)
        await pilot.pause()
        await pilot.press(*"delta")
        assert NOTHING_FOUND not in text(pilot)
        picker.reads_more = False
        picker.replace_choices(CHOICES)
        await pilot.pause()
        assert NOTHING_FOUND in text(pilot)

    stage(lambda theme: Screen(), scene)
