"""The printed tables of chapters 3 to 5: whole, and consistent with themselves but for the slips that are named."""

from __future__ import annotations

import math
from pathlib import Path
from statistics import fmean, pstdev

import click
import pytest
from gymnasium.spaces import Discrete

from kit.cli import main
from kit.learning.tasks.actions import DiscreteActions
from kit.learning.tasks.catalogue import find_task, task_names
from kit.learning.training.crosstable import CrosstableColumn
from kit.study.evaluation import evaluation_plots
from kit.study.evaluation_data import read_evaluation_data
from kit.study.pairs import TABLE_46, TABLE_53
from kit.study.printed_tables import (
    ADJACENCY,
    CHAPTER_FILES,
    SUCCESS,
    PrintedTable,
    printed_means,
    printed_table,
    read_study_chapter,
    study_chapters,
)
from kit.world.catalogue import find_map
from kit.world.problems import WorldError

CELLS = {"3.3": 16, "3.4": 10, "3.5": 85, "4.1": 3, "4.2": 3, "4.3": 8, "4.4": 3, "4.5": 6, "4.6": 54}
CELLS |= {"5.2": 6, "5.3": 4}
FIGURES = {3: range(5, 10), 4: range(9, 16), 5: range(6, 20)}
TABLES = [table for chapter in study_chapters() for table in chapter.tables]


def test_every_table_and_figure_is_there_whole() -> None:
    assert {each.id: len(each.rows) * len(each.columns) for each in TABLES} == CELLS
    for chapter in study_chapters():
        assert [each.id for each in chapter.figures if each.sessions != "values"] == [
            f"{chapter.number}.{number}" for number in FIGURES[chapter.number]
        ]


def test_table_3_5_gives_its_own_means_and_deviations_but_for_the_named_slip() -> None:
    table = printed_table("3.5")
    slips = {
        (cell.row, cell.column): cell.ours for each in study_chapters()[0].misprints for cell in each.cells
    }
    for column, group in zip(table.columns, table.groups, strict=True):
        cells = table.case_cells(column)
        assert len(cells) == 15
        ours = CrosstableColumn(group, 0, 0.0, cells)
        for row, value in (("mean", ours.mean), ("SD", ours.spread)):
            assert round(value, 3) == slips.pop((row, column), table.cell(row, column))
    assert slips == {}


def test_table_3_3_gives_its_own_means() -> None:
    table = printed_table("3.3")
    for column, decimals in zip(table.columns, table.decimals, strict=True):
        attempts = [table.cell(f"attempt {number}", column) for number in (1, 2, 3)]
        assert round(fmean(attempts), decimals) == table.cell("mean", column)


def test_what_the_slips_say_of_the_cells_is_so() -> None:
    rooms, pairs = printed_table("3.5"), printed_table("4.6")
    cells = [number for column in rooms.columns for number in rooms.case_cells(column).values()]
    assert (sum(each < 0.5 for each in cells), len(cells)) == (14, 75)
    assert pstdev(rooms.case_cells("180 turns").values()) == pytest.approx(0.285, abs=0.0005)
    turns = pairs.case_cells("90 acc")
    assert sorted(each for each in turns.values() if each > 0.5) == [0.68, 0.79, 0.96]
    assert round(fmean(turns.values()), 3) == 0.443


def test_the_same_number_printed_twice_is_the_same() -> None:
    rooms, attempts, turns = printed_table("3.4"), printed_table("3.3"), printed_table("4.5")
    assert rooms.rows["all"] == attempts.rows["attempt 1"][2:]
    assert turns.rows["straight"] == printed_table("4.4").rows["straight"]
    pairs = {each.case: (each.accuracy, each.adjacency) for each in TABLE_46}
    assert [(each.accuracy, each.adjacency) for each in TABLE_53] == [
        pairs["pair_turn_right_90"],
        pairs["pair_turn_left_90"],
    ]


@pytest.mark.parametrize("table", [pytest.param(each, id=each.id) for each in TABLES if each.cases])
def test_cases_and_groups_are_the_kit_s(table: PrintedTable) -> None:
    for place, case in table.cases:
        assert case in [each.name for each in find_map(place).cases]
    for name in table.tasks:
        cases = {case.name: case.group for _, case in find_task(name).map_cases()}
        assert set(cases) == {case for _, case in table.cases}
        assert set(table.trained_groups) <= {"all", *cases, *cases.values()}


def test_an_empty_cell_is_no_number() -> None:
    table = printed_table("4.6")
    assert math.isnan(table.cell("curve left 90", "APF acc"))
    assert len(table.case_cells("APF acc")) == 5
    assert table.column_of("90_turns", ADJACENCY) == "90 adj"
    assert table.column_of("doors", SUCCESS) is None


def test_means_belong_to_their_task() -> None:
    assert printed_means("hallway")[1] == {
        "doors": 0.797,
        "obstacles": 0.674,
        "90_turns": 0.711,
        "180_turns": 0.711,
        "all": 0.825,
    }
    assert printed_means("wheelchairs-seed") == ("4.6", {"90_turns": 0.443, "pair_straight": 0.111})
    assert printed_means("turn") == printed_means("wheelchairs-seed-49") == ("", {})


@pytest.mark.parametrize(
    ("table", "actions", "gap", "radius"),
    [("4.1", 49, None, 0.25), ("4.2", 49, 0.4, 0.4), ("4.4", 16, 0.4, 0.4)],
)
def test_the_wheelchairs_of_a_training_are_those_of_its_table(
    table: str, actions: int, gap: float | None, radius: float
) -> None:
    task = find_task(printed_table(printed_table(table).results_of or table).repeat_task)
    assert isinstance(task.actions, DiscreteActions)
    assert task.actions.space(2) == Discrete(actions)
    assert (task.start.gap, task.target_radius) == (gap, radius)  # without a gap the map's stands: 0.3 m


def test_every_command_that_is_named_can_be_given() -> None:
    items = [*TABLES, *(figure for chapter in study_chapters() for figure in chapter.figures)]
    named = {each.run for each in items if each.run}
    assert len(named) >= 6
    for line in named:
        program, verb, *words = line.split()
        assert program == "kit"
        command = main.get_command(click.Context(main), verb)
        assert command is not None
        command.make_context(verb, [*words])  # raises where an option or a value is wrong
        if verb in ("train", "sweep"):
            assert words[0] in task_names()


@pytest.mark.long
def test_figures_of_the_evaluation_name_plots_that_are_there() -> None:
    plots = evaluation_plots(read_evaluation_data())
    named = [plot for each in study_chapters()[2].figures for plot in each.plots]
    assert named
    assert set(named) <= set(plots)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("0.99 0.94 0.96 0.88 1.0", "0.99 0.94 0.96 0.88", "5 numbers"),
        ("0.99 0.94 0.96 0.88 1.0", "0.99 0.94 0.96 0.88 nan", "5 numbers"),
        ('"left door |', '"straight |', "two rows"),
        ("hall_straight/straight", "hall_straight", "MAP/CASE"),
        ("    groups: [doors,", "    groups: [", "one entry for each of 5"),
        ("    groups: [target, target, all, all]\n", "", '"repeat_task" and "kit_task" need'),
        ("measures: [steps, success]", "measures: [steps, accuracy]", '"measures" must hold'),
        ("column: 180 turns", "column: 180", "no cell"),
        ("title: Accuracy of", "titel: Accuracy of", 'did you mean "title"'),
        ('table: "3.5"', 'table: "3.6"', '"3.6"'),
    ],
)
def test_a_mistake_in_the_data_is_told(tmp_path: Path, old: str, new: str, words: str) -> None:
    text = CHAPTER_FILES[0].read_text()
    assert old in text
    file = tmp_path / "chapter.yaml"
    file.write_text(text.replace(old, new, 1))
    with pytest.raises(WorldError) as caught:
        read_study_chapter(file)
    assert words in str(caught.value)
