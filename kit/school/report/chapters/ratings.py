"""What students say the lessons gave them, what they found hard, and what was well explained."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np

from kit.school.report.chapters.setting import SCALE, Setting, means_bars, means_table, slug, title_of, within
from kit.school.report.document import Block, Caution, Cell, Chapter, Column, Style, Table
from kit.school.report.inference import paired_test, present, summary
from kit.school.report.measures import Measure
from kit.school.survey.questions import Phase, Purpose


class _Kind(NamedTuple):
    id: str
    title: str
    all: str


_KINDS: Final = {
    Purpose.DIFFICULTY: _Kind("difficulty", "How hard it was: 1 very easy, 7 very hard", "All topics"),
    Purpose.EXPLANATION: _Kind(
        "explanation", "How well it was explained: 1 not at all, 7 very well", "All topics"
    ),
}


def knowledge(setting: Setting) -> Chapter | None:
    """What they say they learned, and how their rating of themselves changed."""
    ratings = setting.data.ratings
    blocks: list[Block] = []
    gained = ratings.measures(Purpose.GAINED, Phase.AFTER)
    if gained:
        everything = ratings.overall(Purpose.GAINED, Phase.AFTER)
        assert everything is not None  # there are ratings
        rows = (*gained, Measure("all", "All of it", everything))
        blocks.append(means_table("gained", "Learned, by their own account, 1 to 7", rows, setting))
        blocks.append(means_bars("gained-bars", "Learned, by their own account", gained, setting))
    blocks += _change(setting, _EXPERIENCE)
    if gained:
        blocks += _change(setting, _GAINED)
    return Chapter("knowledge", "Knowledge gained", tuple(blocks)) if blocks else None


class _Twice(NamedTuple):
    """A rating that is asked twice."""

    id: str
    title: str
    purpose: Purpose
    first: Phase
    second: Phase
    heads: tuple[str, str]
    nobody: str


_EXPERIENCE: Final = _Twice(
    "change",
    "Experience before and after, rated the same way",
    Purpose.EXPERIENCE,
    Phase.BEFORE,
    Phase.AFTER,
    ("before", "after"),
    "Nobody rated their experience both before and after: no change can be told.",
)
_QUIZZED: Final = ("then", "quizzed")
_GAINED: Final = _Twice(
    "gained-quizzed",
    "What they learned, before the quiz and once more after it",
    Purpose.GAINED,
    Phase.AFTER,
    Phase.QUIZZED,
    _QUIZZED,
    "Nobody rated what they learned once more after the quiz (`kit form quizzed`).",
)
_OUTCOME: Final = _Twice(
    "outcomes-quizzed",
    "Outcomes, before the quiz and once more after it",
    Purpose.OUTCOME,
    Phase.AFTER,
    Phase.QUIZZED,
    _QUIZZED,
    "Nobody rated the outcomes once more after the quiz (`kit form quizzed`).",
)


def _change(setting: Setting, asked: _Twice) -> Iterator[Block]:
    """The same rating at two times, of those who gave both."""
    ratings = setting.data.ratings
    after = {each.id: each for each in ratings.measures(asked.purpose, asked.second)}
    pairs = [
        (each.label, each.values, after[each.id].values)
        for each in ratings.measures(asked.purpose, asked.first)
        if each.id in after
    ]
    rows: list[tuple[Cell, ...]] = []
    for label, first, second in pairs:
        change = second - first
        found = summary(change)
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
                chance.p,
            )
        )
    if not rows and any((asked.second, each.id) in ratings.values for each in ratings.questions):
        yield Caution(asked.nobody)  # the form does ask it twice
    if not rows:
        return
    yield Table(
        asked.id,
        asked.title,
        (
            Column("", Style.TEXT),
            Column("n"),
            Column(asked.heads[0]),
            Column(asked.heads[1]),
            Column("change"),
            Column("95% of change"),
            Column("p", Style.CHANCE, 3),
        ),
        tuple(rows),
        "Only who rated it twice. p: by the signs of the differences, all 2^n of them.",
    )


def outcomes(setting: Setting) -> Chapter | None:
    """How far the lessons enabled them."""
    ratings = setting.data.ratings
    blocks: list[Block] = []
    for topic in ratings.topics(Purpose.OUTCOME, Phase.AFTER):
        measures = ratings.of_topic(Purpose.OUTCOME, Phase.AFTER, topic)
        name = title_of(topic)
        blocks.append(
            means_table(
                f"outcomes-{slug(topic)}", f"Outcomes, {name}: 1 not at all, 7 completely", measures, setting
            )
        )
        blocks.append(means_bars(f"outcomes-{slug(topic)}-bars", f"Outcomes, {name}", measures, setting))
    if blocks:
        blocks += _change(setting, _OUTCOME)
    return Chapter("outcomes", "Outcomes", tuple(blocks)) if blocks else None


def difficulty(setting: Setting) -> Chapter | None:
    """How hard each topic was."""
    return _by_topic(setting, Purpose.DIFFICULTY, "Difficulty")


def explanation(setting: Setting) -> Chapter | None:
    """How well each topic was explained."""
    return _by_topic(setting, Purpose.EXPLANATION, "Explanation")


def _by_topic(setting: Setting, purpose: Purpose, title: str) -> Chapter | None:
    ratings, kind = setting.data.ratings, _KINDS[purpose]
    everything = ratings.overall(purpose, Phase.AFTER)
    if everything is None:
        return None
    topics = tuple(
        Measure(each.id, title_of(each.id), each.values) for each in ratings.by_topic(purpose, Phase.AFTER)
    )
    single: tuple[tuple[Cell, ...], ...] = tuple(
        (title_of(topic), each.label, found.n, found.mean, found.sd, within(found.interval, SCALE))
        for topic in ratings.topics(purpose, Phase.AFTER)
        for each in ratings.of_topic(purpose, Phase.AFTER, topic)
        for found in [summary(present(each.values))]
    )
    heads = (
        Column("topic", Style.TEXT),
        Column("", Style.TEXT),
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
                kind.id, kind.title, (*topics, Measure("all", kind.all, everything)), setting, SCALE, note
            ),
            means_bars(f"{kind.id}-bars", kind.title, topics, setting),
            Table(f"{kind.id}-single", f"{title}, question by question", heads, single, grouped=True),
        ),
    )
