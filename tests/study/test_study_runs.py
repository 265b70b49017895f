"""Agents of a printed table, trained and tested again; the event log of it, and what follows from it."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

from kit.controllers import ControllerFile
from kit.learning.training.runs import RunError
from kit.run.scenario import Scenario
from kit.study import study_runs
from kit.study.pairs import PairRunResult
from kit.study.printed_tables import SUCCESS, PrintedTable, printed_table
from kit.study.recorded_results import (
    RecordedResult,
    RecordedResultError,
    RecordedSettings,
    RecordedTest,
    append_event,
    read_recorded_result,
    recorded_result_file,
)
from kit.study.study_runs import StudyRun
from kit.workspace import Workspace

SETTINGS = RecordedSettings("3.5", "hallway-seed", "boltzmann-dqn", "seed", 100, None, {"numpy": "2"})


def agent(
    group: str, seed: int, reached: int, *, adjacency: float | None = None, table: str = "3.5"
) -> RecordedTest:
    cases = [case for _, case in printed_table(table).cases]
    shares = {} if adjacency is None else dict.fromkeys(cases, adjacency)
    return RecordedTest(group, seed, 50_000, 100.0, 100, dict.fromkeys(cases, reached), shares)


def test_a_log_is_read_as_it_was_written_and_a_cut_line_is_made_again(tmp_path: Path) -> None:
    file = tmp_path / "deep" / "3.5.jsonl"
    assert read_recorded_result(file) is None
    tests = (agent("doors", 0, 90), agent("all", 0, 40))
    for event in (SETTINGS, *tests):
        append_event(file, event)
    found = read_recorded_result(file)
    assert found is not None
    assert (found.settings, found.tests, found.rate) == (SETTINGS, tests, 500.0)
    file.write_bytes(file.read_bytes()[:-9])  # killed while it wrote
    cut = read_recorded_result(file)
    assert cut is not None
    assert cut.tests == tests[:1]
    append_event(file, tests[1])
    again = read_recorded_result(file)
    assert again is not None
    assert again.tests == tests


def test_cells_pool_the_seeds_and_know_their_interval(tmp_path: Path) -> None:
    file = tmp_path / "3.5.jsonl"
    for event in (SETTINGS, agent("doors", 0, 90), agent("doors", 1, 100)):
        append_event(file, event)
    found = read_recorded_result(file)
    assert found is not None
    cells = found.cells(printed_table("3.5"))
    assert {column for _, column in cells} == {"doors"}
    cell = cells["left door", "doors"]
    assert cell.value == 0.95
    assert cell.interval is not None
    assert 0.9 < cell.interval.low < 0.95 < cell.interval.high < 1
    assert cells["mean", "doors"].value == pytest.approx(0.95)
    assert cells["SD", "doors"].value == pytest.approx(0)


def test_adjacency_stands_in_its_own_columns(tmp_path: Path) -> None:
    file = tmp_path / "4.6.jsonl"
    append_event(file, replace(SETTINGS, table="4.6", task="wheelchairs-seed"))
    append_event(file, agent("90_turns", 0, 90, adjacency=0.25, table="4.6"))
    found = read_recorded_result(file)
    assert found is not None
    cells = found.cells(printed_table("4.6"))
    assert {column for _, column in cells} == {"90 acc", "90 adj"}
    assert cells["straight", "90 adj"].value == 0.25
    assert cells["straight", "90 adj"].interval is None


def test_the_adjacency_of_agents_that_rarely_reach_the_target_is_not_told(tmp_path: Path) -> None:
    """They crash soon after the start, and were side by side there."""
    test = agent("pair_straight", 0, 79, adjacency=0.97, table="4.6")
    for table, name in (("4.6", "straight adj"), ("4.4", "adj")):
        test = replace(test, own_cases=("pair_straight",))
        found = RecordedResult(tmp_path, SETTINGS, (test,)).cells(printed_table(table))
        assert ("straight", name) not in found
        assert found["straight", name.replace("adj", "acc")].value == 0.79
        better = replace(test, reached=dict.fromkeys(test.reached, 80))
        found = RecordedResult(tmp_path, SETTINGS, (better,)).cells(printed_table(table))
        assert found["straight", name].value == pytest.approx(0.97)


def test_the_adjacency_of_potential_fields_is_by_poses(tmp_path: Path) -> None:
    test = replace(agent("fields", 0, 0, adjacency=0.1, table="4.6"), by_poses={"pair_straight": 0.9})
    cells = RecordedResult(tmp_path, SETTINGS, (test,)).cells(printed_table("4.6"))
    assert {place: cell.value for place, cell in cells.items() if place[1] == "APF adj"} == {
        ("straight", "APF adj"): 0.9
    }


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"tested"', '"guessed"'),
        ('"seed": 0', '"sead": 0'),
        ('"straight": 90', '"straight": 900'),
        ('{"event"', "{"),
    ],
)
def test_a_damaged_log_is_told_with_its_line(tmp_path: Path, old: str, new: str) -> None:
    file = tmp_path / "3.5.jsonl"
    for event in (SETTINGS, agent("doors", 0, 90)):
        append_event(file, event)
    first, second = file.read_text().splitlines(keepends=True)
    assert old in second
    file.write_text(first + second.replace(old, new, 1))
    with pytest.raises(RecordedResultError, match=r"3\.5\.jsonl, line 2"):
        read_recorded_result(file)


def small_table() -> PrintedTable:
    """A table of the turn's two cases and of agents trained on one of them and on both."""
    return replace(
        printed_table("3.5"),
        repeat_task="turn",
        cases=(("turn", "turn_a_to_b"), ("turn", "turn_b_to_a")),
        columns=("one", "both"),
        groups=("turn_a_to_b", "all"),
        measures=(SUCCESS, SUCCESS),
    )


def small_run(folder: Path, **changes: object) -> StudyRun:
    run = StudyRun(small_table(), Workspace(folder), "q-learning", "kit", episodes=4, steps=1000)
    return replace(run, **changes)  # type: ignore[arg-type]  # any of its fields


@pytest.mark.long
def test_agents_are_trained_and_tested_once_and_a_stopped_run_goes_on(tmp_path: Path) -> None:
    run = small_run(tmp_path)
    assert run.missing_seeds(2) == (0, 1)
    before = run.expected_seconds(2, 2)
    sweep = run.sweep(0)
    told: list[RecordedTest] = []
    first, second = sweep.waiting()
    sweep.run_job(first)
    with pytest.raises(RunError, match="not trained yet"):
        run.record(sweep, 0, told.append)
    assert [each.group for each in told] == ["turn_a_to_b"]
    assert run.missing_seeds(2) == (0, 1)
    sweep.run_job(second)
    run.record(run.sweep(0), 0, told.append)
    assert [each.group for each in told] == ["turn_a_to_b", "all"]
    assert run.missing_seeds(2) == (1,)
    assert 0 < run.expected_seconds(2, 2)[0] != before[0]
    found = run.recorded()
    assert found is not None
    assert found.tests == tuple(told)
    assert all(each.steps >= 1000 and set(each.reached) == {"turn_a_to_b", "turn_b_to_a"} for each in told)
    assert recorded_result_file(run.workspace, "3.5").stat().st_size < 3000
    with pytest.raises(RunError, match="other settings"):
        small_run(tmp_path, episodes=5).recorded()


def test_it_takes_as_long_as_the_printed_steps_at_the_measured_rate(tmp_path: Path) -> None:
    run = StudyRun.of(printed_table("3.5"), Workspace(tmp_path))
    append_event(recorded_result_file(run.workspace, "3.5"), run.settings)
    append_event(recorded_result_file(run.workspace, "3.5"), agent("doors", 0, 90))
    steps = 720_000 + 270_000 + 50_000 + 130_000 + 590_000
    most = 5 * 1_000_000
    assert run.expected_seconds(3, 1) == pytest.approx((3 * steps / 500, 3 * most / 500))
    assert run.expected_seconds(3, 9) == pytest.approx((3 * steps / 500 / 5, 3 * most / 500 / 5))


def test_potential_fields_are_run_case_by_case_and_go_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    starts: list[tuple[str, int]] = []

    def drive(scenario: Scenario, controller: ControllerFile, *, seed: int = 0) -> PairRunResult:
        assert scenario.case is not None
        starts.append((scenario.case.name, seed))
        if len(starts) == 3:
            nan = math.nan
            return PairRunResult("failed", "It did not come back.", 0.0, nan, nan, nan, 0.0, math.inf, 0.0)
        return PairRunResult("reached" if seed else "collided", "", 9.0, 0.25, 0.5, 0.0, 2.0, 0.1, 0.0)

    monkeypatch.setattr(study_runs, "run_once", drive)
    run = StudyRun.of(printed_table("5.3"), Workspace(tmp_path))
    assert (run.groups, run.fields_runs) == ((), 40)
    with pytest.raises(RunError, match="pair_turn_b_to_a, run 0: It did not come back"):
        run.record_fields(runs=2)
    assert [case for _, case in run.missing_fields_cases] == ["pair_turn_b_to_a"]
    run.record_fields(runs=2)
    assert not run.misses_fields
    assert starts.count(("pair_turn_a_to_b", 0)) == 1
    found = run.recorded()
    assert found is not None
    cells = found.cells(run.table)
    assert {place: cell.value for place, cell in cells.items()} == {
        ("right turn", "acc"): 0.5,
        ("right turn", "adj"): 0.25,
        ("left turn", "acc"): 0.5,
        ("left turn", "adj"): 0.25,
    }
