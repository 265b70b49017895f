"""DriveScreen inside an app without a terminal: routing of keys, stopping, modes, and the one timer."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping
from typing import ClassVar

from textual import events
from textual.app import App, ComposeResult
from textual.binding import BindingType
from textual.pilot import Pilot
from textual.screen import Screen
from textual.widgets import Input, Static

from kit.tui.app import KitApp
from kit.tui.input.drive import DriveState
from kit.tui.input.key_parser import KeyboardAnswer, KeyReleased, KeyRepeated
from kit.tui.input.modes import HoldMode
from kit.tui.input.screen import DriveScreen
from kit.tui.terminal import TerminalFacts, decide_terminal
from tests.waiting import wait_until_shown


class Recorder(DriveScreen):
    BINDINGS: ClassVar[list[BindingType]] = [("plus", "zoom", "Zoom")]

    def __init__(self, environ: Mapping[str, str]) -> None:
        super().__init__(decide_terminal(environ, TerminalFacts()))
        self.messages: list[str] = []
        self.states: list[dict[str, float]] = []
        self.zooms = 0

    def compose(self) -> ComposeResult:
        yield Static("driving")
        yield Input()

    def on_mount(self) -> None:
        self.set_focus(None)

    def action_zoom(self) -> None:
        self.zooms += 1

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        self.messages += messages
        self.states.append(dict(state.held))


Scene = Callable[[Recorder, Pilot[None]], Awaitable[None]]


TMUX = {"TERM": "tmux-256color", "TMUX": "/x"}


def play(scene: Scene, environ: Mapping[str, str] = TMUX) -> None:
    async def run() -> None:
        app: App[None] = App()
        async with app.run_test() as pilot:
            screen = Recorder(environ)
            await app.push_screen(screen)
            await pilot.pause()
            screen.set_focus(None)
            await scene(screen, pilot)

    asyncio.run(run())


def test_before_the_terminal_answers_keys_drive_while_held() -> None:
    async def scene(screen: Recorder, pilot: Pilot[None]) -> None:
        await pilot.press("w", "k", "shift+left")
        assert screen.drive.choice.mode == "hold"
        assert screen.messages == ["p_up", "p_left"]

    play(scene)


def test_the_answer_sets_the_mode_and_names_who_hides_the_releases() -> None:
    async def scene(screen: Recorder, pilot: Pilot[None]) -> None:
        screen.app.post_message(KeyboardAnswer(None))
        await pilot.pause()
        assert screen.drive.choice.mode == "hold"
        assert "tmux" in screen.drive.status
        screen.app.post_message(KeyboardAnswer(27))
        await pilot.pause()
        assert screen.drive.choice.mode == "exact"

    play(scene)


def test_a_terminal_that_must_not_be_asked_has_its_mode_at_once() -> None:
    async def scene(screen: Recorder, pilot: Pilot[None]) -> None:
        assert "reports no key releases" in screen.drive.status

    play(scene, {"TERM": "linux"})


def test_a_bad_link_shows_in_the_status() -> None:
    async def scene(screen: Recorder, pilot: Pilot[None]) -> None:
        shown: list[str] = []
        screen.drive_status_changed = lambda: shown.append(screen.drive.status)  # type: ignore[method-assign]  # a spy
        assert isinstance(screen.drive._mode, HoldMode)
        screen.drive._mode.rhythm.uneven = True
        await pilot.press("w")
        assert len(shown) == 1
        assert "latch" in shown[0]

    play(scene)


def test_a_press_overtaken_by_its_release_is_a_tap() -> None:
    """Presses go by way of the widget in focus, releases straight to the screen."""

    async def scene(screen: Recorder, pilot: Pilot[None]) -> None:
        screen.app.post_message(KeyboardAnswer(27))
        press, release = events.Key("w", "w"), KeyReleased("w")
        screen.app.post_message(release)
        await pilot.pause()
        screen.app.post_message(press)
        await pilot.pause()
        assert screen.messages == ["p_up", "r_up"]
        await pilot.press("w")
        assert screen.messages == ["p_up", "r_up", "p_up"]

    play(scene)


def test_a_press_that_arrives_after_the_focus_went_does_not_drive() -> None:
    async def scene(screen: Recorder, pilot: Pilot[None]) -> None:
        await pilot.press("w")
        screen.app.post_message(events.AppBlur())
        await pilot.pause()
        assert screen.messages == ["p_up", "r_up"]
        screen.post_message(events.Key("w", "w"))
        await pilot.pause()
        assert screen.drive.state.held == {}
        await pilot.press("w")  # by way of the app, to which a key proves that the focus is back
        assert screen.drive.state.held == {"up": 1.0}

    play(scene)


def test_another_screen_on_top_stops() -> None:
    async def scene(screen: Recorder, pilot: Pilot[None]) -> None:
        await pilot.press("w")
        await screen.app.push_screen(Screen())
        await pilot.pause()
        assert screen.messages == ["p_up", "r_up"]

    play(scene)


def test_repeats_of_keys_that_do_not_drive_act_like_presses() -> None:
    async def scene(screen: Recorder, pilot: Pilot[None]) -> None:
        screen.app.post_message(KeyRepeated("plus", "+"))
        screen.app.post_message(KeyRepeated("w", "w"))
        await pilot.pause()
        await pilot.pause()
        assert screen.zooms == 1

    play(scene)


def test_an_input_field_in_focus_gets_the_keys() -> None:
    async def scene(screen: Recorder, pilot: Pilot[None]) -> None:
        field = screen.query_one(Input)
        field.focus()
        await pilot.press("w", "a", "s")
        screen.app.post_message(KeyReleased("w"))
        await pilot.pause()
        assert field.value == "was"
        assert screen.messages == []

    play(scene)


def test_a_tap_is_released_by_the_timer_and_then_nothing_ticks() -> None:
    async def scene(screen: Recorder, pilot: Pilot[None]) -> None:
        await pilot.press("w")
        await wait_until_shown(pilot, lambda: screen._alarm is None, "the timer to end")
        assert screen.messages == ["p_up", "r_up"]
        slowed = {"up": 0.35}  # in between, but for a machine that stands still for so long
        assert [each for each in screen.states if each != slowed] == [{"up": 1.0}, {}]

    play(scene)


def test_one_key_goes_through_the_modes() -> None:
    async def scene(screen: Recorder, pilot: Pilot[None]) -> None:
        screen.app.post_message(KeyboardAnswer(27))
        await pilot.pause()
        modes = []
        for _ in range(4):
            modes.append((screen.drive.requested_mode, screen.drive.choice.mode))
            screen.action_drive_mode()
        assert modes == [(None, "exact"), ("latch", "latch"), ("hold", "hold"), (None, "exact")]

    play(scene)


def test_the_mode_that_was_chosen_holds_on_the_screens_that_follow_and_on_those_below() -> None:
    async def run() -> None:
        app: App[None] = KitApp(decide_terminal(TMUX, TerminalFacts()))
        async with app.run_test() as pilot:
            below, first, second = (Recorder(TMUX) for _ in range(3))
            await app.push_screen(below)
            await app.push_screen(first)
            first.action_drive_mode()
            await app.pop_screen()
            await app.push_screen(second)
            await pilot.pause()
            assert [each.drive.choice.mode for each in (first, second, below)] == ["latch"] * 3
            second.action_drive_mode()
            await app.pop_screen()
            await pilot.pause()
            assert below.drive.requested_mode == "hold"

    asyncio.run(run())
