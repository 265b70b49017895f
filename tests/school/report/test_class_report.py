"""A class's report: made of whatever a class has, legible at 80 columns, safe to open."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from kit.document.blocks import (
    BarChart,
    Caution,
    Chapter,
    Column,
    Document,
    Histogram,
    Quote,
    ScatterPlot,
    Table,
)
from kit.document.data_files import document_to_json, table_to_csv
from kit.document.glyphs import ASCII_GLYPHS, BLOCK_GLYPHS
from kit.document.html import document_to_html
from kit.document.layout import document_lines, lines_of
from kit.document.svg import plot_to_svg
from kit.document.tables import MAX_CELL_LENGTH
from kit.school.progress import EventKind
from kit.school.quiz.answers import BLANK, NOT_SURE, AnswerChoice, AnswerOccasion
from kit.school.report.class_data import ClassData, build_class_data, read_roster
from kit.school.report.class_report import CHAPTER_IDS, build_report, prepare_report
from kit.school.report.measures import ReportItem
from tests.school.report.class_builder import Diary, classroom, diaries, the_bank, the_form


def known() -> Mapping[str, ReportItem]:
    return {
        each.id: ReportItem(each.id, each.topic.value, tuple(o.text for o in each.options), bool(each.idea))
        for each in the_bank().items
    }


def data_of(folder: Path, made: Sequence[Diary]) -> ClassData:
    for diary in made:
        diary.export(folder)
    return build_class_data(read_roster([folder], use_names=True), the_form(), known())


def report_of(folder: Path, made: Sequence[Diary]) -> Document:
    return build_report(prepare_report(data_of(folder, made)), len(made))


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Document:
    folder = tmp_path_factory.mktemp("class")
    classroom(folder)
    roster = read_roster([folder], use_names=True)
    return build_report(prepare_report(build_class_data(roster, the_form(), known())), roster.file_count)


def table(report: Document, identity: str) -> Table:
    return next(each for each in report.tables if each.id == identity)


@pytest.mark.long
def test_a_whole_class_has_every_chapter(report: Document) -> None:
    assert tuple(each.id for each in report.chapters) == CHAPTER_IDS
    assert len({each.id for each in (*report.tables, *report.plots)}) == len(report.tables) + len(
        report.plots
    )


@pytest.mark.long_cases("blocks")
@pytest.mark.parametrize("glyphs", [BLOCK_GLYPHS, ASCII_GLYPHS], ids=["blocks", "ascii"])
def test_it_fits_eighty_columns(report: Document, glyphs: Any) -> None:
    rows = list(document_lines(report, glyphs))
    assert max(map(len, rows)) <= 79
    assert all(row == row.rstrip() for row in rows)
    assert glyphs is BLOCK_GLYPHS or "\n".join(rows).isascii()


def test_every_mean_has_its_n_and_interval(report: Document) -> None:
    means = [each for each in report.tables if "M" in {column.title for column in each.columns}]
    assert len(means) >= 8
    for each in means:
        titles = [column.title for column in each.columns]
        assert {"n", "SD", "95% of M"} <= set(titles), each.id
        if "group" in titles:
            assert titles[-1] == "p"


@pytest.mark.long
def test_the_same_class_makes_the_same_report(report: Document, tmp_path: Path) -> None:
    assert document_to_json(report_of(tmp_path, list(diaries(12)))) == document_to_json(report)


def nothing_but(*kinds: EventKind, count: int = 3) -> list[Diary]:
    made = list(diaries(count))
    for diary in made:
        diary.events = [event for event in diary.events if event.kind in (*kinds, EventKind.ABOUT)]
    return made


@pytest.mark.parametrize("count", [1, 2, 3])
def test_small_classes_are_reported(tmp_path: Path, count: int) -> None:
    rows = list(document_lines(report_of(tmp_path, list(diaries(count)))))
    assert max(map(len, rows)) <= 79
    assert not any("nan" in row.split() for row in rows)


@pytest.mark.parametrize(
    ("kinds", "there", "missing"),
    [
        ((EventKind.FORM,), "outcomes", "quiz"),
        ((EventKind.ANSWER,), "quiz", "outcomes"),
        ((EventKind.STEP, EventKind.ATTEMPT), "lessons", "quiz"),
        ((), "class", "lessons"),
    ],
    ids=["form-only", "quiz-only", "lessons-only", "names-only"],
)
def test_a_class_that_did_only_a_part(
    tmp_path: Path, kinds: tuple[EventKind, ...], there: str, missing: str
) -> None:
    report = report_of(tmp_path, nothing_but(*kinds))
    chapters = {each.id for each in report.chapters}
    assert there in chapters
    assert missing not in chapters
    assert list(document_lines(report))
    assert json.loads(document_to_json(report))
    assert document_to_html(report)


def test_a_class_of_which_all_say_the_same(tmp_path: Path) -> None:
    made = []
    for name in ("Ada", "Ben", "Cleo", "Dan"):
        diary = Diary(name)
        for question in the_form().questions:
            for phase in question.phases:
                diary.rate(question.id, 4, phase)
        for item in the_bank().quiz_items:
            diary.answer(item, AnswerChoice(item.right_option))
        made.append(diary)
    report = report_of(tmp_path, made)
    assert any("one group empty" in each.text for each in report_warnings(report))
    assert any("a tie" in each.text for each in report_warnings(report))
    assert not any(
        np.isnan(each)
        for row in table(report, "quiz-topics").rows
        for each in row[2:4]
        if isinstance(each, float)
    )
    json.loads(document_to_json(report))


def report_warnings(report: Document) -> list[Caution]:
    return [each for chapter in report.chapters for each in chapter.blocks if isinstance(each, Caution)]


def test_blank_not_sure_and_wrong_stay_apart(tmp_path: Path) -> None:
    first, *others = the_bank().quiz_items[:4]
    ada = Diary("Ada")
    ada.answer(first, AnswerChoice(first.right_option))
    ada.answer(others[0], AnswerChoice((others[0].right_option + 1) % 3))
    ada.answer(others[1], NOT_SURE)
    ada.answer(others[2], BLANK)
    ben = Diary("Ben")
    ben.answer(first, AnswerChoice(first.right_option))
    row = table(report_of(tmp_path, [ada, ben]), "quiz-outcomes").rows[-1]
    assert row == ("overall", 2, 2, 1, 1, 4, 8), "what Ben did not reach is blank"


def test_who_did_not_take_the_quiz_is_not_in_it(tmp_path: Path) -> None:
    item = the_bank().quiz_items[0]
    ada, ben = Diary("Ada"), Diary("Ben")
    ada.answer(item, AnswerChoice(item.right_option))
    ben.answer(item, AnswerChoice(item.right_option), AnswerOccasion.LESSON)
    data = data_of(tmp_path, [ada, ben])
    assert [each is None for each in data.quiz.replies[item.id]] == [False, True]


def test_only_the_first_answer_counts_and_later_ones_are_the_gain(tmp_path: Path) -> None:
    item = the_bank().quiz_items[0]
    wrong = AnswerChoice((item.right_option + 1) % 3)
    made = []
    for name in ("Ada", "Ben", "Cleo"):
        diary = Diary(name)
        diary.answer(item, AnswerChoice(item.right_option), AnswerOccasion.LESSON)
        diary.answer(item, wrong)
        diary.answer(item, wrong, AnswerOccasion.SPACED)
        diary.answer(item, AnswerChoice(item.right_option), AnswerOccasion.SPACED)
        made.append(diary)
    report = report_of(tmp_path, made)
    assert table(report, "quiz-gain").rows[-1][:5] == ("Total", 3, 0.0, 1.0, 1.0)
    assert table(report, "items").rows[0][3] == 0.0


def test_questions_of_another_kit_are_left_out_with_a_warning(tmp_path: Path) -> None:
    made = list(diaries(2))
    made[0].note(
        EventKind.ANSWER, "of-another-kit", {"chosen": 1, "occasion": "quiz", "right": True, "topic": "x"}
    )
    data = data_of(tmp_path, made)
    assert "of-another-kit" not in data.quiz.replies
    assert any("not in this kit" in each for each in data.warnings)


WICKED = "<script>alert(1)</script>&\"'\x1b[31m\x07=1+1"


def test_nothing_a_student_wrote_does_anything(tmp_path: Path) -> None:
    diary = Diary("x")
    diary.note(EventKind.ABOUT, "name", {"value": "=cmd|' /C calc'!A0" + WICKED})
    diary.rate("other_words", WICKED)
    diary.note(EventKind.ATTEMPT, WICKED, {"verdict": "fail", "points": 1, "max_points": 2, "lost": [WICKED]})
    for content in (
        {"chosen": [1], "confidence": [2], "occasion": ["quiz"]},
        {"chosen": 1, "confidence": {}, "occasion": "quiz"},
    ):
        diary.note(EventKind.ANSWER, the_bank().quiz_items[0].id, content)
    report = report_of(tmp_path, [diary])
    text = "\n".join(document_lines(report))
    page = document_to_html(report)
    assert "\x1b" not in text + page
    assert "<script" not in page
    assert "&lt;script&gt;" in page
    for each in report.tables:
        for row in csv.reader(io.StringIO(table_to_csv(each))):
            assert not any(cell.startswith(("=", "@", "+")) for cell in row)
    said = [each for chapter in report.chapters for each in chapter.blocks if isinstance(each, Quote)]
    assert [each.text for each in said] == [WICKED]


def test_a_page_needs_nothing_from_elsewhere(report: Document) -> None:
    page = document_to_html(report)
    assert "http://www.w3.org/2000/svg" in page
    loaders = ("<script", "<link", "<img", "src=", "@import", "url(")
    assert [each for each in loaders if each in page] == []
    assert "default-src 'none'" in page


def test_every_plot_is_a_picture_with_what_it_shows(report: Document) -> None:
    for plot in report.plots:
        root = ElementTree.fromstring(plot_to_svg(plot))
        tags = [element.tag.rpartition("}")[2] for element in root.iter()]
        match plot:
            case BarChart():
                wanted = sum(value == value for _, values in plot.rows for value in values) + len(plot.groups)
                assert tags.count("rect") == wanted + 1
            case Histogram():
                assert tags.count("rect") == len(plot.counts) + 1
            case ScatterPlot():
                assert tags.count("circle") == len(set(plot.points))


def test_tables_as_csv_hold_the_numbers_in_full(report: Document) -> None:
    rows = list(csv.reader(io.StringIO(table_to_csv(table(report, "gained")))))
    assert rows[0] == ["", "group", "n", "M", "SD", "95% of M low", "95% of M high", "p"]
    assert all(len(row) == len(rows[0]) and row[0] for row in rows[1:])
    overall = next(row for row in rows if row[1] == "overall")
    assert float(overall[5]) < float(overall[3]) < float(overall[6])


def test_a_bar_is_as_long_as_its_value() -> None:
    bars = BarChart(
        "b", "Bars", ("one",), (("full", (7.0,)), ("none", (1.0,)), ("gone", (float("nan"),))), 1, 7
    )
    lines = list(document_lines(Document("r", (Chapter("c", "C", (bars,)),)), ASCII_GLYPHS))
    assert [line.count("#") for line in lines if "|" in line] == [40, 0, 0]
    assert "nobody" in lines[-1]


def test_a_point_lies_where_it_belongs() -> None:
    scatter = ScatterPlot("s", "S", "x", "y", ((1, 0), (7, 1), (7, 1)), (1, 7), (0, 1), (1 / 6, -1 / 6))
    lines = list(document_lines(Document("r", (Chapter("c", "C", (scatter,)),)), ASCII_GLYPHS))
    field = [line.partition("|")[2] for line in lines if "|" in line]
    assert field[-1][0] == "o"
    assert field[0][55] == "2"
    assert field[len(field) // 2][27] == "."


@pytest.mark.parametrize("name", ["=1+1", "\uff1d1+1", "|x", "x;=1+1", "a\x1b[2J"])
def test_no_name_is_a_formula_or_a_command_in_a_table(name: str) -> None:
    made = Table("t", "T", (Column("name"),), ((name,),))
    line = table_to_csv(made).splitlines()[1]
    assert line.startswith('"')
    assert line.endswith('"')
    assert not line[1:].startswith(("=", "\uff1d", "|"))
    assert line.isprintable()


def test_a_long_cell_is_cut_at_its_limit_and_says_so() -> None:
    def shown(length: int) -> str:
        lines = lines_of([Table("t", "T", (Column("name"),), (("x" * length,),))])
        return "".join(lines[3:])  # below its title, head and line

    assert shown(MAX_CELL_LENGTH) == "x" * MAX_CELL_LENGTH
    assert shown(MAX_CELL_LENGTH + 1) == "x" * (MAX_CELL_LENGTH - 3) + "..."
