"""The upkeep of runs: renamed and deleted only while nobody trains them; the disk and the time that they take."""

from __future__ import annotations

import fcntl
from dataclasses import replace
from pathlib import Path

import pytest

from kit.document.layout import lines_of
from kit.learning.tasks.rewards import REWARDS
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.events import EventWriter, TrainingProgress
from kit.learning.training.run_check import check_run_config
from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.run_folders import create_run, find_run, list_runs
from kit.learning.training.run_upkeep import (
    delete_run,
    disk_bytes,
    format_seconds,
    read_overviews,
    rename_run,
    runs_blocks,
    runs_table,
)
from kit.learning.training.runs import TrainingRun


@pytest.fixture
def run(tmp_path: Path) -> TrainingRun:
    return create_run(tmp_path, RunConfig(TaskSpec("turn"), "q-learning", steps=10_000), "mine")


def test_a_renamed_run_is_found_by_its_new_name_alone(run: TrainingRun) -> None:
    folder = run.folder.parent
    renamed = rename_run(run, "first.try")
    assert renamed.config() == find_run(folder, "first.try").config()
    assert [each.name for each in list_runs(folder)] == ["first.try"]


@pytest.mark.parametrize("name", ["a/b", "", "..", "other"])
def test_a_name_that_cannot_be_one_changes_nothing(run: TrainingRun, name: str) -> None:
    create_run(run.folder.parent, RunConfig(TaskSpec("turn")), "other")
    with pytest.raises(RunError, match=r"may contain letters|already"):
        rename_run(run, name)
    assert {each.name for each in list_runs(run.folder.parent)} == {"mine", "other"}


def test_a_run_that_is_being_trained_is_left_alone(run: TrainingRun) -> None:
    with (run.folder / "lock").open("ab") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        for change in (lambda: delete_run(run), lambda: rename_run(run, "new")):
            with pytest.raises(RunError, match="--stop"):
                change()
        assert run.config()
    assert delete_run(run) > 0
    assert not run.folder.exists()


def test_the_list_tells_disk_and_time_left(run: TrainingRun) -> None:
    (run.folder / "checkpoint.zip").write_bytes(bytes(2_000_000))
    with EventWriter(run.events_file) as writer:
        for steps, seconds in ((1000, 10.0), (2000, 20.0)):
            writer.write(TrainingProgress(steps, seconds, 100.0, {"turn_a_to_b": [1, 0, 0]}, 0.0, 9.0, {}))
    (idle,) = read_overviews([run])
    assert idle.remaining_s is None
    assert idle.disk_bytes == disk_bytes(run) > 2_000_000
    with (run.folder / "lock").open("ab") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        (active,) = read_overviews([run])
    assert active.remaining_s == pytest.approx(80.0)
    rows = lines_of(runs_blocks([active]))
    assert "1.9 MiB" in rows[1]
    assert rows[1].endswith("80 s")
    assert "1 run, 1.9 MiB" in rows[-1]


def test_a_damaged_run_is_listed_too(run: TrainingRun) -> None:
    (run.folder / "config.json").write_text("{")
    (found,) = read_overviews([run])
    assert found.summary is None
    lines = lines_of(runs_blocks([found]))
    assert "damaged" in lines[1]
    assert found.problem
    assert "".join(found.problem.split()) == "".join("".join(lines[2:-1]).split())


@pytest.mark.parametrize(("seconds", "text"), [(40, "40 s"), (720, "12 min"), (11_100, "3 h 05 min")])
def test_times_are_told_as_people_say_them(seconds: float, text: str) -> None:
    assert format_seconds(seconds) == text


def test_what_cannot_be_trained_is_refused_before_anything_is_written() -> None:
    check_run_config(RunConfig(TaskSpec("turn"), "q-learning"))
    with pytest.raises(RunError, match="without a mirror"):
        check_run_config(RunConfig(TaskSpec("hallway"), "sarsa", mirrored=True))


def test_a_reward_of_ones_own_stands_in_the_list(run: TrainingRun, tmp_path: Path) -> None:
    file = tmp_path / "straight_ahead.py"
    file.write_text("def reward(step):\n    return 0.0\n")
    kits_own = next(iter(REWARDS))
    create_run(run.folder.parent, RunConfig(TaskSpec("turn"), "q-learning", reward_file=str(file)), "own")
    create_run(run.folder.parent, RunConfig(TaskSpec("turn", reward=kits_own), "q-learning"), "kits")
    overviews = {each.run.name: each for each in read_overviews(list_runs(run.folder.parent))}
    assert {name: each.reward for name, each in overviews.items()} == {
        "own": "straight_ahead.py",
        "mine": "",
        "kits": kits_own,
    }
    rows = lines_of(runs_blocks(tuple(overviews.values())))
    assert ["straight_ahead.py" in each for each in rows if each.startswith("own")] == [True]
    assert not any("straight_ahead.py" in each for each in rows if not each.startswith("own"))


def test_what_no_run_has_needs_no_column(run: TrainingRun) -> None:
    (plain,) = read_overviews([run])
    heads = [column.title for column in runs_table([plain]).columns]
    assert heads[-1] == "time"
    waiting = replace(plain, remaining_s=80.0)
    assert runs_table([plain, waiting]).columns[-1].title == "left"
    both = runs_table([plain, replace(waiting, reward="mine.py")])
    assert [column.title for column in both.columns[-2:]] == ["left", "reward"]
    assert all(len(each) == len(both.columns) for each in both.rows)


def test_values_that_rewards_cannot_pay_are_marked_and_explained(run: TrainingRun) -> None:
    measures = {"value_max": 57_123_456.0, "value_mean": 3.0, "value_payable": 1390.0}
    with EventWriter(run.events_file) as events:
        events.write(TrainingProgress(10, 1.0, 10.0, {"a": [5, 3, 2]}, 0.0, 1.0, {}, measures=measures))
    text = "\n".join(lines_of(runs_blocks(read_overviews([run]))))
    assert "57,123,456!" in text
    assert "rewards can" in " ".join(text.split())
