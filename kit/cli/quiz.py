"""``kit quiz``: asks the twelve ideas, a lesson's questions or those due today; prints scores and confidence."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import click

from kit.cli import messages, opening, options, terminal_options
from kit.cli.dialogue import run_dialogue
from kit.cli.full_screen import show_dialogue
from kit.document.blocks import Text
from kit.document.layout import lines_of
from kit.school.progress import FILE, ProgressError, ProgressEvent, ProgressJournal
from kit.school.quiz.answers import answers_from_events
from kit.school.quiz.items import LessonWithoutQuestions, QuestionBank, read_bank
from kit.school.quiz.quiz_dialogue import QuizDialogue
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
    closing_blocks,
    restart_line,
    schedule_blocks,
    scores_blocks,
    today_line,
)
from kit.school.quiz.schedule import build_schedule
from kit.workspace import WorkspaceError, open_workspace
from kit.world.problems import WorldError

FLAGS: Final = ("today", "scores", "again", "plain")


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
@terminal_options.glyphs
@terminal_options.color
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
    if lesson in FLAGS:
        raise click.UsageError(f"It is `kit quiz --{lesson}`.")
    terminal = terminal_options.decide(plain=plain, glyphs=glyphs, color=color)
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
                run_dialogue(QuizDialogue(session))
            else:
                show_dialogue(QuizDialogue(session), terminal)
    except ProgressError as error:
        messages.fail(str(error))


def _read_bank() -> QuestionBank:
    try:
        return read_bank()
    except (WorldError, FileNotFoundError) as error:
        messages.fail(str(error))


def _choose_plan(bank: QuestionBank, lesson: str | None, today: bool) -> QuestionPlan:
    try:
        if today:
            return PracticePlan(bank)
        return quiz_plan(bank) if lesson is None else lesson_plan(bank, bank.find_lesson(lesson))
    except LessonWithoutQuestions as error:
        messages.fail(str(error))


def _open_journal(workspace: Path | None) -> ProgressJournal:
    try:
        return opening.open_journal(open_workspace(workspace))
    except WorkspaceError as error:
        messages.fail(str(error))


def _start_session(
    journal: ProgressJournal, bank: QuestionBank, plan: QuestionPlan, again: bool
) -> QuizSession:
    return QuizSession(journal, bank, plan, seed=student_seed(journal), restart=again)


def _print_scores(bank: QuestionBank, workspace: Path | None) -> None:
    events: list[ProgressEvent] = []
    try:
        if (opening.open_existing_workspace(workspace).folder / FILE).exists():  # else looking would make it
            with _open_journal(workspace) as journal:
                events = journal.events()
    except ProgressError as error:
        messages.fail(str(error))
    schedule = build_schedule(bank, events, local_now())
    click.echo("\n".join(lines_of(scores_blocks(bank, answers_from_events(events), schedule))))


def _print_finished(session: QuizSession) -> None:
    """Prints the result of a finished quiz and what can be done next."""
    schedule = session.build_schedule()
    if isinstance(session.plan, QuizRoundPlan):
        blocks = [*closing_blocks(session), Text(restart_line(session.plan), is_tight=True)]
    else:
        blocks = [Text(today_line(schedule)), *(schedule_blocks(schedule) if schedule.topics else ())]
    click.echo("\n".join(lines_of(blocks)))
