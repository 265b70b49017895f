"""The full screen of ``kit layers``, opened on a case."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, NoReturn

from kit.cli import options

if TYPE_CHECKING:
    from kit.layers.case_sources import PlanningTask
    from kit.tui.terminal import TerminalDecision


def show_on_screen(task: PlanningTask, title: str, terminal: TerminalDecision | None = None) -> NoReturn:
    """Goes through the case on a full screen, and ends the verb when that is left."""
    terminal = options.terminal() if terminal is None else terminal
    if terminal.plain.value:
        options.fail(
            f"The screen needs a full-screen terminal. {terminal.plain.reason}\n"
            f"`kit layers explain {title} --pictures` shows the same line by line."
        )
    os.environ.update(terminal.environment())
    from kit.tui.app import KitApp
    from kit.tui.screens.layers import LayersScreen
    from kit.workspace import open_workspace

    app = KitApp(terminal)
    app.begin(LayersScreen(app.kit_theme, task, title, saved_to=open_workspace(make=False).worlds))
    app.run()
    raise SystemExit(app.return_code or 0)
