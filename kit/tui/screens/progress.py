"""What a student has done so far: lessons, exercises, the quiz by topic, and how to take it along."""

from __future__ import annotations

from asyncio import to_thread
from typing import Any

from textual.screen import Screen

from kit.tui.rows import lesson_list_rows
from kit.tui.screens.message_dialog import MessageDialog, wrapped
from kit.tui.screens.text_screen import TextScreen
from kit.tui.student_store import StudentStore
from kit.tui.widgets.text_rows import Row


async def show_progress(screen: Screen[Any], store: StudentStore) -> None:
    """Opens the page, and comes back when it is left. To be called in a worker."""
    found = await to_thread(_rows, store)
    if isinstance(found, str):
        screen.app.push_screen(MessageDialog("Progress cannot be read", wrapped(found)))
    else:
        await screen.app.push_screen_wait(TextScreen("Progress", found))


def _rows(store: StudentStore) -> list[Row] | str:
    """In another thread: there are many files. What is wrong, if something is."""
    overview = store.read_overview()
    if overview.problem:
        return overview.problem
    return lesson_list_rows.progress(overview.shelf, _quiz(store), str(store.workspace.folder))


def _quiz(store: StudentStore) -> list[str]:
    from kit.school.quiz.answers import answers_from_events
    from kit.school.quiz.quiz_session import local_now
    from kit.school.quiz.quiz_text import scores_lines
    from kit.school.quiz.reading import read_bank
    from kit.school.quiz.schedule import build_schedule
    from kit.world.problems import WorldError

    events = store.progress().events()
    try:
        bank = read_bank()
    except (WorldError, FileNotFoundError) as error:
        return str(error).splitlines()
    answers = answers_from_events(events)
    if not answers:
        return ["Nothing answered yet."]
    return list(scores_lines(bank, answers, build_schedule(bank, events, local_now())))
