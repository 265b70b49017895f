"""Agents of a printed table, trained and tested again; the event log of it, and what follows from it."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

from kit.controllers import ControllerFile
from kit.learning.training.run_config import RunError
from kit.learning.training.training import resolve_preset
from kit.run.scenario import Scenario
from kit.study import study_runs
from kit.study.pairs import PairRunResult
from kit.study.printed_tables import ADJACENCY_BY_POSES, SUCCESS, PrintedTable, printed_table
from kit.study.recorded_results import (
    RecordedResult,
    RecordedResultError,
    RecordedSettings,
    RecordedTest,
    SideShare,
    TrainingSession,
)
from kit.study.result_logs import append_event, read_recorded_result, recorded_result_file
from kit.study.study_runs import StudyRun
from kit.study.trained_seeds import TrainedSeeds
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
    append_event(file, agent("90_turns", 0, 100, adjacency=0.25, table="4.6"))
    found = read_recorded_result(file)
    assert found is not None
    cells = found.cells(printed_table("4.6"))
    assert {column for _, column in cells} == {"90 acc", "90 adj"}
    assert (cells["straight", "90 adj"].value, cells["straight", "90 adj"].episodes) == (0.25, 100)
    assert cells["straight", "90 adj"].interval is None


def test_adjacency_is_of_episodes_that_reached_the_target_and_says_how_many(tmp_path: Path) -> None:
    """Agents that crash soon after the start were side by side there."""
    table, of_all = printed_table("4.6"), agent("pair_straight", 0, 2, adjacency=0.97, table="4.6")
    for test in (of_all, replace(of_all, reached=dict.fromkeys(of_all.reached, 0))):
        cells = RecordedResult(tmp_path, SETTINGS, (test,)).cells(table)
        assert ("straight", "straight adj") not in cells  # of which two it is was not recorded
        assert ("straight", "straight acc") in cells
    known = replace(of_all, reached_by_rays={"pair_straight": 0.3}, reached_by_rays_sd={"pair_straight": 0.1})
    other = replace(known, seed=1, reached={"pair_straight": 6}, reached_by_rays={"pair_straight": 0.5})
    cell = RecordedResult(tmp_path, SETTINGS, (known, other)).cells(table)["straight", "straight adj"]
    assert cell.value == pytest.approx((2 * 0.3 + 6 * 0.5) / 8)
    assert cell.episodes == 8
    assert cell.interval is not None


def test_the_adjacency_of_potential_fields_is_by_poses(tmp_path: Path) -> None:
    test = replace(
        agent("fields", 0, 20, adjacency=0.1, table="4.6"), episodes=20, by_poses={"pair_straight": 0.9}
    )
    cells = RecordedResult(tmp_path, SETTINGS, (test,)).cells(printed_table("4.6"))
    assert {place: cell.value for place, cell in cells.items() if place[1] == "APF adj"} == {
        ("straight", "APF adj"): 0.9
    }
    assert test.side_share("pair_straight", ADJACENCY_BY_POSES) == SideShare(
        0.9, pytest.approx(math.nan, nan_ok=True), 20
    )


def session(steps: int, reached: int, value: float | None = None) -> TrainingSession:
    return TrainingSession(steps, reached, 100 - reached, 0, 1.0, 0.5, value)


def test_seeds_stand_against_a_best_test_by_their_best_tests(tmp_path: Path) -> None:
    table = printed_table("4.1")
    assert (table.prints_best_test, table.seeds) == (True, 5)
    tests = (
        replace(agent("pair_straight", 0, 7), sessions=(session(10_000, 30, 600.0), session(20_000, 0, 1e6))),
        replace(
            agent("pair_straight", 1, 90), sessions=(session(10_000, 0, 90.0), session(20_000, 91, 300.0))
        ),
    )
    result = RecordedResult(tmp_path, SETTINGS, tests)
    assert result.cells(table) == {}
    seeds = TrainedSeeds.of(table, result, "pair_straight")
    assert (len(seeds.tests), seeds.planned, seeds.reached) == (2, 5, 1)
    assert [each.share for each in seeds.best_sessions] == [0.3, 0.91]
    assert (seeds.steps_to_goal, seeds.largest_value) == ((20_000,), 1e6)
    nothing = TrainedSeeds.of(table, None, "pair_straight")
    assert (nothing.tests, nothing.planned, nothing.reached, nothing.largest_value) == ((), 5, 0, None)


def test_the_agents_of_a_part_are_those_of_the_whole(tmp_path: Path) -> None:
    part, whole = (StudyRun.of(printed_table(number), Workspace(tmp_path)) for number in ("4.4", "4.6"))
    assert (part.log, part.groups) == (whole.log, ("pair_straight",))
    assert whole.groups == ("pair_straight", "90_turns")
    assert part.configs(3) == whole.configs(3)[:1]
    assert part.sweep(3).folder == whole.sweep(3).folder
    assert [entry.config for entry in part.sweep(3).entries()] == list(
        whole.configs(3)
    )  # the longer one stays
    assert not part.has_potential_fields
    assert whole.has_potential_fields


def test_without_the_limit_nothing_else_differs(tmp_path: Path) -> None:
    limited, free = (
        StudyRun.of(printed_table("4.1"), Workspace(tmp_path), variant) for variant in ("seed", "no-limit")
    )
    (one,), (other,) = limited.configs(0), free.configs(0)
    assert replace(other, settings=()) == one
    presets = [resolve_preset(config).settings for config in (one, other)]
    assert [each.value_limit for each in presets] == [500.0, math.inf]  # type: ignore[union-attr]  # deep Q-networks
    assert free.settings.changed == "value_limit=none"
    assert free.log != limited.log
    assert not StudyRun.of(printed_table("5.2"), Workspace(tmp_path), "no-limit").groups  # PPO has none


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
    found = run.read_recorded()
    assert found is not None
    assert found.tests == tuple(told)
    assert all(each.steps >= 1000 and set(each.reached) == {"turn_a_to_b", "turn_b_to_a"} for each in told)
    assert recorded_result_file(run.workspace, "3.5").stat().st_size < 3000
    with pytest.raises(RunError, match="other settings"):
        small_run(tmp_path, episodes=5).read_recorded()


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
    found = run.read_recorded()
    assert found is not None
    cells = found.cells(run.table)
    assert {place: cell.value for place, cell in cells.items()} == {
        ("right turn", "acc"): 0.5,
        ("right turn", "adj"): 0.25,
        ("left turn", "acc"): 0.5,
        ("left turn", "adj"): 0.25,
    }
