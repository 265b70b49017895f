"""Options that several verbs share."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from kit.cli.existing_path import ExistingPath

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

workspace: Decorator = click.option(
    "--workspace",
    type=click.Path(file_okay=False, path_type=Path),
    help="Workspace folder (default: $KIT_WORKSPACE, else ~/robot-kit).",
)
seed: Decorator = click.option(
    "--seed",
    type=click.IntRange(0, 2**63 - 1),
    default=0,
    show_default=True,
    help="Random seed; the same seed gives the same run.",
)
case: Decorator = click.option(
    "--case", help="Start and target, for a map with several; `kit maps MAP` lists them."
)
root: Decorator = click.option(
    "--root",
    type=ExistingPath(file_okay=False, path_type=Path),
    help="Folder that the world file may read (default: its own).",
)


def controller_option(default: str) -> Decorator:
    """The option ``--controller`` with this default."""
    return click.option(
        "--controller",
        default=default,
        show_default=True,
        help="Controller name, or a Python file with a ROS 2 node.",
    )


controller: Decorator = controller_option("random_walk")


def environment_variable(text: str) -> tuple[str, str]:
    """Name and value of ``--env NAME[=VALUE]``; without a value that of this process."""
    name, given, value = text.partition("=")
    if not given and name not in os.environ:
        raise click.UsageError(f"The environment variable {name} is not set; use --env {name}=VALUE.")
    return name, value if given else os.environ[name]


class ListOptionsCommand(click.Command):
    """A command some of whose options take all the words up to the next option, as those of ``ros2``."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        lists = {
            name
            for option in self.params
            if isinstance(option, click.Option) and option.multiple
            for name in option.opts
        }
        given: list[str] = []
        current: str | None = None
        for word in args:
            if word.startswith("-"):
                current = word if word in lists else None
                if current is None and word != "--":
                    given.append(word)
            elif current is not None:
                given += [current, word]
            else:
                given.append(word)
        return super().parse_args(ctx, given)
