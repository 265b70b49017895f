"""A training in words: what fits where, what is called how."""

from __future__ import annotations

from dataclasses import replace

import pytest

from kit.learning.environment.episode_stats import EpisodeOutcome
from kit.learning.tasks.catalogue import TASKS
from kit.learning.training.events import Evaluated, TrainingEvent, TrainingProgress
from kit.learning.training.run_status import RECENT_REPORTS, RunPlan, RunStatus, RunTracker
from kit.tui.rows import training_rows
from kit.tui.rows.training_list_rows import no_trainings
from kit.tui.screens.training import TrainingScreen
from tests.cases import every_case
from tests.tui.lesson_stage import row_text

STATES = ("new", "running", "paused", "finished", "stopped", "interrupted", "failed")


def status(*events: TrainingEvent, cases: tuple[str, ...] = ("a", "b"), alive: bool = True) -> RunStatus:
    logbook = RunTracker(RunPlan("title", cases, 4_000_000, 0.9, True))
    for event in events:
        logbook.add(event)
    return logbook.status(alive=alive, order="go")


def full(cases: tuple[str, ...], terms: int) -> RunStatus:
    """As much of everything as there can be."""
    batch = TrainingProgress(
        *(1_234_567, 4000.0, 123_456.0, {case: [7, 2, 1] for case in cases}, -1234.5, 200.0),
        {f"turning_with_room{number}": -1234.56 for number in range(terms)},
        0.5,
    )
    later = replace(batch, steps=1_300_000, seconds=5000.0)
    return status(batch, Evaluated(1, 1.0, {case: [95, 3, 2] for case in cases}, True), later, cases=cases)


def test_outcomes_are_called_as_in_the_learning_side() -> None:
    assert [part.name for part in training_rows.OUTCOMES] == [outcome.value for outcome in EpisodeOutcome]
    assert all(part.glyph.isascii() for part in training_rows.ASCII_OUTCOMES)


@every_case("task", TASKS, ids=lambda task: task.name)
@every_case(("width", "height"), [(39, 9), (36, 9), (46, 45), (20, 9), (1, 1)])
def test_every_case_and_every_term_is_on_some_page(task: object, width: int, height: int) -> None:
    cases = tuple(case.name for _, case in task.map_cases())  # type: ignore[attr-defined]  # a Task
    pages = training_rows.pages(full(cases, 17), width, height)
    if width >= 36:
        assert all(len(row_text(row).rstrip()) <= width for page in pages for row in page)
        assert all(len(page) <= height for page in pages)
        shown = "\n".join(row_text(row) for page in pages for row in page)
        assert all(name in shown for name in training_rows.short_names(cases))
        assert shown.count("-1234.56") == 17
        assert shown.count(" 95") >= len(cases)


def test_with_much_room_all_is_on_one_page() -> None:
    assert len(training_rows.pages(full(tuple("abcdefghijklmno"), 17), 46, 45)) == 1


def test_a_case_with_a_short_name_leaves_the_heading_whole() -> None:
    batch = TrainingProgress(10, 1.0, 10.0, {"a": [5, 3, 2]}, 0.0, 1.0, {})
    title, *cases = (row_text(row) for row in training_rows.pages(status(batch, cases=("a",)), 34, 9)[0])
    assert title.split() == ["case", "recent", "train", "test"]
    assert title.index("train") + len("train") == cases[0].index("50") + len("50")


def test_one_robot_has_no_curve_of_two_side_by_side() -> None:
    alone = TrainingProgress(10, 1.0, 10.0, {"a": [5, 3, 2]}, 0.0, 1.0, {}, 0.0)
    assert training_rows.curve_kinds(status(alone)) == ("success", "reward")
    assert len(training_rows.curve_kinds(status(replace(alone, adjacency=0.4)))) == 3


def test_bars_show_what_the_counts_say() -> None:
    batch = TrainingProgress(10, 1.0, 10.0, {"a": [5, 3, 2]}, 0.0, 1.0, {})
    rows = [row_text(row) for row in training_rows.pages(status(batch), 37, 9)[0]]
    assert "█" * 10 + "▒" * 6 + "░" * 4 in rows[1]
    assert rows[1].split()[-2:] == ["50", "-"]
    assert rows[2].split() == ["b", "-", "-"]


def test_a_hundred_means_all() -> None:
    assert "99 " in row_text(
        training_rows.pages(status(Evaluated(1, 1.0, {"a": [999, 1, 0]}, True)), 39, 9)[0][1]
    )


def test_short_names_drop_the_words_that_all_begin_with() -> None:
    assert training_rows.short_names(["turn_a_to_b", "turn_b_to_a"]) == ["a_to_b", "b_to_a"]
    assert training_rows.short_names(["turn", "turn_left"]) == ["turn", "turn_left"]
    assert training_rows.short_names(["straight"]) == ["straight"]
    assert training_rows.short_names([]) == []


@pytest.mark.parametrize(("seconds", "told"), [(0.9, "0:00"), (62, "1:02"), (3600 * 3 + 10, "3:00:10")])
def test_clock(seconds: float, told: str) -> None:
    assert training_rows.clock(seconds) == told


def test_the_lines_fit_into_eighty_columns() -> None:
    found = full(("a",), 1)
    for part in (training_rows.heading("x" * 90, found, 80), training_rows.note("x" * 90, found, 80)):
        assert len(row_text(part)) <= 80
    figures = row_text(training_rows.figures(found, 80))
    assert len(figures) <= 80
    assert "1,300,000 of 4,000,000 steps   123,456 steps/s" in figures
    assert "reward -1234.50" in row_text(training_rows.figures(found, 200))
    for state in STATES:
        assert len(row_text(training_rows.keys(TrainingScreen.screen_actions, state, 80)).rstrip()) <= 80
        assert "mine" in training_rows.farewell("mine", state)


def test_a_note_that_is_too_long_ends_with_a_whole_part() -> None:
    found = replace(
        full(("a",), 1),
        note="TEST mean 0.971, worst 0.948 (turn_b_to_a), kept; largest value 1.8, mean value 0.7",
    )
    assert (
        row_text(training_rows.note("mine", found, 80))
        == "TEST mean 0.971, worst 0.948 (turn_b_to_a), kept; largest value 1.8"
    )
    assert (
        row_text(training_rows.note("mine", found, 60)) == "TEST mean 0.971, worst 0.948 (turn_b_to_a), kept"
    )


def test_each_task_to_begin_with_can_be_chosen_where_they_are_cut() -> None:
    whole = [row_text(each) for each in no_trainings(TASKS, 0, 80, 100)]
    assert all(any(task.name in line for line in whole) for task in TASKS)
    for number, task in enumerate(TASKS):
        cut = [row_text(each) for each in no_trainings(TASKS, number, 80, 8)]
        assert len(cut) <= 8
        assert any(line.startswith(">") and task.name in line for line in cut)


def test_two_windows_of_averaging_have_two_names() -> None:
    found = full(("a",), 2)
    present = row_text(training_rows.figures(found, 200))
    assert f"last {RECENT_REPORTS} batches" in present
    assert [curve.name for curve in training_rows.curves(found, "reward", 80)] == [
        "reward in training, by batch"
    ]


def test_every_metric_has_a_curve_of_its_own() -> None:
    found = full(("a",), 2)
    assert training_rows.curve_kinds(found) == (
        *("success", "reward", "side by side"),
        "turning_with_room0",
        "turning_with_room1",
    )
    (curve,) = training_rows.curves(found, "side by side", 80)
    assert curve.y.tolist() == [0.5, 0.5]
    assert len(curve.x) == 2


def test_what_can_be_done_is_said_where_nobody_trains() -> None:
    batch = TrainingProgress(10, 1.0, 10.0, {"a": [5, 3, 2]}, 0.0, 1.0, {})
    found = status(batch, alive=False)
    assert "p continues" in row_text(training_rows.note("mine", found, 80))
    assert "interrupted" in row_text(training_rows.heading("mine", found, 80))


def test_curves_for_little_and_for_much_room() -> None:
    found = full(("a", "b"), 1)
    assert len(training_rows.curves(found, "success", 41)) == 2
    assert len(training_rows.curves(found, "success", 80)) == 3
    assert training_rows.axes(found, "success").goal == 0.9
    assert training_rows.axes(found, "reward").goal is None
    assert training_rows.curves(found, "reward", 80)[0].y.tolist() == [-1234.5, -1234.5]


def test_values_that_rewards_cannot_pay_are_told_at_once() -> None:
    measures = {"value_max": 57_123_456.0, "value_mean": 3.0, "value_payable": 1390.0}
    batch = TrainingProgress(10, 1.0, 10.0, {"a": [5, 3, 2]}, 0.0, 1.0, {}, measures=measures)
    shown = row_text(training_rows.figures(status(batch), 80))
    assert "57,123,456" in shown
    assert "1,390" in shown
    calm = replace(batch, measures={**measures, "value_max": 747.0})
    shown = row_text(training_rows.figures(status(calm), 80))
    assert "largest value 747" in shown
    assert "1,390" not in shown
    panel = "\n".join(row_text(each) for page in training_rows.pages(status(calm), 39, 20) for each in page)
    assert "most that rewards pay" in panel
    assert "largest value" in training_rows.curve_kinds(status(calm))
