"""A dialog that asks for a name."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Vertical
from textual.screen import ModalScreen
from textual.widgets import Input

from kit.tui.screens.message_dialog import WIDTH


class NameDialog(ModalScreen[str | None]):
    """Returns what was typed, or None if nothing was."""

    BINDINGS: ClassVar[list[BindingType]] = [("escape", "back", "")]
    DEFAULT_CSS = f"""
    NameDialog {{ align: center middle; }}
    NameDialog > Vertical {{ width: {WIDTH}; max-width: 100%; height: auto; border: solid $foreground; padding: 0 1; }}
    NameDialog Input, NameDialog Input:focus {{ border: none; padding: 0; height: 1; background: transparent; }}
    """

    def __init__(self, title: str, value: str = "") -> None:
        super().__init__()
        self._title = title
        self._value = value

    def compose(self) -> ComposeResult:
        with Vertical() as box:
            box.border_title = self._title
            box.border_subtitle = "Enter confirm, Esc back"
            yield Input(self._value, select_on_focus=False)

    def on_mount(self) -> None:
        field = self.query_one(Input)
        field.cursor_blink = False
        field.focus()

    def on_input_submitted(self, event: Input.Submitted) -> None:
        self.dismiss(event.value.strip() or None)

    def action_back(self) -> None:
        self.dismiss(None)
