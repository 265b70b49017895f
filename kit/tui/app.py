"""The full-screen face. What it looks like was decided before Textual was imported: see ``terminal.py``."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

from textual.app import App
from textual.binding import BindingType
from textual.screen import Screen

from kit.picture.encode import ENCODERS
from kit.picture.roles import PALETTES
from kit.tui.input.driver import KeyDriver
from kit.tui.screens.play import PlayScreen
from kit.tui.terminal import TerminalDecision

_PALETTE_OF = {"none": "none", "ansi16": "16", "256": "256", "truecolour": "truecolor"}


class KitApp(App[None]):
    """Opens one screen; screens open others."""

    TITLE = "kit"
    ENABLE_COMMAND_PALETTE = False
    BINDINGS: ClassVar[list[BindingType]] = []
    CSS = """
    Screen { background: transparent; }
    """

    def __init__(self, terminal: TerminalDecision) -> None:
        super().__init__(driver_class=KeyDriver, ansi_color=terminal.ansi)
        self.terminal = terminal
        self._first: Screen[None] | None = None
        self.theme = terminal.theme

    def begin(self, screen: Screen[None]) -> None:
        """Opens with this screen when it runs."""
        self._first = screen

    def on_mount(self) -> None:
        if self._first is not None:
            self.push_screen(self._first)

    def play(self, place: str, controller: str, *, case: str | None, folder: Path, seed: int) -> PlayScreen:
        """The screen to begin with."""
        colour = self.terminal.colour.value
        return PlayScreen(
            place,
            controller,
            case=case,
            folder=folder,
            terminal=self.terminal,
            encoder=ENCODERS[self.terminal.glyphs.value](colour == "none"),
            palette=PALETTES[_PALETTE_OF[colour]],
            seed=seed,
        )
