"""``grader report``: a result that was kept, in another format."""

from __future__ import annotations

import json
from pathlib import Path

import click

from grader.cli import options


@click.command()
@click.argument("file", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option(
    "--format",
    "format_name",
    default="text",
    show_default=True,
    metavar="NAME",
    help="text, json, junit, gradescope, classroom, prairielearn, check50 or markdown.",
)
@click.option(
    "--output", type=click.Path(dir_okay=False, path_type=Path), help="Write the report there instead."
)
def command(file: Path, format_name: str, output: Path | None) -> None:
    """Write a result (made by `grader check --json`) in another format."""
    from grader.reports import FORMATS, find_writer
    from kit.school.result import GradingResult
    from kit.workspace import write_atomically

    if format_name not in FORMATS:
        options.fail(f"There is no format {format_name}; there are: {', '.join(FORMATS)}.")
    try:
        result = GradingResult.from_dict(json.loads(file.read_bytes()))
    except (KeyError, TypeError, ValueError, RecursionError):
        options.fail(f"{file}: not a result of the grader.")
    text = find_writer(format_name)(result)
    if output is None:
        click.echo(text, nl=False)
    else:
        write_atomically(output.absolute(), text.encode())
