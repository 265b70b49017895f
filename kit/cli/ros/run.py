"""``kit ros run``: runs one program beside the running world."""

from __future__ import annotations

import os
import shlex
from collections.abc import Sequence
from pathlib import Path

import click

from kit.cli import messages, opening, options, terminal_options
from kit.cli.launch import run_launch
from kit.cli.process import INTERRUPTED
from kit.cli.ros.world_client import exit_with_error
from kit.host.program_terminal import ProgramTerminal, has_user_terminal
from kit.inspection.client import InspectionClient, WorldDisconnected
from kit.inspection.sockets import WORLD_VARIABLE, WorldNotFound, find_world, sockets_folder
from kit.launch.launch_file_process import SHARE_FOLDER, LaunchTarget
from kit.launch.processes import PrintedLine, ProcessExit, ProcessStartError
from kit.launch.requests import StartRequest
from kit.launch.single_program import SingleProgram
from kit.ros.packages import PackageError, read_package, workspace_folders
from kit.workspace import Workspace


@click.command(context_settings={"ignore_unknown_options": True, "allow_interspersed_args": False})
@click.option(
    "--world",
    metavar="NAME",
    envvar=WORLD_VARIABLE,
    help="World to use, if several run (default: the newest).",
)
@options.seed
@options.workspace
@click.argument("package", metavar="PACKAGE|FOLDER|FILE.py")
@click.argument("words", nargs=-1, type=click.UNPROCESSED, metavar="[EXECUTABLE] [ARGUMENTS ...]")
def command(world: str | None, seed: int, workspace: Path | None, package: str, words: Sequence[str]) -> None:
    """Run a package's program, or a Python file with a node, in the world of another terminal.

    If no world is running, the program runs alone, in real time; the next program joins it.

    \b
    kit ros run my_package my_node --ros-args -p speed:=0.2
    kit ros run my_node.py
    kit ros run turtlesim turtlesim_node

    The program gets its own terminal, shown in this one: input(), single keys and pynput listeners work, while the
    world keeps running in real time. Ctrl-C asks the program to stop; a second Ctrl-C ends it.
    """
    opened_workspace = opening.open_existing_workspace(workspace)
    if (package, *words[:1]) == ("turtlesim", "turtlesim_node"):
        _run_turtlesim(words[1:], opened_workspace, seed)
        return
    search: tuple[Path, ...] = (Path.cwd(), Path.cwd() / "src", opened_workspace.packages, SHARE_FOLDER)
    folder = Path(package).expanduser()
    if folder.is_dir() and (folder / "package.xml").is_file():
        search = (*workspace_folders(folder.absolute() / "package.xml"), *search)
        try:
            package = read_package(folder).name
        except PackageError as problem:
            messages.fail(str(problem))
    if package.endswith(".py"):
        request = StartRequest(
            1, Path(package).stem, None, None, ("python3", package, *words), False, _environment(), None, ""
        )
    elif words:
        request = StartRequest(
            1, words[0], package, words[0], tuple(words[1:]), False, _environment(), None, ""
        )
    else:
        messages.fail(f"Give a program of the package; `kit pkg executables {package}` lists them.")
    sockets = sockets_folder(opened_workspace.folder)

    def on_output(line: PrintedLine) -> None:
        click.echo(line.text, err=line.stream == "err")

    def run(terminal: ProgramTerminal | None) -> ProcessExit:
        single = SingleProgram(
            request, search, seed=seed, workspace=opened_workspace.folder, terminal=terminal
        )
        try:
            found = find_world(sockets, world)
        except WorldNotFound:
            if world is not None:
                raise
            return single.run_alone(sockets, on_output)
        with InspectionClient(found) as client:
            return single.run_beside(client, on_output)

    try:
        if has_user_terminal():
            with ProgramTerminal(shows_output=True, on_interrupt=lambda: None) as terminal:
                ended = run(terminal)
                if terminal.was_interrupted:
                    raise KeyboardInterrupt  # how the program took it is its own matter
        else:
            ended = run(None)
    except (ProcessStartError, WorldNotFound) as problem:
        messages.fail(str(problem))
    except OSError as problem:
        messages.fail(messages.describe_os_error(problem))
    except WorldDisconnected as problem:
        exit_with_error(str(problem))
    except KeyboardInterrupt:
        raise SystemExit(INTERRUPTED) from None
    if ended.reason:
        click.echo(ended.reason, err=True)
    raise SystemExit(ended.code)


def _run_turtlesim(words: Sequence[str], opened_workspace: Workspace, seed: int) -> None:
    """Runs turtlesim's node in a world of its own, on the screen where there is one, as ROS 2 does in its window."""
    folder = SHARE_FOLDER / "turtlesim"
    target = LaunchTarget(folder / "launch" / "turtlesim_node.launch.py", folder, (SHARE_FOLDER,))
    run_launch(target, {"words": shlex.join(words)}, opened_workspace, terminal_options.decide(), seed=seed)


def _environment() -> dict[str, str]:
    return dict(os.environ)
