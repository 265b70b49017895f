"""Whole trainings, small ones: their events, their end, what kills and damage do to them."""

from __future__ import annotations

import errno
import io
import os
import signal
import time
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kit.learning.environment.episode_stats import EpisodeStats
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithms import ALGORITHMS
from kit.learning.training.events import Evaluated, TrainingNote, TrainingProgress, TrainingStarted
from kit.learning.training.learn_extra import LearnExtraMissing
from kit.learning.training.presets import KIT_PPO_HALLWAY
from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.run_folders import create_run
from kit.learning.training.runs import TrainingRun
from kit.learning.training.stopping_rules import CaseCount, TrainThenTest, TrainUntilSure
from kit.learning.training.training import fit_task_spec, make_learner, practice_shares, resolve_preset, train
from kit.learning.training.worker import start_worker
from tests.waiting import wait_until

TABLE = RunConfig(TaskSpec("turn"), "q-learning", steps=20_000, keep_training=True)
"""Needs no torch; runs for about a second."""
ENDLESS = replace(TABLE, steps=10**9)
needs_learner = pytest.mark.skipif(find_spec("torch") is None, reason="the extra learn is not installed")


def events(run: TrainingRun, kind: type) -> list[object]:
    return [event for event in run.events() if isinstance(event, kind)]


@pytest.mark.long
def test_a_training_tells_its_story(tmp_path: Path) -> None:
    run = create_run(tmp_path, TABLE)
    ended = train(run)
    assert ended.how == "finished"
    told = run.events()
    assert isinstance(told[0], TrainingStarted)
    assert told[0].versions["numpy"]
    assert told[-1] == ended
    progress = [event for event in told if isinstance(event, TrainingProgress)]
    assert [event.steps for event in progress] == sorted({event.steps for event in progress})
    assert progress[-1].steps == ended.steps >= 20_000
    assert sum(sum(counts) for event in progress for counts in event.episodes.values()) > 20
    ends = [event for event in progress if event.reward is not None]
    assert all(sum(event.terms.values()) == pytest.approx(event.reward, abs=1e-3) for event in ends)
    tests = [event for event in told if isinstance(event, Evaluated)]
    assert set(tests[-1].cases) == {"turn_a_to_b", "turn_b_to_a"}
    assert run.policy().steps == tests[-1].steps
    assert run.summary().state == "finished"


@pytest.mark.long
def test_the_same_seed_learns_the_same(tmp_path: Path) -> None:
    runs = [create_run(tmp_path, TABLE) for _ in range(2)] + [create_run(tmp_path, replace(TABLE, seed=1))]
    for run in runs:
        train(run)
    same, again, other = (run.best_policy.read_bytes() for run in runs)
    assert same == again != other


@pytest.mark.long
def test_it_stops_and_pauses_as_asked(tmp_path: Path) -> None:
    run = create_run(tmp_path, ENDLESS)
    process = start_worker(run)
    wait_until(lambda: events(run, TrainingProgress))
    run.send_command("pause")
    wait_until(lambda: run.summary().state == "paused" and run.checkpoints[0].exists())
    time.sleep(0.3)
    count = len(run.events())
    time.sleep(0.8)
    assert len(run.events()) == count
    run.send_command("go")
    wait_until(lambda: len(run.events()) > count)
    run.send_command("stop")
    assert process.wait(20) == 0
    summary = run.summary()
    assert summary.state == "stopped"
    assert summary.steps == run.policy(newest=True).steps > 0


@pytest.mark.long
@pytest.mark.parametrize("after", [0.0, 0.6])
def test_a_killed_run_goes_on_and_says_so(tmp_path: Path, after: float) -> None:
    run = create_run(tmp_path, replace(ENDLESS, seed=2))
    first = start_worker(run)
    wait_until(lambda: events(run, TrainingStarted))
    time.sleep(after)
    os.kill(first.pid, signal.SIGKILL)
    first.wait()
    assert run.summary().state == "interrupted"
    second = start_worker(run)
    wait_until(lambda: len(events(run, TrainingStarted)) == 2)
    wait_until(lambda: isinstance(run.events()[-1], TrainingProgress))
    assert events(run, TrainingNote)
    os.kill(second.pid, signal.SIGTERM)  # what a shutdown sends: a checkpoint is left
    assert second.wait(20) == 0
    steps = run.summary().steps
    third = start_worker(run)
    wait_until(lambda: len(events(run, TrainingStarted)) == 3)
    began = events(run, TrainingStarted)[-1]
    assert isinstance(began, TrainingStarted)
    assert began.steps >= steps > 0
    run.send_command("stop")
    assert third.wait(20) == 0


@pytest.mark.long
def test_a_hang_up_does_not_end_it(tmp_path: Path) -> None:
    run = create_run(tmp_path, ENDLESS)
    process = start_worker(run)
    wait_until(lambda: events(run, TrainingProgress))
    assert os.getsid(process.pid) == process.pid
    os.kill(process.pid, signal.SIGHUP)
    count = len(run.events())
    wait_until(lambda: len(run.events()) > count)
    with pytest.raises(RunError, match="already"):
        train(run)
    run.send_command("stop")
    assert process.wait(20) == 0


@pytest.mark.long
def test_a_damaged_checkpoint_costs_a_little(tmp_path: Path) -> None:
    run = create_run(tmp_path, TABLE)
    train(run)
    newer, older = run.checkpoints
    older.write_bytes(newer.read_bytes())
    newer.write_bytes(newer.read_bytes()[:-100])
    (run.folder / "config.json").write_text(
        (run.folder / "config.json").read_text().replace("20000", "25000")
    )
    train(run)
    (note,) = events(run, TrainingNote)
    assert isinstance(note, TrainingNote)
    assert "checkpoint.zip is damaged" in note.text
    assert run.summary().steps >= 25_000


@pytest.mark.long
def test_a_full_disk_is_told_and_the_run_is_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = create_run(tmp_path, TABLE)

    def full(*args: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("kit.learning.training.runs.write_atomically", full)
        with pytest.raises(RunError, match=r"disk is full.*--resume"):
            train(run)
    run.log.write_text("the disk is full\n")  # the worker's, where it prints what `train` raised
    assert (run.summary().state, run.summary().reason) == ("interrupted", "the disk is full")
    assert train(run).how == "finished"
    assert "full" not in run.summary().reason


BAD_REWARDS = {
    "raises": ("def reward(step):\n    return 1 / (step - 7)\n", "mine.py:2"),
    "nan": ("def reward(step):\n    return float('nan')\n", "nan"),
    "text": ("def reward(step):\n    return 'good'\n", "mine.py"),
    "sleeps": ("import time\ndef reward(step):\n    time.sleep(60)\n", "3"),
    "exits": ("import os\ndef reward(step):\n    os._exit(3)\n", "_exit"),
}


@pytest.mark.long_cases("sleeps")
@pytest.mark.parametrize(("source", "said"), BAD_REWARDS.values(), ids=BAD_REWARDS)
def test_a_bad_reward_ends_the_run_with_its_fault(tmp_path: Path, source: str, said: str) -> None:
    file = tmp_path / "mine.py"
    file.write_text(source)
    run = create_run(tmp_path, replace(TABLE, reward_file=str(file)))
    ended = train(run)
    assert ended.how == "failed"
    assert said in ended.reason
    assert ended.reason.startswith(str(file))
    assert run.summary().state == "failed"


@pytest.mark.long
def test_a_student_s_reward_is_what_is_learned(tmp_path: Path) -> None:
    """Paid for crashing soon, an agent crashes soon."""
    file = tmp_path / "mine.py"
    file.write_text("def reward(collided):\n    return 5.0 if collided else -0.1\n")
    run = create_run(tmp_path, replace(TABLE, reward_file=str(file), steps=30_000))
    file.write_text("syntax error (the run has its own copy)")
    assert train(run).how == "finished"
    last = events(run, TrainingProgress)[-1]
    assert isinstance(last, TrainingProgress)
    assert last.length is not None
    assert last.length < 40
    assert last.terms == {}
    _, collided, timed_out = map(sum, zip(*last.episodes.values(), strict=True))
    assert collided > 20 * timed_out
    (note,) = events(run, TrainingNote)
    assert isinstance(note, TrainingNote)
    assert f"kit watch {run.name}" in note.text


@pytest.mark.long
def test_a_reward_that_pays_for_arriving_is_not_called_cheated(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(
        "def reward(previous_to_go, to_go, reached, collided):\n"
        "    return previous_to_go - to_go + 2.0 * reached - 2.0 * collided - 0.01\n"
    )
    run = create_run(tmp_path, replace(TABLE, reward_file=str(file), steps=60_000))
    assert train(run).how == "finished"
    assert run.summary().last_evaluation is not None
    assert events(run, TrainingNote) == []


@pytest.mark.long
@needs_learner
def test_a_network_s_run_is_whole_too(tmp_path: Path) -> None:
    run = create_run(tmp_path, RunConfig(TaskSpec("turn"), steps=16_384))
    assert train(run).how == "finished"
    assert run.policy().steps == 16_384
    if find_spec("tensorboard"):
        assert list((run.folder / "tensorboard").glob("*/events*"))


def test_without_the_extra_it_says_how_to_get_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("kit.learning.training.learn_extra.find_spec", lambda name: None)
    run = create_run(tmp_path, RunConfig(TaskSpec("turn")))
    with pytest.raises(LearnExtraMissing, match=r"torch.*\n.*pip install"):
        train(run)
    assert train(create_run(tmp_path, replace(TABLE, steps=100))).how == "finished"


def test_a_configuration_changes_its_preset() -> None:
    preset = resolve_preset(RunConfig(TaskSpec("turn"), steps=7, worlds=3, learning_rate=0.5, goal=0.6))
    assert (preset.steps, preset.worlds) == (7, 3)
    assert preset.learning_rate is not None
    assert preset.learning_rate.value_at(1.0) == preset.learning_rate.value_at(0.0) == 0.5
    assert isinstance(preset.stopping_rule, TrainUntilSure)
    assert preset.stopping_rule.goal == 0.6
    assert isinstance(resolve_preset(TABLE).stopping_rule, TrainThenTest)


def test_a_pair_s_moves_become_one_number_where_they_must() -> None:
    choice = TaskSpec("wheelchairs")
    assert fit_task_spec(choice, ALGORITHMS["ppo"]) == choice
    assert fit_task_spec(choice, ALGORITHMS["dqn"]).resolve().actions.one_number
    assert fit_task_spec(TaskSpec("turn"), ALGORITHMS["dqn"]) == TaskSpec("turn")


def test_what_went_wrong_is_practised_more() -> None:
    counts = {"easy": CaseCount(40, 40), "hard": CaseCount(20, 40), "slippery": CaseCount(39, 40)}
    easy, hard, slippery = practice_shares(counts, 0.5)
    assert easy + hard + slippery == pytest.approx(1)
    assert 1 / 6 < easy < slippery < hard
    assert practice_shares(counts, 0.0) == pytest.approx(np.full(3, 1 / 3))


class Onlooker:
    def between_updates(self) -> None: ...

    def on_episode_end(self, episode: EpisodeStats) -> None: ...


@pytest.mark.long
@needs_learner
def test_hard_cases_get_more_of_the_worlds() -> None:
    choice = TaskSpec("hallway", ("straight", "center_door"))
    preset = replace(KIT_PPO_HALLWAY, worlds=60)
    learner = make_learner(ALGORITHMS["ppo"], preset, choice, choice.resolve(), seed=1)
    learner.assign_cases(np.array([0.25, 0.75]))
    learner.learn(60 * 400, Onlooker())
    batch = learner._env.unwrapped.batch  # type: ignore[attr-defined]  # not in the protocol
    assert np.bincount(batch.state.case).tolist() == [15, 45]


class Spy:
    """What is pickled in a hostile checkpoint: loading it writes a file."""

    def __init__(self, file: Path) -> None:
        self.file = file

    def __reduce__(self) -> tuple[Any, ...]:
        return Path.touch, (self.file,)


@needs_learner
@pytest.mark.parametrize("place", [-1, 10**9])
def test_a_replay_buffer_that_ends_outside_of_itself_is_refused(place: int) -> None:
    choice = TaskSpec("turn")
    preset = resolve_preset(RunConfig(choice, "dqn"))
    learner = make_learner(ALGORITHMS["dqn"], preset, choice, choice.resolve(), seed=1)
    parts, changed = learner.save(), io.BytesIO()
    with np.load(io.BytesIO(parts["replay.npz"])) as stored:
        np.savez(changed, **{**stored, "arr_0": np.array([place, 0])})
    with pytest.raises(ValueError, match="replay buffer"):
        learner.load({**parts, "replay.npz": changed.getvalue()})


@needs_learner
@pytest.mark.parametrize("name", ["ppo", "dqn", "boltzmann-dqn", "q-learning"])
def test_a_hostile_checkpoint_runs_nothing(name: str, tmp_path: Path) -> None:
    """Every part of numpy's holds an object that would be run by unpickling."""
    choice = TaskSpec("turn")
    preset = resolve_preset(RunConfig(choice, name))
    learner = make_learner(ALGORITHMS[name], preset, choice, choice.resolve(), seed=1)
    parts, ran = learner.save(), tmp_path / "ran"
    damages = {".npy": io.BytesIO(), ".npz": io.BytesIO()}
    objects = np.array([Spy(ran)], dtype=object)
    np.save(damages[".npy"], objects)
    tried = [part for part in parts if Path(part).suffix in damages]
    for part in tried:
        if part.endswith(".npz"):
            with np.load(io.BytesIO(parts[part])) as stored:
                np.savez(damages[".npz"], **dict.fromkeys(stored, objects))
        damage = damages[Path(part).suffix]
        with pytest.raises(ValueError, match=r"pickle|not what it says"):
            learner.load({**parts, part: damage.getvalue()})
        assert not ran.exists(), part
    assert tried
    np.load(io.BytesIO(damages[".npy"].getvalue()), allow_pickle=True)
    assert ran.exists(), "what was refused would have run"
