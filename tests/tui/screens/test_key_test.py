"""The key test screen as a student sees it, in a headless app."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Awaitable, Callable

import pytest
from textual.app import App
from textual.pilot import Pilot

from kit.tui.input.drive_keys import DRIVE_KEYS
from kit.tui.input.key_parser import KeyboardAnswer, KeyReleased, KeyRepeated
from kit.tui.screens.key_test import KeyTestScreen
from tests.tui.lesson_stage import rows

Scene = Callable[[App[None], Pilot[None]], Awaitable[None]]


def play(scene: Scene, size: tuple[int, int] = (80, 24)) -> None:
    async def run() -> None:
        app: App[None] = App()
        async with app.run_test(size=size) as pilot:
            await app.push_screen(KeyTestScreen())
            await pilot.pause()
            await scene(app, pilot)

    asyncio.run(run())


def row(app: App[None], start: str) -> str:
    return next(line.strip() for line in rows(app) if line.strip().startswith(start))


def test_a_press_shows_as_a_line_and_as_a_bar() -> None:
    async def scene(app: App[None], pilot: Pilot[None]) -> None:
        assert "[####]" not in row(app, "Up or W")
        await pilot.press("w", "k")
        assert re.search(r"\[#+ *\] p_up", row(app, "Up or W"))  # full, or fading on a busy machine
        assert row(app, "press    w").endswith("p_up")
        assert "press    k" in "\n".join(rows(app))

    play(scene)


@pytest.mark.long
def test_without_releases_a_tap_fades_and_times_out() -> None:
    async def scene(app: App[None], pilot: Pilot[None]) -> None:
        await pilot.press("w")
        await pilot.pause(0.3)
        assert "[#   ] p_up" in row(app, "Up or W")
        await pilot.pause(0.6)
        assert "[    ] p_up" in row(app, "Up or W")
        assert any("timeout" in line and line.endswith("r_up") for line in rows(app))

    play(scene)


def test_with_releases_repeats_and_releases_show() -> None:
    async def scene(app: App[None], pilot: Pilot[None]) -> None:
        app.post_message(KeyboardAnswer(27))
        await pilot.press("w")
        app.post_message(KeyRepeated("w", "w"))
        app.post_message(KeyReleased("w"))
        await pilot.pause()
        text = "\n".join(rows(app))
        assert row(app, "exact")
        assert "repeat   w" in text
        assert "release  w" in text
        assert "[    ] p_up" in row(app, "Up or W")

    play(scene)


def test_m_changes_the_mode_and_x_closes() -> None:
    async def scene(app: App[None], pilot: Pilot[None]) -> None:
        assert row(app, "hold")
        await pilot.press("z")
        assert row(app, "latch")
        await pilot.press("x")
        await pilot.pause()
        assert not isinstance(app.screen, KeyTestScreen)

    play(scene)


@pytest.mark.long
@pytest.mark.parametrize("size", [(80, 24), (60, 18)])
def test_it_fits_and_is_ascii(size: tuple[int, int]) -> None:
    async def scene(app: App[None], pilot: Pilot[None]) -> None:
        await pilot.press(*["w", "a", "s", "d"] * 5)
        lines = rows(app)
        assert len(lines) == size[1]
        assert all(len(line) <= size[0] and line.isascii() for line in lines)
        assert "x close" in lines[0]
        assert all(any(name in line for line in lines) for name in ("p_up", "p_f", "p_space", "p_esc"))

    play(scene, size)


@pytest.mark.long
def test_a_large_terminal_is_used() -> None:
    async def scene(app: App[None], pilot: Pilot[None]) -> None:
        await pilot.press("w", "k")
        lines = rows(app)
        keys = [number for number, line in enumerate(lines) if re.search(r"\[[# ]{40}\] p_", line)]
        assert len(keys) == len(DRIVE_KEYS)
        assert keys[-1] > 30
        log = next(line for line in lines if "press    w" in line)
        assert log.index("press    w") > 100, "what arrived stands beside the keys"
        assert all(line.isascii() for line in lines)

    play(scene, (200, 50))
