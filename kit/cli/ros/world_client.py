"""Connects a verb to the running world, and turns the end of the connection into an exit code."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Any, NoReturn

import click

from kit.cli import messages, opening, options
from kit.cli.process import INTERRUPTED
from kit.inspection.client import InspectionClient, ServiceTimeout, WorldDisconnected
from kit.inspection.sockets import WORLD_VARIABLE, WorldNotFound, find_world, sockets_folder
from kit.msg.interfaces import register_packages
from kit.ros.packages import find_packages, interface_packages

EXIT_FAILURE = 1


def exit_with_error(message: str) -> NoReturn:
    """Prints the message and exits with the code of ROS 2's commands for a failure."""
    click.echo(message, err=True)
    raise SystemExit(EXIT_FAILURE)


def package_folders(workspace: Path | None = None) -> tuple[Path, ...]:
    """The folders in which packages are searched for: this one, its ``src`` and the workspace's."""
    return Path.cwd(), Path.cwd() / "src", opening.open_existing_workspace(workspace).packages


def register_workspace_interfaces(workspace: Path | None = None) -> None:
    """Makes the interfaces of the packages of this folder and of the workspace known to this process."""
    found = interface_packages(find_packages(package_folders(workspace)))
    register_packages({name: str(folder) for name, folder in found.items()})


@contextmanager
def connect_to_world(world: str | None, workspace: Path | None) -> Iterator[InspectionClient]:
    """Connects to a world; if it ends or Ctrl-C is pressed, the verb ends with one line and an exit code."""
    register_workspace_interfaces(workspace)
    try:
        with InspectionClient(
            find_world(sockets_folder(opening.open_existing_workspace(workspace).folder), world)
        ) as client:
            yield client
    except WorldNotFound as problem:
        messages.fail(str(problem))
    except (WorldDisconnected, ServiceTimeout) as problem:
        exit_with_error(str(problem))
    except KeyboardInterrupt:
        raise SystemExit(INTERRUPTED) from None


def with_world_client(function: Callable[..., Any]) -> Callable[..., Any]:
    """Decorator: adds the options that choose a world, and passes the connected client as first argument."""

    @click.option(
        "--world",
        metavar="NAME",
        envvar=WORLD_VARIABLE,
        help="World to use, if several run (default: $KIT_WORLD, else the newest).",
    )
    @options.workspace
    @click.option("--use-sim-time", is_flag=True, hidden=True)
    @click.option("--no-daemon", is_flag=True, hidden=True)
    @click.option("--spin-time", type=float, hidden=True)
    @wraps(function)
    def verb(
        *arguments: Any,
        world: str | None,
        workspace: Path | None,
        use_sim_time: bool,
        no_daemon: bool,
        spin_time: float | None,
        **rest: Any,
    ) -> None:
        # The last three are options of ROS 2 that users type by habit; they have no effect here.
        with connect_to_world(world, workspace) as client:
            function(client, *arguments, **rest)

    return verb


def print_names(found: Iterable[tuple[str, Iterable[str]]], *, count: bool, show_types: bool = False) -> None:
    """Prints the names of topics, services or actions, a line each; with ``count`` only how many."""
    lines = [f"{name} [{', '.join(types)}]" if show_types else name for name, types in found]
    for line in [len(lines)] if count else lines:
        click.echo(line)


def print_types_of(name: str, found: Iterable[tuple[str, Iterable[str]]]) -> None:
    """Prints the types of one of the named topics, services or actions, a line each; exits with a failure if there is
    none of that name."""
    types = dict(found).get(name)
    if types is None:
        raise SystemExit(EXIT_FAILURE)
    for each in types:
        click.echo(each)


def print_names_of(type_name: str, found: Iterable[tuple[str, Iterable[str]]], *, count: bool) -> None:
    """Prints the names of those that have a type, likewise."""
    print_names([(name, types) for name, types in found if type_name in types], count=count)
