"""Chapters on the class: its members, their experience before, and its division into beginners and experts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from kit.school.report.chapters.context import (
    SCALE_BOUNDS,
    ReportContext,
    division_warnings,
    file_name_part,
    means_bars,
    means_table,
    topic_title,
)
from kit.school.report.document import (
    CellStyle,
    Histogram,
    ReportBlock,
    ReportChapter,
    ReportTable,
    ReportText,
    ReportWarning,
    TableCell,
    TableColumn,
)
from kit.school.report.expertise import effective_weights
from kit.school.report.inference import non_blank, summary_statistics
from kit.school.report.measures import StudentMeasure
from kit.school.survey.reading import QuestionPurpose, SurveyPhase

BINS = tuple(float(edge) for edge in np.linspace(*SCALE_BOUNDS, 7))


def class_chapter(context: ReportContext, file_count: int) -> ReportChapter:
    """The chapter on the class: number of students, what they filled in, warnings about their files."""
    data = context.data
    quiz = [
        name
        for i, name in enumerate(data.names)
        if any(row[i] is not None for row in data.quiz.replies.values())
    ]
    blocks: list[ReportBlock] = [ReportWarning(text) for text in data.warnings]
    rows: tuple[tuple[TableCell, ...], ...] = (
        ("files", file_count),
        ("students", len(data.names)),
        ("form before", _rated_count(context, SurveyPhase.BEFORE)),
        ("form after", _rated_count(context, SurveyPhase.AFTER)),
        ("form quizzed", _rated_count(context, SurveyPhase.QUIZZED)),
        ("quiz", len(quiz)),
        ("lessons", sum(bool(work) for work in data.work)),
    )
    blocks.append(
        ReportTable(
            "class", "Who is in this report", (TableColumn("", CellStyle.TEXT), TableColumn("n")), rows
        )
    )
    option_rows: tuple[tuple[TableCell, ...], ...] = tuple(
        (question.text, word, count)
        for question, _, counts in data.option_counts
        for word, count in counts.items()
        if count
    )
    if option_rows:
        columns = (TableColumn("", CellStyle.TEXT), TableColumn("answer", CellStyle.TEXT), TableColumn("n"))
        blocks.append(
            ReportTable("facts", "What students said about themselves", columns, option_rows, grouped=True)
        )
    blocks.append(
        ReportText(
            "How to read: n counts who answered; blanks are left out and never replaced. SD is of the sample "
            "(n - 1). Intervals hold the true value with 95% confidence (means by Student's t, shares by Wilson). "
            "p is the share of all divisions into groups of these sizes that differ at least as much (exact "
            "permutation test, two-sided; in a large class a sample of 20,000 of them). Of twenty such p, one is below 0.05 by chance alone."
        )
    )
    return ReportChapter("class", "The class", tuple(blocks))


def _rated_count(context: ReportContext, phase: SurveyPhase) -> int:
    """Number of students with at least one rating of that phase."""
    rows = [values for (of, _), values in context.data.ratings.values.items() if of is phase]
    return int((~np.isnan(np.stack(rows))).any(axis=0).sum()) if rows else 0


def experience_chapter(context: ReportContext) -> ReportChapter | None:
    """The chapter on experience before the lessons, Algorithm 4 and the three divisions."""
    prior = context.data.ratings.measures(QuestionPurpose.EXPERIENCE, SurveyPhase.BEFORE)
    if not prior:
        return None
    overall = context.data.ratings.overall_means(QuestionPurpose.EXPERIENCE, SurveyPhase.BEFORE)
    assert overall is not None  # there are ratings
    blocks: list[ReportBlock] = [
        means_table(
            "prior",
            "Experience before, 1 to 7",
            (*prior, StudentMeasure("all", "All of it", overall)),
            context,
        ),
        means_bars("prior-bars", "Experience before, by topic", prior, context),
        rating_histogram("prior-histogram", "Students by mean experience before", overall),
        *(
            rating_histogram(
                f"prior-{file_name_part(each.id)}",
                f"Students by experience before: {each.label}",
                each.values,
            )
            for each in prior
        ),
        *_score_blocks(context),
    ]
    return ReportChapter("experience", "Experience and expertise", tuple(blocks))


def _score_blocks(context: ReportContext) -> Iterator[ReportBlock]:
    if context.score is None or not len(non_blank(context.score)):
        yield ReportWarning(
            "Nobody rated all six topics of Algorithm 4, so there are no scores and no groups."
        )
        return
    missing = int(np.isnan(context.score).sum())
    if missing:
        yield ReportWarning(
            f"{missing} of {len(context.score)} left out a topic of Algorithm 4: no score, in no group."
        )
    names = {"ros": "the greater of ROS 1 and 2"}
    weights: tuple[tuple[TableCell, ...], ...] = tuple(
        (names.get(topic, topic_title(topic)), weight) for topic, weight in effective_weights()
    )
    yield ReportTable(
        "weights",
        "What Algorithm 4 weighs in truth: its means of means come to this",
        (TableColumn("rating", CellStyle.TEXT), TableColumn("weight", decimals=3)),
        weights,
    )
    order = np.argsort(-np.nan_to_num(context.score, nan=-np.inf), kind="stable")[
        : len(context.score) - missing
    ]
    rows: tuple[tuple[TableCell, ...], ...] = tuple(
        (
            context.data.names[i],
            float(context.score[i]),
            *("expert" if each.experts.members[i] else "beginner" for each in context.divisions),
        )
        for i in order
    )
    yield ReportTable(
        "scores",
        "Expertise scores and divisions",
        (
            TableColumn("student", CellStyle.TEXT),
            TableColumn("score"),
            *(TableColumn(each.title, CellStyle.TEXT) for each in context.divisions),
        ),
        rows,
    )
    if not context.divisions:
        yield ReportWarning("The scores cannot be divided into two groups.")
        return
    yield _division_table(context)
    for each in context.divisions:
        yield from division_warnings(each)
    if context.division is None:
        yield ReportWarning(
            "The division asked for leaves one group empty, so the tables below do not divide the class."
        )
    else:
        yield ReportText(f"The tables below divide the class {context.division.title}.")


def _division_table(context: ReportContext) -> ReportTable:
    rows: list[tuple[TableCell, ...]] = []
    for each in context.divisions:
        assert context.score is not None  # a division comes from scores
        parts: list[TableCell] = [each.title]
        for group in each.groups:
            stats = summary_statistics(context.score[group.members])
            parts += [stats.n, stats.mean, stats.sd]
        inside = context.score[each.experts.members].min() - context.score[each.beginners.members].max()
        rows.append((*parts, float(inside)))
    heads = ("n", "M", "SD")
    return ReportTable(
        "divisions",
        "The groups by each division: beginners, then experts",
        (
            TableColumn("", CellStyle.TEXT),
            *(TableColumn(f"{who} {head}") for who in ("B", "E") for head in heads),
            TableColumn("gap"),
        ),
        tuple(rows),
        "gap: from the best beginner to the least expert.",
    )


def rating_histogram(
    identity: str, title: str, values: np.ndarray[tuple[int], np.dtype[np.float64]]
) -> Histogram:
    """A histogram of ratings from 1 to 7."""
    counts, _ = np.histogram(non_blank(values), BINS)
    return Histogram(identity, title, BINS, tuple(int(count) for count in counts))
