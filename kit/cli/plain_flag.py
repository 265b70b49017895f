"""``--plain`` holds for every command, given before or after it, also for those that never open a full screen."""

from __future__ import annotations

from typing import Final

import click

PLAIN: Final = "kit.plain"
"""In a context's ``meta``: whether it was given."""


def _remember(ctx: click.Context, option: click.Parameter, given: bool) -> None:
    ctx.meta[PLAIN] = given or ctx.meta.get(PLAIN, False)


PLAIN_OPTION: Final = click.Option(
    ["--plain"], is_flag=True, hidden=True, expose_value=False, callback=_remember
)
"""For the commands without an option of their own: whoever always works line by line need not know which ones have it."""
