"""The palette: all commands of the present screen and of the first one, in one list."""

from __future__ import annotations

from asyncio import create_task
from collections.abc import Awaitable, Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from kit.dialogue.actions import ScreenActions
from kit.render.palettes import COLOR_SCHEMES
from kit.tui.input.driver import key_driver
from kit.tui.screens.dialog import Dialog
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.terminal import MOUSE_VARIABLE
from kit.workspace import WorkspaceError, open_workspace

if TYPE_CHECKING:
    from textual.app import App
    from textual.screen import Screen

    from kit.tui.app import KitApp
    from kit.tui.screens.start import StartScreen


@dataclass(frozen=True, slots=True)
class PaletteCommand:
    """One line of the palette and what choosing it does."""

    name: str
    text: str
    run: Callable[[], Awaitable[object]]
    words: str = ""
    """Words by which it is found too."""
    is_place: bool = False
    """Whether it leaves what is open."""


async def open_palette(app: KitApp, switch_theme: Callable[[str], None]) -> None:
    """Shows what the present screen can do, what the first screen opens, and the themes; does what is chosen."""
    screen = app.screen
    if isinstance(screen, MessageDialog):  # the commands wanted are those of the screen below
        screen.dismiss()
        screen = next(each for each in reversed(app.screen_stack) if each is not screen)
    if isinstance(screen, Dialog):
        return
    own = [*_screen_commands(screen)]
    commands = [*own, *_theme_commands(app, switch_theme), *_mouse_commands(app)]
    settings = range(len(own), len(commands))
    picker = Picker("Commands", _command_items(own))
    picker.reads_more = True
    choice = create_task(app.push_screen_wait(picker))
    start = _start_screen(app)
    try:
        if start is not None:  # which may have to read them first
            commands += await start.palette_commands()
        items = _command_items(commands)  # the settings last
        places = items[settings.stop :]
        picker.reads_more = False
        picker.replace_choices([*items[: settings.start], *places, *(items[each] for each in settings)])
        chosen = None if (number := await choice) is None else commands[int(number)]
        if chosen is not None and (not chosen.is_place or await _may_leave(app)):
            await chosen.run()
    finally:
        if start is not None and not start.is_attached:
            start.release()


def _start_screen(app: KitApp) -> StartScreen | None:
    """The first screen, which opens all others; where a verb has opened another one first, a new one, which is not shown
    before one of its places is chosen. None where the student's files cannot be opened."""
    from kit.tui.screens.start import StartScreen  # which imports this module
    from kit.tui.student_store import StudentStore

    first = app.screen_stack[1]
    if isinstance(first, StartScreen):
        return first
    try:
        return StartScreen(app.kit_theme, StudentStore(open_workspace(app.workspace)))
    except WorkspaceError:
        return None


async def _may_leave(app: KitApp) -> bool:
    """Asks where something that is not over would be left; whether it may be."""
    told = (getattr(screen, "not_over", "") for screen in reversed(app.screen_stack))
    question = next(filter(None, told), "")
    if not question:
        return True
    choices = [PickerItem("stay", "go on"), PickerItem("leave", "leave")]
    return await app.push_screen_wait(Picker(question, choices)) == "leave"


def _command_items(commands: Sequence[PaletteCommand]) -> list[PickerItem]:
    return [
        PickerItem(str(number), command.name, command.text, command.words)
        for number, command in enumerate(commands)
    ]


def _screen_commands(screen: Screen[Any]) -> Iterator[PaletteCommand]:
    """The keys of the screen that mean one thing each and do something now."""
    actions: ScreenActions | None = getattr(screen, "screen_actions", None)
    unavailable = getattr(screen, "unavailable_actions", ())
    for action in () if actions is None else actions.records:
        if len(action.bindings) == 1 and action.id not in unavailable:
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
    about = f"{text}; for this session, {MOUSE_VARIABLE}={is_wanted:d} keeps it"
    yield PaletteCommand(name, about, switch, "settings")


def _theme_commands(app: App[None], switch_theme: Callable[[str], None]) -> Iterator[PaletteCommand]:
    if app.native_ansi_color:
        return
    for name in COLOR_SCHEMES:

        async def switch(name: str = name) -> None:
            switch_theme(name)

        about = f"for this session; KIT_THEME={name} keeps it"
        yield PaletteCommand(f"Theme {name}", about, switch, "settings colours colors")
