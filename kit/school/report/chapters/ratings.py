"""Chapters on students' ratings: knowledge gained, outcomes, difficulty and explanation."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np

from kit.school.report.chapters.context import (
    SCALE_BOUNDS,
    ReportContext,
    clip_interval,
    file_name_part,
    means_bars,
    means_table,
    topic_title,
)
from kit.school.report.document import (
    CellStyle,
    ReportBlock,
    ReportChapter,
    ReportTable,
    ReportWarning,
    TableCell,
    TableColumn,
)
from kit.school.report.inference import non_blank, paired_test, summary_statistics
from kit.school.report.measures import StudentMeasure
from kit.school.survey.reading import QuestionPurpose, SurveyPhase


class _TopicRating(NamedTuple):
    id: str
    title: str
    overall_label: str


_TOPIC_RATINGS: Final = {
    QuestionPurpose.DIFFICULTY: _TopicRating(
        "difficulty", "How hard it was: 1 very easy, 7 very hard", "All topics"
    ),
    QuestionPurpose.EXPLANATION: _TopicRating(
        "explanation", "How well it was explained: 1 not at all, 7 very well", "All topics"
    ),
}


def knowledge_chapter(context: ReportContext) -> ReportChapter | None:
    """The chapter on knowledge gained, and on changes of students' ratings of themselves."""
    ratings = context.data.ratings
    blocks: list[ReportBlock] = []
    gained = ratings.measures(QuestionPurpose.GAINED, SurveyPhase.AFTER)
    if gained:
        everything = ratings.overall_means(QuestionPurpose.GAINED, SurveyPhase.AFTER)
        assert everything is not None  # there are ratings
        rows = (*gained, StudentMeasure("all", "All of it", everything))
        blocks.append(means_table("gained", "Learned, by their own account, 1 to 7", rows, context))
        blocks.append(means_bars("gained-bars", "Learned, by their own account", gained, context))
    blocks += _change_blocks(context, _EXPERIENCE)
    if gained:
        blocks += _change_blocks(context, _GAINED)
    return ReportChapter("knowledge", "Knowledge gained", tuple(blocks)) if blocks else None


class _RepeatedRating(NamedTuple):
    """A rating that is asked twice."""

    id: str
    title: str
    purpose: QuestionPurpose
    first: SurveyPhase
    second: SurveyPhase
    heads: tuple[str, str]
    missing_text: str


_EXPERIENCE: Final = _RepeatedRating(
    "change",
    "Experience before and after, rated the same way",
    QuestionPurpose.EXPERIENCE,
    SurveyPhase.BEFORE,
    SurveyPhase.AFTER,
    ("before", "after"),
    "Nobody rated their experience both before and after: no change can be told.",
)
_QUIZZED: Final = ("then", "quizzed")
_GAINED: Final = _RepeatedRating(
    "gained-quizzed",
    "What they learned, before the quiz and once more after it",
    QuestionPurpose.GAINED,
    SurveyPhase.AFTER,
    SurveyPhase.QUIZZED,
    _QUIZZED,
    "Nobody rated what they learned once more after the quiz (`kit form quizzed`).",
)
_OUTCOME: Final = _RepeatedRating(
    "outcomes-quizzed",
    "Outcomes, before the quiz and once more after it",
    QuestionPurpose.OUTCOME,
    SurveyPhase.AFTER,
    SurveyPhase.QUIZZED,
    _QUIZZED,
    "Nobody rated the outcomes once more after the quiz (`kit form quizzed`).",
)


def _change_blocks(context: ReportContext, rating: _RepeatedRating) -> Iterator[ReportBlock]:
    """The change between two times of the same rating, of students who gave both."""
    ratings = context.data.ratings
    after = {each.id: each for each in ratings.measures(rating.purpose, rating.second)}
    pairs = [
        (each.label, each.values, after[each.id].values)
        for each in ratings.measures(rating.purpose, rating.first)
        if each.id in after
    ]
    rows: list[tuple[TableCell, ...]] = []
    for label, first, second in pairs:
        change = second - first
        stats = summary_statistics(change)
        if not stats.n:
            continue
        both = ~np.isnan(change)
        test = paired_test(change, np.random.default_rng(context.seed))
        rows.append(
            (
                label,
                stats.n,
                float(first[both].mean()),
                float(second[both].mean()),
                stats.mean,
                stats.interval,
                test.p_value,
            )
        )
    if not rows and any((rating.second, each.id) in ratings.values for each in ratings.questions):
        yield ReportWarning(rating.missing_text)  # the form does ask it twice
    if not rows:
        return
    yield ReportTable(
        rating.id,
        rating.title,
        (
            TableColumn("", CellStyle.TEXT),
            TableColumn("n"),
            TableColumn(rating.heads[0]),
            TableColumn(rating.heads[1]),
            TableColumn("change"),
            TableColumn("95% of change"),
            TableColumn("p", CellStyle.P_VALUE, 3),
        ),
        tuple(rows),
        "Only who rated it twice. p: by the signs of the differences, all 2^n of them.",
    )


def outcomes_chapter(context: ReportContext) -> ReportChapter | None:
    """The chapter on outcomes."""
    ratings = context.data.ratings
    blocks: list[ReportBlock] = []
    for topic in ratings.topics(QuestionPurpose.OUTCOME, SurveyPhase.AFTER):
        measures = ratings.topic_measures(QuestionPurpose.OUTCOME, SurveyPhase.AFTER, topic)
        name = topic_title(topic)
        blocks.append(
            means_table(
                f"outcomes-{file_name_part(topic)}",
                f"Outcomes, {name}: 1 not at all, 7 completely",
                measures,
                context,
            )
        )
        blocks.append(
            means_bars(f"outcomes-{file_name_part(topic)}-bars", f"Outcomes, {name}", measures, context)
        )
    if blocks:
        blocks += _change_blocks(context, _OUTCOME)
    return ReportChapter("outcomes", "Outcomes", tuple(blocks)) if blocks else None


def difficulty_chapter(context: ReportContext) -> ReportChapter | None:
    """The chapter on the difficulty of topics."""
    return _topic_chapter(context, QuestionPurpose.DIFFICULTY, "Difficulty")


def explanation_chapter(context: ReportContext) -> ReportChapter | None:
    """The chapter on how well topics were explained."""
    return _topic_chapter(context, QuestionPurpose.EXPLANATION, "Explanation")


def _topic_chapter(context: ReportContext, purpose: QuestionPurpose, title: str) -> ReportChapter | None:
    ratings, kind = context.data.ratings, _TOPIC_RATINGS[purpose]
    everything = ratings.overall_means(purpose, SurveyPhase.AFTER)
    if everything is None:
        return None
    topics = tuple(
        StudentMeasure(each.id, topic_title(each.id), each.values)
        for each in ratings.topic_means(purpose, SurveyPhase.AFTER)
    )
    single: tuple[tuple[TableCell, ...], ...] = tuple(
        (
            topic_title(topic),
            each.label,
            stats.n,
            stats.mean,
            stats.sd,
            clip_interval(stats.interval, SCALE_BOUNDS),
        )
        for topic in ratings.topics(purpose, SurveyPhase.AFTER)
        for each in ratings.topic_measures(purpose, SurveyPhase.AFTER, topic)
        for stats in [summary_statistics(non_blank(each.values))]
    )
    heads = (
        TableColumn("topic", CellStyle.TEXT),
        TableColumn("", CellStyle.TEXT),
        TableColumn("n"),
        TableColumn("M"),
        TableColumn("SD"),
        TableColumn("95% of M"),
    )
    note = "All topics: each student's mean over the topics' means."
    return ReportChapter(
        kind.id,
        title,
        (
            means_table(
                kind.id,
                kind.title,
                (*topics, StudentMeasure("all", kind.overall_label, everything)),
                context,
                SCALE_BOUNDS,
                note,
            ),
            means_bars(f"{kind.id}-bars", kind.title, topics, context),
            ReportTable(f"{kind.id}-single", f"{title}, question by question", heads, single, grouped=True),
        ),
    )
