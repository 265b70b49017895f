"""The screen of fields over a real session: what is seen, what a changed intensity does, to picture and controller."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest
from textual.app import App
from textual.pilot import Pilot

from kit.msg.rcl_interfaces import GetParameters
from kit.render.roles import Role
from kit.ros.node.client import Client
from kit.ros.node.node import create_graph_node
from kit.run.session import Session
from kit.tui.screens.fields import FieldsScreen
from kit.tui.terminal import TerminalFacts, TerminalOptions, decide_terminal
from kit.tui.theme import Theme
from tests.tui.lesson_stage import row_text
from tests.waiting import wait_until_shown

Scene = Callable[[FieldsScreen, Pilot[None]], Awaitable[None]]


def play(scene: Scene, folder: Path, *, place: str = "pair_turn_180", controller: str = "fields") -> None:
    terminal = decide_terminal(
        {"TERM": "xterm-256color"}, TerminalFacts(), TerminalOptions(False, "braille", None)
    )

    async def run() -> None:
        app: App[None] = App()
        async with app.run_test(size=(80, 24)) as pilot:
            screen = FieldsScreen(Theme.of(terminal), place, controller, folder=folder, runs=folder)
            await app.push_screen(screen)
            await scene(screen, pilot)

    asyncio.run(run())


def seen(screen: FieldsScreen) -> str:
    return "\n".join(screen.world.frame.rows()) if screen.world.frame else ""


def panel(screen: FieldsScreen) -> str:
    return "\n".join(row_text(parts) for parts in screen._rows("panel")._rows)


def arrows(screen: FieldsScreen) -> int:
    assert screen.world.frame is not None
    return int((screen.world.frame.fg == Role.FIELD).sum())


@pytest.mark.long
def test_the_field_is_over_the_floor_with_its_traps(tmp_path: Path) -> None:
    async def scene(screen: FieldsScreen, pilot: Pilot[None]) -> None:
        await wait_until_shown(pilot, lambda: "!" in seen(screen))
        assert arrows(screen) > 50
        assert {"→", "⇐", "⇓"} <= set(seen(screen))
        await wait_until_shown(pilot, lambda: "46%" in panel(screen))  # the panel may come after the floor
        assert "walls" in panel(screen)
        await pilot.press("o", "o")
        await wait_until_shown(pilot, lambda: arrows(screen) == 0)

    play(scene, tmp_path)


@pytest.mark.long
def test_an_intensity_changes_the_picture_at_once_and_the_controller_too(tmp_path: Path) -> None:
    async def scene(screen: FieldsScreen, pilot: Pilot[None]) -> None:
        await wait_until_shown(pilot, lambda: "!" in seen(screen) and screen.view and screen.view.controller)
        before = seen(screen)
        asked = Asked()
        await pilot.press("i", *["right_square_bracket"] * 8)
        assert "32.15" in panel(screen)
        await wait_until_shown(pilot, lambda: seen(screen) != before)
        await wait_until_shown(
            pilot, lambda: screen.host.post(asked) or pytest.approx(32.15, abs=0.01) in asked.told
        )

    play(scene, tmp_path)


class Asked:
    """Asks the controller for its parameter again and again."""

    def __init__(self) -> None:
        self.client: Client[Any, Any] | None = None
        self.told: list[float] = []

    def __call__(self, session: Session) -> None:
        if self.client is None:
            node = create_graph_node(session.graph, "asker")
            self.client = node.create_client(GetParameters, "/left/fields/get_parameters")
        if self.client.service_is_ready():
            future = self.client.call_async(GetParameters.Request(names=["intensity.target"]))
            future.add_done_callback(
                lambda done: self.told.extend(value.double_value for value in done.result().values)
            )


@pytest.mark.long
def test_a_map_for_one_robot_is_shown_too(tmp_path: Path) -> None:
    async def scene(screen: FieldsScreen, pilot: Pilot[None]) -> None:
        await wait_until_shown(pilot, lambda: arrows(screen) > 50 if screen.world.frame else False)
        assert "side by side" not in panel(screen)

    play(scene, tmp_path, place="hall_turn_90", controller="abreast")
