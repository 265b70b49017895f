"""A dialog: a box over a screen, which stays to be seen behind it, fainter than the box."""

from __future__ import annotations

from typing import Final, TypeVar

from rich.console import Console, ConsoleOptions, RenderableType, RenderResult
from rich.segment import Segment
from rich.style import Style
from textual import events
from textual.screen import ModalScreen

Result = TypeVar("Result")

FAINT: Final = Style(dim=True, bold=False)


class FaintPicture:
    """Something drawn, in the faint look that a terminal has for its own colours, and where it has none."""

    def __init__(self, drawn: RenderableType) -> None:
        self._drawn = drawn

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        for text, style, control in console.render(self._drawn, options):
            yield Segment(text, style if control else (style or Style.null()) + FAINT, control)


class Dialog(ModalScreen[Result]):
    """A box in the middle of the screen. In the colours of a theme what lies behind takes on the theme's paper; where the
    colours are the terminal's own, it is faint."""

    DEFAULT_CSS = """
    Dialog { align: center middle; }
    """

    def on_click(self, event: events.Click) -> None:
        """A click beside the box closes it."""
        if event.widget is self and self.is_active:
            self.close()

    def close(self) -> None:
        """Gives up what the dialog asks for."""
        self.dismiss(None)

    def render(self) -> RenderableType:
        shown = super().render()
        return FaintPicture(shown) if self.app.native_ansi_color else shown
