"""The full screen of ``kit game``."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from kit.school.game.levels import GameLevel
    from kit.school.progress import ProgressJournal
    from kit.tui.terminal import TerminalDecision
    from kit.workspace import Workspace


def show_on_screen(
    journal: ProgressJournal, desk: Workspace, terminal: TerminalDecision, level: GameLevel | None = None
) -> NoReturn:
    """The map of levels, or one level at once; ends the verb when that is left."""
    os.environ.update(terminal.environment())
    from kit.tui.app import KitApp
    from kit.tui.screens.levels import LevelsScreen

    app = KitApp(terminal)
    app.begin(LevelsScreen(app.kit_theme, journal, desk, level))
    app.run()
    raise SystemExit(app.return_code or 0)
