"""The curve as a widget: shows its frame, and sends little when a point is added."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from textual.app import App
from textual.pilot import Pilot

from kit.learning.policies.policy import ActionSampling, Policy, task_interface
from kit.learning.policies.policy_file import save_policy
from kit.learning.policies.policy_network import LinearLayer, PolicyNetwork
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_folders import create_run
from kit.learning.training.runs import TrainingRun
from kit.render.curve import Axes, Curve
from kit.render.encode import AsciiEncoder
from kit.tui.rows.agent_rows import agent_panel
from kit.tui.screens.training import TrainingScreen
from kit.tui.widgets.chart_view import CurveView
from tests.learning.policies.test_agent_view import random_policy, view_of
from tests.tui.lesson_stage import row_text, seen, stage, text
from tests.tui.tape import Display, TapeDriver, painted, run_in


class CurveApp(App[None]):
    def __init__(self) -> None:
        super().__init__(driver_class=TapeDriver)
        self.theme = "ansi-dark"
        self.view = CurveView(Axes("steps", low=0, high=1, goal=0.8))

    def compose(self) -> Any:
        yield self.view

    def take(self) -> str:
        assert isinstance(self._driver, TapeDriver)
        return self._driver.take()


def learning(count: int) -> list[Curve]:
    x = 1000.0 * np.arange(1, count + 1)
    return [Curve("accuracy", x, 1 - np.exp(-x / 20_000))]


@pytest.mark.long
def test_a_growing_curve_is_shown_and_costs_few_bytes() -> None:
    app = CurveApp()
    sizes = []

    async def script(pilot: Pilot[None]) -> None:
        await painted(app)
        display = Display(60, 10)
        for count in range(1, 50):
            app.view.show(learning(count))
            await painted(app)
            text = app.take()
            sizes.append(len(text.encode()))
            display.feed(text)
            assert app.view.frame is not None
            assert display.rows == app.view.frame.rows()
        assert not app.view.show(learning(49))
        await painted(app)
        assert app.take() == ""

    run_in(app, script, (60, 10))
    assert np.median(sizes[1:]) < 200


def test_no_data_and_little_room_are_no_trouble() -> None:
    app = CurveApp()

    async def script(pilot: Pilot[None]) -> None:
        app.view.show([])
        for size in ((60, 10), (3, 2), (1, 1), (30, 5)):
            await pilot.resize_terminal(*size)
            await painted(app)
            assert app.view.frame is not None
            assert app.view.frame.shape == (app.view.size.height, app.view.size.width)

    run_in(app, script, (60, 10))


def test_glyphs_can_be_chosen() -> None:
    app = CurveApp()
    app.view = CurveView(encoder=AsciiEncoder())

    async def script(pilot: Pilot[None]) -> None:
        app.view.show(learning(20))
        assert app.view.frame is not None
        assert all(row.isascii() for row in app.view.frame.rows())

    run_in(app, script, (60, 10))


@pytest.fixture
def run(tmp_path: Path) -> TrainingRun:
    """A run that has left a policy, which prefers to stay where it is and turn."""
    made = create_run(tmp_path, RunConfig(TaskSpec("turn")), "mine")
    layer = LinearLayer(np.zeros((9, 3), np.float32), np.array([0.0, 2.0, 0.0], np.float32))
    policy = Policy(
        PolicyNetwork((layer,), "tanh"),
        (3,),
        ActionSampling("softmax"),
        TaskSpec("turn"),
        4000,
        task_interface(TaskSpec("turn").resolve()),
    )
    save_policy(policy, made.newest_policy)
    return made


@pytest.mark.long
@pytest.mark.parametrize(("size", "has_curve"), [((80, 24), False), ((120, 30), True), ((200, 50), True)])
def test_i_shows_what_the_agent_perceives(run: TrainingRun, size: tuple[int, int], has_curve: bool) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "after 4k")
        assert "probability" not in text(pilot)
        assert "timed out" in text(pilot)
        await pilot.press("i")
        await seen(pilot, "probability of each action")
        await seen(pilot, "return so far")
        for part in ("mine, newest of 4k", "turn, turn_", "▶left", "79%", "nearest"):
            assert part in text(pilot)
        assert ("timed out" in text(pilot)) == has_curve
        await pilot.press("i")
        await pilot.pause()
        await seen(pilot, "timed out")

    stage(lambda theme: TrainingScreen(theme, run), scene, size=size)


def test_of_many_actions_the_best_are_shown_and_the_chosen_one_among_them() -> None:
    view, _, _ = view_of(random_policy("wheelchairs-seed-49"))
    for width, height in ((30, 12), (26, 8), (40, 60)):
        rows = [row_text(row) for row in agent_panel(view, (("agent", "x" * 50),), width, height)]
        assert len(rows) <= height
        assert all(len(row) <= width for row in rows)
        assert sum("▶" in row for row in rows) == 1
        assert any("more" in row for row in rows) == (height < 50)


def test_news_that_arrives_while_the_screen_closes_does_no_harm(run: TrainingRun) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "after 4k")
        screen = pilot.app.screen
        assert isinstance(screen, TrainingScreen)
        await screen.query_one("#caption").remove()
        screen.on_moment_changed()
        screen.on_status_changed()

    stage(lambda theme: TrainingScreen(theme, run), scene)
