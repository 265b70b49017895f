"""Textual's text area in the kit's few styles, and a field of it in which a student writes an answer."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar, Final, Literal

from rich.style import Style
from textual import events
from textual._text_area_theme import TextAreaTheme
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.widget import Widget
from textual.widgets import Input, TextArea

_NAME: Final = "kit"
_NO_STYLES: Final[Mapping[str, Style]] = MappingProxyType({})


class EditorLeft(Message):
    """Esc was pressed in a text."""


class AnswerEntered(Message):
    """Enter was pressed in an answer."""


class OrderedKeys:
    """A part of a widget: edits its text by a key of its own before the next key is read.

    Textual hands a key that is no letter on to the app, which finds its binding: letters that arrive in the same read, as they do
    over a slow line, would be typed before a Backspace or an arrow that was pressed before them. Keys for the screen go that way
    all the same, in their order.
    """

    async def on_key(self, event: events.Key) -> None:
        assert isinstance(self, Widget)  # a base that is one would take the place of the other one's styles
        for binding in self._bindings.key_to_bindings.get(event.key, ()):
            is_for_screen = binding.action == "submit" or "." in binding.action
            if not is_for_screen and await self.app.run_action(binding.action, self):
                event.prevent_default()
                event.stop()
                return


class KitInput(OrderedKeys, Input):
    """A text in one line."""


class KitTextArea(OrderedKeys, TextArea):
    """A text area whose cursor does not blink. ``syntax_styles``: of the names that ``highlight`` gives."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("ctrl+home", "to_text(False)", show=False),
        Binding("ctrl+end", "to_text(True)", show=False),
    ]

    def __init__(
        self,
        *,
        tab_behavior: Literal["focus", "indent"] = "focus",
        show_line_numbers: bool = False,
        soft_wrap: bool = True,
        syntax_styles: Mapping[str, Style] = _NO_STYLES,
    ) -> None:
        self._syntax_styles = syntax_styles
        super().__init__(tab_behavior=tab_behavior, show_line_numbers=show_line_numbers, soft_wrap=soft_wrap)
        self.cursor_blink = False

    def on_mount(self) -> None:
        self.register_theme(
            TextAreaTheme(
                _NAME,
                cursor_style=Style(reverse=True),
                gutter_style=Style(dim=True),
                cursor_line_gutter_style=Style(bold=True),
                bracket_matching_style=Style(bold=True, underline=True),
                selection_style=Style(reverse=True),
                syntax_styles=dict(self._syntax_styles),
            )
        )
        self.theme = _NAME

    def action_to_text(self, at_end: bool) -> None:
        """Puts the cursor at the beginning of the text, or at its end."""
        self.move_cursor(self.document.end if at_end else self.document.start)

    async def on_key(self, event: events.Key) -> None:
        """Esc leaves, where Textual would give the focus to whatever comes next."""
        if event.key == "escape":
            event.prevent_default()
            event.stop()
            self.post_message(EditorLeft())


class AnswerField(KitTextArea):
    """Takes a text of one paragraph, which is wrapped to the field's width; Enter ends it."""

    DEFAULT_CSS = """
    AnswerField, AnswerField:focus { height: 6; border: solid $foreground; padding: 0 1; background: transparent; }
    .-ascii AnswerField, .-ascii AnswerField:focus { border: ascii $foreground; }
    """

    async def on_key(self, event: events.Key) -> None:
        if event.key == "enter":
            event.prevent_default()
            event.stop()
            self.post_message(AnswerEntered())

    @property
    def answer(self) -> str:
        """The text in one line: what was pasted may have several."""
        return " ".join(line.strip() for line in self.text.splitlines()).strip()
