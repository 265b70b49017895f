"""A trained agent drives on the play screen, and what it perceives is shown: beside the figures, or in their place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from textual.pilot import Pilot

from kit.controllers import prepare_workspace
from kit.learning.policies.policy import ActionSampling, Policy, task_interface
from kit.learning.policies.policy_file import save_policy
from kit.learning.policies.policy_network import LinearLayer, PolicyNetwork
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.events import Evaluated, encode_event
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_folders import create_run, find_run
from kit.run.headless import run_episode
from kit.run.recording import load_recording
from kit.run.scenario import find_scenario
from kit.school.progress import ProgressJournal
from kit.tui.screens.agents import agent_items
from kit.tui.screens.lesson_drive import ReplayScreen
from kit.tui.screens.level_drive import LevelDrive
from kit.tui.screens.levels import LevelsScreen
from kit.tui.screens.play import PlayScreen
from kit.tui.theme import Theme
from tests.tui.lesson_stage import seen, stage, text, until


def save_agent(runs: Path, name: str, spec: TaskSpec) -> None:
    """An agent that turns left whatever it perceives."""
    run = create_run(runs, RunConfig(spec), name)
    inputs = spec.resolve().observation.size
    layer = LinearLayer(np.zeros((inputs, 3), np.float32), np.array([0.0, 2.0, 0.0], np.float32))
    save_policy(
        Policy(
            PolicyNetwork((layer,), "tanh"),
            (3,),
            ActionSampling("softmax"),
            spec,
            100,
            task_interface(spec.resolve()),
        ),
        run.best_policy,
    )


def test_an_agent_to_choose_is_told_with_its_task_and_how_often_it_arrives(tmp_path: Path) -> None:
    save_agent(tmp_path, "mine", TaskSpec("turn"))
    create_run(tmp_path, RunConfig(TaskSpec("hallway")), "begun")  # has no policy yet
    (item,) = agent_items(tmp_path, "agent ")
    assert (item.key, item.name) == ("agent mine", "mine")
    assert TaskSpec("turn").title in item.text
    assert "%" not in item.text
    tested = encode_event(Evaluated(100, 1.0, {"a": [9, 1, 0], "b": [3, 1, 0]}, True))
    find_run(tmp_path, "mine").events_file.write_bytes(tested + b"\n")
    (item,) = agent_items(tmp_path)
    assert "75%" in item.text, "the worst case"


@pytest.mark.long
@pytest.mark.parametrize(("size", "has_figures"), [((80, 24), False), ((130, 36), True)])
def test_an_agent_is_chosen_like_a_program_and_looked_into(
    tmp_path: Path, size: tuple[int, int], has_figures: bool
) -> None:
    runs = tmp_path / "runs"
    runs.mkdir()
    save_agent(runs, "mine", TaskSpec("turn"))
    save_agent(runs, "parked", TaskSpec("bay-parking"))  # by a heading that no node is told

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "forward")
        await pilot.press("i")
        await seen(pilot, "no agent drives")
        assert ("bumps" in text(pilot)) == has_figures
        await pilot.press("c")
        await seen(pilot, "Enter confirm")
        await pilot.press(*"mine", "enter")
        await seen(pilot, "probability of each action")
        await seen(pilot, "▶left")
        screen = pilot.app.screen
        assert isinstance(screen, PlayScreen)
        assert screen.agent_view is not None
        assert len(screen.agent_view.sight) == TaskSpec("turn").resolve().observation.scan_size
        await pilot.press("c")
        await seen(pilot, "Enter confirm")
        await pilot.press(*"parked", "enter")
        await seen(pilot, "This agent cannot drive here")
        await pilot.press("escape", "c")
        await seen(pilot, "Enter confirm")
        await pilot.press(*"forward", "enter")
        await seen(pilot, "no agent drives")
        await pilot.press("i")
        await until(
            pilot, lambda: "no agent drives" not in text(pilot) and "bumps" in text(pilot), "the figures"
        )

    stage(
        lambda theme: PlayScreen(theme, "turn", "circle", folder=tmp_path / "controllers", runs=runs),
        scene,
        size=size,
    )


@pytest.mark.long
def test_an_agent_in_a_level_is_looked_into_while_it_races(tmp_path: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    save_agent(workspace.runs, "mine", TaskSpec("turn"))

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "First drive")
        await pilot.press("a")
        await seen(pilot, "Which agent drives?")
        await pilot.press("enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, LevelDrive), "the drive")
        await pilot.press("i")
        await seen(pilot, "probability of each action")
        await seen(pilot, "▶left")
        await seen(pilot, "mine")

    with ProgressJournal(workspace.folder) as journal:
        stage(lambda theme: LevelsScreen(theme, journal, workspace), scene, size=(100, 30))


@pytest.mark.long
def test_a_replay_shows_what_the_agent_perceived_and_expected(tmp_path: Path) -> None:
    drive = tmp_path / "drive.npz"
    run_episode("turn", "forward", seconds=3.0, record=drive)
    recording, scenario = load_recording(drive), find_scenario("turn")
    spec = TaskSpec("turn")
    inputs = spec.resolve().observation.size
    layer = LinearLayer(np.zeros((inputs, 3), np.float32), np.array([2.0, 0.0, 0.0], np.float32))
    critic = LinearLayer(np.zeros((inputs, 1), np.float32), np.array([1.25], np.float32))
    policy = Policy(
        PolicyNetwork((layer,), "tanh"),
        (3,),
        ActionSampling("softmax"),
        spec,
        100,
        task_interface(spec.resolve()),
        critic=PolicyNetwork((critic,), "tanh"),
    )

    def make(theme: Theme) -> ReplayScreen:
        screen = ReplayScreen(theme, scenario, recording, "drive.npz")
        screen.watch_agent("mine", policy)
        return screen

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "expects 1.25")
        await seen(pilot, "▶forward")
        screen = pilot.app.screen
        assert isinstance(screen, ReplayScreen)

        def steps() -> int:
            return len(screen.agent_view.expected_returns) if screen.agent_view else 0

        await until(pilot, lambda: steps() >= 20, "a step for each tenth of a second")
        await pilot.press("r")
        await until(pilot, lambda: steps() < 20, "the beginning, of the chart too")
        await pilot.press("i")
        await until(pilot, lambda: "expects" not in text(pilot), "the figures")

    stage(make, scene)
