"""What all verbs share that look into a running world: how it is found, and how a visit ends."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Any, NoReturn

import click

from kit.cli import options
from kit.inspection.client import NoAnswer, Visit, WorldGone
from kit.inspection.world_sockets import WORLD_VARIABLE, NoWorld, find_world, sockets_folder

NOT_DONE = 1
INTERRUPTED = 128 + signal.SIGINT


def refuse(message: str) -> NoReturn:
    """Ends the verb as ROS 2's commands do when what was asked for cannot be done."""
    click.echo(message, err=True)
    raise SystemExit(NOT_DONE)


@contextmanager
def visit_world(world: str | None, workspace: Path | None) -> Iterator[Visit]:
    """A visit; when the world ends, or Ctrl-C is pressed, one line and the exit code say so."""
    try:
        with Visit(find_world(sockets_folder(options.desk(workspace).folder), world)) as visit:
            yield visit
    except NoWorld as problem:
        options.fail(str(problem))
    except (WorldGone, NoAnswer) as problem:
        refuse(str(problem))
    except KeyboardInterrupt:
        raise SystemExit(INTERRUPTED) from None


def visiting(function: Callable[..., Any]) -> Callable[..., Any]:
    """Makes a verb of a function whose first argument is a visit."""

    @click.option(
        "--world",
        metavar="NAME",
        envvar=WORLD_VARIABLE,
        help="Which world, if several run; by default $KIT_WORLD, else the newest.",
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
        # The last three are for whoever types them by habit: here they mean what is so anyway.
        with visit_world(world, workspace) as visit:
            function(visit, *arguments, **rest)

    return verb
