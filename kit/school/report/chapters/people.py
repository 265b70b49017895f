"""Chapters on the class: its members and its division into beginners and experts, and what they say of themselves."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np

from kit.document.blocks import (
    Block,
    Caution,
    Cell,
    CellStyle,
    Chapter,
    Column,
    Histogram,
    Table,
    Text,
)
from kit.school.report.chapters.context import (
    SCALE_BOUNDS,
    ReportContext,
    clip_interval,
    division_warnings,
    file_name_part,
    means_bars,
    means_table,
    topic_title,
)
from kit.school.report.expertise import effective_weights
from kit.school.report.inference import non_blank, paired_test, summary_statistics
from kit.school.report.measures import StudentMeasure
from kit.school.survey import QuestionPurpose, SurveyPhase

BINS = tuple(float(edge) for edge in np.linspace(*SCALE_BOUNDS, 7))


def class_chapter(context: ReportContext, file_count: int) -> Chapter:
    """The chapter on the class: number of students, what they filled in, warnings about their files."""
    data = context.data
    quiz = [
        name
        for i, name in enumerate(data.names)
        if any(row[i] is not None for row in data.quiz.replies.values())
    ]
    blocks: list[Block] = [Caution(text) for text in data.warnings]
    rows: tuple[tuple[Cell, ...], ...] = (
        ("files", file_count),
        ("students", len(data.names)),
        ("form before", _rated_count(context, SurveyPhase.BEFORE)),
        ("form after", _rated_count(context, SurveyPhase.AFTER)),
        ("form quizzed", _rated_count(context, SurveyPhase.QUIZZED)),
        ("quiz", len(quiz)),
        ("lessons", sum(bool(work) for work in data.work)),
    )
    blocks.append(Table("class", "Who is in this report", (Column("", CellStyle.TEXT), Column("n")), rows))
    option_rows: tuple[tuple[Cell, ...], ...] = tuple(
        (question.text, word, count)
        for question, _, counts in data.option_counts
        for word, count in counts.items()
        if count
    )
    if option_rows:
        columns = (Column("", CellStyle.TEXT), Column("answer", CellStyle.TEXT), Column("n"))
        blocks.append(
            Table("facts", "What students said about themselves", columns, option_rows, grouped=True)
        )
    blocks.append(
        Text(
            "How to read: n counts the answers; blanks are left out and never replaced. SD is of the sample "
            "(n - 1). Intervals hold the true value with 95% confidence (means by Student's t, shares by Wilson). "
            "p is the share of all divisions into groups of these sizes that differ at least as much (exact "
            "permutation test, two-sided; in a large class a sample of 20,000 of them). Of twenty such p, one is below 0.05 by chance alone."
        )
    )
    return Chapter("class", "The class", tuple(blocks))


def _rated_count(context: ReportContext, phase: SurveyPhase) -> int:
    """Number of students with at least one rating of that phase."""
    rows = [values for (of, _), values in context.data.ratings.values.items() if of is phase]
    return int((~np.isnan(np.stack(rows))).any(axis=0).sum()) if rows else 0


def experience_chapter(context: ReportContext) -> Chapter | None:
    """The chapter on experience before the lessons, Algorithm 4 and the three divisions."""
    prior = context.data.ratings.measures(QuestionPurpose.EXPERIENCE, SurveyPhase.BEFORE)
    if not prior:
        return None
    overall = context.data.ratings.overall_means(QuestionPurpose.EXPERIENCE, SurveyPhase.BEFORE)
    assert overall is not None  # there are ratings
    blocks: list[Block] = [
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
    return Chapter("experience", "Experience and expertise", tuple(blocks))


def _score_blocks(context: ReportContext) -> Iterator[Block]:
    if context.score is None or not len(non_blank(context.score)):
        yield Caution("Nobody rated all six topics of Algorithm 4, so there are no scores and no groups.")
        return
    missing = int(np.isnan(context.score).sum())
    if missing:
        yield Caution(
            f"{missing} of {len(context.score)} left out a topic of Algorithm 4: no score, in no group."
        )
    names = {"ros": "the greater of ROS 1 and 2"}
    weights: tuple[tuple[Cell, ...], ...] = tuple(
        (names.get(topic, topic_title(topic)), weight) for topic, weight in effective_weights()
    )
    yield Table(
        "weights",
        "What Algorithm 4 weighs in truth: its means of means come to this",
        (Column("rating", CellStyle.TEXT), Column("weight", decimals=3)),
        weights,
    )
    order = np.argsort(-np.nan_to_num(context.score, nan=-np.inf), kind="stable")[
        : len(context.score) - missing
    ]
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (
            context.data.names[i],
            float(context.score[i]),
            *("expert" if each.experts.members[i] else "beginner" for each in context.divisions),
        )
        for i in order
    )
    yield Table(
        "scores",
        "Expertise scores and divisions",
        (
            Column("student", CellStyle.TEXT),
            Column("score"),
            *(Column(each.title, CellStyle.TEXT) for each in context.divisions),
        ),
        rows,
    )
    if not context.divisions:
        yield Caution("The scores cannot be divided into two groups.")
        return
    yield _division_table(context)
    for each in context.divisions:
        yield from division_warnings(each)
    if context.division is None:
        yield Caution(
            "The division asked for leaves one group empty, so the tables below do not divide the class."
        )
    else:
        yield Text(f"The tables below divide the class {context.division.title}.")


def _division_table(context: ReportContext) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for each in context.divisions:
        assert context.score is not None  # a division comes from scores
        parts: list[Cell] = [each.title]
        for group in each.groups:
            stats = summary_statistics(context.score[group.members])
            parts += [stats.n, stats.mean, stats.sd]
        inside = context.score[each.experts.members].min() - context.score[each.beginners.members].max()
        rows.append((*parts, each.cut_score, float(inside)))
    heads = ("n", "M", "SD")
    return Table(
        "divisions",
        "The groups by each division: beginners, then experts",
        (
            Column("", CellStyle.TEXT),
            *(Column(f"{who} {head}") for who in ("B", "E") for head in heads),
            Column("cut"),
            Column("gap"),
        ),
        tuple(rows),
        "cut: students with a lower score are beginners; gap: from the best beginner to the least expert.",
    )


def rating_histogram(
    identity: str, title: str, values: np.ndarray[tuple[int], np.dtype[np.float64]]
) -> Histogram:
    """A histogram of ratings from 1 to 7."""
    counts, _ = np.histogram(non_blank(values), BINS)
    return Histogram(identity, title, BINS, tuple(int(count) for count in counts))


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


def knowledge_chapter(context: ReportContext) -> Chapter | None:
    """The chapter on knowledge gained, and on changes of students' ratings of themselves."""
    ratings = context.data.ratings
    blocks: list[Block] = []
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
    return Chapter("knowledge", "Knowledge gained", tuple(blocks)) if blocks else None


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
    "Nobody rated their experience both before and after, so the change is unknown.",
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


def _change_blocks(context: ReportContext, rating: _RepeatedRating) -> Iterator[Block]:
    """The change between two times of the same rating, of students who gave both."""
    ratings = context.data.ratings
    after = {each.id: each for each in ratings.measures(rating.purpose, rating.second)}
    pairs = [
        (each.label, each.values, after[each.id].values)
        for each in ratings.measures(rating.purpose, rating.first)
        if each.id in after
    ]
    rows: list[tuple[Cell, ...]] = []
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
        yield Caution(rating.missing_text)  # the form does ask it twice
    if not rows:
        return
    yield Table(
        rating.id,
        rating.title,
        (
            Column("", CellStyle.TEXT),
            Column("n"),
            Column(rating.heads[0]),
            Column(rating.heads[1]),
            Column("change"),
            Column("95% of change"),
            Column("p", CellStyle.P_VALUE, 3),
        ),
        tuple(rows),
        "Only students who rated it twice. p: by the signs of the differences, all 2^n of them.",
    )


def outcomes_chapter(context: ReportContext) -> Chapter | None:
    """The chapter on outcomes."""
    ratings = context.data.ratings
    blocks: list[Block] = []
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
    return Chapter("outcomes", "Outcomes", tuple(blocks)) if blocks else None


def difficulty_chapter(context: ReportContext) -> Chapter | None:
    """The chapter on the difficulty of topics."""
    return _topic_chapter(context, QuestionPurpose.DIFFICULTY, "Difficulty")


def topic_clarity_chapter(context: ReportContext) -> Chapter | None:
    """The chapter on how well topics were explained."""
    return _topic_chapter(context, QuestionPurpose.EXPLANATION, "Explanation")


def _topic_chapter(context: ReportContext, purpose: QuestionPurpose, title: str) -> Chapter | None:
    ratings, kind = context.data.ratings, _TOPIC_RATINGS[purpose]
    everything = ratings.overall_means(purpose, SurveyPhase.AFTER)
    if everything is None:
        return None
    topics = tuple(
        StudentMeasure(each.id, topic_title(each.id), each.values)
        for each in ratings.topic_means(purpose, SurveyPhase.AFTER)
    )
    single: tuple[tuple[Cell, ...], ...] = tuple(
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
        Column("topic", CellStyle.TEXT),
        Column("", CellStyle.TEXT),
        Column("n"),
        Column("M"),
        Column("SD"),
        Column("95% of M"),
    )
    note = "All topics: each student's mean over the topics' means."
    return Chapter(
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
            Table(f"{kind.id}-single", f"{title}, question by question", heads, single, grouped=True),
        ),
    )
