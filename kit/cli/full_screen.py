"""Opens full screens: each verb that has one builds it here, and ends when the user leaves it."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

import click

from kit.cli import terminal_options
from kit.cli.process import INTERRUPTED, ScreenClosed
from kit.tui.terminal import TerminalDecision
from kit.workspace import Workspace, open_workspace

if TYPE_CHECKING:
    from textual.screen import Screen

    from kit.dialogue.dialogue import Dialogue
    from kit.layers.case_sources import PlanningTask
    from kit.school.game.levels import GameLevel
    from kit.school.lessons.lesson_session import LessonSession
    from kit.school.progress import ProgressJournal
    from kit.tui.app import KitApp
    from kit.tui.screens.dialogue import DialogueScreen
    from kit.tui.screens.layers import LayersScreen
    from kit.tui.screens.lesson import LessonScreen
    from kit.tui.screens.lessons import LessonsScreen
    from kit.tui.screens.levels import LevelsScreen

AnyScreen = TypeVar("AnyScreen", bound="Screen[Any]")


def run_screen(
    terminal: TerminalDecision, make_screen: Callable[[KitApp], AnyScreen]
) -> tuple[AnyScreen, int]:
    """Runs the app with the screen that ``make_screen`` builds until the user leaves it.

    ``make_screen`` imports its screen itself: textual reads the environment when it is imported, and that is set
    here first. Returns the screen, and the exit code: 0 unless the app failed or a signal has ended it. What the screen has made is there in every case.
    """
    os.environ.update(terminal.environment())
    from kit.tui.app import KitApp

    verb = click.get_current_context(silent=True)
    app = KitApp(terminal, verb.params.get("workspace") if verb is not None else None)
    screen = make_screen(app)
    app.begin(screen)
    # Elsewhere the mouse is left to the terminal, so that what is shown can be selected and copied.
    try:
        app.run(mouse=terminal.mouse.value or getattr(screen, "uses_mouse", False))
    except KeyboardInterrupt:  # the second signal
        return screen, INTERRUPTED
    return screen, app.return_code or 0


def show_screen(terminal: TerminalDecision, make_screen: Callable[[KitApp], Screen[Any]]) -> NoReturn:
    """Runs a screen as ``run_screen``, and ends the verb with it; at SIGTERM and SIGHUP too, after the screen has saved its state."""
    _, code = run_screen(terminal, make_screen)
    raise ScreenClosed(code)


def show_dialogue(dialogue: Dialogue, terminal: TerminalDecision) -> NoReturn:
    """Asks on the full screen."""

    def make_screen(app: KitApp) -> DialogueScreen:
        from kit.tui.screens.dialogue import DialogueScreen

        return DialogueScreen(dialogue)

    show_screen(terminal, make_screen)


def show_lesson(session: LessonSession, workspace: Workspace, terminal: TerminalDecision) -> NoReturn:
    """Goes through one lesson."""

    def make_screen(app: KitApp) -> LessonScreen:
        from kit.tui.screens.lesson import LessonScreen

        return LessonScreen(app.kit_theme, session, workspace)

    show_screen(terminal, make_screen)


def show_lessons(workspace: Workspace, terminal: TerminalDecision) -> NoReturn:
    """Shows the list of all lessons."""
    from kit.tui.student_store import StudentStore

    store = StudentStore(workspace)

    def make_screen(app: KitApp) -> LessonsScreen:
        from kit.tui.screens.lessons import LessonsScreen

        return LessonsScreen(app.kit_theme, store, store.read_overview())

    try:
        show_screen(terminal, make_screen)
    finally:
        store.close()


def show_levels(
    journal: ProgressJournal,
    workspace: Workspace,
    terminal: TerminalDecision,
    level: GameLevel | None = None,
) -> NoReturn:
    """Shows the map of levels, or opens one level at once."""

    def make_screen(app: KitApp) -> LevelsScreen:
        from kit.tui.screens.levels import LevelsScreen

        return LevelsScreen(app.kit_theme, journal, workspace, level)

    show_screen(terminal, make_screen)


def show_layers(task: PlanningTask, title: str, terminal: TerminalDecision | None = None) -> NoReturn:
    """Goes through a layer case; ends the verb with a message where there is no full screen."""
    if terminal is None:
        instead = f"`kit layers explain {title} --pictures` prints the same as text."
        terminal = terminal_options.full_screen("The screen", instead)

    def make_screen(app: KitApp) -> LayersScreen:
        from kit.tui.screens.layers import LayersScreen

        return LayersScreen(app.kit_theme, task, title, saved_to=open_workspace(make=False).worlds)

    show_screen(terminal, make_screen)
