"""The quiz, opened from another screen: which questions, and what is said where there is nothing to ask."""

from __future__ import annotations

from asyncio import to_thread
from typing import Any, Final

from textual.screen import Screen

from kit.document.blocks import Text, Tone
from kit.school.lessons.reading import lesson_number, lesson_title
from kit.school.progress import ProgressError, ProgressJournal
from kit.school.quiz.answers import answers_from_events
from kit.school.quiz.items import QuestionBank, read_bank
from kit.school.quiz.quiz_dialogue import QuizDialogue
from kit.school.quiz.quiz_session import (
    PracticePlan,
    QuestionPlan,
    QuizSession,
    lesson_plan,
    local_now,
    quiz_plan,
    student_seed,
)
from kit.school.quiz.quiz_text import answered_blocks, lesson_table, scores_blocks, today_line
from kit.school.quiz.schedule import build_schedule
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.dialogue import DialogueScreen
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.screens.text_screen import page_screen
from kit.world.problems import WorldError

ANSWERED_LAST: Final = "Answered last"
MOST_ANSWERED: Final = 12
"""Answers that the scores list."""
SCORES_COLUMNS: Final = 3
"""Of the scores, where there is room for as many."""
TWELVE, TODAY, SCORES = "twelve", "today", "scores"


async def choose_questions(screen: Screen[Any], journal: ProgressJournal) -> None:
    """Has the student choose what to be asked, and asks it. To be called in a worker."""
    bank = await _bank(screen)
    if bank is None:
        return
    try:
        events = journal.events()
    except ProgressError as error:
        screen.app.push_screen(MessageDialog("Progress cannot be read", str(error)))
        return
    schedule = build_schedule(bank, events, local_now())
    plans: dict[str, QuestionPlan] = {TODAY: PracticePlan(bank), TWELVE: quiz_plan(bank)}
    today = PickerItem(TODAY, "today", today_line(schedule))
    twelve = PickerItem(TWELVE, "the twelve", "The twelve ideas, one question each.")
    choices = [
        *((today, twelve) if schedule.queue else (twelve, today)),
        PickerItem(SCORES, "scores", "What you know by topic, and how well you judge it."),
    ]
    lesson_plans = await to_thread(_lesson_plans, bank)
    plans |= lesson_plans
    choices += [
        PickerItem(name, f"lesson {lesson_number(name)}", lesson_title(name)) for name in lesson_plans
    ]
    chosen = await screen.app.push_screen_wait(Picker("Questions", choices))
    if chosen == SCORES:
        answers = answers_from_events(events)
        blocks = [
            *scores_blocks(bank, answers, schedule),
            Text("By lesson", Tone.BOLD),
            lesson_table(bank, answers),
        ]
        if answers:
            blocks += [Text(ANSWERED_LAST, Tone.BOLD), *answered_blocks(bank, answers[-MOST_ANSWERED:])]
        await screen.app.push_screen_wait(page_screen("Scores", blocks, SCORES_COLUMNS))
    elif chosen is not None:
        await _ask(screen, journal, bank, plans[chosen])


def _lesson_plans(bank: QuestionBank) -> dict[str, QuestionPlan]:
    """The plan of each lesson with questions. Slow: reads the titles of the lessons."""
    return {name: lesson_plan(bank, name) for name in bank.lessons}


async def _bank(screen: Screen[Any]) -> QuestionBank | None:
    """Read in another thread: there are many files."""
    try:
        return await to_thread(read_bank)
    except (WorldError, FileNotFoundError) as error:
        screen.app.push_screen(MessageDialog("The questions cannot be read", str(error)))
        return None


async def _ask(screen: Screen[Any], journal: ProgressJournal, bank: QuestionBank, plan: QuestionPlan) -> None:
    try:
        session = QuizSession(journal, bank, plan, seed=student_seed(journal))
        if session.current_item is None:  # all were asked: once more, for practice
            session = QuizSession(journal, bank, plan, seed=student_seed(journal), restart=True)
    except ProgressError as error:
        screen.app.push_screen(MessageDialog("Progress cannot be saved", str(error)))
        return
    if session.current_item is None:
        screen.app.push_screen(
            MessageDialog(
                plan.title,
                f"There is nothing to ask now. {today_line(build_schedule(bank, journal.events(), local_now()))}",
            )
        )
        return
    await screen.app.push_screen_wait(DialogueScreen(QuizDialogue(session)))
