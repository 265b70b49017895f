"""The dissertation's evaluation of its kit as a report: its tables beside ours, misprints, and what its numbers bear."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from kit.document.blocks import (
    Block,
    Caution,
    Cell,
    CellStyle,
    Chapter,
    Column,
    Document,
    Plot,
    Table,
    Text,
)
from kit.plain_text import join_with_and
from kit.school.quiz.answers import AnswerOutcome
from kit.school.report.chapters import people, quiz, relations
from kit.school.report.chapters.context import ReportContext
from kit.school.report.class_report import build_chapters
from kit.school.report.inference import summary_statistics
from kit.school.report.item_analysis import analyse_item
from kit.school.report.normality import shapiro_wilk
from kit.school.survey import QuestionPurpose
from kit.study.evaluation_data import EvaluationData
from kit.study.evaluation_tables import (
    PrintDifference,
    TableRows,
    differences_from_print,
    recompute_tables,
    score_order,
    setting_of,
    unexplained_differences,
)
from kit.study.printed_tables import PrintedTable

GROUP_LETTERS: Final = ("B", "E")
GROUP_TABLE: Final = "5.4"
COUNT_COLUMNS: Final = ("B n", "E n")
STACKED_COLUMNS: Final = 4
"""Columns from which print and ours stand one below the other."""


def evaluation_chapters(study: EvaluationData, *, with_class: bool = False) -> tuple[Chapter, ...]:
    """Where the print is wrong, and what its numbers bear.

    ``with_class``: also every chapter that a class gets, from the dissertation's raw answers (appendix B.3).
    """
    context = setting_of(study)
    more = build_chapters(context) if with_class else ()
    return (_misprint_chapter(study), _limits_chapter(study, context), *more)


def evaluation_table(study: EvaluationData, number: str) -> tuple[Block, ...]:
    """One printed table beside ours, and its slips. LookupError if the evaluation has no such table."""
    table = next((each for each in study.printed if each.id == number), None)
    if table is None:
        raise LookupError(f"The evaluation has no Table {number}.")
    ours = recompute_tables(study)[number]
    slips = (Text(f"Slip: {each.why}") for each in study.misprints if each.table == number)
    return (_comparison_table(table, ours, differences_from_print(study), setting_of(study)), *slips)


def evaluation_plots(study: EvaluationData) -> dict[str, Plot]:
    """The figures of a class's report from the dissertation's raw answers, by name."""
    return {each.id: each for each in Document("", build_chapters(setting_of(study))).plots}


def _comparison_table(
    table: PrintedTable, ours: TableRows, wrong: Sequence[PrintDifference], context: ReportContext
) -> Table:
    name = f"Table {table.id}" if table.id != "text" else "Text"
    identity = f"table-{table.id.replace('.', '-')}"
    title = f"{name}. {table.title}"
    letters = table.id == GROUP_TABLE
    found = {(each.row, each.column) for each in wrong if each.table == table.id}

    def cells(row: tuple[float, ...]) -> Iterator[Cell]:
        for value, column in zip(row, table.columns, strict=True):
            if letters and column != table.columns[0]:
                yield GROUP_LETTERS[int(value)]
            else:
                yield int(value) if column in COUNT_COLUMNS else value

    def verdict(row: str) -> str:
        slips = [column for column in table.columns if (row, column) in found]
        return f"differs: {', '.join(slips)}" if slips else "same"

    columns = tuple(
        Column(column, CellStyle.TEXT if letters and i else CellStyle.NUMBER)
        for i, column in enumerate(table.columns)
    )
    if len(columns) >= STACKED_COLUMNS and not letters:
        # One below the other: side by side they would not fit 80 columns.
        rows = [
            line
            for row, printed in table.rows.items()
            for line in (
                (row, "printed", *cells(printed), ""),
                (row, "ours", *cells(ours[row]), verdict(row)),
            )
        ]
        heads = (
            Column("", CellStyle.TEXT),
            Column("", CellStyle.TEXT),
            *columns,
            Column("", CellStyle.TEXT),
        )
        return Table(identity, title, heads, tuple(rows), grouped=True)
    bar = Column("|", CellStyle.TEXT)
    rows = [
        (row, *cells(printed), "|", *cells(ours[row]), verdict(row)) for row, printed in table.rows.items()
    ]
    note = "Left of the bar as printed, right of it ours."
    if letters:
        order = score_order(context)
        note += f" Users 1 to {len(order)} are the subjects {', '.join(str(i + 1) for i in order)}."
    heads = (
        Column("user" if letters else "", CellStyle.TEXT),
        *columns,
        bar,
        *columns,
        Column("", CellStyle.TEXT),
    )
    return Table(identity, title, heads, tuple(rows), note)


def _misprint_chapter(study: EvaluationData) -> Chapter:
    total = sum(len(row) for table in study.printed for row in table.rows.values())
    wrong, unknown = differences_from_print(study), unexplained_differences(study)
    blocks: list[Block] = [
        Text(
            f"{total - len(wrong)} of {total} printed entries are exact; {len(wrong)} differ, all in {_places_text(wrong)}."
        )
    ]
    rows: list[tuple[Cell, ...]] = []
    for slip in study.misprints:
        cells = [each for each in wrong if each.table == slip.table]
        rows += [(_place_name(each), each.row, each.column, each.printed, each.ours) for each in cells]
    blocks.append(
        Table(
            "slips",
            "Known slips",
            (
                Column("where", CellStyle.TEXT),
                Column("row", CellStyle.TEXT),
                Column("column", CellStyle.TEXT),
                Column("printed"),
                Column("ours"),
            ),
            tuple(rows),
        )
    )
    blocks += [
        Text(f"{'Table ' if slip.table != 'text' else ''}{slip.table}: {slip.why}")
        for slip in study.misprints
    ]
    blocks += [
        Caution(
            f"{_place_name(each)}, {each.row}, {each.column}: {each.printed} printed, {each.ours:.4f} ours, and not known."
        )
        for each in unknown
    ]
    two_keys = [
        each.item.id
        for each in (analyse_item(study.quiz, item) for item in study.quiz.items)
        if len(each.right_options) > 1
    ]
    if two_keys:
        blocks.append(
            Caution(f"{', '.join(two_keys)}: two answers counted as right, so the question is ambiguous.")
        )
    blocks.append(
        Text(
            "The degrees and the answers of yes or no (tables B.3 and B.4) are missing in the source: that eleven of "
            "twelve used the prepared machine, and that one had problems, cannot be checked."
        )
    )
    return Chapter("slips", "Where the print is wrong", tuple(blocks))


def _places_text(wrong: Sequence[PrintDifference]) -> str:
    names = ("the text" if each.table == "text" else f"table {each.table}" for each in wrong)
    return join_with_and(dict.fromkeys(names)) or "no table"


def _place_name(each: PrintDifference) -> str:
    return "text" if each.table == "text" else f"table {each.table}"


def _limits_chapter(study: EvaluationData, context: ReportContext) -> Chapter:
    """The limits of the dissertation's numbers that it does not state."""
    first = people.experience_chapter(context)
    weights = (
        [each for each in first.blocks if isinstance(each, Table) and each.id == "weights"] if first else []
    )
    cautions = [each for each in first.blocks if isinstance(each, Caution)] if first else []
    robust, together, questions = (
        relations.robustness_chapter(context),
        relations.relations_chapter(context),
        quiz.items_chapter(context),
    )
    blocks: list[Block] = [*weights, *cautions]
    if robust is not None:
        blocks += robust.blocks
    if together is not None:
        blocks += [each for each in together.blocks if isinstance(each, Table | Text)]
    if questions is not None:
        blocks += [each for each in questions.blocks if not isinstance(each, Caution)]
    blocks += [_normality_text(study), _blank_text(study), _layers_text(study)]
    return Chapter("bearing", "What these numbers bear", tuple(blocks))


def _normality_text(study: EvaluationData) -> Text:
    w, p = shapiro_wilk(study.quiz.scores)
    return Text(
        f"The dissertation takes the quiz scores for normally distributed. Shapiro and Wilk's W = {w:.2f}, "
        f"p = {p:.2f}: with {study.subjects} subjects that is not ruled out, and not shown. A standard normal "
        "distribution, which it names, has mean 0 and SD 1."
    )


def _blank_text(study: EvaluationData) -> Text:
    blanks = study.quiz.outcome_counts(AnswerOutcome.BLANK)
    most = int(np.argmax(blanks))
    return Text(
        f"{int(blanks.sum())} of {len(blanks) * len(study.quiz.items)} answers of the quiz are blank, "
        f"{int(blanks[most])} of them subject {most + 1}'s, and count as wrong."
    )


def _layers_text(study: EvaluationData) -> Text:
    question = next(each for each in study.ratings.questions if each.topic == "layers")
    phase = question.phases[0]
    stats = summary_statistics(study.ratings.values[phase, question.id])
    hardest = max(
        summary_statistics(each.values).mean
        for each in study.ratings.measures(QuestionPurpose.DIFFICULTY, phase)
    )
    more = f", more than any topic that is shown ({hardest:.1f} at most)" if stats.mean > hardest else ""
    return Text(
        f"The method for the fewest layers, which no table shows, was rated {stats.mean:.1f} of 7 hard{more}; n = {stats.n}."
    )
