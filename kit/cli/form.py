"""``kit form``: asks the evaluation form question by question; each answer is saved before the next is asked."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Final

import click

from kit.cli import options
from kit.plain_text import counted, is_printable

if TYPE_CHECKING:
    from kit.school.progress import ProgressJournal
    from kit.school.survey import AnswerValue, FormAnswers, SurveyForm, SurveyPhase, SurveyQuestion

WIDTH: Final = 78

BACK, LEAVE, BLANK = "b", "q", "-"


@click.command()
@click.argument("phase", required=False, type=click.Choice(["before", "after", "quizzed"]))
@click.option("--again", is_flag=True, help="Ask every question again; new answers replace the old ones.")
@click.option("--show", is_flag=True, help="Show your answers without asking anything.")
@options.workspace
def command(phase: str | None, again: bool, show: bool, workspace: Path | None) -> None:
    """Fill in the evaluation form: what you knew before, what you learned, how useful the kit was.

    \b
    kit form before      before the first lesson; a few minutes
    kit form after       after the lessons, before the quiz; about ten minutes
    kit form quizzed     after the quiz: rate what you learned once more

    Without an argument, the form continues where you stopped. Each answer is saved at once; quit whenever you like.
    Enter leaves a question blank, and blank answers are counted only as blank. Your teacher sees your answers only
    if you export your progress and hand it in.
    """
    from kit.school.progress import EventKind
    from kit.school.survey import FormAnswers, SurveyPhase, read_form
    from kit.workspace import open_workspace

    with _explained_errors():
        form = read_form()
        with options.open_journal(open_workspace(workspace)) as journal:
            answers = FormAnswers.from_events(form, journal.events(EventKind.FORM))
            chosen = SurveyPhase(phase) if phase else _current_phase(form, answers, journal)
            if show:
                _show(form, answers, [SurveyPhase(phase)] if phase else list(SurveyPhase))
            else:
                _ask_all(form, chosen, journal, again=again)


def _current_phase(form: SurveyForm, answers: FormAnswers, journal: ProgressJournal) -> SurveyPhase:
    """Returns ``before`` until that part is done or a lesson was begun without it, then ``after``, then what follows the quiz."""
    from kit.school.progress import EventKind
    from kit.school.quiz.schedule import AnswerOccasion, answers_from_events
    from kit.school.survey import SurveyPhase, open_questions

    if answers.has_started(SurveyPhase.AFTER) and not open_questions(form, answers, SurveyPhase.AFTER):
        last = max(
            each.timestamp
            for each in journal.events(EventKind.FORM)
            if each.content.get("phase") == SurveyPhase.AFTER.value
        )
        quiz = [
            each
            for each in answers_from_events(journal.events(EventKind.ANSWER))
            if each.occasion is AnswerOccasion.QUIZ
        ]
        if any(each.time > datetime.fromisoformat(last) for each in quiz):
            return SurveyPhase.QUIZZED
    if answers.has_started(SurveyPhase.AFTER) or not open_questions(form, answers, SurveyPhase.BEFORE):
        return SurveyPhase.AFTER
    begun = answers.has_started(SurveyPhase.BEFORE) or not journal.events(EventKind.ATTEMPT)
    return SurveyPhase.BEFORE if begun else SurveyPhase.AFTER


def _ask_all(form: SurveyForm, phase: SurveyPhase, journal: ProgressJournal, *, again: bool) -> None:
    """Asks the open questions. Each answer can change which ones follow, so they are determined again each time."""
    from kit.school.progress import EventKind
    from kit.school.survey import FormAnswers, asked_questions, open_questions

    done: list[SurveyQuestion] = []
    """Questions answered since the start, for going back."""
    lead = ""
    back_to: SurveyQuestion | None = None
    introduced = False
    while True:
        answers = FormAnswers.from_events(form, journal.events(EventKind.FORM))
        ahead = asked_questions(form, answers, phase) if again else open_questions(form, answers, phase)
        question = back_to or next((each for each in ahead if each not in done), None)
        if question is None:
            break
        if not introduced:
            _print_introduction(form, phase, len(ahead))
            introduced = True
        if question.group_text and question.group_text != lead:
            _print_group(question)
        lead = question.group_text
        number = asked_questions(form, answers, phase).index(question) + 1
        reply = _ask(
            question, answers.value(question.id, phase), number, len(asked_questions(form, answers, phase))
        )
        back_to = None
        if reply is None:
            left = len(open_questions(form, answers, phase))
            click.echo(f"Saved. {counted(left, 'question')} left; `kit form {phase.value}` continues here.")
            return
        if reply.back:
            back_to = done.pop() if done else question
            lead = ""
            if back_to is question:
                click.echo("  This is the first question since you started.")
            continue
        journal.add(EventKind.FORM, question.id, {"phase": phase.value, "value": reply.value})
        done.append(question)
    click.echo(
        f"Thank you, that is all.{_NEXT_STEP.get(phase.value, '')}"
        if introduced
        else f"Every question of the form '{phase.value}' is answered. `kit form {phase.value} --again` asks again, "
        "`kit form --show` shows it."
    )


@dataclass(frozen=True, slots=True)
class _Reply:
    """The reply to one question: an answer, or a step back."""

    value: AnswerValue = None
    back: bool = False


def _ask(question: SurveyQuestion, was: AnswerValue, number: int, of: int) -> _Reply | None:
    """Asks one question until it is answered; None where the student leaves."""
    from kit.school.survey import InvalidAnswer, parse_answer

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


_NEXT_STEP: Final = {"after": " Now the quiz: `kit quiz`; then `kit form quizzed`, which is short."}
_WHEN: Final = {"before": "before the lessons", "after": "after the lessons", "quizzed": "after the quiz"}


def _print_introduction(form: SurveyForm, phase: SurveyPhase, count: int) -> None:
    click.echo(f"{form.title} ({_WHEN[phase.value]}): {counted(count, 'question')}.")
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
    from kit.school.survey import asked_questions

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
    from kit.school.progress import ProgressError
    from kit.workspace import WorkspaceError
    from kit.world.problems import WorldError

    try:
        yield
    except (ProgressError, WorkspaceError, WorldError, FileNotFoundError) as error:
        options.fail(str(error))
