"""The private names of Textual that the kit leans on to send less: if one of these fails, read the new version
before touching ``KNOWN_TEXTUAL``."""

from __future__ import annotations

import asyncio
import inspect
import random
from itertools import count
from typing import Any

import pyte
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.cells import cell_len
from rich.console import Console
from rich.segment import Segment
from rich.style import Style
from textual import _compositor, _time, events, message_pump
from textual._xterm_parser import XTermParser
from textual.app import App
from textual.geometry import Region
from textual.screen import Screen
from textual.strip import Strip
from textual.timer import Timer

from kit.tui import textual_patches
from kit.tui.late_timers import fire_late_timers
from kit.tui.textual_patches import (
    ASK_CURSOR,
    KNOWN_TEXTUAL,
    CroppedUpdate,
    CroppingCompositor,
    PlacedRun,
    ask_cursor,
    crop_left,
    write_runs,
)
from tests.cases import every_case
from tests.tui.tape import TapeDriver, ViewApp, run_in


def test_the_installed_textual_is_the_one_that_was_read() -> None:
    assert textual_patches.is_installed(KNOWN_TEXTUAL)
    assert not textual_patches.is_installed("99.0.0")


def test_a_partial_update_holds_chops_spans_and_ends() -> None:
    parameters = list(inspect.signature(_compositor.ChopsUpdate.__init__).parameters)
    assert parameters == ["self", "chops", "spans", "chop_ends"]
    update = _compositor.ChopsUpdate([{0: None}], [(0, 0, 1)], [[1]])
    assert (update.chops, update.spans, update.chop_ends) == ([{0: None}], [(0, 0, 1)], [[1]])


def test_a_screen_draws_with_its_compositor() -> None:
    screen: Screen[None] = Screen()
    assert type(screen._compositor) is _compositor.Compositor
    assert "self._compositor.render_update(" in inspect.getsource(Screen._compositor_refresh)


def test_the_compositor_makes_partial_updates_in_one_place() -> None:
    assert "self.render_partial_update()" in inspect.getsource(_compositor.Compositor.render_update)
    assert CroppingCompositor().render_partial_update() is None


def test_the_app_writes_what_render_segments_says() -> None:
    assert "renderable.render_segments(console)" in inspect.getsource(App._display)


def test_spans_come_as_row_left_and_right() -> None:
    regions = [Region(3, 1, 2, 1), Region(4, 1, 5, 2), Region(20, 1, 1, 1)]
    spans = list(_compositor.Compositor._regions_to_spans(regions))
    assert spans == [(1, 3, 9), (1, 20, 21), (2, 4, 9)]


def test_textual_understands_the_terminals_answer() -> None:
    parser = XTermParser()
    (answer,) = [event for event in parser.feed("\x1b[12;34R") if isinstance(event, events.CursorPosition)]
    assert (answer.x, answer.y) == (33, 11)


def line(text: str) -> Strip:
    return Strip([Segment(text)])


@every_case(
    ("span", "sent"),
    [
        ((0, 0, 10), [(0, "0123456789")]),
        ((0, 3, 5), [(3, "34")]),
        ((0, 8, 13), [(8, "89abc")]),
        ((0, 10, 20), [(10, "abcdefghij")]),
        ((0, 19, 99), [(19, "j")]),
    ],
)
def test_a_span_is_sent_and_no_more(span: tuple[int, int, int], sent: list[tuple[int, str]]) -> None:
    """On a line of two widgets, ten characters each."""
    update = CroppedUpdate([{0: line("0123456789"), 10: line("abcdefghij")}], [span], [[10, 20]])
    expected = "".join(f"\x1b[1;{x + 1}H{text}" for x, text in sent)
    assert update.render_segments(Console()) == expected


COLORS = [Style(color=f"rgb({n},{n + 1},200)", bgcolor=f"rgb(10,{n},90)", bold=n == 111) for n in (111, 122)]
STYLES = [
    None,
    *COLORS,
    Style(color="red", dim=True),
    Style(bold=True),
    Style(reverse=True),
    Style(underline=True, color="green"),
]


@given(st.integers(0, 10_000))
def test_what_is_sent_shows_what_the_strips_say_and_nothing_else(seed: int) -> None:
    chance = random.Random(seed)

    def strip(width: int) -> Strip:
        segments = []
        while width:
            text = "".join(chance.choice("ab  █⣿表") for _ in range(chance.randint(1, 4)))
            while cell_len(text) > width:
                text = text[:-1]
            if text:
                segments.append(Segment(text, chance.choice(STYLES)))
                width -= cell_len(text)
            elif width == 1:
                segments.append(Segment(" "))
                width = 0
        return Strip(segments)

    chops = [{0: strip(12), 12: strip(8)} for _ in range(4)]
    spans = [
        (y, start, start + chance.randint(1, 20 - start))
        for y in range(4)
        for start in (chance.randrange(20),)
        if chance.random() < 0.7
    ] or [(0, 0, 20)]
    console = Console(color_system="truecolor", force_terminal=True)
    screen = pyte.Screen(20, 4)
    stream = pyte.Stream(screen)
    stream.feed(CroppedUpdate(chops, spans, [[12, 20]] * 4).render_segments(console))
    assert screen.cursor.attrs == screen.default_char  # the next to write finds the pen as it was
    whole = pyte.Screen(20, 4)
    whole_stream = pyte.Stream(whole)
    for y, start, end in spans:
        for x, width in ((0, 12), (12, 8)):
            left, right = max(x, start), min(x + width, end)
            if left < right:
                text = chops[y][x].crop(left - x, right - x).render(console)
                whole_stream.feed(f"\x1b[{y + 1};{left + 1}H{text}")
    for y in range(4):
        for x in range(20):
            assert looks(screen.buffer[y][x]) == looks(whole.buffer[y][x])


def looks(cell: Any) -> tuple[object, ...]:
    """What is seen of a character: of a blank no foreground."""
    marks = (cell.bg, cell.reverse, cell.underscore)
    if cell.data == " " and not (cell.reverse or cell.underscore):
        return " ", *marks
    return cell.data, cell.fg, cell.bold, *marks


def test_styles_that_alternate_are_named_once_each() -> None:
    first, second = (Style(color=f"rgb({n},{n},{n})", bgcolor=f"rgb(1,2,{n})") for n in (111, 222))
    chops = [{0: Strip([Segment("a", first), Segment("b", second), Segment("c")])} for _ in range(6)]
    spans = [(y, 0, 3) for y in range(6)]
    console = Console(color_system="truecolor", force_terminal=True)
    sent = CroppedUpdate(chops, spans, [[20]] * 6).render_segments(console)
    assert sent.count("111;111;111") == sent.count("222;222;222") == 1


def test_a_link_is_opened_and_closed_around_its_text() -> None:
    chops = [
        {0: Strip([Segment("see ", COLORS[0]), Segment("here", Style(link="https://x.org")), Segment("!")])}
    ]
    sent = CroppedUpdate(chops, [(0, 0, 9)], [[20]]).render_segments(Console())
    before, _, rest = sent.partition("\x1b]8;")
    assert before.endswith("see \x1b[0m")
    assert rest.endswith("\x1b]8;;\x1b\\!")


def test_runs_are_written_where_the_compositor_would_put_them() -> None:
    """What ``write_runs`` asks a screen for."""
    assert "if self._batch_count:" in inspect.getsource(App._display)
    app = ViewApp()

    async def script(pilot: object) -> None:
        screen = app.screen
        waiting = screen._layout_required, screen._scroll_required, screen._repaint_required
        assert not any((*waiting, screen._recompose_required, screen._dirty_widgets))
        assert list(screen._compositor.visible_widgets)[-1] is screen, "from the front to the back"
        app.terminal.take()
        assert write_runs(app.view, [PlacedRun(2, 3, "##", Style(color="red"))])
        assert app.terminal.take().startswith("\x1b[3;4H\x1b[31m##\x1b[0m")
        app.view.refresh()
        assert not write_runs(app.view, [])

    run_in(app, script, (40, 10))


def test_stock_painting_still_sends_what_lies_to_the_left() -> None:
    """When this fails, Textual has learned to crop and ``crop_left`` may go."""
    update = _compositor.ChopsUpdate([{0: line("0123456789")}], [(0, 8, 9)], [[10]])
    assert "012345678" in update.render_segments(Console())


def test_another_version_of_textual_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(textual_patches, "is_installed", lambda version: False)
    screen: Screen[None] = Screen()
    assert not crop_left(screen)
    assert type(screen._compositor) is _compositor.Compositor


def test_a_screen_that_is_already_shown_can_be_made_thrifty() -> None:
    screen: Screen[None] = Screen()
    compositor = screen._compositor
    assert crop_left(screen)
    assert crop_left(screen)
    assert screen._compositor is compositor
    assert isinstance(compositor, CroppingCompositor)


def test_the_question_is_put_to_the_terminal_and_to_no_one_else() -> None:
    app = ViewApp()
    asked: list[bool] = []

    async def script(pilot: object) -> None:
        app.terminal.take()
        asked.append(ask_cursor(app))
        assert app.terminal.take() == ASK_CURSOR

    run_in(app, script, (40, 10))
    assert asked == [True]
    assert not ask_cursor(App())
    assert isinstance(app._driver, TapeDriver)


@pytest.mark.parametrize("is_mended", [False, True])
def test_a_timer_that_fires_once_fires_even_if_its_task_starts_late(
    is_mended: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of Textual's own the call is left out; when that no longer holds, ``fire_late_timers`` may go."""
    monkeypatch.setattr(message_pump, "Timer", Timer)
    if is_mended:
        fire_late_timers()
    fired: list[float] = []

    async def script(app: App[None]) -> None:
        async with app.run_test() as pilot:
            with monkeypatch.context() as busy:
                busy.setattr(_time, "get_time", count(start=0.0, step=1.0).__next__)  # a second at each look
                app.set_timer(0.01, lambda: fired.append(1))
                await asyncio.sleep(0.05)
            await pilot.pause()

    asyncio.run(script(App()))
    assert len(fired) == is_mended
