"""``kit form``: asks the evaluation form question by question; each answer is saved before the next is asked."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Final, NoReturn

import click

from kit.cli import options
from kit.cli.full_screen import show_screen
from kit.plain_text import counted, is_printable
from kit.school.form_session import PHASE_LABELS, FormSession, current_phase
from kit.school.progress import ProgressError
from kit.school.survey import (
    AnswerValue,
    FormAnswers,
    InvalidAnswer,
    SurveyForm,
    SurveyPhase,
    SurveyQuestion,
    asked_questions,
    parse_answer,
    read_form,
)
from kit.tui.terminal import TerminalDecision
from kit.workspace import WorkspaceError, open_workspace
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.tui.app import KitApp
    from kit.tui.screens.form import FormScreen

WIDTH: Final = 78

BACK, LEAVE, BLANK = "b", "q", "-"


@click.command()
@click.argument("phase", required=False, type=click.Choice(["before", "after", "quizzed"]))
@click.option("--again", is_flag=True, help="Ask every question again; new answers replace the old ones.")
@click.option("--show", is_flag=True, help="Show your answers without asking anything.")
@click.option("--plain", is_flag=True, help="Print lines of text instead of a full screen.")
@options.workspace
@options.glyphs
@options.color
def command(
    phase: str | None,
    again: bool,
    show: bool,
    plain: bool,
    workspace: Path | None,
    glyphs: str | None,
    color: str | None,
) -> None:
    """Fill in the evaluation form: what you knew before, what you learned, how useful the kit was.

    \b
    kit form before      before the first lesson; a few minutes
    kit form after       after the lessons, before the quiz; about ten minutes
    kit form quizzed     after the quiz: rate what you learned once more

    Without an argument, the form continues where you stopped. Each answer is saved at once; quit whenever you like.
    Enter leaves a question blank, and blank answers are counted only as blank. Your teacher sees your answers only
    if you export your progress and hand it in.
    """
    terminal = options.terminal(plain=plain, glyphs=glyphs, color=color)
    with _explained_errors():
        form = read_form()
        with options.open_journal(open_workspace(workspace)) as journal:
            chosen = SurveyPhase(phase) if phase else current_phase(form, journal)
            session = FormSession(form, chosen, journal, again=again)
            if show:
                _show(form, session.answers, [SurveyPhase(phase)] if phase else list(SurveyPhase))
            elif terminal.plain.value:
                _ask_all(session)
            else:
                _ask_on_full_screen(session, terminal)


def _ask_on_full_screen(session: FormSession, terminal: TerminalDecision) -> NoReturn:
    def make_screen(app: KitApp) -> FormScreen:
        from kit.tui.screens.form import FormScreen

        return FormScreen(session)

    show_screen(terminal, make_screen)


# Line by line


def _ask_all(session: FormSession) -> None:
    """Asks the open questions until none is left, or the student leaves."""
    command_again = f"kit form {session.phase.value}"
    if session.question is None:
        click.echo(
            f"{session.answered_text} `{command_again} --again` asks again, `kit form --show` shows it."
        )
        return
    _print_introduction(session)
    lead = ""
    while (question := session.question) is not None:
        if question.group_text and question.group_text != lead:
            _print_group(question)
        lead = question.group_text
        reply = _ask(question, session.value, session.number, session.count)
        if reply is None:
            click.echo(
                f"Saved. {counted(session.open_count, 'question')} left; `{command_again}` continues here."
            )
            return
        if not reply.back:
            session.answer(reply.value)
            continue
        lead = ""
        if not session.go_back():
            click.echo("  This is the first question.")
    click.echo(session.closing_text)


@dataclass(frozen=True, slots=True)
class _Reply:
    """The reply to one question: an answer, or a step back."""

    value: AnswerValue = None
    back: bool = False


def _ask(question: SurveyQuestion, was: AnswerValue, number: int, of: int) -> _Reply | None:
    """Asks one question until it is answered; None where the student leaves."""
    head = f"{number}/{of}  "
    if question.group_text:
        _print_wrapped(head, question.text)
    else:
        _print_group(question, head)
    if was is not None:
        click.echo(
            f"  your answer: {options.replace_unencodable(format_answer(_shown(was, question)))} (Enter keeps it, {BLANK} makes it blank)"
        )
    while True:
        click.echo(f"  {_HINTS[question.shape.value]}> ", nl=False)
        line = _read_line()
        word = line.strip().lower()
        if not line or word == LEAVE:
            return None
        if word == BACK:
            return _Reply(back=True)
        if word == BLANK:
            return _Reply(None)
        if not word and was is not None:
            return _Reply(was)
        try:
            return _Reply(parse_answer(question, line))
        except InvalidAnswer as error:
            click.echo(f"  {error}")


def _read_line() -> str:
    """Reads a line; empty at the end of the input and on Ctrl-C."""
    try:
        line = sys.stdin.readline() if sys.stdin is not None else ""
    except KeyboardInterrupt:
        line = ""
    except UnicodeDecodeError:
        return "\ufffd\n"
    if not line or not sys.stdin.isatty():
        click.echo()
    return line


_HINTS: Final = {"scale": "1-7", "choice": "number", "yes_no": "y/n", "text": "your words"}


def _print_introduction(session: FormSession) -> None:
    click.echo(
        f"{session.form.title} ({PHASE_LABELS[session.phase]}): {counted(session.count if session.asks_again else session.open_count, 'question')}."
    )
    click.echo("Enter leaves one blank, b goes back, q quits. Every answer is kept at once.")


def _print_group(question: SurveyQuestion, head: str = "") -> None:
    """Prints the text and scale of a group of questions, or of one that stands alone."""
    click.echo()
    _print_wrapped(head, question.group_text or question.text)
    if question.low:
        click.echo(f"  1 {question.low} ... 7 {question.high}")
    for number, option in enumerate(question.shown_options or question.options, 1):
        click.echo(f"  {number} {option}")


def _print_wrapped(head: str, text: str) -> None:
    click.echo("\n".join(wrap(text, WIDTH, initial_indent=head, subsequent_indent=" " * len(head))))


def _show(form: SurveyForm, answers: FormAnswers, phases: list[SurveyPhase]) -> None:
    for phase in phases:
        if not answers.has_started(phase):
            click.echo(f"{phase.value}: nothing answered yet.")
            continue
        click.echo(f"{phase.value}:")
        lead = ""
        for question in asked_questions(form, answers, phase):
            if question.group_text and question.group_text != lead:
                click.echo(
                    "\n".join(wrap(question.group_text, WIDTH, initial_indent="  ", subsequent_indent="  "))
                )
            lead = question.group_text
            value = answers.value(question.id, phase)
            answer_text = (
                format_answer(_shown(value, question))
                if answers.is_answered(question.id, phase)
                else "not asked yet"
            )
            indent = "    " if question.group_text else "  "
            text = f"{question.text}: {answer_text}"
            click.echo(
                options.replace_unencodable(
                    "\n".join(wrap(text, WIDTH, initial_indent=indent, subsequent_indent=indent + "  "))
                )
            )


def _shown(value: AnswerValue, question: SurveyQuestion) -> AnswerValue:
    """The answer as the form shows it: an option of a choice in the form's language."""
    return dict(zip(question.options, question.shown_options, strict=False)).get(str(value), value)


def format_answer(value: AnswerValue) -> str:
    """Formats an answer for the terminal."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "blank" if value is None else "".join(sign if is_printable(sign) else "?" for sign in str(value))


@contextmanager
def _explained_errors() -> Iterator[None]:
    try:
        yield
    except (ProgressError, WorkspaceError, WorldError, FileNotFoundError) as error:
        options.fail(str(error))
