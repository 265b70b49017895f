"""What Textual does between a widget's strips and the terminal, where the kit needs it to be thriftier.

A widget says which spans of its lines are dirty. Textual's compositor cuts off what lies to the right of a
span but sends all that lies to its left, from the widget's edge on; with a wide widget and small changes
that is most of the bytes. ``crop_left`` makes a screen send the span and no more, and of its colours only what differs from
the characters sent before, where Textual names all of them with each piece of text. It touches private names, so it is
bound to the one Textual version it was read in; with any other, the screen stays as it is and everything works, with
more bytes.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any, Final, NamedTuple, TypeVar

import textual
from rich.color import ColorSystem
from rich.console import Console
from rich.control import Control
from rich.style import Style
from textual._compositor import ChopsUpdate, Compositor
from textual.app import App
from textual.screen import Screen

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
        sequences = []
        pen = _Pen(console)
        for y, left, right in self.spans:
            for end, (x, strip) in zip(self.chop_ends[y], self.chops[y].items(), strict=False):
                if strip is None or x >= right or end <= left:
                    continue
                first, last = max(x, left), min(end, right)
                sequences.append(Control.move_to(first, y).segment.text)
                sequences += [
                    pen.write(segment.text, segment.style) for segment in strip.crop(first - x, last - x)
                ]
        return "".join((*sequences, pen.reset()))


class _StyleCodes(NamedTuple):
    """SGR codes of a style."""

    attributes: tuple[str, ...]
    """Bold, dim and so on."""
    foreground: str
    background: str


_DEFAULT_CODES: Final = _StyleCodes((), "39", "49")


@lru_cache(maxsize=4096)
def _style_codes(style: Style, system: ColorSystem) -> _StyleCodes:
    attributes = tuple(
        code for code, name in _ATTRIBUTES.items() if getattr(style, name)
    )  # rich keeps the colours' codes apart from these
    colors = [
        ";".join(color.downgrade(system).get_ansi_codes(foreground=is_foreground)) if color else default
        for color, is_foreground, default in ((style.color, True, "39"), (style.bgcolor, False, "49"))
    ]
    return _StyleCodes(attributes, *colors)


_ATTRIBUTES: Final = {
    "1": "bold", "2": "dim", "3": "italic", "4": "underline", "5": "blink", "7": "reverse", "9": "strike",
}  # fmt: skip


class _Pen:
    """What the terminal writes with, from one text to the next: only what changes is sent."""

    def __init__(self, console: Console) -> None:
        self._system = console._color_system or ColorSystem.TRUECOLOR
        self._held = _DEFAULT_CODES

    def write(self, text: str, style: Style | None) -> str:
        """The text, after what makes the pen write in this style."""
        if style is not None and style.link:
            return self.reset() + style.render(text, color_system=self._system)
        wanted = _style_codes(style, self._system) if style is not None else _DEFAULT_CODES
        if wanted == self._held:
            return text
        held, self._held = self._held, wanted
        changes: list[str] = []
        if wanted == _DEFAULT_CODES or not set(held.attributes) <= set(wanted.attributes):
            changes, held = ["0"], _DEFAULT_CODES
        changes += [code for code in wanted.attributes if code not in held.attributes]
        changes += [wanted.foreground] if wanted.foreground != held.foreground else []
        changes += [wanted.background] if wanted.background != held.background else []
        return f"\x1b[{';'.join(changes)}m{text}"

    def reset(self) -> str:
        """What makes the pen the terminal's own again."""
        if self._held == _DEFAULT_CODES:
            return ""
        self._held = _DEFAULT_CODES
        return "\x1b[0m"


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


def ask_cursor(app: App[Any]) -> bool:
    """Asks the terminal for its cursor position, after all that was drawn so far. False where there is no
    terminal to ask."""
    driver = app._driver
    if driver is None or app.is_headless or app.is_web:
        return False
    driver.write(ASK_CURSOR)
    driver.flush()
    return True
