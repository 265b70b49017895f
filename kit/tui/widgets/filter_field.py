"""A field in place of a screen's keys, whose text filters what the screen lists."""

from __future__ import annotations

from textual.widgets import Input

from kit.tui.widgets.text_field import KitInput
from kit.tui.widgets.text_rows import RowsScreen


class FilterField(KitInput):
    """Where the text is typed; the arrows are the list's."""

    DEFAULT_CSS = """
    FilterField, FilterField:focus { display: none; border: none; padding: 0; height: 1; background: transparent; }
    """

    def __init__(self) -> None:
        super().__init__(
            placeholder="part of a name; Enter keeps the filter, Esc shows all", select_on_focus=False
        )
        self.cursor_blink = False


class FilteredScreen(RowsScreen[None]):
    """A screen with the action ``filter``, whose ``compose`` ends in its keys and a ``FilterField``."""

    filter_text = ""
    """What is typed; empty where all is shown."""

    def on_filter(self) -> None:
        """Is called after each change of ``filter_text``."""
        raise NotImplementedError

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        # Before all others, so that letters that come with it reach the field; in the field it is a letter itself.
        return action != "filter" or (self.is_mounted and self.focused is None)

    def action_filter(self) -> None:
        self._show_field(True)

    def on_input_changed(self, event: Input.Changed) -> None:
        self.filter_text = event.value
        self.on_filter()

    def on_input_submitted(self) -> None:
        self._show_field(False)

    def leave_field(self) -> bool:
        """Closes the field and shows all; False: it is not open."""
        if self.focused is None:
            return False
        self.show_all()
        self._show_field(False)
        return True

    def show_all(self) -> None:
        """Takes the filter away."""
        self.query_one(FilterField).value = ""

    def _show_field(self, shown: bool) -> None:
        """The field in place of the keys, or the keys. At once: the next letters may be here already."""
        field = self.query_one(FilterField)
        field.display, self._rows("keys").display = shown, not shown
        self.set_focus(field if shown else None)
