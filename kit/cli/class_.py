"""``kit class``: reports what a class did and did not learn; computes the dissertation's own evaluation again."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kit.cli import options

if TYPE_CHECKING:
    from kit.school.report.document import ClassReport
    from kit.school.report.measures import ReportItem

DIVISION_METHODS = ("mean", "half", "scale")

EMPTY = 1
"""Exit code of ``report``: no file held a student's progress."""


@click.group()
def command() -> None:
    """Reports on a class.

    \b
    kit class report FILES...    from the progress files that students handed in
    kit class guide              what each lesson teaches, and what students get wrong
    kit class study              the dissertation's tables beside ours, from its raw answers

    A student makes such a file with `kit progress export FILE`.
    """


def _output_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Adds the options that write a report to files."""
    for option in (
        click.option("--glyphs", type=click.Choice(["unicode", "ascii"]), help="What bars are drawn with."),
        click.option(
            "--json",
            "json_file",
            metavar="FILE",
            type=click.Path(dir_okay=False, allow_dash=True, path_type=Path),
            help="Everything for machines; - is standard output.",
        ),
        click.option(
            "--csv",
            "csv_folder",
            metavar="FOLDER",
            type=click.Path(file_okay=False, path_type=Path),
            help="A file a table.",
        ),
        click.option(
            "--html",
            "html_file",
            metavar="FILE",
            type=click.Path(dir_okay=False, path_type=Path),
            help="One page, with plots.",
        ),
        click.option(
            "--svg",
            "svg_folder",
            metavar="FOLDER",
            type=click.Path(file_okay=False, path_type=Path),
            help="A picture a plot.",
        ),
    ):
        function = option(function)
    return function


@command.command()
@click.argument("files", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "--division",
    type=click.Choice(DIVISION_METHODS),
    default="mean",
    show_default=True,
    help="Beginners and experts: at the mean score, into halves, or at 3.5, half of the scale.",
)
@click.option("--names", is_flag=True, help="Call students by their names instead of S1, S2, ...")
@click.option(
    "--only",
    metavar="CHAPTERS",
    help="Only these, with commas between: class, experience, knowledge, outcomes, difficulty, explanation, quiz, items, relations, robustness, lessons, words.",
)
@_output_options
def report(
    files: tuple[Path, ...],
    division: str,
    names: bool,
    only: str | None,
    svg_folder: Path | None,
    html_file: Path | None,
    csv_folder: Path | None,
    json_file: Path | None,
    glyphs: str | None,
) -> None:
    """Print what a class knew, learned, found hard and got right, from FILES that its students exported.

    A folder stands for every .json file in it. Files that cannot be read are named and left out; two files of one
    student count once. Students are called S1, S2, ... unless --names is given.
    """
    from kit.plain_text import suggestion
    from kit.school.report.class_data import build_class_data
    from kit.school.report.class_report import CHAPTER_IDS, build_report, prepare_report
    from kit.school.report.students import read_roster
    from kit.school.survey.reading import read_form

    wanted = tuple(part.strip() for part in (only or "").split(",") if part.strip())
    for each in wanted:
        if each not in CHAPTER_IDS:
            options.fail(f"There is no chapter {each!r}: {suggestion(each, CHAPTER_IDS)}")
    with _explained_errors():
        roster = read_roster(files, use_names=names)
        if not roster.students:
            click.echo("\n".join(roster.warnings), err=True)
            click.echo("No file holds a student's progress. `kit progress export FILE` makes one.", err=True)
            raise SystemExit(EMPTY)
        data = build_class_data(roster, read_form(), _items())
        made = build_report(prepare_report(data, method=division), roster.file_count, wanted)
        _write_outputs(made, svg_folder, html_file, csv_folder, json_file, glyphs)


@command.command()
@click.option(
    "--whole", is_flag=True, help="Also every chapter that a class gets, from the dissertation's answers."
)
@_output_options
def study(
    whole: bool,
    svg_folder: Path | None,
    html_file: Path | None,
    csv_folder: Path | None,
    json_file: Path | None,
    glyphs: str | None,
) -> None:
    """Print the dissertation's Tables 5.4 to 5.9 beside ours, computed from its raw answers; its slips by name."""
    from kit.study.evaluation_data import read_evaluation_data
    from kit.study.evaluation_report import evaluation_report

    with _explained_errors():
        made = evaluation_report(read_evaluation_data(), whole=whole)
        _write_outputs(made, svg_folder, html_file, csv_folder, json_file, glyphs)


@command.command()
@click.argument("lessons", nargs=-1)
def guide(lessons: tuple[str, ...]) -> None:
    """Print the teacher's guide as Markdown: the whole, or the part of some LESSONS, by name or number.

    \b
    kit class guide > guide.md
    kit class guide 3
    """
    from kit.school.lessons.reading import UnknownLesson, find_lesson
    from kit.school.lessons.teachers_guide import teachers_guide

    with _explained_errors():
        try:
            names = [find_lesson(each).name for each in lessons]
        except UnknownLesson as error:
            options.fail(str(error))
        click.echo(options.replace_unencodable(teachers_guide(names)), nl=False)


def _items() -> Mapping[str, ReportItem]:
    """The questions of the kit's quiz with their options; none where the lessons are not there."""
    from kit.school.quiz.reading import read_bank
    from kit.school.report.measures import ReportItem

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


def _write_outputs(
    made: ClassReport,
    svg_folder: Path | None,
    html_file: Path | None,
    csv_folder: Path | None,
    json_file: Path | None,
    glyphs: str | None,
) -> None:
    """Writes the files that were asked for, and prints the text unless JSON goes to the terminal."""
    from kit.school.report.as_data import report_to_json, table_to_csv
    from kit.school.report.as_html import report_to_html
    from kit.school.report.as_svg import plot_to_svg
    from kit.school.report.as_text import ASCII_GLYPHS, BLOCK_GLYPHS, report_lines

    to_terminal = json_file is not None and str(json_file) == "-"
    files: dict[Path, str] = {}
    if svg_folder is not None:
        files |= {svg_folder / f"{plot.id}.svg": plot_to_svg(plot) for plot in made.plots}
    if csv_folder is not None:
        files |= {csv_folder / f"{table.id}.csv": table_to_csv(table) for table in made.tables}
    if html_file is not None:
        files[html_file] = report_to_html(made)
    if json_file is not None and not to_terminal:
        files[json_file] = report_to_json(made)
    for folder in (svg_folder, csv_folder):
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)
    _write(files)
    if to_terminal:
        click.echo(report_to_json(made).encode(), nl=False)
    else:
        chosen = (
            ASCII_GLYPHS
            if glyphs == "ascii" or (glyphs is None and not _can_encode_blocks())
            else BLOCK_GLYPHS
        )
        click.echo(options.replace_unencodable("\n".join(report_lines(made, chosen))))


def _write(files: Mapping[Path, str]) -> None:
    """Writes each file whole or not at all, and prints which."""
    from kit.workspace import write_atomically

    for file, text in files.items():
        write_atomically(file, text.encode("utf-8", errors="replace"))
    if files:
        places = sorted(
            {str(file.parent) if file.suffix in (".svg", ".csv") else str(file) for file in files}
        )
        click.echo(f"Written: {', '.join(places)}", err=True)


def _can_encode_blocks() -> bool:
    """Whether standard output can encode block characters."""
    decided = options.terminal().glyphs.value
    encoding = getattr(sys.stdout, "encoding", None) or "ascii"
    try:
        "█▒░·".encode(encoding)
    except (UnicodeEncodeError, LookupError):
        return False
    return decided != "ascii"


@contextmanager
def _explained_errors() -> Iterator[None]:
    from kit.school.progress import ProgressError
    from kit.world.problems import WorldError

    try:
        yield
    except BrokenPipeError:
        raise  # whoever read the output has enough; click ends quietly
    except OSError as error:
        options.fail(f"{options.describe_os_error(error)}.")
    except (ProgressError, WorldError) as error:
        options.fail(str(error))
