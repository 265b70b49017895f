"""In which format a verb writes a bag."""

from __future__ import annotations

from typing import Literal

import click

from kit.cli.messages import say
from kit.cli.options import Decorator

Storage = Literal["mcap", "sqlite3"]
"""Kinds of bags."""

storage: Decorator = click.option(
    "-s",
    "--storage",
    type=click.Choice(["mcap", "sqlite3"]),
    default="mcap",
    show_default=True,
    help="Bag format: mcap for ROS 2 Iron and later, sqlite3 for Humble.",
)


def explain_storage(kind: Storage) -> None:
    """Prints which ROS 2 distributions read such a bag."""
    if kind == "mcap":
        say(
            "The bag is in MCAP format. ROS 2 Humble needs a plugin to read it; `-s sqlite3` needs none.",
            err=True,
        )
