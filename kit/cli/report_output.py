"""Options and files of the verbs that print a report: text, JSON, CSV, HTML, SVG."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kit.cli import messages, terminal_options
from kit.cli.output_file import OutputFile
from kit.document.data_files import document_to_json, table_to_csv
from kit.document.glyphs import ASCII_GLYPHS, BLOCK_GLYPHS
from kit.document.layout import document_lines
from kit.school.progress import ProgressError
from kit.workspace import write_atomically
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.document.blocks import Document


@dataclass(frozen=True, slots=True)
class ReportOutputs:
    """The files that were asked for, each by an option; None: not this one."""

    svg_folder: Path | None
    html_file: Path | None
    csv_folder: Path | None
    json_file: Path | None
    glyphs: str | None
    """Characters used to draw bars; None: those that standard output can encode."""

    @property
    def has_files(self) -> bool:
        """Whether any file was asked for."""
        return any((self.svg_folder, self.html_file, self.csv_folder, self.json_file))


def output_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Decorator: adds the options that write a report to files, and passes them as ``outputs``."""

    @wraps(function)
    def verb(
        *arguments: Any,
        svg_folder: Path | None,
        html_file: Path | None,
        csv_folder: Path | None,
        json_file: Path | None,
        glyphs: str | None,
        **rest: Any,
    ) -> None:
        function(
            *arguments,
            outputs=ReportOutputs(svg_folder, html_file, csv_folder, json_file, glyphs),
            **rest,
        )

    decorated: Callable[..., Any] = verb
    for option in (
        click.option(
            "--glyphs", type=click.Choice(["unicode", "ascii"]), help="Characters used to draw bars."
        ),
        click.option(
            "--json",
            "json_file",
            metavar="FILE",
            type=OutputFile(allow_dash=True),
            help="Write everything as JSON; - writes to standard output.",
        ),
        click.option(
            "--csv",
            "csv_folder",
            metavar="FOLDER",
            type=click.Path(file_okay=False, path_type=Path),
            help="Write one CSV file per table.",
        ),
        click.option(
            "--html",
            "html_file",
            metavar="PLACE",
            type=click.Path(path_type=Path),
            help="Write one page with plots: an .html file, or a folder for index.html.",
        ),
        click.option(
            "--svg",
            "svg_folder",
            metavar="FOLDER",
            type=click.Path(file_okay=False, path_type=Path),
            help="Write one SVG picture per plot.",
        ),
    ):
        decorated = option(decorated)
    return decorated


def write_outputs(made: Document, outputs: ReportOutputs, *, printed: Document | None = None) -> None:
    """Writes the files that were asked for, and prints the text unless JSON goes to the terminal.

    ``printed``: what is printed instead of the whole.
    """
    from kit.document.html import document_to_html
    from kit.document.svg import plot_to_svg

    html_file, json_file = outputs.html_file, outputs.json_file
    to_terminal = json_file is not None and str(json_file) == "-"
    files: dict[Path, str] = {}
    if outputs.svg_folder is not None:
        files |= {outputs.svg_folder / f"{plot.id}.svg": plot_to_svg(plot) for plot in made.plots}
    if outputs.csv_folder is not None:
        files |= {outputs.csv_folder / f"{table.id}.csv": table_to_csv(table) for table in made.tables}
    if html_file is not None:
        page = html_file
        if html_file.suffix != ".html":
            html_file.mkdir(parents=True, exist_ok=True)
            page = html_file / "index.html"
        files[page] = document_to_html(made)
    if json_file is not None and not to_terminal:
        files[json_file] = document_to_json(made)
    for folder in (outputs.svg_folder, outputs.csv_folder):
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)
    _write_reports(files)
    if to_terminal:
        click.echo(document_to_json(made).encode(), nl=False)
    else:
        chosen = (
            ASCII_GLYPHS
            if outputs.glyphs == "ascii" or (outputs.glyphs is None and not _can_encode_blocks())
            else BLOCK_GLYPHS
        )
        click.echo(messages.replace_unencodable("\n".join(document_lines(printed or made, chosen))))


def _write_reports(files: Mapping[Path, str]) -> None:
    """Writes each file whole or not at all, and prints which."""
    for file, text in files.items():
        write_atomically(file, text.encode("utf-8", errors="replace"))
    if files:
        places = sorted(
            {str(file.parent) if file.suffix in (".svg", ".csv") else str(file) for file in files}
        )
        click.echo(f"Written: {', '.join(places)}", err=True)


def _can_encode_blocks() -> bool:
    """Whether standard output can encode block characters."""
    decided = terminal_options.decide().glyphs.value
    encoding = getattr(sys.stdout, "encoding", None) or "ascii"
    try:
        "█▒░·".encode(encoding)
    except (UnicodeEncodeError, LookupError):
        return False
    return decided != "ascii"


@contextmanager
def explained_errors() -> Iterator[None]:
    """Ends the verb with one clear line for every error that a user can cause."""
    try:
        yield
    except BrokenPipeError:
        raise  # whoever read the output has enough; click ends quietly
    except OSError as error:
        messages.fail(messages.describe_os_error(error))
    except (ProgressError, WorldError) as error:
        messages.fail(str(error))
