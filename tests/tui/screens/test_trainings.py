"""The list of trainings and the form for a new one, without a terminal."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from textual.pilot import Pilot

from kit.learning.authoring.new_task import new_task_file
from kit.learning.policies.policy import ActionSampling, Policy, task_interface
from kit.learning.policies.policy_file import save_policy
from kit.learning.policies.policy_network import LinearLayer, PolicyNetwork
from kit.learning.tasks.catalogue import find_task
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_folders import create_run, find_run, list_runs
from kit.learning.training.run_upkeep import RunOverview
from kit.learning.training.runs import TrainingRun
from kit.learning.training.training_sweep import TrainingSweep
from kit.tui.rows.training_list_rows import AFTERWARDS
from kit.tui.screens import trainings
from kit.tui.screens.new_training import ABOUT, NewTrainingScreen, TrainingChoices
from kit.tui.screens.trainings import TrainingsScreen
from tests.tui.lesson_stage import ROBOT, rows, seen, stage, text, until


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Of two runs that drive ahead whatever they see, and one without a policy."""
    runs = tmp_path / "home" / "runs"
    runs.mkdir(parents=True)
    for number, name in enumerate(("empty", "one", "two")):
        run = create_run(runs, RunConfig(TaskSpec("turn"), "q-learning"), name)
        os.utime(run.folder / "config.json", (number, number))
        if name != "empty":
            layer = LinearLayer(np.zeros((9, 3), np.float32), np.array([1, 0, 0], np.float32))
            network = PolicyNetwork((layer,), "tanh")
            save_policy(
                Policy(
                    network,
                    (3,),
                    ActionSampling("softmax"),
                    TaskSpec("turn"),
                    100,
                    task_interface(TaskSpec("turn").resolve()),
                ),
                run.best_policy,
            )
    return runs


@pytest.mark.long
def test_runs_are_tested_compared_renamed_and_deleted(folder: Path) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, ">  two")
        await pilot.press("e")
        await seen(pilot, "Test of two")
        await seen(pilot, "200 episodes each")
        await pilot.press("escape", "o")
        await seen(pilot, "Mark two runs")
        await pilot.press("space", "down", "space", "o")
        await seen(pilot, "Comparison")
        await seen(pilot, "turn_b_to_a")
        await pilot.press("escape", "down", "e")
        await seen(pilot, "has no policy yet")
        await pilot.press("escape", "a")
        await seen(pilot, "Rename empty")
        await pilot.press("2", "enter")
        await seen(pilot, ">  empty2")
        await pilot.press("d")
        await seen(pilot, "Delete empty2?")
        await pilot.press("enter")  # keep it
        await pilot.pause()
        assert find_run(folder, "empty2")
        await pilot.press("d")
        await seen(pilot, "Delete empty2?")
        await pilot.press("down", "enter")
        await until(pilot, lambda: "empty2" not in text(pilot), "the list without it")

    stage(lambda theme: TrainingsScreen(theme, folder), scene)
    assert {run.name for run in list_runs(folder)} == {"one", "two"}


def test_a_renamed_run_stays_chosen_though_the_list_was_read_while_it_had_no_name(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    read_all = trainings._read_runs
    renamed: list[str] = []

    def read_in_between(runs: Path) -> Sequence[RunOverview]:
        overviews = read_all(runs)
        if not renamed and any(each.run.name == "empty2" for each in overviews):
            renamed.append("empty2")
            return [each for each in overviews if each.run.name != "empty2"]
        return overviews

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, ">  two")
        await pilot.press("down", "down")
        await seen(pilot, ">  empty")
        await pilot.press("a")
        await seen(pilot, "Rename empty")
        await pilot.press("2", "enter")
        await seen(pilot, ">  empty2")

    monkeypatch.setattr(trainings, "_read_runs", read_in_between)
    stage(lambda theme: TrainingsScreen(theme, folder), scene)
    assert renamed


@pytest.mark.long
def test_the_tables_of_sweeps_are_shown(folder: Path) -> None:
    async def without(pilot: Pilot[None]) -> None:
        await seen(pilot, ">  two")
        await pilot.press("l")
        await seen(pilot, "No sweeps yet")

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, ">  two")
        await pilot.press("l")
        await seen(pilot, "0 of 2 trained")
        await pilot.press("enter")
        await seen(pilot, "go on")
        await pilot.press("enter")
        await seen(pilot, "Sweep of-turn")
        await seen(pilot, "0 of 2")
        await seen(pilot, "missing")

    stage(lambda theme: TrainingsScreen(theme, folder), without)
    configs = [RunConfig(TaskSpec("turn"), "q-learning", seed=seed) for seed in (0, 1)]
    TrainingSweep.prepare(folder.parent / "sweeps" / "of-turn", configs, 50)
    stage(lambda theme: TrainingsScreen(theme, folder), scene)


@pytest.mark.long
def test_a_new_training_has_what_was_chosen(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    home, started = folder.parent, []
    monkeypatch.setattr("kit.learning.training.worker.start_worker", started.append)
    monkeypatch.chdir(home)
    task = new_task_file("corridor", "hallway", home)
    reward = home / "own.py"
    reward.write_text("def reward(reached):\n    return 1.0 * reached\n")

    async def choose(pilot: Pilot[None], title: str, letters: str) -> None:
        await pilot.press("enter")
        await seen(pilot, title)
        await pilot.press(*letters, "enter")
        await pilot.pause()

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "A new training")
        await choose(pilot, " Task ", "corrid")
        await pilot.press("down")
        await choose(pilot, " Cases", "doors")
        await seen(pilot, "* doors")
        await pilot.press("escape", "down")
        await choose(pilot, " Algorithm ", "sarsa")
        await pilot.press("down")
        await choose(pilot, " Preset ", "diss")
        await pilot.press("down")
        await choose(pilot, " Reward ", "own.py")
        await pilot.press("down")
        await choose(pilot, " Seed ", "17")
        screen = pilot.app.screen
        assert isinstance(screen, NewTrainingScreen)
        chosen = screen.settings
        assert (chosen.task, chosen.cases, chosen.algorithm) == (str(task), ("doors",), "sarsa")
        assert (chosen.preset, chosen.reward, chosen.seed) == ("seed", str(reward), 17)
        await pilot.press("t")
        await until(pilot, lambda: started, "the training")

    stage(lambda theme: NewTrainingScreen(theme, folder), scene)
    run: TrainingRun = started[0]
    config = run.config()
    assert config.choice.name == "corridor"
    assert (config.choice.on, config.algorithm, config.preset, config.seed) == (
        ("doors",),
        "sarsa",
        "seed",
        17,
    )
    assert run.reward.read_text() == reward.read_text()


def test_the_tasks_as_in_the_dissertation_are_behind_one_line(folder: Path) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "A new training")
        await pilot.press("enter")
        await seen(pilot, " Task ")
        assert "-seed" not in text(pilot)
        await pilot.press(*"wheelchairs-seed", "enter")
        await seen(pilot, "As in the dissertation")
        await pilot.press(*"49-wide-as", "enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, NewTrainingScreen), "the form")
        screen = pilot.app.screen
        assert isinstance(screen, NewTrainingScreen)
        assert screen.settings.task == "wheelchairs-seed-49-wide-as-run"

    stage(lambda theme: NewTrainingScreen(theme, folder), scene)


@pytest.mark.long
def test_the_training_begun_last_is_chosen_in_the_list(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("kit.learning.training.worker.start_worker", lambda run: None)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, ">  two")
        await pilot.press("t")
        await seen(pilot, "A new training")
        await pilot.press("t")
        await seen(pilot, "turn-ppo-kit-0  turn")
        await pilot.press("escape")
        await seen(pilot, ">  turn-ppo-kit-0")

    stage(lambda theme: TrainingsScreen(theme, folder), scene)


@pytest.mark.long
def test_several_trainings_are_a_sweep_that_goes_on_and_can_be_stopped(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    endless = RunConfig(TaskSpec("turn"), "q-learning", steps=10**9, keep_training=True)
    monkeypatch.setattr(TrainingChoices, "config", lambda choices: replace(endless, seed=choices.seed))
    sweeps: list[TrainingSweep] = []

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, ">  two")
        await pilot.press("t")
        await seen(pilot, "A new training")
        await pilot.press("end", "enter")
        await seen(pilot, " Trainings ")
        await pilot.press("3", "enter")
        await seen(pilot, "3, a sweep")
        await pilot.press("t")
        await seen(pilot, "f shows how far it is")
        sweeps.extend(TrainingSweep(each.parent) for each in folder.parent.glob("sweeps/*/manifest.json"))
        assert [entry.config.seed for entry in sweeps[0].entries()] == [0, 1, 2]
        assert sweeps[0].is_active
        await pilot.press("l")
        await seen(pilot, "0 of 3 trained, training")
        await pilot.press("enter")
        await seen(pilot, "stop")
        await pilot.press("down", "enter")
        await until(pilot, lambda: not sweeps[0].is_active, "the sweep to end")

    try:
        stage(lambda theme: TrainingsScreen(theme, folder), scene)
    finally:
        for sweep in sweeps:
            sweep.stop()


@pytest.mark.long
def test_what_cannot_be_trained_says_why_and_writes_nothing(folder: Path) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "A new training")
        await pilot.press("enter")
        await seen(pilot, " Task ")
        await pilot.press(*"smooth", "enter", "down", "down", "enter")
        await seen(pilot, " Algorithm ")
        await pilot.press(*"sarsa", "enter", "t")
        await seen(pilot, "continuous")

    stage(lambda theme: NewTrainingScreen(theme, folder), scene)
    assert len(list_runs(folder)) == 3


@pytest.mark.long
def test_where_there_is_room_the_chosen_run_drives_beside_the_list_or_below_it(folder: Path) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "turn_a_to_b")  # what the caption names
        await until(pilot, lambda: set(ROBOT) & set(text(pilot)), "a robot")
        await pilot.press("down", "down")
        await seen(pilot, "no policy yet")
        assert "turn_a_to_b" not in text(pilot)
        await seen(pilot, "case   recent")  # below the list, what the run's own screen tells
        await pilot.resize_terminal(80, 24)
        await until(pilot, lambda: "case   recent" not in text(pilot), "the preview below the list")
        await seen(pilot, "no policy yet")
        await pilot.press("up")
        await until(pilot, lambda: set(ROBOT) & set(text(pilot)), "a robot")
        await pilot.resize_terminal(80, 14)
        await until(pilot, lambda: not set(ROBOT) & set(text(pilot)), "the list alone")

    stage(lambda theme: TrainingsScreen(theme, folder), scene, size=(120, 36))


@pytest.mark.parametrize(("size", "is_told"), [((80, 24), False), ((120, 35), True)], ids=str)
def test_whoever_has_no_training_is_told_what_comes_after_where_there_is_room(
    tmp_path: Path, size: tuple[int, int], is_told: bool
) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "No trainings yet")
        assert all((title.text in text(pilot)) is is_told for title, _ in AFTERWARDS)
        assert "14 tasks" in rows(pilot)[0]

    stage(lambda theme: TrainingsScreen(theme, tmp_path / "none"), scene, size=size)


@pytest.mark.parametrize("size", [(80, 24), (200, 50)], ids=str)
def test_a_first_training_learns_the_task_that_is_chosen(tmp_path: Path, size: tuple[int, int]) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, ">  turn")
        await pilot.press("down")
        await seen(pilot, ">  hallway")
        if size[0] == 200:
            await seen(pilot, "algorithms that can learn hallway")
            await seen(pilot, "the first of 15 cases")
        await pilot.press("t")
        await seen(pilot, "A new training")
        assert any(line.split()[1:3] == ["task", "hallway"] for line in rows(pilot))
        if size[0] == 200:
            await seen(pilot, "what preset kit sets")

    stage(lambda theme: TrainingsScreen(theme, tmp_path / "none"), scene, size=size)


@pytest.mark.parametrize("size", [(120, 35), (200, 50)])
def test_the_task_stands_beside_the_form_where_there_is_room(tmp_path: Path, size: tuple[int, int]) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "at most")
        shown = text(pilot)
        for term in find_task("turn").reward.weights:
            assert term.term in shown
        assert "ended" in " ".join(shown.split())
        (start,) = {each.index(" S ") for each in rows(pilot) if " S " in each and "is a start" not in each}
        assert start > 60
        about = ABOUT["task"]
        assert (about in shown) is (size[0] == 200), "one line where there is room"

    stage(lambda theme: NewTrainingScreen(theme, tmp_path), scene, size=size)


def test_more_is_told_of_the_task_once_there_is_room_for_it(tmp_path: Path) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "at most")
        assert "forward_lost" not in text(pilot)
        await pilot.resize_terminal(160, 50)
        await seen(pilot, "forward_lost")

    stage(lambda theme: NewTrainingScreen(theme, tmp_path), scene, size=(160, 18))


def test_a_narrow_form_has_the_form_alone(tmp_path: Path) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "A new training")
        await pilot.pause()
        assert "is a start" not in text(pilot)

    stage(lambda theme: NewTrainingScreen(theme, tmp_path), scene)


@pytest.mark.parametrize("size", [(120, 35), (200, 50)])
def test_the_map_of_the_chosen_task_stands_beside_the_first_list(
    tmp_path: Path, size: tuple[int, int]
) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "◎")
        before = [line[76:] for line in rows(pilot)]
        assert any("◎" in line for line in before), "beside the list"
        await pilot.press("down")
        await until(pilot, lambda: [line[76:] for line in rows(pilot)] != before, "another task's map")
        assert not any(line.rstrip().endswith("...") for line in rows(pilot))

    stage(lambda theme: TrainingsScreen(theme, tmp_path / "runs"), scene, size=size)
