"""The document that comes with the kit: every number of it follows from the logs beside it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.study import recorded_results, study_document
from kit.study.printed_tables import printed_table
from kit.study.recorded_results import (
    SHIPPED_FOLDER,
    RecordedSettings,
    RecordedTest,
    TrainingSession,
    append_event,
    find_recorded_result,
    read_recorded_result,
)
from kit.study.study_document import check_document, shipped_document, summary_lines
from kit.study.study_runs import StudyRun
from kit.workspace import Workspace

CASES = tuple(case for _, case in printed_table("3.5").cases)
LOGS = sorted(SHIPPED_FOLDER.glob("*.jsonl"))


def test_what_comes_with_the_kit_follows_from_its_logs() -> None:
    assert check_document() == []
    result = CliRunner().invoke(main, ["study", "--check"])
    assert result.exit_code == 0, result.stderr


def test_logs_that_come_with_the_kit_are_small_and_say_how_they_were_made() -> None:
    for file in LOGS:
        assert file.stat().st_size < 30_000
        found = read_recorded_result(file)
        assert found is not None
        assert found.settings.command.startswith(f"kit study {found.settings.table} --again")
        assert found.settings.commit
        assert {"python", "machine", "numpy"} <= set(found.settings.versions)


@pytest.fixture
def shipped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with one log and the document that follows from it."""
    for module in (recorded_results, study_document):
        monkeypatch.setattr(module, "SHIPPED_FOLDER", tmp_path)
    monkeypatch.setattr(study_document, "DOCUMENT", tmp_path / "STUDY.md")
    monkeypatch.setattr(study_document, "README", tmp_path / "README.md")
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
    (tmp_path / "STUDY.md").write_text(shipped_document())
    (tmp_path / "README.md").write_text("\n".join(summary_lines()))
    return tmp_path


@pytest.mark.parametrize("file", ["STUDY.md", pytest.param("README.md", marks=pytest.mark.long)])
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


def test_tests_during_training_make_its_figure(shipped: Path) -> None:
    runner = CliRunner()
    svg = shipped / "svg"
    result = runner.invoke(
        main, ["study", "figure", "3.8", "--svg", str(svg), "--workspace", str(shipped / "w")]
    )
    assert result.exit_code == 0
    assert re.search(r"20,000 steps.*0\.81", result.stdout)
    assert "0.81" in (svg / "figure-3-8.svg").read_text()


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
