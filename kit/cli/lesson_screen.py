"""The full screen of ``kit lesson``: all lessons, or one of them."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from kit.school.lessons.records import Lesson
    from kit.school.progress import ProgressJournal
    from kit.tui.terminal import TerminalDecision
    from kit.workspace import Workspace


def show_on_screen(
    lesson: Lesson, journal: ProgressJournal, desk: Workspace, terminal: TerminalDecision
) -> NoReturn:
    """Goes through a lesson on a full screen, and ends the verb when that is left."""
    os.environ.update(terminal.environment())
    from kit.school.lessons.lesson_session import LessonSession
    from kit.tui.app import KitApp
    from kit.tui.screens.lesson import LessonScreen

    app = KitApp(terminal)
    app.begin(LessonScreen(app.kit_theme, LessonSession(lesson, journal, desk), desk))
    app.run()
    raise SystemExit(app.return_code or 0)


def show_list(desk: Workspace, terminal: TerminalDecision) -> NoReturn:
    """All lessons on a full screen; ends the verb when that is left."""
    os.environ.update(terminal.environment())
    from kit.tui.app import KitApp
    from kit.tui.screens.lessons import LessonsScreen
    from kit.tui.student_store import StudentStore

    app, store = KitApp(terminal), StudentStore(desk)
    try:
        app.begin(LessonsScreen(app.kit_theme, store, store.read_overview()))
        app.run()
    finally:
        store.close()
    raise SystemExit(app.return_code or 0)
