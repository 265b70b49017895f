"""``kit pkg``: ROS 2 packages, as they lie."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click

from kit.cli import options
from kit.ros.packages import Package, PackageError, find_packages, read_package
from kit.workspace import Workspace

where = click.option(
    "--in",
    "folders",
    multiple=True,
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Where to look; by default here, in src, and in the workspace's packages.",
)


@click.group(invoke_without_command=True)
@options.workspace
@click.pass_context
def command(ctx: click.Context, workspace: Path | None) -> None:
    """ROS 2 packages in Python: make one, or see which there are and what programs they have.

    \b
    kit pkg create my_robot
    kit launch my_robot
    """
    ctx.obj = options.open_existing_workspace(workspace)
    if ctx.invoked_subcommand is None:
        ctx.invoke(executables)


@command.command()
@click.argument("name")
@click.option(
    "--dest",
    "--destination-directory",
    "destination",
    type=click.Path(file_okay=False, path_type=Path),
    help="Where it is to lie; by default in the workspace's packages.",
)
@click.option("--node-name", default="driver", show_default=True, help="What its program is called.")
@click.option("--map", "map_name", default="simple", show_default=True, help="The map its world begins with.")
@click.pass_obj
def create(
    opened_workspace: Workspace, name: str, destination: Path | None, node_name: str, map_name: str
) -> None:
    """Make a package with a world, a robot, a program that drives it, and a launch file.

    `kit launch` carries it out as it lies; in a ROS 2 workspace `colcon build` builds it.
    """
    from kit.launch.package_creation import create_package
    from kit.world.catalogue import UnknownMap

    try:
        folder = create_package(
            name, destination or opened_workspace.packages, node=node_name, map_name=map_name
        )
    except (PackageError, UnknownMap) as problem:
        options.fail(str(problem))
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        click.echo(f"creating {path}")
    click.echo(f"\nkit launch {folder if destination else name}")


@command.command("list")
@where
@click.pass_obj
def list_packages(opened_workspace: Workspace, folders: Sequence[Path]) -> None:
    """The names of the packages found."""
    for name in sorted(_found(opened_workspace, folders)):
        click.echo(name)


@command.command()
@click.argument("name", required=False, metavar="[PACKAGE]")
@where
@click.pass_obj
def executables(opened_workspace: Workspace, name: str | None = None, folders: Sequence[Path] = ()) -> None:
    """The programs of all packages, or of one: package and program."""
    found = _found(opened_workspace, folders)
    names = [name] if name else sorted(found)
    for each in names:
        for program in _package(found, each).executables:
            click.echo(f"{each} {program.name}")


@command.command()
@click.argument("name", metavar="PACKAGE")
@where
@click.pass_obj
def prefix(opened_workspace: Workspace, name: str, folders: Sequence[Path]) -> None:
    """The folder of a package."""
    click.echo(_package(_found(opened_workspace, folders), name).folder)


@command.command()
@click.argument("name", metavar="PACKAGE")
@where
@click.pass_obj
def xml(opened_workspace: Workspace, name: str, folders: Sequence[Path]) -> None:
    """A package's package.xml."""
    click.echo(
        (_package(_found(opened_workspace, folders), name).folder / "package.xml").read_text(
            encoding="utf-8"
        ),
        nl=False,
    )


def _found(opened_workspace: Workspace, folders: Sequence[Path]) -> dict[str, Path]:
    return find_packages(folders or (Path.cwd(), Path.cwd() / "src", opened_workspace.packages))


def _package(found: dict[str, Path], name: str) -> Package:
    """One of the packages found, or of those that the kit brings; exits if there is none of this name."""
    from kit.launch.launch_file_process import SHARE_FOLDER

    brought = find_packages((SHARE_FOLDER,))
    if name not in found and name in brought:
        return read_package(brought[name])
    if name not in found:
        options.fail(f"Package '{name}' not found; there are: {', '.join(sorted(found)) or 'none'}.")
    try:
        return read_package(found[name])
    except PackageError as problem:
        options.fail(str(problem))
