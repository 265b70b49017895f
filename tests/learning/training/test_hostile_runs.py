"""Runs and sweeps of somebody else's: what is in their folder neither runs with one's rights nor takes one's memory or time."""

from __future__ import annotations

import io
import json
import math
import os
import signal
import subprocess
import sys
import tracemalloc
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kit.host.sandbox.probe import highest_level_up_to
from kit.host.sandbox.sandbox_config import Level
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.crosstable import TEST_FILE, crosstable_columns
from kit.learning.training.events import TrainingNote, TrainingProgress, decode_event, encode_event
from kit.learning.training.process_lock import process_lock
from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.run_folders import create_run
from kit.learning.training.runs import TrainingRun
from kit.learning.training.training import train
from kit.learning.training.training_sweep import LOCK_FILE, TrainingSweep
from kit.line_log import MAX_LINE_BYTES, MAX_READ_BYTES
from tests.cases import every_case

CONFIG = RunConfig(TaskSpec("turn"), "q-learning", steps=320)
CONFINES = highest_level_up_to(max(Level)) is not Level.LIMITED
EVIL = "try:\n    open({written!r}, 'w')\nexcept OSError:\n    pass\ndef reward(reached):\n    return 1.0 * reached\n"


@pytest.mark.skipif(not CONFINES, reason="nothing is confined here")
def test_a_reward_in_somebody_elses_run_does_not_run_with_ones_rights(tmp_path: Path) -> None:
    reward, written = tmp_path / "reward.py", tmp_path / "written"
    reward.write_text(EVIL.format(written=str(written)))
    run = create_run(tmp_path, replace(CONFIG, reward_file=str(reward)), "theirs")
    assert train(run).how == "finished"
    assert not written.exists()


@pytest.mark.skipif(not CONFINES, reason="nothing is confined here")
@pytest.mark.long
def test_a_controller_that_somebody_elses_run_imitates_does_not_run_with_ones_rights(tmp_path: Path) -> None:
    pytest.importorskip("torch")
    program, written = tmp_path / "drive.py", tmp_path / "written"
    program.write_text(f"open({str(written)!r}, 'w')\n")
    run = create_run(tmp_path, replace(CONFIG, algorithm="dagger", imitate=(str(program),)), "theirs")
    ended = train(run)
    assert (ended.how, "drive.py:1" in ended.reason) == ("failed", True)
    assert not written.exists()


def changed(run: TrainingRun, part: str, change: Callable[[bytes], bytes]) -> None:
    """Puts another part into a run's checkpoint."""
    file = run.checkpoints[0]
    with zipfile.ZipFile(file) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    with zipfile.ZipFile(file, "w") as archive:
        for name, data in {**parts, part: change(parts[part])}.items():
            archive.writestr(name, data)


def with_numbers(**numbers: object) -> Callable[[bytes], bytes]:
    return lambda data: json.dumps(json.loads(data) | numbers).encode()


@pytest.fixture(scope="module")
def table_run(tmp_path_factory: pytest.TempPathFactory) -> TrainingRun:
    run = create_run(tmp_path_factory.mktemp("runs"), CONFIG, "theirs")
    train(run)
    return run


@every_case(
    ("part", "numbers"),
    [
        ("learner.json", {"steps": 10**400}),
        ("learner.json", {"steps": -(10**6)}),
        ("learner.json", {"steps": 1.5}),
        ("learner.json", {"slower": 1e308}),
        ("learner.json", {"slower": -0.5}),
        ("learner.json", {"slower": float("nan")}),
        ("learner.json", {"largest": ["a", "b"]}),
        ("learner.json", {"algorithm": "sarsa"}),
        ("learner.json", {"more": 1}),
        ("training.json", {"resumed": 10**400}),
        ("training.json", {"seconds": float("inf")}),
        ("training.json", {"memory": {"best": ["a"]}}),
        ("training.json", {"memory": {"best": None, "best_low": None}}),
        ("training.json", {"memory": {"best": None, "confirmations": "a"}}),
    ],
)
def test_numbers_that_no_learner_has_are_no_checkpoint(
    part: str, numbers: Mapping[str, Any], table_run: TrainingRun
) -> None:
    kept = table_run.checkpoints[0].read_bytes()
    changed(table_run, part, with_numbers(**numbers))
    with pytest.raises(RunError, match="not one of this kit's"):
        train(table_run)
    table_run.checkpoints[0].write_bytes(kept)


def with_array(name: str, change: Callable[[Any], Any]) -> Callable[[bytes], bytes]:
    def make(data: bytes) -> bytes:
        with np.load(io.BytesIO(data)) as stored:
            arrays = {key: stored[key] for key in stored.files}
        arrays[name] = change(arrays[name])
        file = io.BytesIO()
        np.savez(file, **{key: array for key, array in arrays.items() if array is not None})
        return file.getvalue()

    return make


ODD_ARRAYS: tuple[tuple[str, str, Callable[[Any], Any]], ...] = (
    ("replay.npz", "arr_1", lambda seen: np.full_like(seen, np.nan)),
    ("replay.npz", "arr_1", lambda seen: seen[:0]),
    ("replay.npz", "arr_1", lambda seen: seen.astype(np.float64)),
    ("replay.npz", "arr_0", lambda place: np.full_like(place, 10**12)),
)


@pytest.mark.long
@pytest.mark.parametrize("algorithm", ["dqn", "boltzmann-dqn"])
def test_arrays_that_no_learner_has_are_no_checkpoint(algorithm: str, tmp_path: Path) -> None:
    pytest.importorskip("torch")
    config = replace(CONFIG, algorithm=algorithm, steps=320, settings=(("learning_starts", 100),))
    run = create_run(tmp_path, config, "theirs")
    train(run)
    kept = run.checkpoints[0].read_bytes()
    actions = "arr_3" if algorithm == "dqn" else "arr_2"
    odd = [*ODD_ARRAYS, ("replay.npz", actions, lambda chosen: chosen + 1000)]
    if algorithm == "dqn":
        odd.append(("parameters.npz", "policy.optimizer/0/exp_avg", lambda mean: None))
    for part, name, change in odd:
        changed(run, part, with_array(name, change))
        with pytest.raises(RunError, match="not one of this kit's"):
            train(run)
        run.checkpoints[0].write_bytes(kept)
    assert train(run).how == "finished"


@every_case(
    ("algorithm", "settings"),
    [
        ("ppo", {"n_steps": 10**8}),
        ("ppo", {"n_epochs": 10**8}),
        ("dqn", {"buffer_size": 10**9}),
        ("dqn", {"batch_size": 10**9}),
        ("dqn", {"train_freq": 10**9}),
        ("sac", {"gradient_steps": 10**9}),
        ("ars", {"n_delta": 10**9}),
    ],
)
def test_settings_that_take_any_memory_or_never_look_are_refused(
    algorithm: str, settings: Mapping[str, float], tmp_path: Path
) -> None:
    pytest.importorskip("torch")
    choice = TaskSpec("smooth-turn" if algorithm == "sac" else "turn")
    config = RunConfig(choice, algorithm, settings=tuple(settings.items()))
    run = create_run(tmp_path, config)
    with pytest.raises(RunError, match=next(iter(settings))):
        train(run)


@pytest.mark.long
def test_a_training_whose_numbers_overflow_fails_with_a_sentence(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("torch")
    run = create_run(
        tmp_path, RunConfig(TaskSpec("turn"), "a2c", settings=(("learning_rate", 1e300),)), "mine"
    )
    ended = train(run)
    assert (ended.how, "Lower the learning rate" in ended.reason) == ("failed", True)
    assert "Traceback" in capfd.readouterr().err, "the run's log has all of it"
    assert run.summary().state == "failed"


@every_case(
    "numbers",
    [{"steps": 10**400}, {"seed": 10**400}, {"learning_rate": -1.0}, {"goal": float("nan")}],
)
def test_numbers_that_no_training_has_are_no_configuration(
    numbers: Mapping[str, object], tmp_path: Path
) -> None:
    run = create_run(tmp_path, CONFIG)
    file = run.folder / "config.json"
    file.write_text(json.dumps(json.loads(file.read_text()) | numbers))
    with pytest.raises(RunError, match="damaged"):
        run.config()


def test_events_without_end_are_read_at_their_end(tmp_path: Path) -> None:
    run = create_run(tmp_path, CONFIG, "theirs")
    progress = TrainingProgress(5, 1.0, 5.0, {}, None, None, {})
    with run.events_file.open("wb") as file:
        file.truncate(1 << 40)  # a file of holes
        file.seek(0, os.SEEK_END)
        file.write(b"\n" + encode_event(progress) + b"\n")
    tracemalloc.start()
    assert run.events() == (progress,)
    assert tracemalloc.get_traced_memory()[1] < 8 * MAX_LINE_BYTES
    tracemalloc.stop()
    assert run.summary().steps == 5
    assert train(run).how == "finished", "its newest line is whole, so it can be trained on"


@every_case(
    "event",
    [
        {"event": "examined", "steps": 1, "seconds": 1.0, "cases": cases, "kept": False}
        for cases in ({}, {"ahead": []}, {"ahead": [1, 2]}, {"ahead": [1] * 50}, {"ahead": [5, -2, 0]})
    ],
)
def test_counts_of_other_outcomes_than_there_are_are_no_event(event: Mapping[str, object]) -> None:
    assert decode_event(json.dumps(event).encode()) is None
    assert decode_event(json.dumps({**event, "cases": {"ahead": [5, 2, 0]}}).encode()) is not None


@every_case(
    "numbers", [{"seconds": math.nan}, {"reward": math.inf}, {"steps": -1}, {"seconds": -1.0}], ids=str
)
def test_numbers_that_measure_nothing_are_no_event(numbers: Mapping[str, float]) -> None:
    progress = TrainingProgress(1, 1.0, 1.0, {"ahead": [1, 0, 0]}, 0.0, 1.0, {})
    assert decode_event(encode_event(progress)) == progress
    assert decode_event(encode_event(replace(progress, **numbers))) is None


def test_what_a_run_of_somebody_elses_says_commands_no_terminal(tmp_path: Path) -> None:
    command = "\x1b[2J\x1b]0;title\x07\u202e"
    run = create_run(tmp_path, CONFIG, "theirs")
    run.events_file.write_bytes(
        encode_event(TrainingProgress(1, 1.0, 1.0, {command: [1, 0, 0]}, 0.0, 1.0, {command: 0.0}))
        + b"\n"
        + encode_event(TrainingNote(command))
        + b"\n"
    )
    run.log.write_text(f"{command * 10_000}\n")
    progress, note = run.events()
    assert isinstance(progress, TrainingProgress)
    assert isinstance(note, TrainingNote)
    for text in (*progress.episodes, *progress.terms, note.text, run.last_log_line):
        assert text.isprintable()
        assert "[2J" in text
    assert len(run.last_log_line) < 10_000


def test_a_line_that_is_too_long_is_passed_over_and_cut_off_nowhere(tmp_path: Path) -> None:
    run = create_run(tmp_path, CONFIG, "theirs")
    note = TrainingNote("here")
    long = encode_event(TrainingNote("a" * (2 * MAX_LINE_BYTES)))
    run.events_file.write_bytes(b"\n".join([encode_event(note), long, encode_event(note), b""]))
    assert run.events() == (note, note)
    run.events_file.write_bytes(long)
    assert run.events() == ()
    with pytest.raises(OSError, match="more than 1 MiB"):
        train(run)
    assert run.events_file.stat().st_size == len(long) > MAX_LINE_BYTES < MAX_READ_BYTES


def test_an_order_without_end_is_none(tmp_path: Path) -> None:
    run = create_run(tmp_path, CONFIG, "theirs")
    with (run.folder / "control").open("wb") as file:
        file.truncate(1 << 40)
    assert run.read_command() == "go"


@pytest.mark.skipif(not Path("/proc/self/fd").exists(), reason="the system does not tell who has a file open")
def test_a_sweep_of_somebody_elses_ends_no_process_of_ones_own(tmp_path: Path) -> None:
    sweep = TrainingSweep.prepare(tmp_path / "theirs", [CONFIG], 2)
    lock = sweep.folder / LOCK_FILE
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as own:
        with process_lock(lock) as held:
            held.write(b"%d" % own.pid)
            held.flush()
            sweep.stop()
            assert own.poll() is None
            asked: list[int] = []
            before = signal.signal(signal.SIGTERM, lambda number, frame: asked.append(number))
            held.truncate(0)
            held.write(b"%d" % os.getpid())
            held.flush()
            sweep.stop()
            signal.signal(signal.SIGTERM, before)
        assert own.poll() is None
        assert asked == [signal.SIGTERM], "who trains it is asked to end"
        own.communicate(b"\n")


def test_a_cross_table_of_somebody_elses_is_tested_again(tmp_path: Path) -> None:
    sweep = TrainingSweep.prepare(tmp_path / "theirs", [CONFIG], 2)
    (entry,) = sweep.entries()
    sweep.run_job(entry.key)
    (wanted,) = crosstable_columns(sweep)
    file = sweep.run_of(entry).folder / TEST_FILE
    for odd in ("[]", "{}", '{"shares": {"a": 1.0}, "adjacency": {}}', '{"shares": {}, "adjacency": []}'):
        file.write_text(odd)
        assert crosstable_columns(sweep) == (wanted,)
