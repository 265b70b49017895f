"""The dissertation's numbers from its raw answers: exact, but for the slips that are known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.document.blocks import Document, Table
from kit.school.quiz.answers import AnswerOutcome
from kit.school.report.chapters import relations
from kit.school.report.chapters.context import ReportContext
from kit.school.report.expertise import difference_sensitivity
from kit.school.report.inference import (
    correlation,
    correlation_test,
    difference_test,
    fit_polynomial,
    rank_correlation,
)
from kit.school.report.item_analysis import analyse_item, kr20
from kit.school.report.measures import ClassRatings
from kit.school.report.normality import shapiro_wilk
from kit.study.evaluation import evaluation_chapters, evaluation_table
from kit.study.evaluation_data import DATA_FILE, read_evaluation_data
from kit.study.evaluation_tables import (
    TableRows,
    differences_from_print,
    recompute_tables,
    score_order,
    setting_of,
    unexplained_differences,
)
from kit.world.problems import WorldError
from tests.cases import every_case

study = cache(read_evaluation_data)


@cache
def setting() -> ReportContext:
    return setting_of(study())


@cache
def ours() -> Mapping[str, TableRows]:
    return recompute_tables(study())


EXACT = ("5.4", "5.5", "5.7", "5.8", "5.9")
CELLS = {"5.4": 48, "5.5": 18, "5.6": 24, "5.7": 18, "5.8": 36, "5.9": 24, "text": 32}
SLIPS = {
    ("5.6", "beginners M", "4"): (4.00, 4.20),
    ("5.6", "beginners SD", "4"): (0.71, 0.84),
    ("5.6", "overall M", "4"): (4.58, 4.67),
    ("5.6", "overall SD", "4"): (1.16, 1.15),
    ("text", "gained, overall", "SD"): (1.24, 1.34),
    ("text", "difficulty, beginners", "SD"): (1.67, 1.57),
}


def test_every_printed_table_is_there_whole() -> None:
    assert {each.id: sum(map(len, each.rows.values())) for each in study().printed} == CELLS


@pytest.mark.parametrize("table", EXACT)
def test_these_tables_are_exact(table: str) -> None:
    printed = next(each for each in study().printed if each.id == table)
    computed = ours()[table]
    assert list(computed) == list(printed.rows)
    for row, numbers in printed.rows.items():
        assert [f"{value:.2f}" for value in computed[row]] == [f"{value:.2f}" for value in numbers], row


def test_the_others_differ_in_the_known_cells_and_nowhere_else() -> None:
    found = {
        (each.table, each.row, each.column): (each.printed, round(each.ours, 2))
        for each in differences_from_print(study())
    }
    assert found == SLIPS
    assert unexplained_differences(study()) == ()


def test_a_slip_that_nobody_knows_is_unexplained() -> None:
    assert len(unexplained_differences(replace(study(), misprints=study().misprints[:1]))) == 2


@pytest.mark.parametrize("subject", range(1, 13))
def test_one_cell_explains_table_5_6(subject: int) -> None:
    """With a 4 for a beginner's 5 all four numbers are as printed; only subjects 3 and 4 can be meant."""
    values = {
        key: np.where(np.arange(12) == subject - 1, 4.0, row) if key[1] == "q21" else row
        for key, row in study().ratings.values.items()
    }
    changed = replace(study(), ratings=ClassRatings(study().ratings.questions, values))
    left = [each for each in differences_from_print(changed) if each.table == "5.6"]
    assert (not left) == (subject in (3, 4))


def test_users_are_these_subjects() -> None:
    assert [i + 1 for i in score_order(setting())] == [1, 10, 8, 7, 12, 2, 6, 3, 5, 11, 4, 9]


def test_what_is_doubtful_about_the_divisions() -> None:
    found = {each.id: each.warnings for each in setting().divisions}
    assert found["mean"] == ()
    assert ["0.05 apart" in each for each in found["half"]] == [True]
    assert ["only 2 experts" in each for each in found["scale"]] == [True]


def test_quiz_totals_and_blanks() -> None:
    quiz = study().quiz
    assert (quiz.scores * 12).round().tolist() == [9, 5, 2, 6, 4, 7, 10, 7, 0, 10, 8, 9]
    blanks = quiz.outcome_counts(AnswerOutcome.BLANK)
    assert (blanks.sum(), blanks[8]) == (19, 10)
    assert kr20(quiz) == pytest.approx(0.81, abs=0.005)
    assert shapiro_wilk(quiz.scores)[1] == pytest.approx(0.33, abs=0.005)


@pytest.mark.parametrize(
    ("item", "chosen", "blank"),
    [
        ("Flatland Q1", {0: 1, 1: 3, 2: 6, 3: 1}, 1),
        ("RL Q2", {0: 4, 2: 1, 3: 5}, 2),
        ("RL Q1", {0: 5, 1: 5, 2: 1, 3: 1}, 0),
        ("ROS 2 Q3", {0: 4, 1: 1, 2: 3, 3: 3}, 1),
    ],
)
def test_who_fell_for_what(item: str, chosen: dict[int, int], blank: int) -> None:
    found = {each.item.id: each for each in (analyse_item(study().quiz, one) for one in study().quiz.items)}
    assert found[item].choice_counts == chosen
    assert found[item].outcomes[AnswerOutcome.BLANK] == blank
    assert found["Flatland Q1"].rest_correlation == pytest.approx(0.07, abs=0.005)
    assert [name for name, each in found.items() if len(each.right_options) > 1] == ["ROS 2 Q2"]


def test_the_headline_rests_on_subject_9() -> None:
    division = setting().division
    assert division is not None
    found = difference_sensitivity(study().quiz.scores, division, seed=0)
    assert found is not None
    assert found.value == pytest.approx(0.345, abs=0.0005)
    assert (found.test.arrangements, found.test.is_exact) == (792, True)
    assert found.test.p_value == pytest.approx(0.019, abs=0.0005)
    assert [each.student + 1 for each in found.decisive] == [9]
    assert found.decisive[0].value == pytest.approx(0.262, abs=0.0005)
    assert found.decisive[0].test.p_value == pytest.approx(0.064, abs=0.0005)


@every_case(
    ("a", "b", "r"),
    [
        ("score", "quiz", 0.60),
        ("explanation", "gained", 0.68),
        ("gained", "quiz", 0.07),
        ("difficulty", "quiz", -0.03),
        ("prior", "gained", 0.01),
    ],
)
def test_what_goes_together(a: str, b: str, r: float) -> None:
    known = relations.student_quantities(setting())
    assert correlation(known[a].values, known[b].values) == pytest.approx(r, abs=0.005)
    p = correlation_test(known[a].values, known[b].values, np.random.default_rng(0)).p_value
    assert (p < 0.05) == (abs(r) > 0.5)


def test_rank_correlation_and_the_parabola() -> None:
    known = relations.student_quantities(setting())
    assert rank_correlation(known["score"].values, known["quiz"].values) == pytest.approx(0.70, abs=0.005)
    curve = fit_polynomial(known["prior"].values, known["gained"].values, 2)
    assert curve is not None
    assert -curve[1] / (2 * curve[0]) == pytest.approx(3.2, abs=0.05)


def test_no_difference_of_outcomes_is_more_than_chance() -> None:
    division = setting().division
    assert division is not None
    experts, beginners = (each.members for each in division.groups[::-1])
    for number in (*range(18, 22), *range(34, 37)):
        values = next(row for (_, name), row in study().ratings.values.items() if name == f"q{number}")
        assert difference_test(values[experts], values[beginners], np.random.default_rng(0)).p_value > 0.3


@pytest.mark.long
def test_the_report_names_every_slip() -> None:
    report = Document("", evaluation_chapters(study()))
    slips = next(each for each in report.tables if each.id == "slips")
    assert len(slips.rows) == len(SLIPS)
    blocks = (block for number in CELLS for block in evaluation_table(study(), number))
    printed = [block for block in blocks if isinstance(block, Table)]
    said = [row[-1] for table in printed for row in table.rows if isinstance(row[-1], str)]
    assert sum(each.startswith("differs") for each in said) == len(SLIPS)


@pytest.mark.long
def test_the_verb_fits_eighty_columns_and_ascii() -> None:
    result = CliRunner().invoke(main, ["study", "5", "--whole", "--glyphs", "ascii"])
    assert result.exit_code == 0
    assert max(map(len, result.stdout.splitlines())) <= 79
    assert result.stdout.isascii()


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"5 3 3 1 4 5 3 4 1 4 1 4"', '"5 3 3 1 4 5 3 4 1 4 1"', "12 numbers from 1 to 7"),
        ('"5 3 3 1 4 5 3 4 1 4 1 4"', '"5 3 3 1 4 5 3 4 1 4 1 8"', "12 numbers from 1 to 7"),
        ("purpose: gained", "purpose: gaind", 'did you mean "gained"'),
        ("1 | 5.76 E E E", "1 | 5.76 E E", "4 numbers"),
        ("subjects: 12", "subject: 12", 'did you mean "subjects"'),
    ],
)
def test_a_mistake_in_the_data_is_told(tmp_path: Path, old: str, new: str, words: str) -> None:
    text = DATA_FILE.read_text()
    assert old in text
    file = tmp_path / "evaluation.yaml"
    file.write_text(text.replace(old, new, 1))
    with pytest.raises(WorldError) as caught:
        read_evaluation_data(file)
    assert words in str(caught.value)
