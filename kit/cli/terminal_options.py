"""What the terminal of a verb can show, and the options that change it."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import click

from kit.cli.messages import fail
from kit.cli.options import Decorator
from kit.cli.plain_flag import PLAIN
from kit.tui.terminal import (
    COLOUR_CHOICES,
    GLYPH_CHOICES,
    THEME_CHOICES,
    THEME_VARIABLE,
    TerminalDecision,
    TerminalFacts,
    TerminalOptions,
    decide_terminal,
)

glyphs: Decorator = click.option(
    "--glyphs", type=click.Choice(GLYPH_CHOICES), help="Characters used to draw the world."
)


def _choose_theme(context: click.Context, parameter: click.Parameter, value: str | None) -> None:
    """The environment is where the terminal's decision and other programs of the kit find it."""
    if value is not None:
        os.environ[THEME_VARIABLE] = value


def color(function: Callable[..., Any]) -> Callable[..., Any]:
    """The options ``--color`` and ``--theme``; the second is not handed to the verb."""
    theme = click.option(
        "--theme",
        type=click.Choice(THEME_CHOICES),
        expose_value=False,
        callback=_choose_theme,
        help=f"Colour theme; {THEME_VARIABLE} sets it too. `terminal` uses your terminal's 16 colours.",
    )
    count = click.option(
        "--color", type=click.Choice(COLOUR_CHOICES), help="Number of colours; NO_COLOR is respected."
    )
    return count(theme(function))


def decide(*, plain: bool = False, glyphs: str | None = None, color: str | None = None) -> TerminalDecision:
    """Decides what this terminal can show. ``--plain`` before the verb counts as after it."""
    context = click.get_current_context(silent=True)
    plain = plain or (context is not None and context.meta.get(PLAIN, False))
    glyph_choice = next((choice for choice in GLYPH_CHOICES if choice == glyphs), None)
    return decide_terminal(os.environ, TerminalFacts.here(), TerminalOptions(plain, glyph_choice, color))


def full_screen(
    subject: str, instead: str = "", *, glyphs: str | None = None, color: str | None = None
) -> TerminalDecision:
    """Decides what this terminal can show; ends the verb with a message where that is no full screen.

    ``subject``: what needs one. ``instead``: what does the same line by line, in a sentence.
    """
    found = decide(glyphs=glyphs, color=color)
    if found.plain.value:
        fail(f"{subject} needs a full-screen terminal. {found.plain.reason}" + (instead and f"\n{instead}"))
    return found
