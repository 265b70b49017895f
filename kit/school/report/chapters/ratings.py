"""What students say the lessons gave them, what they found hard, and what was well explained."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np

from kit.school.report.chapters.setting import SCALE, Setting, means_bars, means_table, slug, title_of, within
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
from kit.school.survey.questions import QuestionPurpose, SurveyPhase


class _Kind(NamedTuple):
    id: str
    title: str
    all: str


_KINDS: Final = {
    QuestionPurpose.DIFFICULTY: _Kind(
        "difficulty", "How hard it was: 1 very easy, 7 very hard", "All topics"
    ),
    QuestionPurpose.EXPLANATION: _Kind(
        "explanation", "How well it was explained: 1 not at all, 7 very well", "All topics"
    ),
}


def knowledge(setting: Setting) -> ReportChapter | None:
    """What they say they learned, and how their rating of themselves changed."""
    ratings = setting.data.ratings
    blocks: list[ReportBlock] = []
    gained = ratings.measures(QuestionPurpose.GAINED, SurveyPhase.AFTER)
    if gained:
        everything = ratings.overall(QuestionPurpose.GAINED, SurveyPhase.AFTER)
        assert everything is not None  # there are ratings
        rows = (*gained, StudentMeasure("all", "All of it", everything))
        blocks.append(means_table("gained", "Learned, by their own account, 1 to 7", rows, setting))
        blocks.append(means_bars("gained-bars", "Learned, by their own account", gained, setting))
    blocks += _change(setting, _EXPERIENCE)
    if gained:
        blocks += _change(setting, _GAINED)
    return ReportChapter("knowledge", "Knowledge gained", tuple(blocks)) if blocks else None


class _Twice(NamedTuple):
    """A rating that is asked twice."""

    id: str
    title: str
    purpose: QuestionPurpose
    first: SurveyPhase
    second: SurveyPhase
    heads: tuple[str, str]
    nobody: str


_EXPERIENCE: Final = _Twice(
    "change",
    "Experience before and after, rated the same way",
    QuestionPurpose.EXPERIENCE,
    SurveyPhase.BEFORE,
    SurveyPhase.AFTER,
    ("before", "after"),
    "Nobody rated their experience both before and after: no change can be told.",
)
_QUIZZED: Final = ("then", "quizzed")
_GAINED: Final = _Twice(
    "gained-quizzed",
    "What they learned, before the quiz and once more after it",
    QuestionPurpose.GAINED,
    SurveyPhase.AFTER,
    SurveyPhase.QUIZZED,
    _QUIZZED,
    "Nobody rated what they learned once more after the quiz (`kit form quizzed`).",
)
_OUTCOME: Final = _Twice(
    "outcomes-quizzed",
    "Outcomes, before the quiz and once more after it",
    QuestionPurpose.OUTCOME,
    SurveyPhase.AFTER,
    SurveyPhase.QUIZZED,
    _QUIZZED,
    "Nobody rated the outcomes once more after the quiz (`kit form quizzed`).",
)


def _change(setting: Setting, asked: _Twice) -> Iterator[ReportBlock]:
    """The same rating at two times, of those who gave both."""
    ratings = setting.data.ratings
    after = {each.id: each for each in ratings.measures(asked.purpose, asked.second)}
    pairs = [
        (each.label, each.values, after[each.id].values)
        for each in ratings.measures(asked.purpose, asked.first)
        if each.id in after
    ]
    rows: list[tuple[TableCell, ...]] = []
    for label, first, second in pairs:
        change = second - first
        found = summary_statistics(change)
        if not found.n:
            continue
        both = ~np.isnan(change)
        chance = paired_test(change, np.random.default_rng(setting.seed))
        rows.append(
            (
                label,
                found.n,
                float(first[both].mean()),
                float(second[both].mean()),
                found.mean,
                found.interval,
                chance.p_value,
            )
        )
    if not rows and any((asked.second, each.id) in ratings.values for each in ratings.questions):
        yield ReportWarning(asked.nobody)  # the form does ask it twice
    if not rows:
        return
    yield ReportTable(
        asked.id,
        asked.title,
        (
            TableColumn("", CellStyle.TEXT),
            TableColumn("n"),
            TableColumn(asked.heads[0]),
            TableColumn(asked.heads[1]),
            TableColumn("change"),
            TableColumn("95% of change"),
            TableColumn("p", CellStyle.CHANCE, 3),
        ),
        tuple(rows),
        "Only who rated it twice. p: by the signs of the differences, all 2^n of them.",
    )


def outcomes(setting: Setting) -> ReportChapter | None:
    """How far the lessons enabled them."""
    ratings = setting.data.ratings
    blocks: list[ReportBlock] = []
    for topic in ratings.topics(QuestionPurpose.OUTCOME, SurveyPhase.AFTER):
        measures = ratings.of_topic(QuestionPurpose.OUTCOME, SurveyPhase.AFTER, topic)
        name = title_of(topic)
        blocks.append(
            means_table(
                f"outcomes-{slug(topic)}", f"Outcomes, {name}: 1 not at all, 7 completely", measures, setting
            )
        )
        blocks.append(means_bars(f"outcomes-{slug(topic)}-bars", f"Outcomes, {name}", measures, setting))
    if blocks:
        blocks += _change(setting, _OUTCOME)
    return ReportChapter("outcomes", "Outcomes", tuple(blocks)) if blocks else None


def difficulty(setting: Setting) -> ReportChapter | None:
    """How hard each topic was."""
    return _by_topic(setting, QuestionPurpose.DIFFICULTY, "Difficulty")


def explanation(setting: Setting) -> ReportChapter | None:
    """How well each topic was explained."""
    return _by_topic(setting, QuestionPurpose.EXPLANATION, "Explanation")


def _by_topic(setting: Setting, purpose: QuestionPurpose, title: str) -> ReportChapter | None:
    ratings, kind = setting.data.ratings, _KINDS[purpose]
    everything = ratings.overall(purpose, SurveyPhase.AFTER)
    if everything is None:
        return None
    topics = tuple(
        StudentMeasure(each.id, title_of(each.id), each.values)
        for each in ratings.by_topic(purpose, SurveyPhase.AFTER)
    )
    single: tuple[tuple[TableCell, ...], ...] = tuple(
        (title_of(topic), each.label, found.n, found.mean, found.sd, within(found.interval, SCALE))
        for topic in ratings.topics(purpose, SurveyPhase.AFTER)
        for each in ratings.of_topic(purpose, SurveyPhase.AFTER, topic)
        for found in [summary_statistics(non_blank(each.values))]
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
                (*topics, StudentMeasure("all", kind.all, everything)),
                setting,
                SCALE,
                note,
            ),
            means_bars(f"{kind.id}-bars", kind.title, topics, setting),
            ReportTable(f"{kind.id}-single", f"{title}, question by question", heads, single, grouped=True),
        ),
    )
