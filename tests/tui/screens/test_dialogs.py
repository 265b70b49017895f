"""What a dialog does with the keys that come while it closes."""

from __future__ import annotations

import asyncio

import pytest
from textual import events
from textual.app import App
from textual.pilot import Pilot
from textual.screen import Screen
from textual.widgets import OptionList

from kit.document.rows import row
from kit.render.roles import COLOR_SCHEMES, Role
from kit.tui.app import KitApp
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.lesson import LessonScreen
from kit.tui.screens.lessons import LessonsScreen
from kit.tui.screens.new_training import NewTrainingScreen
from kit.tui.screens.picker import LINE, Picker, PickerItem
from kit.tui.screens.play import PlayScreen
from kit.tui.screens.text_screen import TextScreen
from kit.tui.terminal import TerminalFacts, TerminalOptions, decide_terminal
from tests.tui.lesson_stage import rows, seen, stage, text, until
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
        (["end", "enter"], "c"),
        (["end", "home", "enter"], "a"),
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
def test_it_lists_lessons_levels_and_maps_and_opens_one_over_whatever_is_open(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("2")
        await until(pilot, lambda: isinstance(pilot.app.screen, LessonsScreen), "the lessons")
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(pilot.app.screen, Picker), "the palette")
        await pilot.press(*"map warehouse", "enter")
        await until(pilot, lambda: type(pilot.app.screen) is PlayScreen, "the map")
        await seen(pilot, "warehouse")
        assert len(pilot.app.screen_stack) == 3
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(pilot.app.screen, Picker), "the palette")
        await pilot.press(*"lesson 1", "enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, LessonScreen), "the lesson")
        assert len(pilot.app.screen_stack) == 3

    house.play(scene)


def test_it_does_what_a_key_of_the_screen_does(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await until(pilot, lambda: "Lessons" in text(pilot), "the menu")
        await pilot.press("ctrl+p", *"this page", "enter")
        await seen(pilot, "The start screen")

    house.play(scene)


def test_it_lists_the_actions_of_the_screen_and_no_others(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await until(pilot, lambda: "Lessons" in text(pilot), "the menu")
        await pilot.press("2")
        await until(pilot, lambda: isinstance(pilot.app.screen, LessonsScreen), "the lessons")
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(pilot.app.screen, Picker), "the palette")
        options = pilot.app.screen.query_one(OptionList)
        await until(pilot, lambda: options.option_count > 50, "lessons, levels and maps")
        found = [str(option.prompt) for option in options.options]
        assert sum("open the selected item (Enter)" in each for each in found) == 1
        for action in NewTrainingScreen.screen_actions.own + TextScreen.screen_actions.records:
            if action.id in ("change", "close"):  # call what actions of this screen call
                assert not any(action.help in each for each in found)

    house.play(scene)


def test_escape_leaves_everything_as_it_was(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        before = pilot.app.screen
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(pilot.app.screen, Picker), "the palette")
        options = pilot.app.screen.query_one(OptionList)
        await until(pilot, lambda: options.option_count > 50, "lessons, levels and maps")
        await pilot.press("ctrl+p", "escape")
        assert pilot.app.screen is before

    house.play(scene)


def test_themes_can_be_switched_while_it_runs() -> None:
    terminal = decide_terminal(
        {"TERM": "xterm-256color", "COLORTERM": "truecolor"}, TerminalFacts(), TerminalOptions()
    )
    app = KitApp(terminal)
    palette = app.kit_theme.palette
    assert palette[Role.FLOOR].color == COLOR_SCHEMES["dark"].roles[Role.FLOOR]
    app.switch_theme("light")
    assert app.kit_theme.palette is palette
    assert palette[Role.FLOOR].color == COLOR_SCHEMES["light"].roles[Role.FLOOR]
    assert app.theme == "kit-light"


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
