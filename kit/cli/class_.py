"""``kit class``: reports what a class did and did not learn, and prints the teacher's guide."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import click

from kit.cli import messages, report_output
from kit.cli.lazy_group import HintingGroup
from kit.plain_text import escape_controls, unknown_name
from kit.school.form_reading import read_form
from kit.school.lessons.reading import UnknownLesson, find_lesson
from kit.school.lessons.teachers_guide import teachers_guide
from kit.school.quiz.items import read_bank
from kit.school.report.class_data import build_class_data, read_roster
from kit.school.report.class_report import CHAPTER_IDS, build_report, prepare_report
from kit.school.report.measures import ReportItem

DIVISION_METHODS = ("mean", "half", "scale")

EMPTY = 1
"""Exit code of ``report``: no file held a student's progress."""


@click.group(cls=HintingGroup)
def command() -> None:
    """Report on a class, or print the teacher's guide.

    \b
    kit class report FILES...   report on exported progress files
    kit class guide             what each lesson teaches, and common errors

    Students create progress files with `kit progress export FILE`.
    """


@command.command()
@click.argument("files", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "--division",
    type=click.Choice(DIVISION_METHODS),
    default="mean",
    show_default=True,
    help="Divide beginners from experts at the mean score, into two halves, or at 3.5, the middle of the scale.",
)
@click.option("--names", is_flag=True, help="Show students' names instead of S1, S2, ...")
@click.option(
    "--only",
    metavar="CHAPTERS",
    help="Only these chapters, separated by commas: class, experience, knowledge, outcomes, difficulty, explanation, quiz, items, relations, robustness, lessons, words.",
)
@report_output.output_options
def report(
    files: tuple[Path, ...],
    division: str,
    names: bool,
    only: str | None,
    outputs: report_output.ReportOutputs,
) -> None:
    """Report what a class knew, learned, found hard and got right, from FILES that its students exported.

    A folder means every .json file in it. Files that cannot be read are listed and skipped; two files of the same
    student count once. Students are shown as S1, S2, ... unless --names is given.
    """
    wanted = tuple(part.strip() for part in (only or "").split(",") if part.strip())
    for each in wanted:
        if each not in CHAPTER_IDS:
            messages.fail(unknown_name("chapter", each, CHAPTER_IDS))
    with report_output.explained_errors():
        roster = read_roster(files, use_names=names)
        if not roster.students:
            click.echo(escape_controls("\n".join(roster.warnings)), err=True)
            messages.say(
                "None of the files contains a student's progress. `kit progress export FILE` creates one.",
                err=True,
            )
            raise SystemExit(EMPTY)
        data = build_class_data(roster, read_form(), _quiz_items())
        made = build_report(prepare_report(data, method=division), roster.file_count, wanted)
        report_output.write_outputs(made, outputs)


@command.command()
@click.argument("lessons", nargs=-1)
def guide(lessons: tuple[str, ...]) -> None:
    """Print the teacher's guide as Markdown, for all lessons or for LESSONS, by name or number.

    \b
    kit class guide > guide.md
    kit class guide 3
    """
    with report_output.explained_errors():
        try:
            names = [find_lesson(each).name for each in lessons]
        except UnknownLesson as error:
            messages.fail(str(error))
        click.echo(messages.replace_unencodable(teachers_guide(names)), nl=False)


def _quiz_items() -> Mapping[str, ReportItem]:
    """The questions of the kit's quiz with their options; none where the lessons are not there."""
    try:
        bank = read_bank()
    except FileNotFoundError:
        return {}
    ordered = (*bank.quiz_items, *(item for item in bank.items if not item.idea))
    return {
        item.id: ReportItem(
            item.id, item.topic.value, tuple(option.text for option in item.options), bool(item.idea)
        )
        for item in ordered
    }
