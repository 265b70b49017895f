"""A list over a screen to choose from; what is typed filters it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Final

from rich.text import Text
from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.widgets import Input, OptionList
from textual.widgets.option_list import Option

from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import ScreenAction
from kit.plain_text import wrap
from kit.tui.rows.key_rows import bindings
from kit.tui.screens.dialog import Dialog
from kit.tui.widgets.text_field import KitInput
from kit.tui.widgets.text_rows import LOOKS

LIST_WIDTH, WIDEST = 76, 120
"""Columns of a list with its border, at least where the screen has them, and at most."""
HIGHEST: Final = 22
"""Most rows of a list with its border and the field above it, on a screen that is not much higher."""
ROWS_AROUND: Final = 3
"""Rows of these alone."""
CHOOSING: Final = "arrows choose, Enter confirm, Esc back"
NOTHING_FOUND: Final = "Nothing here has these words."
READING: Final = "Reading what else there is ..."
WAY_ON: Final = "Backspace takes letters back; fewer of them may find it."
DELETING: Final = "Backspace delete, Esc back"
COLUMNS_AROUND: Final = 7
"""Columns of the border, of the mark of the chosen line and of the scroll bar."""
WIDEST_NAME, WIDEST_WHERE_NARROW = 24, 16
"""Columns of the names, and where the list is no wider than its least; after a longer one its text begins later."""
FILTER_HINT: Final = "type to filter"
FILTERED_FROM: Final = 8
"""Lines from which on a list says that typing filters it."""


@dataclass(frozen=True, slots=True)
class PickerItem:
    """One line of the list: what choosing it returns, its name, and what is said of it."""

    key: str
    name: str
    text: str = ""
    words: str = ""
    """Words that are not shown, and by which it is found too."""

    def rank(self, wanted: Sequence[str]) -> int | None:
        """The place of the line among those with all these words, in small letters: first those whose names begin with them, then
        those that have them in their names; None: it has not all of them."""
        name, text = self.name.casefold(), self.text.casefold()
        if not all(each in f"{name} {text} {self.words}" for each in wanted):
            return None
        if " ".join(wanted) in name:
            return 0 if name.startswith(" ".join(wanted)) else 1
        return 2 if all(each in name for each in wanted) else 3


class FilterInput(KitInput):
    """The field above a list; Home and End are the list's."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("home", "screen.choose(0, -1000)", show=False),
        Binding("end", "screen.choose(0, 1000)", show=False),
    ]


class ChoiceList(OptionList):
    """The list below it: the wheel chooses, as arrow keys do."""

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        event.prevent_default()

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        event.prevent_default()


class Picker(Dialog[str | None]):
    """Returns the key of the choice, or None."""

    screen_actions = ScreenActions(
        "list",
        ("choose", "back"),
        ("type",),
        own=(
            ScreenAction("type", "letters", "filter", "show only lines that contain what you type", ()),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = f"""
    Picker > Vertical {{
        width: {LIST_WIDTH}; max-width: 100%; height: auto; border: solid $foreground; padding: 0 1;
    }}
    Picker Input, Picker Input:focus {{ border: none; padding: 0; height: 1; background: transparent; }}
    Picker OptionList {{
        border: none; padding: 0; height: auto; background: transparent; scrollbar-size-vertical: 1;
        scrollbar-color: $foreground 50%; scrollbar-background: $background;
        scrollbar-color-hover: $foreground; scrollbar-background-hover: $background;
        scrollbar-color-active: $foreground; scrollbar-background-active: $background;
    }}
    Picker OptionList > .option-list--option-highlighted {{
        color: $foreground; background: transparent; text-style: none;
    }}
    """

    def __init__(self, title: str, choices: Sequence[PickerItem], chosen: str | None = None) -> None:
        super().__init__()
        self._title = title
        self._chosen = chosen
        self._shown: list[PickerItem] = []
        """The lines that match what is typed."""
        self._marked = 0
        """Number of the line that is marked as the chosen one."""
        self._is_entered = False
        """Whether Enter was pressed where nothing matched: what is still to come may match."""
        self.reads_more = False
        """Whether more choices are to follow."""
        self.replace_choices(choices)

    def compose(self) -> ComposeResult:
        with Vertical() as box:
            box.border_title = self._title
            box.border_subtitle = CHOOSING
            yield FilterInput(placeholder=self._hint, select_on_focus=False)
            yield ChoiceList()

    def on_mount(self) -> None:
        self.query_one(Input).cursor_blink = False
        self.query_one(OptionList).can_focus = False
        self._fill("")
        self.query_one(Input).focus()

    def on_resize(self, event: events.Resize) -> None:
        self.query_one(OptionList).styles.max_height = max(1, self._highest - ROWS_AROUND)
        self.replace_choices(self._choices)

    @property
    def _highest(self) -> int:
        """Most rows of the list with what is around it: a high screen shows more than the lowest."""
        return min(self.size.height, max(HIGHEST, self.size.height * 3 // 4))

    def on_input_changed(self, event: Input.Changed) -> None:
        self._is_entered = False
        self._fill(event.value)

    def on_input_submitted(self) -> None:
        options = self.query_one(OptionList)
        self._is_entered = options.highlighted is None
        if self._shown and options.highlighted is not None:
            self.dismiss(options.get_option_at_index(options.highlighted).id)

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        self.dismiss(event.option_id)

    def action_back(self) -> None:
        self.dismiss(None)

    def close(self) -> None:
        self.action_back()

    def action_choose(self, columns: int, rows: int) -> None:
        options = self.query_one(OptionList)
        if self._shown:
            at = (options.highlighted or 0) + rows
            options.highlighted = min(max(at, 0), options.option_count - 1)

    def replace_choices(self, choices: Sequence[PickerItem]) -> None:
        """Shows these from now on, with what is typed and highlighted as it is."""
        self._choices = tuple(choices)
        is_narrow = self.is_attached and self.size.width < LIST_WIDTH + WIDEST_WHERE_NARROW
        widest = WIDEST_WHERE_NARROW if is_narrow else WIDEST_NAME
        self._width = min(max((len(choice.name) for choice in choices), default=0), widest) + 2
        longest = max((len(choice.text) for choice in choices), default=0) + self._width + COLUMNS_AROUND
        self._columns = max(LIST_WIDTH, min(longest, WIDEST))
        if self.is_mounted and self.is_attached:
            self.query_one(Input).placeholder = self._hint
            options = self.query_one(OptionList)
            self.query_one(Vertical).styles.width = self._columns
            if options.highlighted is not None:
                self._chosen = options.get_option_at_index(options.highlighted).id
            self._fill(self.query_one(Input).value)
            if self._is_entered:
                self.on_input_submitted()

    @property
    def _hint(self) -> str:
        return FILTER_HINT if len(self._choices) >= FILTERED_FROM else ""

    def _fill(self, name_filter: str) -> None:
        wanted = name_filter.casefold().split()
        ranked = [(rank, choice) for choice in self._choices if (rank := choice.rank(wanted)) is not None]
        shown = [choice for _, choice in sorted(ranked, key=lambda each: each[0])]
        options = self.query_one(OptionList)
        keys = [choice.key for choice in shown]
        at = keys.index(self._chosen) if self._chosen in keys else 0
        options.clear_options()
        options.add_options(
            Option(self._line(choice, is_chosen=number == at), id=choice.key)
            for number, choice in enumerate(shown)
        )
        self._shown, self._marked = shown, at
        if not shown:
            said = READING if self.reads_more else f"{NOTHING_FOUND}\n{WAY_ON}"
            options.add_option(Option(Text(said), disabled=True))
        self.query_one(Vertical).border_subtitle = CHOOSING if shown else DELETING
        if not wanted:  # a filter leaves the list as high as it is, so that it does not move
            rows = sum(
                option.prompt.plain.count("\n") + 1
                for option in options.options
                if isinstance(option.prompt, Text)
            )
            self.query_one(Vertical).styles.min_height = min(rows + ROWS_AROUND, self._highest)
        if shown:
            options.highlighted = at

    def on_option_list_option_highlighted(self, event: OptionList.OptionHighlighted) -> None:
        """Marks the chosen line: in the terminal's own colours, Textual's highlight looks like any other line."""
        for number in {self._marked, event.option_index}:
            if number < len(self._shown):
                line = self._line(self._shown[number], is_chosen=number == event.option_index)
                event.option_list.replace_option_prompt_at_index(number, line)
        self._marked = event.option_index

    def _line(self, choice: PickerItem, *, is_chosen: bool) -> Text:
        """Name and text; what does not fit on a line stands below the text."""
        name = f"{choice.name}  ".ljust(self._width)
        room = max(20, min(self._columns, self.size.width) - COLUMNS_AROUND - self._width)
        lines = wrap(choice.text, room, first=" " * (len(name) - self._width))
        lines[:1] = [each.lstrip() for each in lines[:1]]
        text = ("\n  " + " " * self._width).join(lines)
        if is_chosen:
            return Text.assemble("> ", (name + text, LOOKS["chosen"]))
        return Text.assemble("  ", name, (text, LOOKS["dim"]))
