"""Pilots' stage for the screens of the school: an app without a terminal, its rows as text, and waiting in it."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from textual.app import App
from textual.pilot import Pilot
from textual.screen import Screen

from kit.document.rows import Row
from kit.tui.app import KitApp
from kit.tui.terminal import TerminalFacts, TerminalOptions, decide_terminal
from kit.tui.theme import Theme
from tests.waiting import wait_until_shown

Scene = Callable[[Pilot[None]], Awaitable[None]]
ROBOT = "►◥▲◤◄◣▼◢"
"""A robot in a picture, by its heading."""


def stage(
    make: Callable[[Theme], Screen[Any]],
    scene: Scene,
    *,
    size: tuple[int, int] = (80, 24),
    ascii_only: bool = False,
    environ: Mapping[str, str] = MappingProxyType({}),
) -> None:
    """Plays a scene on a screen. ``environ``: variables of the terminal, besides its type."""
    wishes = TerminalOptions(False, "ascii" if ascii_only else "braille", None)
    terminal = decide_terminal({"TERM": "xterm-256color", **environ}, TerminalFacts(), wishes)

    async def run() -> None:
        app = KitApp(terminal)
        async with app.run_test(size=size) as pilot:
            await app.push_screen(make(app.kit_theme))
            await pilot.pause()
            await scene(pilot)

    asyncio.run(run())


def rows(shown: Pilot[None] | Screen[Any] | App[None]) -> list[str]:
    """Of the screen that is on top of the app."""
    app = shown if isinstance(shown, App) else shown.app
    return [
        "".join(segment.text for segment in strip).rstrip()
        for strip in app.screen._compositor.render_strips()
    ]


def text(shown: Pilot[None] | Screen[Any]) -> str:
    return "\n".join(rows(shown))


async def until(pilot: Pilot[None], condition: Callable[[], object], what: str) -> None:
    """Waits until something is so; a failure shows the screen."""
    await wait_until_shown(pilot, condition, lambda: f"{what}:\n{text(pilot)}")


async def seen(pilot: Pilot[None], wanted: str) -> None:
    """Waits until these words are on the screen."""
    await until(pilot, lambda: wanted in text(pilot), repr(wanted))


def home(tmp_path: Path) -> Path:
    """A student's workspace."""
    return tmp_path / "home"


def row_text(parts: Row) -> str:
    """A row without its styles."""
    return "".join(text for text, _ in parts)
