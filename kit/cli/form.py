"""``kit form``: asks the evaluation form question by question; each answer is saved before the next is asked."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import click

from kit.cli import messages, opening, options, terminal_options
from kit.cli.dialogue import run_dialogue
from kit.cli.full_screen import show_dialogue
from kit.document.blocks import Block, Text
from kit.document.layout import lines_of
from kit.school.form_answers import FormAnswers, asked_questions
from kit.school.form_dialogue import FormDialogue, shown_answer
from kit.school.form_reading import read_form
from kit.school.form_session import FormSession, current_phase
from kit.school.progress import ProgressError
from kit.school.survey import SurveyForm, SurveyPhase
from kit.workspace import WorkspaceError, open_workspace
from kit.world.problems import WorldError


@click.command()
@click.argument("phase", required=False, type=click.Choice(["before", "after", "quizzed"]))
@click.option("--again", is_flag=True, help="Ask every question again; new answers replace the old ones.")
@click.option("--show", is_flag=True, help="Show your answers without asking anything.")
@click.option("--plain", is_flag=True, help="Print lines of text instead of a full screen.")
@options.workspace
@terminal_options.glyphs
@terminal_options.color
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
    terminal = terminal_options.decide(plain=plain, glyphs=glyphs, color=color)
    with _explained_errors():
        form = read_form()
        with opening.open_journal(open_workspace(workspace)) as journal:
            chosen = SurveyPhase(phase) if phase else current_phase(form, journal)
            session = FormSession(form, chosen, journal, again=again)
            if show:
                _print_answers(form, session.answers, [SurveyPhase(phase)] if phase else list(SurveyPhase))
            elif terminal.plain.value and session.question is None:
                again_command = f"kit form {chosen.value} --again"
                click.echo(
                    f"{session.answered_text} `{again_command}` asks again, `kit form --show` shows it."
                )
            elif terminal.plain.value:
                run_dialogue(FormDialogue(session))
            else:
                show_dialogue(FormDialogue(session), terminal)


def _print_answers(form: SurveyForm, answers: FormAnswers, phases: list[SurveyPhase]) -> None:
    """Prints the answers, phase by phase."""
    blocks: list[Block] = []
    for phase in phases:
        if not answers.has_started(phase):
            blocks.append(Text(f"{phase.value}: nothing answered yet.", is_tight=True))
            continue
        blocks.append(Text(f"{phase.value}:", is_tight=True))
        group = ""
        for question in asked_questions(form, answers, phase):
            if question.group_text and question.group_text != group:
                blocks.append(Text(question.group_text, indent=2, is_tight=True))
            group = question.group_text
            is_answered = answers.is_answered(question.id, phase)
            said = (
                shown_answer(answers.value(question.id, phase), question) if is_answered else "not asked yet"
            )
            blocks.append(Text(f"{question.text}: {said}", indent=4 if group else 2, hang=2, is_tight=True))
    click.echo(messages.replace_unencodable("\n".join(lines_of(blocks))))


@contextmanager
def _explained_errors() -> Iterator[None]:
    try:
        yield
    except (ProgressError, WorkspaceError, WorldError, FileNotFoundError) as error:
        messages.fail(str(error))
