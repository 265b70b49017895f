"""The quiz, opened from another screen: which questions, and what is said where there is nothing to ask."""

from __future__ import annotations

from asyncio import to_thread
from typing import TYPE_CHECKING, Any

from kit.school.lessons.reading import lesson_number
from kit.school.progress import ProgressError, ProgressJournal
from kit.tui.screens.message_dialog import MessageDialog, wrapped
from kit.tui.screens.picker import Picker, PickerItem
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from textual.screen import Screen

    from kit.school.quiz.items import QuestionBank
    from kit.school.quiz.quiz_session import QuestionPlan

TWELVE, TODAY, SCORES = "twelve", "today", "scores"


async def ask_of_lesson(screen: Screen[Any], journal: ProgressJournal, lesson: str) -> None:
    """Asks a lesson's questions, and comes back. To be called in a worker."""
    from kit.school.quiz.quiz_session import lesson_plan

    bank = await _bank(screen)
    if bank is not None:
        await _ask(screen, journal, bank, lesson_plan(bank, lesson))


async def choose_questions(screen: Screen[Any], journal: ProgressJournal) -> None:
    """Has the student choose what to be asked, and asks it. To be called in a worker."""
    from kit.school.quiz.answers import answers_from_events
    from kit.school.quiz.quiz_session import PracticePlan, lesson_plan, local_now, quiz_plan
    from kit.school.quiz.quiz_text import scores_lines, today_line
    from kit.school.quiz.schedule import build_schedule

    bank = await _bank(screen)
    if bank is None:
        return
    try:
        events = journal.events()
    except ProgressError as error:
        screen.app.push_screen(MessageDialog("Progress cannot be read", wrapped(str(error))))
        return
    schedule = build_schedule(bank, events, local_now())
    plans: dict[str, QuestionPlan] = {TODAY: PracticePlan(bank), TWELVE: quiz_plan(bank)}
    choices = [
        PickerItem(TODAY, "today", today_line(schedule)),
        PickerItem(TWELVE, "the twelve", "The twelve ideas, one question each."),
        PickerItem(SCORES, "scores", "What you know by topic, and how well you judge it."),
    ]
    for name in dict.fromkeys(item.lesson for item in bank.items):
        plans[name] = plan = lesson_plan(bank, name)
        choices.append(PickerItem(name, f"lesson {lesson_number(name)}", plan.title))
    chosen = await screen.app.push_screen_wait(Picker("Questions", choices))
    if chosen == SCORES:
        from kit.tui.screens.text_screen import TextScreen  # of no use to the first frame
        from kit.tui.widgets.text_rows import row

        lines = scores_lines(bank, answers_from_events(events), schedule)
        await screen.app.push_screen_wait(TextScreen("Scores", [row(" " + line) for line in lines]))
    elif chosen is not None:
        await _ask(screen, journal, bank, plans[chosen])


async def _bank(screen: Screen[Any]) -> QuestionBank | None:
    """Read in another thread: there are many files."""
    from kit.school.quiz.reading import read_bank

    try:
        return await to_thread(read_bank)
    except (WorldError, FileNotFoundError) as error:
        screen.app.push_screen(MessageDialog("The questions cannot be read", wrapped(str(error))))
        return None


async def _ask(screen: Screen[Any], journal: ProgressJournal, bank: QuestionBank, plan: QuestionPlan) -> None:
    from kit.school.quiz.quiz_session import QuizSession, student_seed
    from kit.tui.screens.quiz import QuizScreen

    try:
        session = QuizSession(journal, bank, plan, seed=student_seed(journal))
        if session.current_item is None:  # all were asked: once more, for practice
            session = QuizSession(journal, bank, plan, seed=student_seed(journal), restart=True)
    except ProgressError as error:
        screen.app.push_screen(MessageDialog("Progress cannot be kept", wrapped(str(error))))
        return
    if session.current_item is None:
        screen.app.push_screen(
            MessageDialog(plan.title, wrapped("There is nothing to ask now. Come back another day."))
        )
        return
    await screen.app.push_screen_wait(QuizScreen(session))
