"""``kit launch`` and ``kit pkg``: runs a ROS 2 package for Flatland as it is; makes and lists packages."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from kit.cli import messages, opening, options, terminal_options
from kit.cli.existing_path import ExistingPath
from kit.cli.full_screen import run_screen
from kit.cli.lazy_group import HintingGroup
from kit.cli.process import INTERRUPTED
from kit.host.failure import StudentCodeError
from kit.inspection.sockets import sockets_folder, world_name
from kit.msg.interfaces import PACKAGES
from kit.ros.graph.graph import Graph
from kit.ros.packages import (
    Package,
    PackageError,
    broken_packages,
    find_packages,
    read_manifest_texts,
    read_package,
)
from kit.tui.terminal import TerminalDecision
from kit.workspace import Workspace, WorkspaceError, open_workspace
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.launch.launch_file_process import LaunchTarget
    from kit.launch.launch_run import LaunchOutputLine
    from kit.tui.app import KitApp
    from kit.tui.screens.launched import LaunchScreen


@click.command()
@click.argument("where", metavar="FOLDER|FILE|PACKAGE")
@click.argument("words", nargs=-1, metavar="[FILE.launch.py] [NAME:=VALUE ...]")
@click.option(
    "-s",
    "--show-args",
    "--show-arguments",
    "show_args",
    is_flag=True,
    help="Show the launch file's arguments and exit.",
)
@click.option(
    "--plain", is_flag=True, help="Print only output, line by line, without the picture of the world."
)
@click.option(
    "--steps", type=click.IntRange(1), help="Run this many ticks as fast as possible, without the picture."
)
@click.option(
    "--until",
    type=click.FloatRange(0, min_open=True),
    help="Run this many simulated seconds, in the same way.",
)
@click.option(
    "--speed",
    type=click.FloatRange(0, min_open=True),
    help="Simulated seconds per second, overriding the launch file.",
)
@options.seed
@options.workspace
@terminal_options.glyphs
@terminal_options.color
def command(
    where: str,
    words: Sequence[str],
    show_args: bool,
    plain: bool,
    steps: int | None,
    until: float | None,
    speed: float | None,
    seed: int,
    workspace: Path | None,
    glyphs: str | None,
    color: str | None,
) -> None:
    """Run a ROS 2 launch file with its package as it is; nothing needs to be built or changed.

    The kit's world replaces flatland_server, and its screen replaces RViz. Each node runs in its own process.
    `kit ros` inspects the nodes from other terminals.

    \b
    kit launch ~/ros2_ws/src/my_package
    kit launch my_package/launch/world.launch.py update_rate:=200 show_viz:=false
    kit launch my_package --show-args

    Exit code: 0 success; 1 a program failed; 2 something is missing or wrong; 130 interrupted by Ctrl-C.
    """
    from kit.launch.launch_file_process import find_launch_file

    try:
        opened_workspace = open_workspace(workspace)
        file, arguments = parse_words(words)
        target = find_launch_file(where, file, [opened_workspace.packages])
    except (PackageError, WorkspaceError) as problem:
        messages.fail(str(problem))
    if show_args:
        show_arguments(target)
        return
    terminal = terminal_options.decide(plain=plain, glyphs=glyphs, color=color)
    run_launch(
        target, arguments, opened_workspace, terminal, seed=seed, steps=steps, until=until, speed=speed
    )


def run_launch(
    target: LaunchTarget,
    arguments: Mapping[str, str],
    opened_workspace: Workspace,
    terminal: TerminalDecision,
    *,
    seed: int = 0,
    steps: int | None = None,
    until: float | None = None,
    speed: float | None = None,
) -> None:
    """Carries a launch file out, on the screen where there is one; ends the verb with an exit code unless all is well."""
    if terminal.plain.value or steps is not None or until is not None:
        _run_plainly(target, arguments, opened_workspace, seed, steps, until, speed)
        return

    def make_screen(app: KitApp) -> LaunchScreen:
        from kit.tui.screens.launched import LaunchScreen

        return LaunchScreen(
            app.kit_theme, target, arguments, workspace=opened_workspace, seed=seed, speed=speed
        )

    screen, code = run_screen(terminal, make_screen)
    if screen.has_no_world:
        _run_plainly(target, arguments, opened_workspace, seed, steps, until, speed)
        return
    if screen.refusal is not None:
        messages.fail(screen.refusal)
    for line in screen.failures:
        click.echo(line, err=True)
    if code or screen.failures:
        raise SystemExit(code or 1)


def parse_words(words: Sequence[str]) -> tuple[str | None, dict[str, str]]:
    """Splits the words into the launch file's name, None if there is none, and the launch arguments."""
    arguments = dict(word.split(":=", 1) for word in words if ":=" in word)
    rest = [word for word in words if ":=" not in word]
    if len(rest) > 1 or "" in arguments:
        messages.fail(
            f"Arguments look like NAME:=VALUE, without spaces; these do not: {' '.join(rest[1:] or words)}"
        )
    return (rest[0] if rest else None), arguments


def show_arguments(target: LaunchTarget, *, is_test: bool = False) -> None:
    """Prints the arguments that a launch file, or a test for launch_testing, declares."""
    from kit.launch.launch_file_process import declared_arguments

    try:
        declared = declared_arguments(target, is_test=is_test)
    except StudentCodeError as error:
        messages.fail(str(error.failure))
    click.echo("Arguments (pass arguments as '<name>:=<value>'):")
    for argument in declared:
        choices = "" if argument.choices is None else f" valid choices are: {list(argument.choices)}"
        click.echo(f"\n    '{argument.name}':{choices}\n        {argument.description}")
        if argument.default is not None:
            click.echo(f"        (default: {argument.default})")
    if not declared:
        click.echo("\n  No arguments.")


def _run_plainly(
    target: LaunchTarget,
    arguments: Mapping[str, str],
    opened_workspace: Workspace,
    seed: int,
    steps: int | None,
    until: float | None,
    speed: float | None,
) -> None:
    from kit.inspection.server import open_inspection_server
    from kit.launch.launch_run import Launch
    from kit.launch.plain_launch import LaunchLimit, run_plain_launch

    name = target.name
    launch = Launch(
        target,
        Graph(),
        arguments=arguments,
        seed=seed,
        workspace=opened_workspace.folder,
        name=world_name(name),
        on_output=_print_line,
    )
    with launch_errors():
        run_plain_launch(
            launch,
            seed=seed,
            limit=LaunchLimit(steps, until),
            factor=speed,
            make_companion=lambda graph: open_inspection_server(
                graph, sockets_folder(opened_workspace.folder), name
            ),
            log=lambda record: click.echo(str(record), err=True),
        )
    if launch.failures:
        raise SystemExit(1)


@contextmanager
def launch_errors() -> Iterator[None]:
    """Ends the command with what has kept a launch from running."""
    from kit.launch.processes import ProcessStartError

    try:
        yield
    except StudentCodeError as error:
        messages.fail(str(error.failure))
    except (ProcessStartError, WorldError) as problem:
        messages.fail(str(problem))
    except OSError as problem:
        messages.fail(messages.describe_os_error(problem))
    except KeyboardInterrupt:
        raise SystemExit(INTERRUPTED) from None


def _print_line(line: LaunchOutputLine) -> None:
    click.echo(str(line), err=line.stream == "err")


where = click.option(
    "--in",
    "folders",
    multiple=True,
    type=ExistingPath(file_okay=False, path_type=Path),
    help="Folder to search (default: this one, src, and the workspace's packages).",
)


@click.group(cls=HintingGroup, invoke_without_command=True)
@options.workspace
@click.pass_context
def package_command(ctx: click.Context, workspace: Path | None) -> None:
    """Create a ROS 2 package in Python, or list packages and their programs.

    \b
    kit pkg create my_robot
    kit launch my_robot
    """
    ctx.obj = opening.open_existing_workspace(workspace)
    if ctx.invoked_subcommand is None:
        ctx.invoke(executables)


@package_command.command(cls=options.ListOptionsCommand)
@click.argument("name")
@click.option(
    "--dest",
    "--destination-directory",
    "destination",
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder to create it in (default: the packages of the workspace; with `kit ros`, as with ros2, the current folder).",
)
@click.option("--node-name", default="driver", show_default=True, help="Name of its program.")
@click.option("--map", "map_name", default="simple", show_default=True, help="Map to start with.")
@click.option("--build-type", type=click.Choice(["ament_python"]), help="Packages are of this type alone.")
@click.option("--dependencies", multiple=True, metavar="PACKAGE ...", help="Packages that it needs too.")
@click.option("--description", default="", help="What it is.")
@click.option("--license", "licence", default="MIT", show_default=True, help="Its licence.")
@click.option("--maintainer-name", "maintainer", default="", help="Who maintains it (default: you).")
@click.option("--maintainer-email", "email", default="", help="The maintainer's address.")
@click.pass_context
def create(
    ctx: click.Context,
    name: str,
    destination: Path | None,
    node_name: str,
    map_name: str,
    build_type: str | None,
    dependencies: tuple[str, ...],
    description: str,
    licence: str,
    maintainer: str,
    email: str,
) -> None:
    """Create a package with a world, a robot, a program and a launch file.

    `kit launch` runs it without building it; in a ROS 2 workspace, `colcon build` builds it.
    """
    from kit.launch.package_creation import PackageOwner, create_package
    from kit.world.catalogue import UnknownMap

    opened_workspace: Workspace = ctx.obj
    if destination is None:
        is_of_ros = "ros" in ctx.command_path.split()
        destination = Path.cwd() if is_of_ros else opened_workspace.packages
    try:
        folder = create_package(
            name,
            destination,
            node=node_name,
            map_name=map_name,
            dependencies=dependencies,
            description=description,
            owner=PackageOwner(maintainer, email, licence),
        )
    except (PackageError, UnknownMap) as problem:
        messages.fail(str(problem))
    click.echo(f"destination directory: {destination.absolute()}")
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        click.echo(f"creating {path}")
    click.echo(f"\nkit launch {name if destination == opened_workspace.packages else folder}")


@package_command.command("list")
@where
@click.pass_obj
def list_packages(opened_workspace: Workspace, folders: Sequence[Path]) -> None:
    """List the packages found, and those that the kit brings: the interfaces of ROS 2, turtlesim and others."""
    from kit.launch.launch_file_process import SHARE_FOLDER
    from kit.launch.program_lookup import BUILTIN_PROGRAMS

    found = _find_packages(opened_workspace, folders)
    brought = {
        *find_packages((SHARE_FOLDER,)),
        *PACKAGES,
        *(package for package, _ in BUILTIN_PROGRAMS if package),
    }
    for name in sorted({*found, *(() if folders else brought)}):
        click.echo(name)


@package_command.command()
@click.argument("name", required=False, metavar="[PACKAGE]")
@click.option("--full-path", is_flag=True, help="Print the file of each, if it has one of its own.")
@where
@click.pass_obj
def executables(
    opened_workspace: Workspace,
    name: str | None = None,
    full_path: bool = False,
    folders: Sequence[Path] = (),
) -> None:
    """List the programs of all packages, or of one."""
    found = _find_packages(opened_workspace, folders)
    names = [name] if name else sorted(found)
    from kit.launch.program_lookup import BUILTIN_PROGRAMS

    for each in names:
        lines = {program: f"{each} {program}" for of, program in BUILTIN_PROGRAMS if of == each and program}
        is_found = name is None or each in found or not lines
        package = _package(found, each) if is_found else _find_bundled_package(each)
        for program in () if package is None else package.executables:
            lines[program.name] = f"{each} {program.name}"
            if package and full_path:
                try:
                    lines[program.name] = str(package.file_of(program))
                except PackageError as problem:
                    messages.fail(str(problem))
        for _, line in sorted(lines.items()):
            click.echo(line)


@package_command.command()
@click.argument("name", metavar="PACKAGE")
@click.option("--share", is_flag=True, help="The same: nothing is installed, and a package has one folder.")
@where
@click.pass_obj
def prefix(opened_workspace: Workspace, name: str, share: bool, folders: Sequence[Path]) -> None:
    """Print the folder of a package."""
    click.echo(_package(_find_packages(opened_workspace, folders), name).folder)


@package_command.command()
@click.argument("name", metavar="PACKAGE")
@click.option("-t", "--tag", metavar="TAG", help="Print only the texts of these tags: version, depend.")
@where
@click.pass_obj
def xml(opened_workspace: Workspace, name: str, tag: str | None, folders: Sequence[Path]) -> None:
    """Print a package's package.xml."""
    folder = _package(_find_packages(opened_workspace, folders), name).folder
    if tag is None:
        click.echo((folder / "package.xml").read_text(encoding="utf-8"), nl=False)
        return
    texts = read_manifest_texts(folder, tag)
    if not texts:
        messages.fail(f"The package.xml of {name} has no tag <{tag}>.")
    for each in texts:
        click.echo(each)


def _find_bundled_package(name: str) -> Package | None:
    """A package with Python programs that the kit brings, if it is one of these."""
    from kit.launch.launch_file_process import SHARE_FOLDER

    folder = find_packages((SHARE_FOLDER,)).get(name)
    return None if folder is None else read_package(folder)


def _find_packages(opened_workspace: Workspace, folders: Sequence[Path]) -> dict[str, Path]:
    searched = tuple(folders) or (Path.cwd(), Path.cwd() / "src", opened_workspace.packages)
    for reason in broken_packages(searched):
        click.echo(reason, err=True)
    return find_packages(searched)


def _package(found: dict[str, Path], name: str) -> Package:
    """One of the packages found, or of those that the kit brings; exits if there is none of this name."""
    if name not in found and (bundled := _find_bundled_package(name)) is not None:
        return bundled
    if name not in found:
        messages.fail(f"Package '{name}' not found; available: {', '.join(sorted(found)) or 'none'}.")
    try:
        return read_package(found[name])
    except PackageError as problem:
        messages.fail(str(problem))
