"""``kit keys``: shows what this terminal sends when keys are pressed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from kit.cli import options
from kit.cli.full_screen import show_screen

if TYPE_CHECKING:
    from kit.tui.app import KitApp
    from kit.tui.screens.key_test import KeyTestScreen


@click.command()
def command() -> None:
    """Press keys and see what arrives, and which way of driving this terminal allows. Ctrl-C leaves."""
    terminal = options.terminal()
    if terminal.plain.value:
        options.fail(f"The key test needs a full-screen terminal. {terminal.plain.reason}")

    def make_screen(app: KitApp) -> KeyTestScreen:
        from kit.tui.screens.key_test import KeyTestScreen

        return KeyTestScreen(terminal)

    show_screen(terminal, make_screen)
