"""The full screen of ``kit lesson``, opened on one lesson."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from kit.school.lessons.records import Lesson
    from kit.school.progress import Progress
    from kit.tui.terminal import TerminalDecision
    from kit.workspace import Workspace


def show_on_screen(
    lesson: Lesson, progress: Progress, desk: Workspace, terminal: TerminalDecision
) -> NoReturn:
    """Goes through a lesson on a full screen, and ends the verb when that is left."""
    os.environ.update(terminal.environment())
    from kit.school.lessons.visit import Visit
    from kit.tui.app import KitApp
    from kit.tui.screens.lesson import LessonScreen

    app = KitApp(terminal)
    app.begin(LessonScreen(app.look, Visit(lesson, progress, desk), desk))
    app.run()
    raise SystemExit(app.return_code or 0)
