"""``kit keys``: what this terminal sends when keys are pressed."""

from __future__ import annotations

import os

import click

from kit.cli import options


@click.command()
def command() -> None:
    """Press keys and see what arrives, and which way of driving this terminal allows. Ctrl-C leaves."""
    terminal = options.terminal()
    if terminal.plain.value:
        options.fail(f"The key test needs a full-screen terminal. {terminal.plain.reason}")
    os.environ.update(terminal.environment())
    from kit.tui.app import KitApp
    from kit.tui.screens.key_test import KeyTestScreen

    app = KitApp(terminal)
    app.begin(KeyTestScreen(terminal))
    app.run()
    raise SystemExit(app.return_code or 0)
