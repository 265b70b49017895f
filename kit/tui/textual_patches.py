"""What Textual does between a widget's strips and the terminal, where the kit needs it to be thriftier.

A widget says which spans of its lines are dirty. Textual's compositor cuts off what lies to the right of a
span but sends all that lies to its left, from the widget's edge on; with a wide widget and small changes
that is most of the bytes. ``crop_left`` makes a screen send the span and no more. It touches private names, so it is bound to the one Textual version it was read in; with any other, the screen
stays as it is and everything works, with more bytes.
"""

from __future__ import annotations

from importlib.metadata import version
from typing import Any, Final, TypeVar

from rich.console import Console
from rich.control import Control
from textual._compositor import ChopsUpdate, Compositor
from textual.app import App
from textual.screen import Screen

KNOWN_TEXTUAL: Final = "8.2.8"

ASK_CURSOR: Final = "\x1b[6n"
"""The terminal answers with its cursor position when it has dealt with all that was written before;
Textual turns the answer into ``events.CursorPosition``, sent to the app."""


Result = TypeVar("Result")


class CroppedUpdate(ChopsUpdate):
    """A partial update of the screen: the dirty spans alone."""

    def render_segments(self, console: Console) -> str:
        """The spans with their cursor moves, ready for the terminal."""
        sequences = []
        for y, left, right in self.spans:
            for end, (x, strip) in zip(self.chop_ends[y], self.chops[y].items(), strict=False):
                if strip is None or x >= right or end <= left:
                    continue
                first, last = max(x, left), min(end, right)
                sequences.append(Control.move_to(first, y).segment.text)
                sequences.append(strip.crop(first - x, last - x).render(console))
        return "".join(sequences)


class CroppingCompositor(Compositor):
    """Textual's compositor, but for partial updates."""

    def render_partial_update(self) -> ChopsUpdate | None:
        update = super().render_partial_update()
        return update and CroppedUpdate(update.chops, update.spans, update.chop_ends)


class ActivePaintScreen(Screen[Result]):
    """A screen that is not painted while another lies over it. Textual would paint both, whole, each time
    anything changes underneath, and from then on for every message."""

    @property
    def is_current(self) -> bool:
        return self.is_active


def crop_left(screen: Screen[Any]) -> bool:
    """Makes a screen send no more than what changed, from now on. False, and nothing done, if the installed
    Textual is not the one known here."""
    if version("textual") != KNOWN_TEXTUAL:
        return False
    # The same compositor with all it knows of the screen, but of the thriftier kind.
    screen._compositor.__class__ = CroppingCompositor
    return True


def ask_cursor(app: App[Any]) -> bool:
    """Asks the terminal for its cursor position, after all that was drawn so far. False where there is no
    terminal to ask."""
    driver = app._driver
    if driver is None or app.is_headless or app.is_web:
        return False
    driver.write(ASK_CURSOR)
    driver.flush()
    return True
