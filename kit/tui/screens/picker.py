"""A list to choose one thing from: maps, controllers. Arrow keys, Enter, Esc; typing narrows it."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Final

from rich.text import Text
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Vertical
from textual.screen import ModalScreen
from textual.widgets import Input, OptionList
from textual.widgets.option_list import Option

from kit.tui.rows.key_rows import bindings

WIDTH: Final = 76
LINE: Final = WIDTH - 6
"""Characters of a line, beside the border and the scroll bar."""


@dataclass(frozen=True, slots=True)
class PickerItem:
    """One line of the list: what choosing it returns, its name, and what is said of it."""

    key: str
    name: str
    text: str = ""


class Picker(ModalScreen[str | None]):
    """Returns the key of the choice, or None."""

    BINDINGS: ClassVar[list[BindingType]] = bindings("list")
    DEFAULT_CSS = f"""
    Picker {{ align: center middle; }}
    Picker > Vertical {{
        width: {WIDTH}; max-width: 100%; height: auto; max-height: 22; border: solid $foreground; padding: 0 1;
    }}
    Picker Input, Picker Input:focus {{ border: none; padding: 0; height: 1; background: transparent; }}
    Picker OptionList {{ border: none; padding: 0; height: auto; max-height: 19; background: transparent; }}
    """

    def __init__(self, title: str, choices: Sequence[PickerItem], chosen: str | None = None) -> None:
        super().__init__()
        self._title = title
        self._choices = tuple(choices)
        self._chosen = chosen
        self._width = max((len(choice.name) for choice in choices), default=0) + 2

    def compose(self) -> ComposeResult:
        with Vertical() as box:
            box.border_title = self._title
            box.border_subtitle = "arrows choose, Enter confirm, Esc back"
            yield Input(placeholder="type to filter", select_on_focus=False)
            yield OptionList()

    def on_mount(self) -> None:
        self.query_one(Input).cursor_blink = False
        self.query_one(OptionList).can_focus = False
        self._fill("")
        self.query_one(Input).focus()

    def on_input_changed(self, event: Input.Changed) -> None:
        self._fill(event.value)

    def on_input_submitted(self) -> None:
        options = self.query_one(OptionList)
        if options.highlighted is not None:
            self.dismiss(options.get_option_at_index(options.highlighted).id)

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        self.dismiss(event.option_id)

    def action_back(self) -> None:
        self.dismiss(None)

    def action_choose(self, columns: int, rows: int) -> None:
        options = self.query_one(OptionList)
        if options.option_count:
            at = (options.highlighted or 0) + rows
            options.highlighted = min(max(at, 0), options.option_count - 1)

    def _fill(self, name_filter: str) -> None:
        wanted = name_filter.casefold()
        shown = [choice for choice in self._choices if wanted in f"{choice.name} {choice.text}".casefold()]
        options = self.query_one(OptionList)
        options.clear_options()
        options.add_options(Option(self._line(choice), id=choice.key) for choice in shown)
        keys = [choice.key for choice in shown]
        if shown:
            options.highlighted = keys.index(self._chosen) if self._chosen in keys else 0

    def _line(self, choice: PickerItem) -> Text:
        """Name and text; what does not fit on a line stands below the text."""
        lines = textwrap.wrap(choice.text, max(20, LINE - self._width)) or [""]
        return Text(f"{choice.name:{self._width}}" + ("\n" + " " * self._width).join(lines))
