"""``kit study``: the list, a table, a figure, files, mistakes."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from kit.cli import main
from kit.cli import study as study_command
from kit.learning.training.runs import TrainingRun
from kit.study import printed_tables, result_logs, study_document
from kit.study.printed_tables import printed_table, study_chapters
from kit.study.recorded_results import RecordedTest
from kit.study.result_logs import append_event, read_recorded_result, recorded_result_file
from kit.study.study_runs import StudyRun
from kit.workspace import Workspace
from tests.waiting import wait_until


def study(folder: Path, *words: str) -> Result:
    return CliRunner().invoke(main, ["study", *words, "--glyphs", "ascii", "--workspace", str(folder)])


@pytest.fixture(autouse=True)
def nothing_ships(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """What these tests record is all there is, whatever results come with the kit."""
    monkeypatch.setattr(result_logs, "SHIPPED_FOLDER", tmp_path_factory.mktemp("shipped"))


def record(folder: Path) -> None:
    run = StudyRun.of(printed_table("3.5"), Workspace(folder))
    cases = dict.fromkeys((case for _, case in run.table.cases), 50)
    file = recorded_result_file(run.workspace, "3.5")
    append_event(file, run.settings)
    append_event(file, RecordedTest("doors", 0, 50_000, 100.0, 100, cases, {}))


def test_the_list_has_every_number_and_says_what_is_recorded(tmp_path: Path) -> None:
    lines = study(tmp_path).stdout.splitlines()
    assert max(map(len, lines)) <= 79
    begins = {line.split("  ")[0] for line in lines}
    assert {"Table 3.3", "Table 4.6", "Table 5.9", "Figure 3.5", "Figure 4.15", "Figure 5.19"} <= begins
    record(tmp_path)
    lines = study(tmp_path, "3").stdout.splitlines()
    assert [line.split()[1] for line in lines if "recorded: ours 1" in line] == ["3.4", "3.5"]


def test_a_table_without_a_result_shows_the_print_and_how_long_it_would_take(tmp_path: Path) -> None:
    result = study(tmp_path, "3.5")
    assert result.exit_code == 0
    assert "0.797" in result.stdout
    assert "differs" not in result.stdout
    assert "--again" in result.stdout
    assert " min " in result.stdout
    assert not any(tmp_path.iterdir())


def test_ours_stand_below_the_print_with_interval_and_difference(tmp_path: Path) -> None:
    record(tmp_path)
    result = study(tmp_path, "table", "3.5", "--csv", str(tmp_path / "csv"))
    assert max(map(len, result.stdout.splitlines())) <= 79
    rows = csv.reader((tmp_path / "csv" / "table-3-5.csv").read_text().splitlines())
    found = {(row[0], row[1]): row[2] for row in rows}
    assert (found["straight", "printed"], found["straight", "ours"]) == ("0.99", "0.5")
    assert float(found["straight", "differs"]) == pytest.approx(-0.49)
    assert float(found["straight", "at least"]) < 0.5 < float(found["straight", "at most"])
    assert "cells fail: their 95 % interval" in result.stdout
    assert "right door, doors" not in result.stdout  # 0.57 lies in the interval


LONG = pytest.mark.long


@pytest.mark.parametrize(
    "words",
    [
        ("4.6",),
        ("5.2",),
        pytest.param(("5.6",), marks=LONG),
        ("figure", "4.10"),
        pytest.param(("figure", "5.17"), marks=LONG),
        ("3.7",),
    ],
)
def test_each_fits_eighty_columns(tmp_path: Path, words: tuple[str, ...]) -> None:
    result = study(tmp_path, *words)
    assert result.exit_code == 0
    assert f"{'Figure' if words[0] in ('figure', '3.7') else 'Table'} {words[-1]}. " in result.stdout
    assert max(map(len, result.stdout.splitlines())) <= 79


@pytest.mark.parametrize("word", ["Figure-4.10", "figure 4.10"])
def test_a_figure_may_be_one_word(tmp_path: Path, word: str) -> None:
    assert study(tmp_path, word).stdout == study(tmp_path, "figure", "4.10").stdout


def test_json_for_machines(tmp_path: Path) -> None:
    content = json.loads(study(tmp_path, "4.6", "--json", "-").stdout)
    table = next(each for each in content["chapters"][0]["blocks"] if "table" in each)
    assert table["rows"][1] == ["turn left 90", 1.0, 0.54, 0.35, 0.02, 0.0, 0.03]
    assert table["rows"][3][1] is None


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("9.9",), "5.9"),
        (("figure",), "needs one number"),
        (("figure", "3.4"), "no figure"),
        (("3.5", "3.4"), "one number"),
        (("4.3", "--again"), "3.3, 3.4, 3.5"),
        (("4.2", "--again", "--kit"), "--again --kit cannot reproduce that"),
        (("--again",), "3.3, 3.4, 3.5"),
    ],
)
def test_a_mistake_is_told(tmp_path: Path, words: tuple[str, ...], told: str) -> None:
    result = study(tmp_path, *words)
    assert result.exit_code == 2
    assert told in result.stderr


def test_a_damaged_log_is_told(tmp_path: Path) -> None:
    record(tmp_path)
    file = recorded_result_file(Workspace(tmp_path), "3.5")
    file.write_text(file.read_text() + "{}\n")
    result = study(tmp_path, "3.5")
    assert result.exit_code == 2
    assert "line 3" in result.stderr


@pytest.mark.long
def test_again_trains_and_tests_in_processes_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The verb as it is, on a small table: what it prints first, what it records, and that it does nothing twice."""
    printed = replace(
        printed_table("3.5"),
        repeat_task="turn",
        cases=(("turn", "turn_a_to_b"), ("turn", "turn_b_to_a")),
        columns=("both",),
        rows={"straight": (0.5,), "left door": (0.5,)},
        decimals=(2,),
        groups=("all",),
        measures=("success",),
    )
    chapter = study_chapters()[0]
    # The ways of a figure are driven on the table's own cases.
    figures = tuple(
        replace(each, paths=printed.cases[:1]) if each.paths else each for each in chapter.figures
    )
    chapter = replace(chapter, tables=(printed, printed_table("3.4")), figures=figures)
    for module in (printed_tables, study_document, study_command):
        monkeypatch.setattr(module, "study_chapters", lambda: (chapter,))
    quick = partial(StudyRun, algorithm="q-learning", preset="kit", episodes=4, steps=1000)
    monkeypatch.setattr(
        StudyRun, "of", lambda table, workspace, variant="seed", steps=None: quick(table, workspace)
    )
    first = study(tmp_path, "3.5", "--again", "--seeds", "2", "--jobs", "1")
    assert first.exit_code == 0, first.output
    assert "Up to 2 agents to train: about" in first.stderr
    assert first.stderr.count("all, seed") == 2
    assert "differs" in first.stdout
    second = study(tmp_path, "3.5", "--again", "--seeds", "2")
    assert "agents to train" not in second.stderr
    assert second.stdout == first.stdout


@pytest.mark.nightly
def test_a_run_that_was_killed_goes_on_where_it_was(tmp_path: Path) -> None:
    """The training of a figure: the verb and its worker are killed after the first checkpoint, then it is given again."""
    words = ["study", "figure", "3.5", "--again", "--steps", "90000", "--jobs", "1"]
    command = [sys.executable, "-m", "kit", *words, "--workspace", str(tmp_path)]
    with subprocess.Popen(command, start_new_session=True, stdout=subprocess.DEVNULL) as process:
        runs = tmp_path / "study" / "figure-3.5" / "seed-0" / "runs"
        wait_until(lambda: list(runs.glob("*/checkpoint.zip")) != [])
        os.killpg(process.pid, signal.SIGKILL)
    (run,) = map(TrainingRun, runs.glob("*"))
    assert run.summary().state != "finished"
    log = recorded_result_file(Workspace(tmp_path), "figure-3.5")
    assert not log.exists()
    assert study(tmp_path, "figure", "3.6", "--again").exit_code == 2  # it shows the training of figure 3.5
    result = study(tmp_path, *words[1:], "--svg", str(tmp_path / "svg"))
    assert result.exit_code == 0, result.output
    assert any("last checkpoint" in str(event) for event in run.events())
    found = read_recorded_result(log)
    assert found is not None
    (test,) = found.tests
    assert [each.steps for each in test.sessions][-1] == test.steps >= 90_000
    assert (found.settings.steps, found.settings.preset) == (90_000, "seed")
    assert "90,000 steps" in result.stdout
    assert "timed out" in (tmp_path / "svg" / "figure-3-5.svg").read_text()
    assert "90,000 steps" in study(tmp_path, "figure", "3.6").stdout


@pytest.mark.long
def test_the_evaluation_s_histograms_are_drawn_beside_its_list(tmp_path: Path) -> None:
    done = study(tmp_path / "none", "5", "--svg", str(tmp_path))
    assert done.exit_code == 0, done.output
    assert done.stdout == study(tmp_path / "none", "5").stdout
    made = {each.name for each in tmp_path.iterdir()}
    assert {"prior-bars.svg", "prior-histogram.svg", "gained-bars.svg", "quiz-histogram.svg"} <= made
    # Figures 5.6a, 5.7a and 5.7b: one histogram for each of the topics that were rated before.
    assert len([name for name in made if name.startswith("prior-q")]) >= 3
