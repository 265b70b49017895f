"""Dialogs over a screen: a text, a list to choose from, and the palette of all commands."""

from __future__ import annotations

from asyncio import create_task
from collections.abc import Awaitable, Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, Final, Protocol, runtime_checkable

from rich.text import Text
from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.widgets import Input, OptionList
from textual.widgets.option_list import Option

from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import ScreenAction
from kit.document.rows import Row, broken, row, row_width, side_by_side
from kit.plain_text import wrap
from kit.render.roles import COLOR_SCHEMES
from kit.tui.input.drive_keys import base_key
from kit.tui.input.driver import key_driver
from kit.tui.rows.key_rows import bindings, footer, help_page
from kit.tui.screens.dialog import Dialog
from kit.tui.terminal import MOUSE_VARIABLE
from kit.tui.textual_patches import ActivePaintScreen
from kit.tui.widgets.text_rows import TextRows

if TYPE_CHECKING:
    from textual.app import App
    from textual.screen import Screen


WIDTH: Final = 74
BORDER_ROWS: Final = 2
MODIFIERS: Final = ("left_shift", "right_shift", "left_control", "right_control")
SCROLL_ROWS: Final = {"up": -1, "down": 1, "pageup": -10, "pagedown": 10}


MOUSE_NOTE: Final = (
    ("mouse", "left to the terminal, so that text can be selected"),
    ("KIT_MOUSE=1 kit", "clicks press keys, choose, drive; the wheel zooms"),
    ("", "most terminals still select text with Shift"),
)
"""What the mouse does, on every help page."""


def wrapped(text: str, style: str = "") -> list[Row]:
    """The lines of a text as rows of a dialog; long lines are wrapped."""
    return [
        row((part, style))
        for line in text.splitlines()
        for part in wrap(line, WIDTH - 4, " " * (len(line) - len(line.lstrip())), "    ")
    ]


class MessageDialog(Dialog[None]):
    """Shows rows; where they are more than the terminal holds, the arrow keys scroll them."""

    DEFAULT_CSS = f"""
    MessageDialog > Vertical {{ width: {WIDTH}; max-width: 100%; height: auto; max-height: 100%; border: solid $foreground; padding: 0 1; }}
    MessageDialog TextRows {{ height: auto; }}
    """
    CLOSES: Final = "any key closes"

    def __init__(self, title: str, rows: Sequence[Row]) -> None:
        super().__init__()
        self._title = title
        self._shown_rows = tuple(rows)
        self._top = 0

    def compose(self) -> ComposeResult:
        with Vertical() as box:
            box.border_title = self._title
            box.border_subtitle = self.CLOSES
            text = TextRows()
            text.show(self._shown_rows)
            yield text

    def on_resize(self, event: events.Resize) -> None:
        self._show()

    @property
    def _overflow(self) -> int:
        """Rows that do not fit."""
        return max(0, len(self._shown_rows) + BORDER_ROWS - self.size.height)

    def _show(self) -> None:
        if not self.query(TextRows):  # before they are mounted, or while the kit is left
            return
        self._top = max(0, min(self._top, self._overflow))
        self.query_one(TextRows).show(self._shown_rows[self._top :])
        more = "arrows scroll, " if self._overflow else ""
        self.query_one(Vertical).border_subtitle = more + self.CLOSES

    def on_key(self, event: events.Key) -> None:
        event.stop()
        key = base_key(event.key)
        if (
            not self.is_active
        ):  # of keys that come at once the first has closed it: the others are for the screen below
            self.app.post_message(events.Key(event.key, event.character))
        elif key in SCROLL_ROWS and self._overflow:
            self._top += SCROLL_ROWS[key]
            self._show()
        elif key not in MODIFIERS:
            self.dismiss()

    def on_click(self) -> None:
        if self.is_active:
            self.dismiss()

    def on_mouse_scroll_down(self) -> None:
        self._top += 1
        self._show()

    def on_mouse_scroll_up(self) -> None:
        self._top -= 1
        self._show()


class HelpDialog(MessageDialog):
    """All keys of a screen. ``notes``: blocks of signs or terms, and what they mean."""

    def __init__(
        self,
        title: str,
        screen: ScreenActions,
        *notes: Sequence[tuple[str, str]],
        without: Sequence[str] = (),
    ) -> None:
        super().__init__(title, help_page(screen, *notes, MOUSE_NOTE, without=without))


class NameDialog(Dialog[str | None]):
    """Returns what was typed, or None if nothing was."""

    BINDINGS: ClassVar[list[BindingType]] = [("escape", "back", "")]
    DEFAULT_CSS = f"""
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


COLUMN: Final = 80
"""Columns of the left one of two texts beside each other, where there is room for two of them."""
COLUMNS_BETWEEN: Final = 2
LEAST_BESIDE: Final = 54


class TextScreen(ActivePaintScreen[None]):
    """Shows rows as they are; one that is too long goes on below."""

    least_beside: ClassVar[int] = LEAST_BESIDE
    """Columns without which nothing stands beside the rest."""
    AUTO_FOCUS = ""
    screen_actions = ScreenActions("text", ("scroll", "back"), ("close",))
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = """
    TextScreen { layout: vertical; }
    TextScreen #heading, TextScreen #keys { height: 1; }
    TextScreen #body { height: 1fr; }
    """

    def __init__(self, title: str, rows: Sequence[Row], beside: Sequence[Row] = ()) -> None:
        """``beside``: more rows, to the right of the others where there is room, else below them."""
        super().__init__()
        self._title = title
        self._rows = tuple(rows)
        self._beside = tuple(beside)
        self._shown: list[Row] = []
        """The same on as many rows as the width asks for."""
        self._width = 0
        self._top = 0

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield TextRows(id="body")
        yield TextRows(id="keys")

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)

    def _show(self) -> None:
        room = max(1, self.size.height - 2 - self._rows_below)
        if self.size.width != self._width:
            self._width = self.size.width
            column = self._column
            if column:
                right = [each for parts in self._beside for each in broken(parts, self._width - column)]
                together = side_by_side(self._rows, right, column)
            else:
                together = [*self._rows, *self._beside]
            self._shown = [each for parts in together for each in broken(parts, self._width)]
        self._top = max(0, min(self._top, len(self._shown) - room))
        last = min(len(self._shown), self._top + room)
        where = f"  lines {self._top + 1} to {last} of {len(self._shown)}" if len(self._shown) > room else ""
        self.query_one("#heading", TextRows).show([row((self._title, "bold"), (where, "dim"))])
        self.query_one("#body", TextRows).show(self._shown[self._top : last])
        self.query_one("#keys", TextRows).show([self._keys()])

    @property
    def _column(self) -> int:
        """The column of what stands beside the rest; 0 where there is no room, or nothing."""
        if not self._beside or self._width >= 2 * COLUMN:
            return COLUMN if self._beside else 0
        column = max(map(row_width, self._rows), default=0) + COLUMNS_BETWEEN
        return column if column + self.least_beside <= self._width else 0

    @property
    def _rows_below(self) -> int:
        """Rows between the text and the keys."""
        return 0

    def _keys(self) -> Row:
        return footer(self.screen_actions, self.size.width)

    def action_scroll(self, lines: int) -> None:
        self._top += lines
        self._show()

    def action_back(self) -> None:
        self.dismiss()


LIST_WIDTH: Final = 76
HIGHEST: Final = 22
"""Most rows of a list with its border and the field above it."""
ROWS_AROUND: Final = 3
"""Rows of these alone."""
COLUMNS_AROUND: Final = 8
"""Columns of the border, of the mark of the chosen line and of the scroll bar."""
LINE: Final = LIST_WIDTH - COLUMNS_AROUND
"""Characters of a line."""


@dataclass(frozen=True, slots=True)
class PickerItem:
    """One line of the list: what choosing it returns, its name, and what is said of it."""

    key: str
    name: str
    text: str = ""


class FilterInput(Input):
    """The field above a list; Home and End are the list's."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("home", "screen.choose(0, -1000)", show=False),
        Binding("end", "screen.choose(0, 1000)", show=False),
    ]


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
        width: {LIST_WIDTH}; max-width: 100%; height: auto; max-height: {HIGHEST}; border: solid $foreground; padding: 0 1;
    }}
    Picker Input, Picker Input:focus {{ border: none; padding: 0; height: 1; background: transparent; }}
    Picker OptionList {{ border: none; padding: 0; height: auto; max-height: {HIGHEST - ROWS_AROUND}; background: transparent; }}
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
        self.replace_choices(choices)

    def compose(self) -> ComposeResult:
        with Vertical() as box:
            box.border_title = self._title
            box.border_subtitle = "arrows choose, Enter confirm, Esc back"
            yield FilterInput(placeholder="type to filter", select_on_focus=False)
            yield OptionList()

    def on_mount(self) -> None:
        self.query_one(Input).cursor_blink = False
        self.query_one(OptionList).can_focus = False
        self._fill("")
        self.query_one(Input).focus()

    def on_resize(self, event: events.Resize) -> None:
        highest = min(HIGHEST, event.size.height)
        self.query_one(Vertical).styles.max_height = highest
        self.query_one(OptionList).styles.max_height = max(1, highest - ROWS_AROUND)
        self.replace_choices(self._choices)

    def on_input_changed(self, event: Input.Changed) -> None:
        self._is_entered = False
        self._fill(event.value)

    def on_input_submitted(self) -> None:
        options = self.query_one(OptionList)
        self._is_entered = options.highlighted is None
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

    def replace_choices(self, choices: Sequence[PickerItem]) -> None:
        """Shows these from now on, with what is typed and highlighted as it is."""
        self._choices = tuple(choices)
        self._width = max((len(choice.name) for choice in choices), default=0) + 2
        if self.is_mounted and self.is_attached:
            options = self.query_one(OptionList)
            if options.highlighted is not None:
                self._chosen = options.get_option_at_index(options.highlighted).id
            self._fill(self.query_one(Input).value)
            if self._is_entered:
                self.on_input_submitted()

    def _fill(self, name_filter: str) -> None:
        wanted = name_filter.casefold()
        shown = [choice for choice in self._choices if wanted in f"{choice.name} {choice.text}".casefold()]
        options = self.query_one(OptionList)
        keys = [choice.key for choice in shown]
        at = keys.index(self._chosen) if self._chosen in keys else 0
        options.clear_options()
        options.add_options(
            Option(self._line(choice, is_chosen=number == at), id=choice.key)
            for number, choice in enumerate(shown)
        )
        self._shown, self._marked = shown, at
        if not wanted:  # a filter leaves the list as high as it is, so that it does not move
            rows = sum(
                option.prompt.plain.count("\n") + 1
                for option in options.options
                if isinstance(option.prompt, Text)
            )
            self.query_one(Vertical).styles.min_height = min(rows + ROWS_AROUND, HIGHEST, self.size.height)
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
        lines = wrap(choice.text, max(20, min(LINE, self.size.width - COLUMNS_AROUND) - self._width))
        text = f"{choice.name:{self._width}}" + ("\n  " + " " * self._width).join(lines)
        return Text.assemble("> " if is_chosen else "  ", (text, "reverse bold" if is_chosen else ""))


@dataclass(frozen=True, slots=True)
class PaletteCommand:
    """One line of the palette and what choosing it does."""

    name: str
    text: str
    run: Callable[[], Awaitable[object]]


@runtime_checkable
class PaletteSource(Protocol):
    """A first screen that can open others from anywhere."""

    async def palette_commands(self) -> list[PaletteCommand]: ...


async def open_palette(app: App[None], switch_theme: Callable[[str], None]) -> None:
    """Shows what the present screen can do, what the first screen opens, and the themes; does what is chosen."""
    screen, first = app.screen, app.screen_stack[1]
    if isinstance(screen, Picker):
        return
    commands = [*_screen_commands(screen), *_theme_commands(app, switch_theme), *_mouse_commands(app)]
    picker = Picker("Commands", _command_items(commands))
    choice = create_task(app.push_screen_wait(picker))
    if isinstance(first, PaletteSource):  # which may have to read them first
        commands += await first.palette_commands()
        picker.replace_choices(_command_items(commands))
    chosen = await choice
    if chosen is not None:
        await commands[int(chosen)].run()


def _command_items(commands: Sequence[PaletteCommand]) -> list[PickerItem]:
    return [PickerItem(str(number), command.name, command.text) for number, command in enumerate(commands)]


def _screen_commands(screen: Screen[Any]) -> Iterator[PaletteCommand]:
    """The keys of the screen that mean one thing each."""
    actions: ScreenActions | None = getattr(screen, "screen_actions", None)
    for action in () if actions is None else actions.records:
        if len(action.bindings) == 1:
            call = action.bindings[0][1]
            yield PaletteCommand(
                action.label.capitalize(),
                f"{action.help} ({action.footer_keys})",
                partial(screen.run_action, call),
            )


def _mouse_commands(app: App[None]) -> Iterator[PaletteCommand]:
    driver = key_driver(app)
    if driver is None:
        return
    is_wanted = not driver.has_mouse

    async def switch() -> None:
        driver.use_mouse(is_wanted)

    name, text = (
        ("Mouse for the kit", "clicks press keys, choose and drive, the wheel zooms")
        if is_wanted
        else ("Mouse for the terminal", "text can be selected and copied")
    )
    yield PaletteCommand(name, f"{text}; for this session, {MOUSE_VARIABLE}={is_wanted:d} keeps it", switch)


def _theme_commands(app: App[None], switch_theme: Callable[[str], None]) -> Iterator[PaletteCommand]:
    if app.native_ansi_color:
        return
    for name in COLOR_SCHEMES:

        async def switch(name: str = name) -> None:
            switch_theme(name)

        yield PaletteCommand(f"Theme {name}", f"for this session; KIT_THEME={name} keeps it", switch)
