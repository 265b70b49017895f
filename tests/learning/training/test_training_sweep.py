"""Sweeps: every combination once, results kept, what was killed goes on, one table with intervals."""

from __future__ import annotations

import csv
import io
import json
import math
import os
import signal
import subprocess
import sys
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.document.layout import lines_of
from kit.host.job_folder import JobExecutor
from kit.learning.policies.confidence_intervals import wilson_interval
from kit.learning.training import training_sweep
from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.run_folders import create_run
from kit.learning.training.runs import TrainingRun
from kit.learning.training.sweep_table import problems, sweep_rows, sweep_table, sweep_table_csv
from kit.learning.training.sweep_worker import start_sweep
from kit.learning.training.training_sweep import SweepResult, TrainingSweep, combine
from tests.waiting import wait_until

QUICK = combine(["turn"], algorithms=["q-learning", "sarsa"], seeds=[3, 4], steps=2_000)


def test_every_combination_is_trained_once(tmp_path: Path) -> None:
    reward = tmp_path / "mine.py"
    reward.write_text("def reward(step):\n    return -step\n")
    configs = combine(
        ["turn", "hallway"], algorithms=["ppo", "a2c"], rewards=["progress", str(reward)], seeds=range(3)
    )
    assert len(configs) == len(set(configs)) == 2 * 2 * 2 * 3
    assert {config.choice.reward for config in configs} == {"progress", None}
    assert {config.reward_file for config in configs} == {None, str(reward)}
    sweep = TrainingSweep.prepare(tmp_path / "sweep", configs, 10)
    entries = sweep.entries()
    assert len({entry.key for entry in entries}) == len(entries) == 24
    assert [entry.config for entry in entries] == list(configs)
    halves = [sweep.waiting((number, 2)) for number in range(2)]
    assert sorted(halves[0] + halves[1]) == sorted(sweep.waiting())
    assert halves[0] != ()
    with pytest.raises(RunError, match="--name"):
        TrainingSweep.prepare(tmp_path / "sweep", configs[1:], 10)
    with pytest.raises(RunError, match="kit sweep"):
        TrainingSweep(tmp_path).entries()


def test_a_sweep_of_somebody_elses_leads_to_no_file_of_ones_own(tmp_path: Path) -> None:
    own, folder = tmp_path / "own.txt", tmp_path / "sweep"
    own.write_text("mine")
    TrainingSweep.prepare(folder, QUICK[:1], 5)
    (folder / "log.txt").symlink_to(own)
    with pytest.raises(RunError, match=r"log\.txt is a link"):
        TrainingSweep.prepare(folder, QUICK[:1], 5)


def test_a_setting_without_limit_is_a_json_value_and_comes_back(tmp_path: Path) -> None:
    configs = combine(["turn"], algorithms=["boltzmann-dqn"], settings={"value_limit": (math.inf,)})
    sweep = TrainingSweep.prepare(tmp_path / "sweep", configs, 10)
    assert [entry.config for entry in sweep.entries()] == list(configs)
    json.dumps(configs[0].as_dict(), allow_nan=False)


def test_a_row_tells_how_many_seeds_have_learned(tmp_path: Path) -> None:
    sweep = TrainingSweep.prepare(tmp_path, QUICK, 10)
    entries = sweep.entries()
    for entry, worst in zip(entries, (0.95, 0.5, 1.0), strict=False):
        sweep._save_result(entry.key, SweepResult(2000, 60.0, 0.97, worst, "turn_a_to_b", 19, 20))
    sweep.record_loss(entries[3].key)
    assert sweep.waiting() == (entries[3].key,)
    first, second = sweep_rows(sweep, 0.9)
    assert (first.learned, first.seeds, second.learned, len(second.results)) == (1, 2, 1, 1)
    lines = lines_of([sweep_table((first, second))])
    low, high = wilson_interval(1, 2)
    assert f"{low:.2f} to {high:.2f}" in lines[1]
    assert lines[0].endswith("missing")
    assert lines[2].endswith("1")
    assert "task " in lines[0]
    assert "preset" not in lines[0], "what does not differ is left out"
    assert max(map(len, lines)) <= 79
    assert len(problems(sweep)) == 1
    table = list(csv.DictReader(io.StringIO(sweep_table_csv(sweep))))
    assert [row["worst"] for row in table] == ["0.95", "0.5", "1.0", "0.0"]
    assert table[3]["problem"]


def test_a_training_of_a_sweep_is_kept_and_not_run_again(tmp_path: Path) -> None:
    sweep = TrainingSweep.prepare(tmp_path, QUICK[:2], 5)
    key, other = (entry.key for entry in sweep.entries())
    sweep.run_job(key)
    found = sweep.result(key)
    assert found is not None
    assert (found.steps >= 2_000, found.episodes, found.problem) == (True, 10, "")
    assert sweep.waiting() == (other,)
    (sweep.folder / "results" / f"{key}.json").unlink()
    sweep.run_job(key)  # trained already: it is only tested
    assert sweep.result(key) == found
    broken = replace(QUICK[0], reward_file=str(tmp_path / "bad.py"))
    (tmp_path / "bad.py").write_text("def reward(step):\n    return 1 / 0\n")
    failing = TrainingSweep.prepare(tmp_path / "failing", [broken], 5)
    failing.run_job(*failing.waiting())
    assert "division" in problems(failing)[0]
    assert len(failing.waiting()) == 1


def test_a_training_that_another_process_begins_at_this_moment_is_no_failure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sweep = TrainingSweep.prepare(tmp_path, QUICK[:1], 5)

    def create_twice(folder: Path, config: RunConfig, name: str) -> TrainingRun:
        create_run(folder, config, name)
        return create_run(folder, config, name)

    monkeypatch.setattr(training_sweep, "create_run", create_twice)
    sweep.run_job(*sweep.waiting())
    assert (sweep.waiting(), problems(sweep)) == ((), [])


def kit_sweep(*arguments: object) -> tuple[int, str]:
    done = CliRunner().invoke(main, ["sweep", *map(str, arguments)], env={"COLUMNS": "80"})
    assert "Traceback" not in done.output
    return done.exit_code, done.output


def test_mistakes_are_told_before_anything_is_trained(tmp_path: Path) -> None:
    for words, told in (
        (("trun",), "turn"),
        (("turn", "--algos", "ppo,sac"), "smooth-turn"),
        (("turn", "--seeds", "none"), "100:110"),
        (("turn", "--presets", "mine"), "kit, seed"),
        (("turn", "--on", "dors"), "no case"),
    ):
        code, output = kit_sweep(*words)
        assert (code, told in output) == (2, True), output
    assert not list((tmp_path / "workspace").glob("sweeps/*"))


@pytest.mark.long
def test_the_verb_runs_shards_of_an_array_job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With a stand-in for sbatch that runs the script's tasks one after the other."""
    sbatch = tmp_path / "bin" / "sbatch"
    sbatch.parent.mkdir()
    sbatch.write_text('#!/bin/sh\nfor i in 0 1; do SLURM_ARRAY_TASK_ID=$i sh "$2" || exit 1; done\n')
    sbatch.chmod(0o755)
    monkeypatch.setenv("PATH", f"{sbatch.parent}:{os.environ['PATH']}")
    words = ("turn", "--algos", "q-learning,sarsa", "--seeds", 2, "--steps", 2000, "--episodes", 5)
    code, output = kit_sweep(*words, "--executor", "slurm", "--jobs", 2, "--csv", tmp_path / "table.csv")
    assert code == 0, output
    assert "2000" in (tmp_path / "table.csv").read_text()
    code, output = kit_sweep(*words, "--executor", "none", "--json")
    rows = json.loads(output)["rows"]
    assert [len(row["results"]) for row in rows] == [2, 2]
    monkeypatch.setenv("PATH", "/nowhere")
    code, output = kit_sweep("turn", "--algos", "sarsa", "--seeds", 1, "--executor", "slurm")
    assert (code, "sbatch" in output) == (2, True)


@pytest.mark.long
@pytest.mark.skipif(find_spec("distributed") is None, reason="the extra `cluster` is not installed")
def test_a_cluster_trains_the_same(tmp_path: Path) -> None:
    from distributed import LocalCluster

    one, other = (TrainingSweep.prepare(tmp_path / name, QUICK[:2], 5) for name in ("one", "other"))
    for key in one.waiting():
        one.run_job(key)
    done: list[str] = []
    options = {"n_workers": 1, "threads_per_worker": 1, "dashboard_address": None, "silence_logs": "ERROR"}
    with LocalCluster(**options, local_directory=str(tmp_path)) as cluster:
        address = cluster.scheduler_address
        JobExecutor("dask", cluster=address).run(other, other.waiting(), done.append)
    assert sorted(done) == sorted(entry.key for entry in one.entries())
    for key in done:
        first, second = one.result(key), other.result(key)
        assert first is not None
        assert second is not None
        assert replace(first, seconds=0.0) == replace(second, seconds=0.0)


@pytest.mark.long
def test_a_killed_sweep_goes_on_in_the_middle_of_a_training(tmp_path: Path) -> None:
    configs = combine(["turn"], algorithms=["q-learning"], seeds=[1, 2], steps=400_000)
    configs = tuple(replace(config, keep_training=True) for config in configs)
    sweep = TrainingSweep.prepare(tmp_path, configs, 5)
    worker = [sys.executable, "-m", "kit.learning.training.sweep_worker", str(tmp_path), "--shard", "0/1"]
    with subprocess.Popen(worker) as process:
        wait_until(lambda: list(tmp_path.glob("runs/*/events.jsonl")) != [])
        (run,) = (TrainingRun(folder) for folder in tmp_path.glob("runs/*"))
        wait_until(lambda: run.summary().steps > 20_000)
        process.send_signal(signal.SIGTERM)
        assert process.wait(60) == 130
    steps = run.summary().steps
    assert 20_000 < steps < 400_000
    assert len(sweep.waiting()) == 2
    assert subprocess.run(worker, check=False).returncode == 0
    assert sweep.waiting() == ()
    assert any("last checkpoint" in str(event) for event in run.events())


@pytest.mark.long
def test_a_process_of_its_own_trains_a_sweep_to_its_end(tmp_path: Path) -> None:
    sweep = TrainingSweep.prepare(tmp_path / "sweep", QUICK, 20)
    first = start_sweep(sweep)
    assert start_sweep(sweep).wait(60) == 0  # there is one already
    assert first.wait(120) == 0
    assert not sweep.waiting()
    assert not sweep.is_active
    found = [sweep.result(entry.key) for entry in sweep.entries()]
    assert [each.episodes for each in found if each is not None] == [40] * len(QUICK)
    assert start_sweep(sweep).wait(60) == 0  # nothing is left to do
    sweep.stop()
