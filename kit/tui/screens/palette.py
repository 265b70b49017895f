"""The command palette: one list of everything that can be done now, filtered by typing. Ctrl-P opens it on every screen."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from textual.binding import Binding

from kit.render.roles import COLOR_SCHEMES
from kit.tui.actions import ACTIONS
from kit.tui.input.driver import key_driver
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.terminal import MOUSE_VARIABLE

if TYPE_CHECKING:
    from textual.screen import Screen

    from kit.tui.app import KitApp


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


async def choose_command(app: KitApp) -> None:
    """Shows what the present screen can do, what the first screen opens, and the themes; does what is chosen."""
    screen, first = app.screen, app.screen_stack[1]
    if isinstance(screen, Picker):
        return
    commands = [*_screen_commands(screen)]
    if isinstance(first, PaletteSource):
        commands += await first.palette_commands()
    commands += [*_theme_commands(app), *_mouse_commands(app)]
    items = [PickerItem(str(number), command.name, command.text) for number, command in enumerate(commands)]
    chosen = await app.push_screen_wait(Picker("Commands", items))
    if chosen is not None:
        await commands[int(chosen)].run()


def _screen_commands(screen: Screen[Any]) -> Iterator[PaletteCommand]:
    """The keys of the screen that mean one thing each."""
    bound = {binding.action for binding in type(screen).BINDINGS if isinstance(binding, Binding)}
    for action in ACTIONS.values():
        if len(action.bindings) == 1 and action.bindings[0][1] in bound:
            call = action.bindings[0][1]
            yield PaletteCommand(
                action.label.capitalize(),
                f"{action.help} ({action.footer_keys})",
                partial(screen.run_action, call),
            )


def _mouse_commands(app: KitApp) -> Iterator[PaletteCommand]:
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


def _theme_commands(app: KitApp) -> Iterator[PaletteCommand]:
    if app.native_ansi_color:
        return
    for name in COLOR_SCHEMES:

        async def switch(name: str = name) -> None:
            app.switch_theme(name)

        yield PaletteCommand(f"Theme {name}", f"for this session; KIT_THEME={name} keeps it", switch)
