"""``kit ros launch_test``: runs a test for launch_testing."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from kit.cli import messages, opening, options
from kit.cli.existing_path import ExistingPath
from kit.cli.launch import launch_errors, parse_words, show_arguments
from kit.cli.output_file import OutputFile
from kit.inspection.sockets import sockets_folder, world_name

if TYPE_CHECKING:
    from kit.launch.launch_run import LaunchOutputLine


@click.command()
@click.argument("file", metavar="FILE", type=ExistingPath(dir_okay=False, path_type=Path))
@click.argument("words", nargs=-1, metavar="[NAME:=VALUE ...]")
@click.option(
    "--junit-xml",
    type=OutputFile(),
    help="Write the results to this file as xUnit XML.",
)
@click.option(
    "--package-name", metavar="NAME", help="Name of the package in the XML (default: the file's name)."
)
@click.option(
    "-s",
    "--show-args",
    "--show-arguments",
    "show_args",
    is_flag=True,
    help="Show the launch's arguments and exit.",
)
@options.seed
@options.workspace
def command(
    file: Path,
    words: Sequence[str],
    junit_xml: Path | None,
    package_name: str | None,
    show_args: bool,
    seed: int,
    workspace: Path | None,
) -> None:
    """Run a test file for launch_testing, as `launch_test` and `ros2 test` do.

    The file's generate_test_description() says what is launched; its unittest classes run beside it in the same simulated
    time, and those marked with launch_testing.post_shutdown_test() when every process has ended. All goes as fast as it can,
    and alike on every machine. `pytest FILE` does not launch anything here.

    \b
    kit ros launch_test test_talker.launch.py
    kit ros launch_test test_talker.launch.py rate:=10 --junit-xml results.xml

    Exit code: 0 all tests passed; 1 one failed, or the launch ended before its tests; 2 something is missing or wrong; 130
    interrupted by Ctrl-C.
    """
    from kit.inspection.server import open_inspection_server
    from kit.launch.launch_file_process import find_test_file
    from kit.launch.launch_test import run_launch_test
    from kit.launch.launch_test_report import write_xunit

    opened_workspace = opening.open_existing_workspace(workspace)
    rest, arguments = parse_words(words)
    if rest is not None:
        messages.fail(f"Arguments look like NAME:=VALUE, without spaces; this does not: {rest}")
    target = find_test_file(file, [opened_workspace.packages])
    if show_args:
        show_arguments(target, is_test=True)
        return
    with launch_errors():
        tested = run_launch_test(
            target,
            arguments,
            seed=seed,
            workspace=opened_workspace.folder,
            name=world_name(target.name),
            on_output=_print_line,
            make_companion=lambda graph: open_inspection_server(
                graph, sockets_folder(opened_workspace.folder), target.name
            ),
            log=lambda record: click.echo(str(record), err=True),
        )
        if junit_xml is not None:
            write_xunit(junit_xml, package_name or target.name, target.name, tested)
    if any(each.is_failed for each in tested):
        raise SystemExit(1)


def _print_line(line: LaunchOutputLine) -> None:
    is_of_tests = line.severity is None and line.program == "launch"
    click.echo(line.text if is_of_tests else str(line), err=line.stream == "err")
