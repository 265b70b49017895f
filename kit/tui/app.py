"""The full-screen application. ``terminal.py`` decides its appearance before Textual is imported."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, ClassVar, Final

from textual import events, work
from textual.app import App
from textual.binding import Binding, BindingType
from textual.filter import DimFilter, LineFilter
from textual.screen import Screen

from kit.dialogue.actions import ScreenActions
from kit.render.palettes import COLOR_SCHEMES
from kit.tui.input.drive import ModeName
from kit.tui.input.driver import KeyDriver
from kit.tui.late_timers import fire_late_timers
from kit.tui.paper_filter import PaperFilter
from kit.tui.terminal import LEAST_SIZE, TerminalDecision
from kit.tui.theme import Theme, text_colors, textual_theme
from kit.tui.widgets.text_rows import ASCII_ONLY

FAINT: Final = DimFilter(0.68)
"""Faint texts of a theme keep two thirds of their contrast with the paper; Textual's half is hard to read on a light one."""


PAPER: Final = PaperFilter()


class KitApp(App[None]):
    """Opens one screen; screens open others."""

    TITLE = "kit"
    ENABLE_COMMAND_PALETTE = False
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("ctrl+c,ctrl+q", "quit", show=False, priority=True),
        Binding("ctrl+z", "suspend_process", show=False, priority=True),
        Binding("ctrl+p", "palette", show=False, priority=True),
    ]
    CSS = """
    Screen { background: transparent; }
    KitApp.-themed Screen { background: $background; color: $foreground; }
    KitApp.-themed Dialog { background: $background 55%; }
    KitApp.-themed Dialog > Vertical { background: $background; }
    ToastRack { align: center middle; overflow-y: hidden; }
    Toast, Toast.-information { width: 100%; max-width: 100%; margin: 0; padding: 0 1; border: none; background: $background; }
    KitApp.-ascii MessageDialog > Vertical, KitApp.-ascii Picker > Vertical { border: ascii $foreground; }
    """

    def __init__(self, terminal: TerminalDecision, workspace: Path | None = None) -> None:
        """``workspace``: the folder of the student's files; by default as ``open_workspace`` has it."""
        fire_late_timers()
        super().__init__(driver_class=KeyDriver, ansi_color=terminal.ansi)
        self.kit_theme = Theme.of(terminal)
        if terminal.ansi:
            self.theme = terminal.theme
        else:
            self.add_class("-themed")
            self.switch_theme(terminal.theme_name.value)
        self.set_class(terminal.glyphs.value == "ascii", ASCII_ONLY)
        self.workspace = workspace
        self._first: Screen[Any] | None = None
        self.drive_mode: ModeName | None = None
        """How keys drive, as the user chose it on one of the screens; None: as the terminal allows."""

    def on_resize(self, event: events.Resize) -> None:
        """Says so as long as the terminal is too small for what is shown."""
        self.clear_notifications()
        width, height = event.size
        if width < LEAST_SIZE[0] or height < LEAST_SIZE[1]:
            least = f"{LEAST_SIZE[0]}x{LEAST_SIZE[1]}"
            self.notify(f"{width}x{height} is too small: the kit needs {least}.", timeout=math.inf)

    def switch_theme(self, name: str) -> None:
        """Shows everything in the colours of this theme of ``COLOR_SCHEMES``."""
        scheme, has_256 = COLOR_SCHEMES[name], self.kit_theme.terminal.colour.value == "256"
        self.kit_theme.palette.update(scheme.palette(has_256))
        if has_256:  # Textual's own reduction turns a paper white pink
            scheme = scheme.reduced()
        self.register_theme(textual_theme(name, scheme))
        self.ansi_theme_dark = self.ansi_theme_light = text_colors(scheme)
        self.theme = f"kit-{name}"

    def get_line_filters(self) -> Sequence[LineFilter]:
        """Textual's own, with a fainter look and the terminal's own colours so that they can be read."""
        terminal = self.kit_theme.terminal
        is_paper = terminal.ansi and terminal.colour.value != "none" and terminal.theme_name.value == "light"
        filters = [FAINT if isinstance(each, DimFilter) else each for each in super().get_line_filters()]
        return [*filters, PAPER] if is_paper else filters

    @work(exclusive=True, group="palette")
    async def action_palette(self) -> None:
        """Opens the command palette over any screen."""
        from kit.tui.screens.palette import open_palette  # of no use to the first frame

        await open_palette(self, self.switch_theme)

    def on_mouse_scroll_down(self) -> None:
        self._turn_wheel("down")

    def on_mouse_scroll_up(self) -> None:
        self._turn_wheel("up")

    @work(group="wheel")
    async def _turn_wheel(self, key: str) -> None:
        """Where the screen chooses or scrolls with a key and nothing below the pointer has a use for the wheel, it does too."""
        actions: ScreenActions | None = getattr(self.screen, "screen_actions", None)
        for action in () if actions is None else actions.records:
            for keys, call in action.bindings:
                if key in keys.split(","):
                    await self.screen.run_action(call)

    def begin(self, screen: Screen[Any]) -> None:
        """Opens with this screen when it runs."""
        self._first = screen

    def action_glossary(self) -> None:
        """Opens the glossary over any screen."""
        from kit.tui.screens.glossary import open_glossary  # of no use to the first frame

        open_glossary(self)

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Leaves Ctrl-C to a screen that has an action for it, and Ctrl-Z to a text that takes a change back."""
        if action == "suspend_process" and hasattr(self.focused, "undo"):
            return False
        if action == "quit" and hasattr(self.screen, "action_interrupt"):
            return False
        return super().check_action(action, parameters)

    def on_mount(self) -> None:
        if self._first is not None:
            self.push_screen(self._first)
