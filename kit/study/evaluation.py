"""The dissertation's evaluation of its kit: its raw answers and printed tables as records, what they come to, and the report."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Final

import numpy as np

from kit.arrays import FloatArray
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
from kit.plain_text import join_with_and, quoted
from kit.school.quiz.answers import AnswerOutcome
from kit.school.report.chapters import people, quiz, relations
from kit.school.report.chapters.context import ReportContext
from kit.school.report.class_data import ClassData
from kit.school.report.class_report import build_chapters, prepare_report
from kit.school.report.expertise import DIVISION_METHODS
from kit.school.report.inference import shapiro_wilk, summary_statistics
from kit.school.report.measures import (
    BLANK,
    AnswerSheet,
    ClassRatings,
    ItemReply,
    ReportItem,
    StudentMeasure,
    analyse_item,
)
from kit.school.survey import SCALE_MAX, SCALE_MIN, QuestionPurpose, SurveyPhase, SurveyQuestion
from kit.study.printed_tables import Misprint, PrintedTable, read_misprint, read_printed_table
from kit.world.documents import open_document
from kit.world.yaml_section import Section

DATA_FILE: Final = Path(__file__).with_name("evaluation.yaml")

BLANK_ANSWER: Final = "-"

_TOPIC_TITLES: Final[Mapping[str, str]] = {"ros2": "ROS 2", "flatland": "Flatland", "rl": "RL"}
_PURPOSES: Final = {each.value: each for each in QuestionPurpose}


@dataclass(frozen=True, slots=True, eq=False)
class EvaluationData:
    """All that is known of the evaluation."""

    subjects: int
    ratings: ClassRatings
    quiz: AnswerSheet
    printed: tuple[PrintedTable, ...]
    misprints: tuple[Misprint, ...]


def read_evaluation_data(file: Path = DATA_FILE) -> EvaluationData:
    """Raises WorldError with all mistakes of the file."""
    with open_document(file) as section:
        subjects = section.integer("subjects", minimum=2)
        printed = tuple(read_printed_table(each) for each in section.sections("printed"))
        return EvaluationData(
            subjects,
            _read_ratings(section.sections("ratings", at_least=1), subjects),
            _read_quiz(section.sections("quiz", at_least=1), subjects),
            printed,
            tuple(read_misprint(each, printed) for each in section.sections("slips")),
        )


def _read_ratings(sections: tuple[Section, ...], subjects: int) -> ClassRatings:
    questions: list[SurveyQuestion] = []
    values: dict[tuple[SurveyPhase, str], FloatArray] = {}
    for section in sections:
        purpose = section.choice("purpose", _PURPOSES) or QuestionPurpose.WORDS
        if not section.flag("counted", True):
            purpose = QuestionPurpose.BACKGROUND
        phase = SurveyPhase.BEFORE if purpose is QuestionPurpose.EXPERIENCE else SurveyPhase.AFTER
        made = SurveyQuestion(
            f"q{section.integer('n', minimum=1)}",
            section.name("text"),
            purpose,
            topic=section.name("topic"),
            phases=(phase,),
        )
        questions.append(made)
        answers = _read_answers(section, subjects, SCALE_MAX)
        values[phase, made.id] = np.array([np.nan if each is None else float(each) for each in answers])
        section.finish()
    return ClassRatings(tuple(questions), values)


def _read_quiz(sections: tuple[Section, ...], subjects: int) -> AnswerSheet:
    items: list[ReportItem] = []
    replies: dict[str, tuple[ItemReply | None, ...]] = {}
    for section in sections:
        topic = section.name("topic")
        item = ReportItem(f"{_TOPIC_TITLES.get(topic, topic)} {section.name('question')}", topic)
        keys = {int(word) for word in section.name("keys").split() if word.isdigit()}
        items.append(item)
        replies[item.id] = tuple(
            BLANK
            if each is None
            else ItemReply(AnswerOutcome.RIGHT if each in keys else AnswerOutcome.WRONG, each - 1)
            for each in _read_answers(section, subjects, 4)
        )
        section.finish()
    return AnswerSheet(tuple(items), replies)


def _read_answers(section: Section, subjects: int, highest: int) -> list[int | None]:
    """One for each subject; None for a blank."""
    words = section.name("answers").split()
    right = [word == BLANK_ANSWER or (word.isdigit() and SCALE_MIN <= int(word) <= highest) for word in words]
    if len(words) != subjects or not all(right):
        section.error(
            f'"answers" must be {subjects} numbers from {SCALE_MIN} to {highest}, or {quoted(BLANK_ANSWER)}',
            "answers",
        )
        return [None] * subjects
    return [None if word == BLANK_ANSWER else int(word) for word in words]


TableRows = dict[str, tuple[float, ...]]
"""The numbers of a table by the labels of its rows."""

ROUNDING_TOLERANCE: Final = 0.005 + 1e-9
"""A number printed with two decimals lies no farther from what was computed."""


@dataclass(frozen=True, slots=True)
class PrintDifference:
    """A printed number that the raw answers do not give."""

    table: str
    row: str
    column: str
    printed: float
    ours: float


def setting_of(study: EvaluationData) -> ReportContext:
    """The dissertation's subjects as a class, divided at the mean score."""
    names = tuple(f"subject {number}" for number in range(1, study.subjects + 1))
    data = ClassData(
        names,
        study.ratings,
        study.quiz,
        later_quiz=study.quiz.without_replies(),
        bank=AnswerSheet((), {}),
        work=tuple({} for _ in names),
        free_text_answers=(),
        option_counts=(),
        warnings=(),
    )
    return prepare_report(data)


@lru_cache(maxsize=1)
def recompute_tables(study: EvaluationData) -> Mapping[str, TableRows]:
    """Every printed table from the raw answers, by its number."""
    context = setting_of(study)
    return {printed.id: _TABLES[printed.id](context) for printed in study.printed}


def print_differences(study: EvaluationData) -> tuple[PrintDifference, ...]:
    """All numbers that differ by more than rounding, known slips and others."""
    ours = recompute_tables(study)
    return tuple(
        PrintDifference(table.id, row, column, printed, computed)
        for table in study.printed
        for row, numbers in table.rows.items()
        for column, printed, computed in zip(table.columns, numbers, ours[table.id][row], strict=True)
        if abs(printed - computed) > ROUNDING_TOLERANCE
    )


def unexplained_differences(study: EvaluationData) -> tuple[PrintDifference, ...]:
    """Differences that are not known misprints, or are known with another value."""
    known = {
        (slip.table, cell.row, cell.column): cell.ours for slip in study.misprints for cell in slip.cells
    }
    return tuple(
        each
        for each in print_differences(study)
        if abs(known.get((each.table, each.row, each.column), np.inf) - each.ours) > ROUNDING_TOLERANCE
    )


def score_order(context: ReportContext) -> list[int]:
    """The subjects, from 0, in the order of Table 5.4: the highest score first."""
    assert context.score is not None  # everybody rated the six topics
    return [int(i) for i in np.argsort(-context.score, kind="stable")]


def _score_table(context: ReportContext) -> TableRows:
    """Table 5.4. An expert is 1, a beginner 0."""
    assert context.score is not None
    found = {each.id: each.experts.members for each in context.divisions}
    return {
        str(place): (float(context.score[i]), *(float(found[way][i]) for way in DIVISION_METHODS))
        for place, i in enumerate(score_order(context), 1)
    }


def _division_table(context: ReportContext) -> TableRows:
    """Table 5.5."""
    assert context.score is not None
    names = {"scale": "at 3.5", "half": "in half", "mean": "at M"}
    grid: TableRows = {}
    for each in context.divisions:
        numbers: list[float] = []
        for group in each.groups:
            stats = summary_statistics(context.score[group.members])
            numbers += [stats.n, stats.mean, stats.sd]
        grid[names[each.id]] = tuple(numbers)
    return grid


def _mean_and_sd_rows(context: ReportContext, measures: Sequence[FloatArray]) -> TableRows:
    """M and SD of each group, a column for each measure."""
    grid: TableRows = {}
    for group in context.groups:
        found = [summary_statistics(values[group.members]) for values in measures]
        grid[f"{group.name} M"] = tuple(each.mean for each in found)
        grid[f"{group.name} SD"] = tuple(each.sd for each in found)
    return grid


def _outcome_table(topic: str) -> Callable[[ReportContext], TableRows]:
    """Tables 5.6 and 5.7."""

    def table(context: ReportContext) -> TableRows:
        measures = context.data.ratings.topic_measures(QuestionPurpose.OUTCOME, SurveyPhase.AFTER, topic)
        return _mean_and_sd_rows(context, [each.values for each in measures])

    return table


def _question_table(context: ReportContext) -> TableRows:
    """Table 5.8."""
    quiz = context.data.quiz
    return {
        item.id: tuple(float(quiz.correctness(item)[group.members].mean()) for group in context.groups)
        for item in quiz.items
    }


def _quiz_topic_table(context: ReportContext) -> TableRows:
    """Table 5.9."""
    quiz = context.data.quiz
    return _mean_and_sd_rows(
        context, [*(quiz.share_right(quiz.topic_items(topic)) for topic in quiz.topics), quiz.scores]
    )


def _text_table(context: ReportContext) -> TableRows:
    """The numbers of the running text of 5.3.1 to 5.3.4."""
    ratings = context.data.ratings
    prior = _values_by_id(ratings.topic_means(QuestionPurpose.EXPERIENCE, SurveyPhase.BEFORE))
    gained = _values_by_id(ratings.topic_means(QuestionPurpose.GAINED, SurveyPhase.AFTER))
    hard = _values_by_id(ratings.topic_means(QuestionPurpose.DIFFICULTY, SurveyPhase.AFTER))
    explained = _values_by_id(ratings.topic_means(QuestionPurpose.EXPLANATION, SurveyPhase.AFTER))
    of = {"prior": _mean_over_topics(prior), "gained": _mean_over_topics(gained)}
    of |= {"difficulty": _mean_over_topics(hard), "explanation": _mean_over_topics(explained)}
    assert context.score is not None
    rows: dict[str, FloatArray] = {
        "prior, Robotics": prior["robotics"],
        "prior, ROS 1": prior["ros1"],
        "prior, ROS 2": prior["ros2"],
        "prior, all six": of["prior"],
        "expertise score": context.score,
        "difficulty, RL": hard["rl"],
        "difficulty, ROS 2": hard["ros2"],
        "explanation, ROS 2": explained["ros2"],
    }
    for what, group in ((w, g) for w in ("gained", "difficulty", "explanation") for g in context.groups):
        rows[f"{what}, {group.name}"] = of[what][group.members]
    return {
        name: (stats.mean, stats.sd)
        for name, values in rows.items()
        for stats in [summary_statistics(values)]
    }


def _values_by_id(measures: Sequence[StudentMeasure]) -> dict[str, FloatArray]:
    return {each.id: each.values for each in measures}


def _mean_over_topics(measures: Mapping[str, FloatArray]) -> FloatArray:
    """Each subject's mean over topics; nobody left one of these blank."""
    mean: FloatArray = np.stack(list(measures.values())).mean(axis=0)
    return mean


_TABLES: Final[Mapping[str, Callable[[ReportContext], TableRows]]] = {
    "5.4": _score_table,
    "5.5": _division_table,
    "5.6": _outcome_table("teleop"),
    "5.7": _outcome_table("rl"),
    "5.8": _question_table,
    "5.9": _quiz_topic_table,
    "text": _text_table,
}


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
    return (_comparison_table(table, ours, print_differences(study), setting_of(study)), *slips)


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
    wrong, unknown = print_differences(study), unexplained_differences(study)
    blocks: list[Block] = [
        Text(
            f"{total - len(wrong)} of {total} printed entries are exact; {len(wrong)} differ, all in {_places(wrong)}."
        )
    ]
    rows: list[tuple[Cell, ...]] = []
    for slip in study.misprints:
        cells = [each for each in wrong if each.table == slip.table]
        rows += [(_named(each), each.row, each.column, each.printed, each.ours) for each in cells]
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
            f"{_named(each)}, {each.row}, {each.column}: {each.printed} printed, {each.ours:.4f} ours, and not known."
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


def _places(wrong: Sequence[PrintDifference]) -> str:
    names = ("the text" if each.table == "text" else f"table {each.table}" for each in wrong)
    return join_with_and(dict.fromkeys(names)) or "no table"


def _named(each: PrintDifference) -> str:
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
