"""The document that comes with the kit: every number of it follows from the logs beside it."""

from __future__ import annotations

import csv
import math
import re
from dataclasses import replace
from pathlib import Path
from statistics import median
from xml.etree import ElementTree

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.study import result_logs, study_check, study_document
from kit.study.printed_tables import ADJACENCY, FIGURE, SUCCESS, parts_of, printed_table
from kit.study.recorded_results import (
    RecordedCell,
    RecordedPath,
    RecordedResult,
    RecordedResultError,
    RecordedSettings,
    RecordedTest,
    TrainingSession,
)
from kit.study.result_logs import (
    SHIPPED_FOLDER,
    append_event,
    find_recorded_result,
    find_recorded_results,
    read_recorded_result,
)
from kit.study.seed_spread import cells_below
from kit.study.study_check import check_document, incomparable_rows
from kit.study.study_document import recorded_study_document
from kit.study.study_runs import StudyRun
from kit.study.study_summary import summary_lines
from kit.workspace import Workspace

CASES = tuple(case for _, case in printed_table("3.5").cases)
LOGS = sorted(SHIPPED_FOLDER.glob("*.jsonl"))


@pytest.mark.long
def test_what_comes_with_the_kit_follows_from_its_logs() -> None:
    assert check_document() == []
    result = CliRunner().invoke(main, ["study", "--check"])
    assert result.exit_code == 0, result.stderr


def test_logs_that_come_with_the_kit_are_small_and_say_how_they_were_made() -> None:
    for file in LOGS:
        assert file.stat().st_size < 100_000  # two groups of cases, five seeds, a hundred tests each
        found = read_recorded_result(file)
        assert found is not None
        number = found.settings.table.replace(FIGURE, "figure ")
        parts = [number, *(part.id for part in parts_of(found.settings.table))]
        assert any(found.settings.command.startswith(f"kit study {part} --again") for part in parts)
        assert found.settings.commit
        assert {"python", "machine", "numpy"} <= set(found.settings.versions)


def test_agents_of_another_task_stand_beside_no_printed_table(tmp_path: Path) -> None:
    for number, task, group, case in (
        ("4.6", "wheelchairs-seed-49-as-run", "90_turns", "pair_straight"),
        ("4.1", "wheelchairs-seed-49", "pair_straight", "pair_straight"),
        ("3.5", "turn", "all", "straight"),
    ):
        table = printed_table(number)
        made = RecordedSettings(number, table.repeat_task, "boltzmann-dqn", "seed", 100, None, {})
        test = RecordedTest(group, 0, 10, 1.0, 100, {case: 9}, {})
        good = RecordedResult(tmp_path / "good.jsonl", made, (test,))
        bad = RecordedResult(tmp_path / "bad.jsonl", replace(made, task=task), (test,))
        assert incomparable_rows(table, {"seed": good}) == []
        assert any("bad.jsonl" in line for line in incomparable_rows(table, {"seed": bad}))
    kit = RecordedResult(tmp_path / "kit.jsonl", replace(made, task="turn"), (test,))
    assert any("target radius" in line for line in incomparable_rows(printed_table("3.5"), {"kit": kit}))


def test_an_adjacency_without_a_success_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    table = printed_table("4.6")
    settings = RecordedSettings("4.6", table.repeat_task, "boltzmann-dqn", "seed", 100, None, {})
    wrong = {("straight", "90 adj"): RecordedCell(0.96, None, ADJACENCY, 0)}
    monkeypatch.setattr(RecordedResult, "cells", lambda self, table: wrong)
    (line,) = incomparable_rows(table, {"seed": RecordedResult(tmp_path / "4.6.jsonl", settings, ())})
    assert "straight, 90 adj" in line


@pytest.fixture
def shipped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with one log and the document that follows from it."""
    for module in (result_logs, study_document):
        monkeypatch.setattr(module, "SHIPPED_FOLDER", tmp_path)
    monkeypatch.setattr(study_check, "DOCUMENT", tmp_path / "STUDY.md")
    monkeypatch.setattr(study_check, "README", tmp_path / "README.md")
    log = tmp_path / "3.5.jsonl"
    settings = RecordedSettings(
        "3.5", "hallway-seed-as-run", "boltzmann-dqn", "seed", 100, None, {"numpy": "2"}, "kit study 3.5"
    )
    sessions = (
        TrainingSession(10_000, 3, 90, 7, -12.5, None),
        TrainingSession(20_000, 81, 9, 10, 300.0, None),
    )
    append_event(log, settings)
    for group in ("doors", "all"):
        reached = dict.fromkeys(CASES, 70)
        append_event(log, RecordedTest(group, 0, 20_000, 9.0, 100, reached, {}, CASES[1:4], sessions))
    (tmp_path / "STUDY.md").write_text(recorded_study_document())
    (tmp_path / "README.md").write_text("\n".join(summary_lines()))
    return tmp_path


@pytest.mark.long
@pytest.mark.parametrize("file", ["STUDY.md", "README.md"])
def test_a_digit_that_was_changed_by_hand_is_found(shipped: Path, file: str) -> None:
    assert check_document() == []
    text = (shipped / file).read_text()
    assert "0.70" in text
    (shipped / file).write_text(text.replace("0.70", "0.71", 1))
    found = check_document()
    assert len(found) == 1
    assert file in found[0]
    assert CliRunner().invoke(main, ["study", "--check"]).exit_code == 1


def test_a_count_that_was_changed_in_a_log_is_found(shipped: Path) -> None:
    log = shipped / "3.5.jsonl"
    log.write_text(log.read_text().replace('"left_door": 70', '"left_door": 71', 1))
    assert any("0.71" in line for line in check_document())


def test_steps_and_accuracy_of_a_training_come_from_the_log_of_its_agents(shipped: Path) -> None:
    table = printed_table("3.4")
    found = find_recorded_result(None, table)
    assert found is not None
    cells = found.cells(table)
    assert cells["doors", "steps"].value == 20_000
    assert cells["doors", "acc"].value == pytest.approx(0.7)
    assert cells["doors", "acc"].interval is not None
    assert ("obstacles", "steps") not in cells


@pytest.mark.long
def test_seeds_are_told_beside_the_printed_spread(shipped: Path) -> None:
    log = shipped / "3.5.jsonl"
    append_event(log, RecordedTest("doors", 1, 20_000, 9.0, 100, dict.fromkeys(CASES, 90), {}, CASES[1:4]))
    folder, table = shipped / "csv", printed_table("3.5")
    words = ["study", "3.5", "--csv", str(folder), "--workspace", str(shipped / "w")]
    assert CliRunner().invoke(main, words).exit_code == 0
    (row,) = csv.DictReader(
        (folder / "table-3-5-means.csv").read_text().splitlines()
    )  # of doors: "all" has one seed
    assert row["agent"] == "doors"
    assert [float(row[name]) for name in ("printed", "SD", "mean", "low", "high", "SD seeds")] == (
        pytest.approx([0.7967, 0.2017, 0.8, 0.7, 0.9, math.sqrt(0.02)], abs=1e-3)
    )
    assert (row["seeds"], row["in SD"], row["between"]) == ("2", "yes", "yes")
    assert any("0.80 (0.70-0.90)" in line for line in summary_lines())
    result = find_recorded_result(None, table)
    assert result is not None
    below = list(cells_below(table, result.cells(table)))
    assert ("straight", "doors") in {(each.row, each.column) for each in below}  # 0.8 for 0.99
    assert ("two doors", "doors") not in {(each.row, each.column) for each in below}  # 0.8 for 0.34
    assert len(below) == len({(each.row, each.column) for each in below}) > 3
    assert f"| 3.5, {below[0].column} | {below[0].row} | ours |" in recorded_study_document()


def test_adjacency_has_an_interval_where_episodes_are_told_apart() -> None:
    test = RecordedTest("fields", 0, 0, 1.0, 20, {"a": 20}, {"a": 0.5}, adjacency_sd={"a": 0.2})
    table = replace(
        printed_table("5.3"), rows={"row": (1.0, 0.6)}, cases=(("map", "a"),), measures=(SUCCESS, ADJACENCY)
    )
    settings = RecordedSettings("5.3", "", "", "", 20, None, {})
    cell = RecordedResult(Path(), settings, (test,)).cells(table)["row", "adj"]
    assert cell.interval == pytest.approx(
        (0.5 - 2.093 * 0.2 / math.sqrt(20), 0.5 + 2.093 * 0.2 / math.sqrt(20)), abs=1e-4
    )
    plain = RecordedResult(Path(), settings, (replace(test, adjacency_sd={}),))
    assert plain.cells(table)["row", "adj"].interval is None


@pytest.mark.long
def test_recorded_ways_are_drawn_over_their_map(shipped: Path) -> None:
    log = shipped / "3.5.jsonl"
    ways = [
        RecordedPath(
            "all", 0, "small_obstacle", outcome, (4.0, 0.5), 0.5, (((0.0, 0.5), (1.0, 0.5), (2.0, 0.6)),)
        )
        for outcome in ("reached", "collided")
    ]
    for way in ways:
        append_event(log, way)
    read = read_recorded_result(log)
    assert read is not None
    assert read.paths == tuple(ways)
    assert "1 reached, 1 collided" in recorded_study_document()
    svg = shipped / "svg"
    words = ["study", "figure", "3.9", "--svg", str(svg), "--workspace", str(shipped / "w")]
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 0, result.output
    assert max(map(len, result.stdout.splitlines())) <= 79
    (picture,) = svg.glob("figure-3-9-*.svg")
    root = ElementTree.fromstring(picture.read_text())
    paths = [each.get("stroke-dasharray") for each in root.iter("{http://www.w3.org/2000/svg}path")]
    assert "2 3" in paths  # dotted: it collided
    log.write_text(log.read_text().replace('"collided"', '"crashed"', 1))
    with pytest.raises(RecordedResultError, match="line 5"):
        read_recorded_result(log)


@pytest.mark.long
def test_tests_during_training_make_its_figure(shipped: Path) -> None:
    runner = CliRunner()
    svg = shipped / "svg"
    result = runner.invoke(
        main, ["study", "figure", "3.8", "--svg", str(svg), "--workspace", str(shipped / "w")]
    )
    assert result.exit_code == 0
    assert re.search(r"20,000 steps.*0\.81", result.stdout)
    assert "0.81" in (svg / "figure-3-8.svg").read_text()


@pytest.mark.long
def test_a_page_opens_without_a_network(shipped: Path) -> None:
    folder = shipped / "page"
    words = ["study", "3", "--html", str(folder), "--workspace", str(shipped / "w")]
    assert CliRunner().invoke(main, words).exit_code == 0
    page = (folder / "index.html").read_text()
    assert "<svg" in page
    assert "kit study 3.5" in page
    assert not re.search(r'(src|href)="(?!#)', page)


@pytest.mark.long
def test_a_recorded_agent_is_trained_again_and_does_as_well(tmp_path: Path) -> None:
    """The quickest of what comes with the kit: an agent of Table 5.2 by the kit's own preset."""
    table = printed_table("5.2")
    recorded = find_recorded_result(None, table, "kit")
    assert recorded is not None
    run = StudyRun.of(table, Workspace(tmp_path), "kit")
    assert (run.task, run.algorithm, run.preset) == (
        recorded.settings.task,
        recorded.settings.algorithm,
        recorded.settings.preset,
    )
    sweep = run.sweep(0)
    for key in sweep.waiting():
        sweep.run_job(key)
    found: list[RecordedTest] = []
    run.record(sweep, 0, found.append)
    (again,), (before, *_) = found, recorded.tests
    assert (again.group, again.seed, again.episodes) == (before.group, before.seed, before.episodes)
    assert again.reached.keys() == before.reached.keys()
    for case, reached in before.reached.items():
        assert abs(again.reached[case] - reached) <= 0.1 * before.episodes


def test_standing_still_pays_more_than_arriving_on_the_turns() -> None:
    """The numbers of the sentence that tells it follow from the tests of the agents of the turns."""
    table = printed_table("4.5")
    result = find_recorded_results(table, None)["no-limit"]
    agents = result.tests_of("90_turns")
    standing = [
        [each for each in agent.sessions if each.timed_out == 100 and (each.adjacency or 0.0) > 0.9]
        for agent in agents
    ]
    earned = median(each.reward for sessions in standing for each in sessions if each.reward is not None)
    most = max(
        each.reward
        for agent in agents
        for each in agent.sessions
        if each.share >= 0.5 and each.reward is not None
    )
    (told,) = (text for text in table.settings if "standing still" in text)
    assert f"{sum(map(bool, standing))} of {len(agents)} seeds" in told
    assert f"{round(earned, -1):,.0f} an episode" in told
    assert f"more than {math.ceil(most / 50) * 50:,} " in told
