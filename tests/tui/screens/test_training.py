"""The training screen without a terminal: the agent's panel beside the scene where there is room, else over the curves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from textual.pilot import Pilot

from kit.learning.environment.tasks import TaskSpec
from kit.learning.policies.policies import ActionSampling, LinearLayer, Policy, PolicyNetwork, save_policy
from kit.learning.training.runs import RunConfig, TrainingRun, create_run
from kit.tui.rows.agent_rows import agent_panel
from kit.tui.screens.training import TrainingScreen
from tests.learning.policies.test_agent_view import random_policy, view_of
from tests.tui.lesson_stage import seen, stage, text


@pytest.fixture
def run(tmp_path: Path) -> TrainingRun:
    """A run that has left a policy, which prefers to stay where it is and turn."""
    made = create_run(tmp_path, RunConfig(TaskSpec("turn")), "mine")
    layer = LinearLayer(np.zeros((9, 3), np.float32), np.array([0.0, 2.0, 0.0], np.float32))
    policy = Policy(PolicyNetwork((layer,), "tanh"), (3,), ActionSampling("softmax"), TaskSpec("turn"), 4000)
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
        rows = [
            "".join(part for part, _ in row)
            for row in agent_panel(view, (("agent", "x" * 50),), width, height)
        ]
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
