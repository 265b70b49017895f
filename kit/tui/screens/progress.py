"""What a student has done so far: the game, the quiz by topic, lessons and exercises, and how to take it along."""

from __future__ import annotations

from asyncio import to_thread
from collections.abc import Sequence
from typing import Any

from textual.screen import Screen

from kit.document.layout import lines_of
from kit.document.rows import Row, row
from kit.school.lessons.catalogue import LessonEntry
from kit.school.progress import EventKind
from kit.school.quiz.items import read_bank
from kit.tui.rows.progress_rows import lesson_rows, short_lesson_rows, summary_rows
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.text_screen import TextScreen
from kit.tui.student_store import StudentOverview, StudentStore
from kit.world.problems import WorldError


class ProgressScreen(TextScreen):
    """Shows all that was done; the lessons beside the rest where there is room, each in one row."""

    def __init__(self, summary: Sequence[Row], shelf: Sequence[LessonEntry]) -> None:
        super().__init__("Progress", summary, short_lesson_rows(shelf))
        self._shelf = shelf

    def _arranged(self, width: int, height: int) -> list[Row]:
        if not self._column:
            return [*self._rows, row(), *lesson_rows(self._shelf)]
        return super()._arranged(width, height)


async def show_progress(screen: Screen[Any], store: StudentStore) -> None:
    """Opens the page, and comes back when it is left. To be called in a worker."""
    found = await to_thread(_read, store)
    if isinstance(found, str):
        screen.app.push_screen(MessageDialog("Progress cannot be read", found))
    else:
        overview, summary = found
        await screen.app.push_screen_wait(ProgressScreen(summary, overview.shelf))


def _read(store: StudentStore) -> tuple[StudentOverview, list[Row]] | str:
    """Reads the lessons and all else, or the problem; runs in another thread, since there are many files."""
    overview = store.read_overview()
    if overview.problem:
        return overview.problem
    return overview, summary_rows(_game(store), _quiz(store), overview.shelf, str(store.workspace.folder))


def _game(store: StudentStore) -> list[Row]:
    from kit.school.game.challenges import game_summary
    from kit.tui.rows.level_rows import game_progress

    try:
        return game_progress(game_summary(store.progress().events(EventKind.FINISH)))
    except (WorldError, FileNotFoundError) as error:
        return [row(f"  {line}") for line in str(error).splitlines()]


def _quiz(store: StudentStore) -> list[str]:
    from kit.school.quiz.answers import answers_from_events
    from kit.school.quiz.quiz_session import local_now
    from kit.school.quiz.quiz_text import scores_blocks
    from kit.school.quiz.schedule import build_schedule

    events = store.progress().events()
    try:
        bank = read_bank()
    except (WorldError, FileNotFoundError) as error:
        return str(error).splitlines()
    answers = answers_from_events(events)
    if not answers:
        return ["Nothing answered yet."]
    return lines_of(scores_blocks(bank, answers, build_schedule(bank, events, local_now())))
