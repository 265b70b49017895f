"""``kit quiz``: the twelve ideas, a lesson's questions, what is due today; with scores and how sure one was."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Final, NoReturn

import click

from kit.cli import options

if TYPE_CHECKING:
    from kit.school.progress import ProgressEvent, ProgressJournal
    from kit.school.quiz.answers import Choice
    from kit.school.quiz.items import Bank, Item
    from kit.school.quiz.quiz_session import Plan, Sitting
    from kit.tui.terminal import TerminalDecision

WIDTH: Final = 78
NOT_SURE_WORDS: Final = ("?", "0")
LEAVE_WORDS: Final = ("q", "quit")


class _Left(Exception):
    """The student has had enough for now."""


@click.command()
@click.argument("lesson", required=False)
@click.option("--today", is_flag=True, help="Ask what is due: topics come back after 1, 3, 7 and 21 days.")
@click.option(
    "--scores", is_flag=True, help="Print scores by topic, how sure you were, and what comes back when."
)
@click.option("--again", is_flag=True, help="Begin anew what is finished; earlier answers are kept.")
@click.option("--plain", is_flag=True, help="Line by line, also on a full-screen terminal.")
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
    """Find out what you know: twelve questions on the twelve ideas, or those of a LESSON (its number or name).

    Each answer is kept at once: leave when you like, and the same command goes on there. "Not sure" is an answer too,
    and not counted as wrong.

    \b
      kit quiz             the twelve questions
      kit quiz 7           the questions of lesson 7
      kit quiz --today     what is due today
      kit quiz --scores    what you know, and how well you judge it
    """
    if sum((lesson is not None, today, scores)) > 1:
        raise click.UsageError("Choose one of LESSON, --today and --scores.")
    terminal = options.terminal(plain=plain, glyphs=glyphs, color=color)
    bank = _bank()
    if scores:
        _print_scores(bank, workspace)
        return
    plan = _plan(bank, lesson, today)
    from kit.school.progress import ProgressError

    try:
        with _progress(workspace) as journal:
            sitting = _sitting(journal, bank, plan, again)
            if sitting.item is None:
                _print_finished(sitting)
            elif terminal.plain.value:
                ask_plainly(sitting)
            else:
                _ask_on_screen(sitting, terminal)
    except ProgressError as error:
        options.fail(str(error))


def _bank() -> Bank:
    from kit.school.quiz.reading import read_bank
    from kit.world.problems import WorldError

    try:
        return read_bank()
    except (WorldError, FileNotFoundError) as error:
        options.fail(str(error))


def _plan(bank: Bank, lesson: str | None, today: bool) -> Plan:
    from kit.school.quiz.items import UnknownLesson
    from kit.school.quiz.quiz_session import Today, of_lesson, the_twelve

    try:
        if today:
            return Today(bank)
        return the_twelve(bank) if lesson is None else of_lesson(bank, bank.find_lesson(lesson))
    except UnknownLesson as error:
        options.fail(str(error))


def _progress(workspace: Path | None) -> ProgressJournal:
    from kit.school.progress import ProgressJournal
    from kit.workspace import WorkspaceError, open_workspace

    try:
        journal = ProgressJournal(open_workspace(workspace).folder)
    except WorkspaceError as error:
        options.fail(str(error))
    if journal.notice:
        click.echo(journal.notice, err=True)
    return journal


def _sitting(journal: ProgressJournal, bank: Bank, plan: Plan, again: bool) -> Sitting:
    from kit.school.quiz.quiz_session import Sitting, student_seed

    return Sitting(journal, bank, plan, seed=student_seed(journal), anew=again)


def _print_scores(bank: Bank, workspace: Path | None) -> None:
    from kit.school.progress import FILE, ProgressError
    from kit.school.quiz.answers import answers_of
    from kit.school.quiz.quiz_session import local_now
    from kit.school.quiz.quiz_text import scores_lines
    from kit.school.quiz.schedule import schedule_of

    events: list[ProgressEvent] = []
    try:
        if (options.desk(workspace).folder / FILE).exists():  # else looking would make it
            with _progress(workspace) as journal:
                events = journal.events()
    except ProgressError as error:
        options.fail(str(error))
    for line in scores_lines(bank, answers_of(events), schedule_of(bank, events, local_now())):
        click.echo(line)


def _print_finished(sitting: Sitting) -> None:
    """There is nothing to ask: how it came out, and what one can do."""
    from kit.school.quiz.quiz_session import InRounds
    from kit.school.quiz.quiz_text import again_line, closing_lines, schedule_lines, today_line

    if isinstance(sitting.plan, InRounds):
        for line in (*closing_lines(sitting), again_line(sitting.plan)):
            click.echo(line)
        return
    schedule = sitting.schedule()
    click.echo(today_line(schedule))
    if schedule.standings:
        click.echo("")
        for line in schedule_lines(schedule):
            click.echo(line)


def _ask_on_screen(sitting: Sitting, terminal: TerminalDecision) -> NoReturn:
    os.environ.update(terminal.environment())
    from kit.tui.app import KitApp
    from kit.tui.screens.quiz import QuizScreen

    app = KitApp(terminal)
    app.begin(QuizScreen(sitting))
    app.run()
    raise SystemExit(app.return_code or 0)


# Line by line


def ask_plainly(sitting: Sitting) -> None:
    """Asks what the sitting has ahead, by lines of standard input, until all is asked, ``q``, or its end."""
    from kit.school.quiz.quiz_text import closing_lines, today_line

    click.echo(f"{sitting.plan.title}: {sitting.total} questions.")
    if sitting.number > 1:
        click.echo(f"You go on at question {sitting.number}.")
    click.echo("Answer with 1, 2 or 3; ? is not sure; Enter alone leaves it blank; q leaves.")
    try:
        while (item := sitting.item) is not None:
            _ask(sitting, item)
        click.echo("")
        for line in closing_lines(sitting):
            click.echo(line)
    except (_Left, KeyboardInterrupt):
        click.echo("")
        click.echo(
            f"{sitting.number - 1} of {sitting.total} answered. `{sitting.plan.command}` goes on here. "
            + today_line(sitting.schedule())
        )


def _ask(sitting: Sitting, item: Item) -> None:
    from kit.school.quiz.quiz_text import feedback, verdict, ways_on, wrapped

    click.echo("")
    click.echo(f"Question {sitting.number} of {sitting.total}, {item.topic.label}")
    for line in wrapped(item.question, WIDTH):
        click.echo(line)
    if item.picture:
        click.echo("")
        for row in item.picture:
            click.echo(f"    {row}".rstrip())
        click.echo("")
    for number, option in enumerate(item.options, 1):
        first, *rest = wrapped(option.text, WIDTH, "     ")
        click.echo(f"  {number}  {first.strip()}")
        for line in rest:
            click.echo(line)
    click.echo("  ?  I am not sure")
    choice = _choice()
    sitting.answer(choice, None if choice.option is None else _confidence())
    click.echo(verdict(item, choice))
    for line in (*wrapped(feedback(item, choice), WIDTH), *ways_on(item, WIDTH)):
        click.echo(line)


def _choice() -> Choice:
    from kit.school.quiz.answers import BLANK, NOT_SURE, Choice
    from kit.school.quiz.items import OPTIONS

    choices = {str(index + 1): Choice(index) for index in range(OPTIONS)}
    choices |= dict.fromkeys(NOT_SURE_WORDS, NOT_SURE)
    asked_once = False
    while True:
        said = _line()
        if said in choices:
            return choices[said]
        if not said and asked_once:
            return BLANK
        asked_once = not said
        click.echo(
            "Enter once more leaves it blank; ? says that you are not sure."
            if asked_once
            else "Answer with 1, 2 or 3; ? is not sure; Enter alone leaves it blank; q leaves."
        )


def _confidence() -> int | None:
    from kit.school.quiz.quiz_text import SURE_CHOICES, SURE_QUESTION

    words = ", ".join(f"{number} {text}" for number, text in SURE_CHOICES)
    click.echo(f"{SURE_QUESTION} {words}")
    while True:
        said = _line()
        if not said:
            return None
        number = next((number for number, _ in SURE_CHOICES if said == str(number)), None)
        if number is not None:
            return number
        click.echo("Say 1, 2, 3 or 4; Enter alone leaves it open; q leaves.")


def _line() -> str:
    """The next line that the student types. Raises _Left where they leave, or there are no more."""
    if sys.stdin is None:
        raise _Left
    if sys.stdin.isatty():
        click.echo("> ", nl=False)
    line = sys.stdin.readline()
    said = line.strip().lower()
    if not line or said in LEAVE_WORDS:
        raise _Left
    return said
