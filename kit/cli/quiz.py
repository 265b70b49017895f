"""``kit quiz``: asks the twelve ideas, a lesson's questions or those due today; prints scores and confidence."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Final, NoReturn

import click

from kit.cli import options
from kit.cli.full_screen import show_screen
from kit.school.progress import FILE, ProgressError, ProgressEvent, ProgressJournal
from kit.school.quiz.items import OPTION_COUNT, LessonWithoutQuestions, QuestionBank, QuizItem, read_bank
from kit.school.quiz.quiz_session import (
    PracticePlan,
    QuestionPlan,
    QuizRoundPlan,
    QuizSession,
    lesson_plan,
    local_now,
    quiz_plan,
    student_seed,
)
from kit.school.quiz.quiz_text import (
    CONFIDENCE_CHOICES,
    CONFIDENCE_QUESTION,
    closing_lines,
    feedback_text,
    follow_up_lines,
    restart_line,
    schedule_lines,
    scores_lines,
    today_line,
    verdict_text,
    wrap_text,
)
from kit.school.quiz.schedule import BLANK, NOT_SURE, AnswerChoice, answers_from_events, build_schedule
from kit.tui.terminal import TerminalDecision
from kit.workspace import WorkspaceError, open_workspace
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.tui.app import KitApp
    from kit.tui.screens.quiz import QuizScreen

WIDTH: Final = 78
NOT_SURE_WORDS: Final = ("?", "0")
LEAVE_WORDS: Final = ("q", "quit")


class _LeaveQuiz(Exception):
    """The student has had enough for now."""


@click.command()
@click.argument("lesson", required=False)
@click.option(
    "--today", is_flag=True, help="Ask the questions due today; topics return after 1, 3, 7 and 21 days."
)
@click.option(
    "--scores", is_flag=True, help="Print your scores by topic, your confidence, and when each topic returns."
)
@click.option("--again", is_flag=True, help="Start a finished quiz again; earlier answers are kept.")
@click.option("--plain", is_flag=True, help="Print lines of text instead of a full screen.")
@options.workspace
@options.glyphs
@options.color
def command(
    lesson: str | None,
    today: bool,
    scores: bool,
    again: bool,
    plain: bool,
    workspace: Path | None,
    glyphs: str | None,
    color: str | None,
) -> None:
    """Test what you know: twelve questions on twelve ideas, or the questions of a LESSON (number or name).

    Each answer is saved at once. You can quit at any time and run the same command to continue. "Not sure" is an
    answer too, and does not count as wrong.

    \b
      kit quiz             the twelve questions
      kit quiz B3          the questions of lesson B3
      kit quiz --today     the questions due today
      kit quiz --scores    what you know, and how well you judge it
    """
    if sum((lesson is not None, today, scores)) > 1:
        raise click.UsageError("Give only one of LESSON, --today and --scores.")
    terminal = options.terminal(plain=plain, glyphs=glyphs, color=color)
    bank = _read_bank()
    if scores:
        _print_scores(bank, workspace)
        return
    plan = _choose_plan(bank, lesson, today)
    try:
        with _open_journal(workspace) as journal:
            session = _start_session(journal, bank, plan, again)
            if session.current_item is None:
                _print_finished(session)
            elif terminal.plain.value:
                ask_line_by_line(session)
            else:
                _ask_on_full_screen(session, terminal)
    except ProgressError as error:
        options.fail(str(error))


def _read_bank() -> QuestionBank:
    try:
        return read_bank()
    except (WorldError, FileNotFoundError) as error:
        options.fail(str(error))


def _choose_plan(bank: QuestionBank, lesson: str | None, today: bool) -> QuestionPlan:
    try:
        if today:
            return PracticePlan(bank)
        return quiz_plan(bank) if lesson is None else lesson_plan(bank, bank.find_lesson(lesson))
    except LessonWithoutQuestions as error:
        options.fail(str(error))


def _open_journal(workspace: Path | None) -> ProgressJournal:
    try:
        return options.open_journal(open_workspace(workspace))
    except WorkspaceError as error:
        options.fail(str(error))


def _start_session(
    journal: ProgressJournal, bank: QuestionBank, plan: QuestionPlan, again: bool
) -> QuizSession:
    return QuizSession(journal, bank, plan, seed=student_seed(journal), restart=again)


def _print_scores(bank: QuestionBank, workspace: Path | None) -> None:
    events: list[ProgressEvent] = []
    try:
        if (options.open_existing_workspace(workspace).folder / FILE).exists():  # else looking would make it
            with _open_journal(workspace) as journal:
                events = journal.events()
    except ProgressError as error:
        options.fail(str(error))
    for line in scores_lines(bank, answers_from_events(events), build_schedule(bank, events, local_now())):
        click.echo(line)


def _print_finished(session: QuizSession) -> None:
    """Prints the result of a finished quiz and what can be done next."""
    if isinstance(session.plan, QuizRoundPlan):
        for line in (*closing_lines(session), restart_line(session.plan)):
            click.echo(line)
        return
    schedule = session.build_schedule()
    click.echo(today_line(schedule))
    if schedule.topics:
        click.echo("")
        for line in schedule_lines(schedule):
            click.echo(line)


def _ask_on_full_screen(session: QuizSession, terminal: TerminalDecision) -> NoReturn:
    def make_screen(app: KitApp) -> QuizScreen:
        from kit.tui.screens.quiz import QuizScreen

        return QuizScreen(session)

    show_screen(terminal, make_screen)


# Line by line


def ask_line_by_line(session: QuizSession) -> None:
    """Asks what the sitting has ahead, by lines of standard input, until all is asked, ``q``, or its end."""
    click.echo(f"{session.plan.title}: {session.question_count} questions.")
    if session.question_number > 1:
        click.echo(f"You continue at question {session.question_number}.")
    click.echo("Type 1, 2 or 3, ? if you are not sure, Enter to leave it blank, q to quit.")
    try:
        while (item := session.current_item) is not None:
            _ask(session, item)
        click.echo("")
        for line in closing_lines(session):
            click.echo(line)
    except (_LeaveQuiz, KeyboardInterrupt):
        click.echo("")
        click.echo(
            f"{session.question_number - 1} of {session.question_count} answered. `{session.plan.command}` continues here. "
            + today_line(session.build_schedule())
        )


def _ask(session: QuizSession, item: QuizItem) -> None:
    click.echo("")
    click.echo(f"Question {session.question_number} of {session.question_count}, {item.topic.label}")
    for line in wrap_text(item.question, WIDTH):
        click.echo(line)
    if item.picture:
        click.echo("")
        for row in item.picture:
            click.echo(f"    {row}".rstrip())
        click.echo("")
    for number, option in enumerate(item.options, 1):
        first, *rest = wrap_text(option.text, WIDTH, "     ")
        click.echo(f"  {number}  {first.strip()}")
        for line in rest:
            click.echo(line)
    click.echo("  ?  I am not sure")
    choice = _read_choice()
    session.answer(choice, None if choice.option is None else _read_confidence())
    click.echo(verdict_text(item, choice))
    for line in (*wrap_text(feedback_text(item, choice), WIDTH), *follow_up_lines(item, WIDTH)):
        click.echo(line)


def _read_choice() -> AnswerChoice:
    choices = {str(index + 1): AnswerChoice(index) for index in range(OPTION_COUNT)}
    choices |= dict.fromkeys(NOT_SURE_WORDS, NOT_SURE)
    asked_once = False
    while True:
        word = _read_line()
        if word in choices:
            return choices[word]
        if not word and asked_once:
            return BLANK
        asked_once = not word
        click.echo(
            "Press Enter again to leave it blank; type ? if you are not sure."
            if asked_once
            else "Type 1, 2 or 3, ? if you are not sure, Enter to leave it blank, q to quit."
        )


def _read_confidence() -> int | None:
    words = ", ".join(f"{number} {text}" for number, text in CONFIDENCE_CHOICES)
    click.echo(f"{CONFIDENCE_QUESTION} {words}")
    while True:
        word = _read_line()
        if not word:
            return None
        number = next((number for number, _ in CONFIDENCE_CHOICES if word == str(number)), None)
        if number is not None:
            return number
        click.echo("Type 1, 2, 3 or 4, Enter to leave it open, q to quit.")


def _read_line() -> str:
    """The next line that the student types. Raises _LeaveQuiz where they leave, or there are no more."""
    if sys.stdin is None:
        raise _LeaveQuiz
    if sys.stdin.isatty():
        click.echo("> ", nl=False)
    line = sys.stdin.readline()
    word = line.strip().lower()
    if not line or word in LEAVE_WORDS:
        raise _LeaveQuiz
    return word
