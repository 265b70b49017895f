"""Replaces Textual's steps between a widget's strips and the terminal by cheaper ones.

A widget says which spans of its lines are dirty. Textual's compositor cuts off what lies to the right of a
span but sends all that lies to its left, from the widget's edge on; with a wide widget and small changes
that is most of the bytes. ``crop_left`` makes a screen send the span and no more, and of its colours only what differs from
the characters sent before (``text_pieces``), where Textual names all of them with each piece of text. ``write_runs`` sends
a widget's characters without asking the compositor, which takes twice as long as to draw them. Both touch private names,
so they are bound to the one Textual version they were read in; with any other, the screen stays as it is and everything
works, with more bytes.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final, NamedTuple, TypeVar

import textual
import textual.message_pump
from rich.color import ColorSystem
from rich.console import Console
from rich.style import Style
from textual import events, on
from textual._compositor import ChopsUpdate, Compositor, CompositorUpdate
from textual.app import App
from textual.geometry import Offset, Size
from textual.screen import Screen
from textual.widget import Widget

from kit.tui.text_pieces import (
    NULL_STYLE,
    TextPiece,
    joined_pieces,
    piece_of_segment,
    shortest_text,
    style_codes,
)

KNOWN_TEXTUAL: Final = "8.2.8"

ASK_CURSOR: Final = "\x1b[6n"
"""The terminal answers with its cursor position when it has dealt with all that was written before;
Textual turns the answer into ``events.CursorPosition``, sent to the app."""
FITTING_S: Final = 0.3
"""Seconds after a change of the terminal's size in which a covered screen is painted."""
Result = TypeVar("Result")


def is_installed(version: str) -> bool:
    """Whether this version of Textual is installed. Where pip left its record beside it, nothing slow is imported."""
    if (Path(textual.__file__).parents[1] / f"textual-{version}.dist-info").is_dir():
        return True
    from importlib import metadata

    return metadata.version("textual") == version


class CroppedUpdate(ChopsUpdate):
    """A partial update of the screen: the dirty spans alone."""

    def render_segments(self, console: Console) -> str:
        """The spans with their cursor moves, ready for the terminal."""
        pieces = self._pieces(console._color_system or ColorSystem.TRUECOLOR)
        return shortest_text(pieces, max(ends[-1] for ends in self.chop_ends if ends))

    def _pieces(self, system: ColorSystem) -> list[TextPiece]:
        pieces: list[TextPiece] = []
        for y, left, right in self.spans:
            for end, (x, strip) in zip(self.chop_ends[y], self.chops[y].items(), strict=False):
                if strip is None or x >= right or end <= left:
                    continue
                place = max(x, left)
                for segment in strip.crop(place - x, min(end, right) - x):
                    piece = piece_of_segment(y, place, segment, system)
                    place += piece.width
                    joined = joined_pieces(pieces[-1], piece) if pieces else None
                    if joined is None:
                        pieces.append(piece)
                    else:
                        pieces[-1] = joined
        return pieces


class PlacedRun(NamedTuple):
    """Text of one style in a widget's row, each character one cell wide."""

    y: int
    x: int
    text: str
    style: Style | None


class _RunsUpdate(CompositorUpdate):
    """Runs of one widget, as an update of the screen."""

    def __init__(self, runs: Iterable[PlacedRun], origin: Offset, screen_width: int) -> None:
        self._runs = runs
        self._origin = origin
        self._screen_width = screen_width

    def render_segments(self, console: Console) -> str:
        system = console._color_system or ColorSystem.TRUECOLOR
        left, top = self._origin
        pieces = [
            TextPiece(
                y + top, x + left, len(text), text, style_codes(style or NULL_STYLE, system, text.isspace())
            )
            for y, x, text, style in self._runs
        ]
        return shortest_text(pieces, self._screen_width)


class CroppingCompositor(Compositor):
    """Textual's compositor, but for partial updates."""

    def render_partial_update(self) -> ChopsUpdate | None:
        update = super().render_partial_update()
        return update and CroppedUpdate(update.chops, update.spans, update.chop_ends)


class ActivePaintScreen(Screen[Result]):
    """A screen that is not painted while another lies over it, but for a moment after the terminal has got another size. Textual
    would paint both, whole, each time anything changes underneath, and from then on for every message."""

    _fitted_to: Size | None = None
    """The size of the terminal for which it has been painted."""

    @property
    def is_current(self) -> bool:
        return self.is_active or (self.is_attached and self._fitted_to not in {None, self.app.size})

    @on(events.Resize)
    def _note_size_later(self) -> None:
        self.set_timer(FITTING_S, self._note_size)

    def _note_size(self) -> None:
        self._fitted_to = self.app.size


def crop_left(screen: Screen[Any]) -> bool:
    """Makes a screen send no more than what changed, from now on. False, and nothing done, if the installed
    Textual is not the one known here."""
    if not is_installed(KNOWN_TEXTUAL):
        return False
    # The same compositor with all it knows of the screen, but of the thriftier kind.
    screen._compositor.__class__ = CroppingCompositor
    return True


def write_runs(widget: Widget, runs: Iterable[PlacedRun]) -> bool:
    """Writes a widget's runs to the terminal at once. False, and nothing done, where the compositor has to: the screen does
    not crop, is not the one on top, or is to be laid out or painted anyway, or something lies over the widget."""
    app, screen = widget.app, widget.screen
    compositor = screen._compositor
    if (
        type(compositor) is not CroppingCompositor
        or app.screen is not screen
        or app.is_inline
        or app._batch_count
        or widget._repaint_required
        or widget in screen._dirty_widgets
        or screen._layout_required
        or screen._scroll_required
        or screen._repaint_required
        or screen._recompose_required
    ):
        return False
    visible = compositor.visible_widgets
    if widget not in visible:
        return False
    region, clip = visible[widget]
    if not clip.contains_region(region):
        return False
    for above, (its_region, its_clip) in visible.items():  # from the front to the back
        if above is widget:
            break
        if its_region.intersection(its_clip).overlaps(region):
            return False
    update: Any = _RunsUpdate(runs, region.offset, compositor.size.width)  # whose type Textual does not name
    app._display(screen, update)
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
