"""A cross table: trained once, tested on all cases, beside the dissertation's means."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.document.layout import lines_of
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.crosstable import (
    CrosstableColumn,
    case_groups,
    check_crosstable,
    crosstable_columns,
    crosstable_tables,
)
from kit.learning.training.run_config import RunError
from kit.learning.training.training_sweep import ALL_CASES, TrainingSweep, combine
from kit.study.printed_tables import printed_means

CASES = {"turn_a_to_b", "turn_b_to_a"}


def crosstable(*arguments: object, code: int = 0) -> str:
    words = ["sweep", *map(str, arguments), "--crosstable"]
    done = CliRunner().invoke(main, words, env={"COLUMNS": "80"})
    assert done.exit_code == code, done.output
    return done.stdout if code == 0 else done.output


@pytest.mark.long
def test_the_table_is_made_once_and_taken_up_again(tmp_path: Path) -> None:
    words = ("turn", "--algos", "q-learning", "--on", "turn_a_to_b,all", "--steps", 2000, "--episodes", 5)
    words = (*words, "--workspace", tmp_path, "--seeds", 2)
    assert "4 of 4 trainings without a result yet" in crosstable(*words, "--executor", "none")
    table = crosstable(*words)
    assert table.splitlines()[0].split() == ["tested", "on", "turn_a_to_b", ALL_CASES]
    marks = {file: file.stat().st_mtime_ns for file in tmp_path.rglob("runs/*/*.npz")}
    tests = [json.loads(file.read_bytes())["shares"] for file in sorted(tmp_path.rglob("tested-on-all.json"))]
    assert len(tests) == 4
    assert all(set(test) == CASES for test in tests)
    assert crosstable(*words) == table
    assert {file: file.stat().st_mtime_ns for file in tmp_path.rglob("runs/*/*.npz")} == marks
    columns = json.loads(crosstable(*words, "--json"))["columns"]
    sweep = TrainingSweep(next(tmp_path.glob("sweeps/*")))
    for column in columns:
        runs = [sweep.run_of(entry) for entry in sweep.entries() if entry.group[1] == column["group"]]
        assert len(runs) == 2
        stored = [json.loads((run.folder / "tested-on-all.json").read_bytes())["shares"] for run in runs]
        for case in CASES:
            assert column["shares"][case] == pytest.approx(sum(test[case] for test in stored) / 2)


@pytest.mark.long
def test_a_pair_has_its_adjacency_whatever_its_algorithm_does_with_actions(tmp_path: Path) -> None:
    configs = combine(("wheelchairs",), cases=("90_turns",), algorithms=("sarsa",), steps=1000)
    sweep = TrainingSweep.prepare(tmp_path / "pair", configs, 2)
    assert crosstable_columns(sweep) == ()
    sweep.run_job(sweep.entries()[0].key)
    (column,) = crosstable_columns(sweep)
    assert len(column.shares) == len(column.adjacency) == 9


def test_a_crosstable_differs_in_cases_and_seeds_alone() -> None:
    check_crosstable(combine(("hallway",), cases=("doors", ALL_CASES), seeds=(0, 1)))
    for tasks, algorithms in ((("hallway", "turn"), ("ppo",)), (("hallway",), ("ppo", "sarsa"))):
        with pytest.raises(RunError, match="groups of cases"):
            check_crosstable(combine(tasks, algorithms=algorithms))
    for words in (("--goal", 0.5), ("--tune", "gamma=0.9:0.99")):
        assert "--crosstable cannot" in crosstable("turn", *words, code=2)


def test_the_table_stands_beside_the_dissertation_s() -> None:
    assert case_groups(TaskSpec("hallway")) == ("doors", "obstacles", "90_turns", "180_turns", ALL_CASES)
    column = CrosstableColumn("doors", 1000, 5.0, {"straight": 0.99, "left_door": 0.75})
    assert column.mean == pytest.approx(0.87)
    assert column.spread == pytest.approx(0.12)
    rows = lines_of(crosstable_tables([column], printed_means("hallway")[1]))
    assert rows[0].split() == ["tested", "on", "doors"]
    assert rows[-1].split() == ["dissertation", "0.797"]


def test_a_table_is_compared_with_its_own_task_alone() -> None:
    columns = [CrosstableColumn(group, 1000, 5.0, {"one": 0.5}) for group in ("doors", "90_turns", ALL_CASES)]
    pair = lines_of(crosstable_tables(columns, printed_means("wheelchairs")[1]))
    assert not any("side by side" in row for row in pair)
    beside = lines_of(crosstable_tables([replace(column, adjacency={"one": 0.25}) for column in columns], {}))
    assert beside[-1].split() == ["mean", *["0.250"] * len(columns)]
    assert pair[-1].split() == ["dissertation", "0.443"]
    for task in ("turn", "turn-seed", "wheelchairs-seed-49"):
        assert not any(
            "dissertation" in row for row in lines_of(crosstable_tables(columns, printed_means(task)[1]))
        )
