"""A terminal in memory: an app runs in it, its bytes are counted, and pyte shows what a user would see."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Coroutine
from typing import Any

import pyte
from textual import events
from textual._compositor import Compositor
from textual.app import App
from textual.drivers.headless_driver import HeadlessDriver
from textual.geometry import Region
from textual.pilot import Pilot
from textual.strip import Strip
from textual.widget import Widget

from kit.render.encode import Encoder
from kit.render.palettes import ANSI_PALETTE, Palette
from kit.tui.textual_patches import ASK_CURSOR, CroppingCompositor
from kit.tui.widgets.world_view import WorldView


class TapeDriver(HeadlessDriver):
    """Keeps what is written, in the order in which a terminal would get it."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.tape: list[str] = []
        self.answers = True
        """Whether this terminal says where its cursor is, when asked."""

    @property
    def is_headless(self) -> bool:
        return False

    def write(self, data: str) -> None:
        self.tape.append(data)
        if self.answers and ASK_CURSOR in data:
            self.send_message(events.CursorPosition(0, 0))

    def take(self) -> str:
        """What was written since the last call."""
        text = "".join(self.tape)
        self.tape.clear()
        return text


class PlainView(WorldView):
    """Rendered as Textual renders any widget."""

    def render_lines(self, crop: Region) -> list[Strip]:
        return Widget.render_lines(self, crop)


class ViewApp(App[None]):
    """A world view and nothing else, on a screen that sends what changed alone."""

    def __init__(
        self,
        encoder: Encoder | None = None,
        palette: Palette = ANSI_PALETTE,
        *,
        cropped: bool = True,
        clock: Callable[[], float] | None = None,
    ) -> None:
        super().__init__(driver_class=TapeDriver)
        self.theme = "ansi-dark"
        self.view = (WorldView if cropped else PlainView)(
            None if encoder is None else lambda: encoder, palette, **({"clock": clock} if clock else {})
        )
        self._cropped = cropped

    def compose(self) -> Any:
        yield self.view

    def on_ready(self) -> None:
        assert type(self.screen._compositor) is CroppingCompositor
        if not self._cropped:
            self.screen._compositor.__class__ = Compositor

    @property
    def terminal(self) -> TapeDriver:
        driver = self._driver
        assert isinstance(driver, TapeDriver)
        return driver


def run_in(
    app: App[None], script: Callable[[Pilot[None]], Coroutine[Any, Any, None]], size: tuple[int, int]
) -> None:
    """Runs the app in a terminal of this size until the script ends."""

    async def scripted(pilot: Pilot[None]) -> None:
        await pilot.pause()
        await script(pilot)
        app.exit()

    asyncio.run(app.run_async(size=size, auto_pilot=scripted))


def painted(app: App[Any]) -> Awaitable[bool]:
    """Waits until all that was to be drawn has been written."""
    written = asyncio.Event()
    app.screen.call_after_refresh(written.set)
    return written.wait()


class Display:
    """A terminal's screen, as pyte understands it."""

    def __init__(self, columns: int, rows: int) -> None:
        self._screen = pyte.Screen(columns, rows)
        self._stream = pyte.Stream(self._screen)

    def feed(self, text: str) -> None:
        self._stream.feed(text)

    @property
    def rows(self) -> list[str]:
        return [row.rstrip() for row in self._screen.display]

    def color(self, row: int, column: int) -> str:
        return str(self._screen.buffer[row][column].fg)

    def paper(self, row: int, column: int) -> str:
        return str(self._screen.buffer[row][column].bg)
