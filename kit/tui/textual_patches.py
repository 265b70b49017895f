"""Replaces Textual's steps between a widget's strips and the terminal by cheaper ones.

A widget says which spans of its lines are dirty. Textual's compositor cuts off what lies to the right of a
span but sends all that lies to its left, from the widget's edge on; with a wide widget and small changes
that is most of the bytes. ``crop_left`` makes a screen send the span and no more, and of its colours only what differs from
the characters sent before, where Textual names all of them with each piece of text. ``write_runs`` sends a widget's characters
without asking the compositor, which takes twice as long as to draw them. Both touch private names, so they are bound to the
one Textual version they were read in; with any other, the screen stays as it is and everything works, with more bytes.

``fire_late_timers`` mends a fault of Textual's: a timer that should fire once never fires where its task starts late.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, Final, NamedTuple, TypeVar

import textual
import textual.message_pump
from rich.color import ColorSystem
from rich.console import Console
from rich.segment import Segment
from rich.style import Style
from textual._compositor import ChopsUpdate, Compositor, CompositorUpdate
from textual.app import App
from textual.geometry import Offset
from textual.screen import Screen
from textual.timer import Timer
from textual.widget import Widget

KNOWN_TEXTUAL: Final = "8.2.8"

ASK_CURSOR: Final = "\x1b[6n"
"""The terminal answers with its cursor position when it has dealt with all that was written before;
Textual turns the answer into ``events.CursorPosition``, sent to the app."""


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
        return _shortest(pieces, max(ends[-1] for ends in self.chop_ends if ends))

    def _pieces(self, system: ColorSystem) -> list[_Piece]:
        pieces: list[_Piece] = []
        for y, left, right in self.spans:
            for end, (x, strip) in zip(self.chop_ends[y], self.chops[y].items(), strict=False):
                if strip is None or x >= right or end <= left:
                    continue
                place = max(x, left)
                for segment in strip.crop(place - x, min(end, right) - x):
                    piece = _piece(y, place, segment, system)
                    place += piece.width
                    joined = _joined(pieces[-1], piece) if pieces else None
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
            _Piece(
                y + top, x + left, len(text), text, _style_codes(style or _NULL_STYLE, system, text.isspace())
            )
            for y, x, text, style in self._runs
        ]
        return _shortest(pieces, self._screen_width)


_NULL_STYLE: Final = Style.null()


class _StyleCodes(NamedTuple):
    """SGR codes of a style."""

    background: str
    attributes: tuple[str, ...]
    """Bold, dim and so on."""
    foreground: str | None
    """None: there is nothing to see of it, nor of the attributes."""


_DEFAULT_CODES: Final = _StyleCodes("49", (), "39")


@lru_cache(maxsize=4096)
def _style_codes(style: Style, system: ColorSystem, is_blank: bool) -> _StyleCodes:
    attributes = tuple(
        code for code, name in _ATTRIBUTES.items() if getattr(style, name)
    )  # rich keeps the colours' codes apart from these
    foreground, background = (
        ";".join(color.downgrade(system).get_ansi_codes(foreground=is_foreground)) if color else default
        for color, is_foreground, default in ((style.color, True, "39"), (style.bgcolor, False, "49"))
    )
    if is_blank and _SEEN_ON_BLANKS.isdisjoint(attributes):
        return _StyleCodes(background, (), None)
    return _StyleCodes(background, attributes, foreground)


_ATTRIBUTES: Final = {
    "1": "bold", "2": "dim", "3": "italic", "4": "underline", "5": "blink", "7": "reverse", "9": "strike",
}  # fmt: skip

_SEEN_ON_BLANKS: Final = frozenset("479")

_WEIGHTS: Final = frozenset("12")
"""Attributes that one short code takes away, leaving the colours."""

_NORMAL_WEIGHT: Final = "22"


class _Piece(NamedTuple):
    """Text of one style in a row."""

    y: int
    x: int
    width: int
    """Width of the text, in cells."""
    text: str
    codes: _StyleCodes


def _piece(y: int, x: int, segment: Segment, system: ColorSystem) -> _Piece:
    text, style, _ = segment
    if style is None:
        style = Style.null()
    if style.link:
        return _Piece(y, x, segment.cell_length, style.render(text, color_system=system), _DEFAULT_CODES)
    codes = _style_codes(style, system, is_blank=not text.strip(" "))
    return _Piece(y, x, segment.cell_length, text, codes)


def _joined(one: _Piece, other: _Piece) -> _Piece | None:
    """One piece of two, if the other goes on where the one ends and a style does for both."""
    if (one.y, one.x + one.width) != (other.y, other.x) or one.codes.background != other.codes.background:
        return None
    codes = other.codes if one.codes.foreground is None else one.codes
    if one.codes != other.codes:
        if None not in (one.codes.foreground, other.codes.foreground):
            return None
        if not _SEEN_ON_BLANKS.isdisjoint(codes.attributes):
            return None
    return _Piece(one.y, one.x, one.width + other.width, one.text + other.text, codes)


def _by_style(piece: _Piece) -> tuple[object, ...]:
    background, attributes, foreground = piece.codes
    return background, foreground or "", attributes, piece.y, piece.x


def _shortest(pieces: Sequence[_Piece], screen_width: int) -> str:
    """The pieces from the top down, or style by style where that is shorter, since to name a style in true colours costs
    more bytes than to move the cursor."""
    in_order = _written(pieces, screen_width)
    if len({piece.codes for piece in pieces}) == len(pieces):
        return in_order
    return min(in_order, _written(sorted(pieces, key=_by_style), screen_width), key=len)


def _written(pieces: Iterable[_Piece], screen_width: int) -> str:
    """The pieces in this order, each at its place. Of a style only what differs from the one before is sent."""
    sequences: list[str] = []
    held = _DEFAULT_CODES
    cursor: tuple[int, int] | None = None
    for y, x, width, text, codes in pieces:
        if cursor != (y, x):
            sequences.append(_move(cursor, y, x))
        if codes != held:
            changes, held = _style_change(held, codes)
            sequences.append(changes)
        sequences.append(text)
        is_known = x + width < screen_width and text and max(text) < _UNSURE_WIDTHS
        cursor = (y, x + width) if is_known else None
    if held != _DEFAULT_CODES:
        sequences.append("\x1b[0m")
    return "".join(sequences)


_UNSURE_WIDTHS: Final = "\u2900"
"""From here on, behind letters, boxes and braille, terminals do not agree how wide a character is."""


def _move(cursor: tuple[int, int] | None, y: int, x: int) -> str:
    """The shortest way from the cursor's row and column, None if not known, to row ``y`` and column ``x``."""
    absolute = f"\x1b[{y + 1};{x + 1}H"
    down = y - cursor[0] if cursor else -1
    if cursor is None or down not in (0, 1):
        return absolute
    right = x - cursor[1]
    relative = "\x1b[B" if down else ""
    if right > 0:
        relative += f"\x1b[{right}C" if right > 1 else "\x1b[C"
    elif right < 0:
        relative += "\b" * -right if right >= -4 else f"\x1b[{-right}D"
    return relative if len(relative) < len(absolute) else absolute


@lru_cache(maxsize=4096)
def _style_change(held: _StyleCodes, wanted: _StyleCodes) -> tuple[str, _StyleCodes]:
    """Returns the sequence that changes a terminal's style from the held one to the wanted one, and the style it then has."""
    if wanted.foreground is None:
        if _SEEN_ON_BLANKS.isdisjoint(held.attributes):
            wanted = held._replace(background=wanted.background)
        else:
            wanted = _DEFAULT_CODES._replace(background=wanted.background)
    now, changes = held, []
    dropped = set(held.attributes) - set(wanted.attributes)
    if wanted == _DEFAULT_CODES or not dropped <= _WEIGHTS:
        now, changes = _DEFAULT_CODES, ["0"]
    elif dropped:
        now = held._replace(attributes=tuple(code for code in held.attributes if code not in _WEIGHTS))
        changes = [_NORMAL_WEIGHT]
    changes += [code for code in wanted.attributes if code not in now.attributes]
    changes += [wanted.foreground] if wanted.foreground and wanted.foreground != now.foreground else []
    changes += [wanted.background] if wanted.background != now.background else []
    return (f"\x1b[{';'.join(changes)}m" if changes else ""), wanted


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


class OneShotTimer(Timer):
    """A timer that leaves out no call if it fires a limited number of times.

    Textual's leaves out the calls whose time has passed when its task gets to run. Of a timer that fires once there is no
    other: on a busy machine the app then keeps a size that the terminal no longer has, and a picture stands still.
    """

    def __init__(self, *args: Any, repeat: int | None = None, skip: bool = True, **options: Any) -> None:
        super().__init__(*args, repeat=repeat, skip=skip and repeat is None, **options)


def fire_late_timers() -> None:
    """From now on ``set_timer`` calls back even if it is late, in widgets, screens and apps, Textual's own calls among them."""
    setattr(textual.message_pump, "Timer", OneShotTimer)  # noqa: B010  # mypy takes no assignment to a class's name
