"""A verb: the angle from one point to another."""

from __future__ import annotations

import math

import click


@click.command("bearing")
@click.argument("x", type=float)
@click.argument("y", type=float)
def command(x: float, y: float) -> None:
    """Print the angle to the point X, Y [m] from the origin [rad]."""
    click.echo(f"{math.atan2(y, x):.3f}")
