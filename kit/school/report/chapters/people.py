"""Who is in the class, what they knew before, and how the class is cut into beginners and experts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from kit.school.report.chapters.setting import SCALE, Setting, cautions_of, means_table, title_of
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
from kit.school.survey.questions import QuestionPurpose, SurveyPhase

BINS = tuple(float(edge) for edge in np.linspace(*SCALE, 7))


def people(setting: Setting, files: int) -> ReportChapter:
    """The roll: how many, what they filled in, what was wrong with their files."""
    data = setting.data
    quiz = [
        name
        for i, name in enumerate(data.names)
        if any(row[i] is not None for row in data.quiz.replies.values())
    ]
    blocks: list[ReportBlock] = [ReportWarning(text) for text in data.warnings]
    rows: tuple[tuple[TableCell, ...], ...] = (
        ("files", files),
        ("students", len(data.names)),
        ("form before", _answered(setting, SurveyPhase.BEFORE)),
        ("form after", _answered(setting, SurveyPhase.AFTER)),
        ("form quizzed", _answered(setting, SurveyPhase.QUIZZED)),
        ("quiz", len(quiz)),
        ("lessons", sum(bool(work) for work in data.work)),
    )
    blocks.append(
        ReportTable(
            "class", "Who is in this report", (TableColumn("", CellStyle.TEXT), TableColumn("n")), rows
        )
    )
    counted: tuple[tuple[TableCell, ...], ...] = tuple(
        (question.text, word, count)
        for question, _, counts in data.option_counts
        for word, count in counts.items()
        if count
    )
    if counted:
        columns = (TableColumn("", CellStyle.TEXT), TableColumn("answer", CellStyle.TEXT), TableColumn("n"))
        blocks.append(ReportTable("facts", "What they said of themselves", columns, counted, grouped=True))
    blocks.append(
        ReportText(
            "How to read: n counts who answered; blanks are left out, never taken for anything. SD is of the sample "
            "(n - 1). Intervals hold the true value with 95% confidence (means by Student's t, shares by Wilson). "
            "p is the share of all divisions into groups of these sizes that differ at least as much (exact "
            "permutation test, two-sided; in a large class a sample of 20,000 of them). Of twenty such p, one is below 0.05 by chance alone."
        )
    )
    return ReportChapter("class", "The class", tuple(blocks))


def _answered(setting: Setting, phase: SurveyPhase) -> int:
    """Students with at least one rating of that phase."""
    rows = [values for (of, _), values in setting.data.ratings.values.items() if of is phase]
    return int((~np.isnan(np.stack(rows))).any(axis=0).sum()) if rows else 0


def experience(setting: Setting) -> ReportChapter | None:
    """What they knew before, Algorithm 4, and the three divisions."""
    prior = setting.data.ratings.measures(QuestionPurpose.EXPERIENCE, SurveyPhase.BEFORE)
    if not prior:
        return None
    everybody = setting.data.ratings.overall(QuestionPurpose.EXPERIENCE, SurveyPhase.BEFORE)
    assert everybody is not None  # there are ratings
    blocks: list[ReportBlock] = [
        means_table(
            "prior",
            "Experience before, 1 to 7",
            (*prior, StudentMeasure("all", "All of it", everybody)),
            setting,
        ),
        histogram("prior-histogram", "Students by mean experience before", everybody),
        *_scores(setting),
    ]
    return ReportChapter("experience", "Experience and expertise", tuple(blocks))


def _scores(setting: Setting) -> Iterator[ReportBlock]:
    if setting.score is None or not len(non_blank(setting.score)):
        yield ReportWarning(
            "Nobody rated all six topics of Algorithm 4, so there are no scores and no groups."
        )
        return
    missing = int(np.isnan(setting.score).sum())
    if missing:
        yield ReportWarning(
            f"{missing} of {len(setting.score)} left out a topic of Algorithm 4: no score, in no group."
        )
    names = {"ros": "the greater of ROS 1 and 2"}
    weights: tuple[tuple[TableCell, ...], ...] = tuple(
        (names.get(topic, title_of(topic)), weight) for topic, weight in effective_weights()
    )
    yield ReportTable(
        "weights",
        "What Algorithm 4 weighs in truth: its means of means come to this",
        (TableColumn("rating", CellStyle.TEXT), TableColumn("weight", decimals=3)),
        weights,
    )
    order = np.argsort(-np.nan_to_num(setting.score, nan=-np.inf), kind="stable")[
        : len(setting.score) - missing
    ]
    rows: tuple[tuple[TableCell, ...], ...] = tuple(
        (
            setting.data.names[i],
            float(setting.score[i]),
            *("expert" if each.experts.members[i] else "beginner" for each in setting.divisions),
        )
        for i in order
    )
    yield ReportTable(
        "scores",
        "Expertise scores and divisions",
        (
            TableColumn("student", CellStyle.TEXT),
            TableColumn("score"),
            *(TableColumn(each.title, CellStyle.TEXT) for each in setting.divisions),
        ),
        rows,
    )
    if not setting.divisions:
        yield ReportWarning("The scores cannot be divided into two groups.")
        return
    yield _divisions(setting)
    for each in setting.divisions:
        yield from cautions_of(each)
    if setting.division is None:
        yield ReportWarning(
            "The division asked for leaves one group empty, so the tables below do not divide the class."
        )
    else:
        yield ReportText(f"The tables below divide the class {setting.division.title}.")


def _divisions(setting: Setting) -> ReportTable:
    rows: list[tuple[TableCell, ...]] = []
    for each in setting.divisions:
        assert setting.score is not None  # a division comes from scores
        parts: list[TableCell] = [each.title]
        for group in each.groups:
            found = summary_statistics(setting.score[group.members])
            parts += [found.n, found.mean, found.sd]
        inside = setting.score[each.experts.members].min() - setting.score[each.beginners.members].max()
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


def histogram(identity: str, title: str, values: np.ndarray[tuple[int], np.dtype[np.float64]]) -> Histogram:
    """Of ratings from 1 to 7."""
    counts, _ = np.histogram(non_blank(values), BINS)
    return Histogram(identity, title, BINS, tuple(int(count) for count in counts))
