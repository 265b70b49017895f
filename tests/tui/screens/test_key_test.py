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
from tests.tui.lesson_stage import rows, stage

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


def bar(app: App[None], name: str) -> str:
    """The bar of a key, full and empty parts."""
    found = re.search(r"[█─]+", row(app, name))
    assert found
    return found[0]


def test_a_press_shows_as_a_line_and_as_a_bar() -> None:
    async def scene(app: App[None], pilot: Pilot[None]) -> None:
        assert not bar(app, "Up or W").startswith("█")
        await pilot.press("w", "k")
        assert bar(app, "Up or W").startswith("█")  # full, or fading on a busy machine
        assert row(app, "press    w").endswith("p_up")
        assert "press    k" in "\n".join(rows(app))

    play(scene)


@pytest.mark.long
def test_without_releases_a_tap_fades_and_times_out() -> None:
    async def scene(app: App[None], pilot: Pilot[None]) -> None:
        await pilot.press("w")
        await pilot.pause(0.3)
        assert 0 < bar(app, "Up or W").count("█") < len(bar(app, "Up or W")) / 2
        await pilot.pause(0.6)
        assert "█" not in bar(app, "Up or W")
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
        assert "█" not in bar(app, "Up or W")

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
@pytest.mark.parametrize("size", [(80, 24), (60, 18), (120, 35), (200, 50)], ids=str)
def test_all_keys_the_newest_of_what_arrived_and_the_ways_out_are_in_sight(size: tuple[int, int]) -> None:
    async def scene(app: App[None], pilot: Pilot[None]) -> None:
        await pilot.press(*["w", "a", "s", "d"] * 5, "k")
        await pilot.pause()
        lines = rows(app)
        assert len(lines) == size[1]
        assert all(len(line) <= size[0] for line in lines)
        assert "x close" in lines[-1]
        assert all(any(key.pressed in line for line in lines) for key in DRIVE_KEYS)
        assert re.search(r"press +k", "\n".join(lines))

    play(scene, size)


@pytest.mark.long
def test_a_large_terminal_is_used() -> None:
    async def scene(app: App[None], pilot: Pilot[None]) -> None:
        await pilot.press("w", "k")
        await pilot.pause()
        lines = rows(app)
        keys = [number for number, line in enumerate(lines) if re.search(r"[█─]{40} p_", line)]
        assert len(keys) == len(DRIVE_KEYS)
        assert keys[-1] > 30
        (log,) = [found for line in lines if (found := re.search(r"press +k", line))]
        assert log.start() > 80, "what arrived stands beside the keys"

    play(scene, (200, 50))


@pytest.mark.parametrize("size", [(80, 24), (120, 35)], ids=str)
def test_what_is_known_of_the_terminal_stands_above_what_arrived_where_there_is_room(
    size: tuple[int, int],
) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("z", "w")
        await pilot.pause()
        lines = rows(pilot.app)
        assert any("press    up" in line or "press    w" in line for line in lines)
        assert any("There is no sign of tmux" in line for line in lines) is (size[0] == 120)
        assert any("> latch" in line for line in lines) is (size[0] == 120), "the mode that is used"

    stage(lambda theme: KeyTestScreen(theme.terminal), scene, size=size)


@pytest.mark.long
def test_a_terminal_that_has_only_ascii_is_shown_nothing_else() -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("w", "k")
        await pilot.pause()
        assert all(line.isascii() for line in rows(pilot))

    stage(lambda theme: KeyTestScreen(theme.terminal), scene, ascii_only=True)
