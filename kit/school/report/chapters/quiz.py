"""What the class got right, and how good the questions are."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from kit.learning.policies.confidence_intervals import wilson_interval
from kit.school.quiz.answers import Outcome
from kit.school.report.chapters.setting import SHARE, Setting, means_bars, means_table, slug, title_of
from kit.school.report.document import (
    Block,
    Caution,
    Cell,
    Chapter,
    Column,
    Histogram,
    Style,
    Table,
    Text,
    chance_text,
)
from kit.school.report.inference import paired_test, present, summary
from kit.school.report.items import ItemAnalysis, analyse, kr20
from kit.school.report.measures import Measure, Quiz
from kit.school.report.normality import shapiro_wilk

BINS: Final = 6
MARKED: Final = "*"


def quiz(setting: Setting) -> Chapter | None:
    """Scores by topic and question, blanks apart from wrong answers, and what changed when asked again."""
    sheet = setting.data.quiz
    if not sheet.items:
        return None
    topics = tuple(
        Measure(topic, title_of(topic), sheet.share(sheet.of_topic(topic))) for topic in sheet.topics
    )
    total = Measure("total", "Total", sheet.score)
    note = "Only a right answer counts; wrong, not sure and blank all count nothing here."
    blocks: list[Block] = [
        means_table("quiz-topics", "Quiz: share of right answers", (*topics, total), setting, SHARE, note),
        means_bars("quiz-topics-bars", "Quiz: share of right answers", (*topics, total), setting, SHARE),
        _outcomes(setting),
        *(_by_question(setting, topic) for topic in sheet.topics),
        _histogram(sheet),
        *_shape(sheet),
        *_again(setting),
        *_bank(setting),
    ]
    return Chapter("quiz", "The quiz", tuple(blocks))


def _outcomes(setting: Setting) -> Table:
    """Of all the answers: how many were what."""
    sheet = setting.data.quiz
    counts = {outcome: sheet.count(outcome) for outcome in Outcome}
    rows: list[tuple[Cell, ...]] = []
    for group in setting.groups:
        sums = [int(np.nansum(counts[outcome][group.members])) for outcome in Outcome]
        taken = int((~np.isnan(sheet.score[group.members])).sum())
        rows.append((group.name, taken, *sums, sum(sums)))
    heads = (
        Column("group", Style.TEXT),
        Column("n"),
        *(Column(each.value) for each in Outcome),
        Column("in all"),
    )
    note = "What was not reached of a quiz that was begun counts as blank."
    return Table("quiz-outcomes", "Answers by what became of them", heads, tuple(rows), note)


def _by_question(setting: Setting, topic: str) -> Table:
    sheet = setting.data.quiz
    rows: list[tuple[Cell, ...]] = []
    for item in sheet.of_topic(topic):
        right = sheet.right(item)
        chance = setting.chance(right)
        for i, group in enumerate(setting.groups):
            replies = [
                each
                for each, inside in zip(sheet.replies[item.id], group.members, strict=True)
                if inside and each is not None
            ]
            counts = [sum(each.outcome is outcome for each in replies) for outcome in Outcome]
            share = counts[0] / len(replies) if replies else None
            p = chance.p if chance is not None and i == len(setting.groups) - 1 else ""
            rows.append(
                (
                    item.id,
                    group.name,
                    len(replies),
                    share,
                    wilson_interval(counts[0], len(replies)) if replies else None,
                    *counts[1:],
                    p,
                )
            )
    heads = (
        Column("question", Style.TEXT),
        Column("group", Style.TEXT),
        Column("n"),
        Column("right"),
        Column("95%"),
        Column("wrong"),
        Column("unsure"),
        Column("blank"),
        Column("p", Style.CHANCE, 3),
    )
    divided = setting.division is not None
    return Table(
        f"quiz-{slug(topic)}",
        f"Questions on {title_of(topic)}",
        heads if divided else heads[:-1],
        tuple(row if divided else row[:-1] for row in rows),
        grouped=True,
    )


def _histogram(sheet: Quiz) -> Histogram:
    edges = np.linspace(0, 1, BINS + 1)
    counts, _ = np.histogram(present(sheet.score), edges)
    return Histogram(
        "quiz-histogram",
        "Students by quiz score",
        tuple(round(float(edge), 2) for edge in edges),
        tuple(int(count) for count in counts),
    )


def _shape(sheet: Quiz) -> Iterator[Block]:
    w, p = shapiro_wilk(sheet.score)
    if p == p:
        n = len(present(sheet.score))
        verdict = (
            "is not what a normal distribution gives" if p < 0.05 else "does not speak against a normal one"
        )
        yield Text(
            f"Shape of the scores: Shapiro and Wilk's W = {w:.3f}, {chance_text(p)}, n = {n}. This {verdict}; with few "
            "students it can hardly tell either way."
        )


def _again(setting: Setting) -> Iterator[Block]:
    """The same items, first and newest answers, of who answered them again."""
    data = setting.data
    if not any(each is not None for row in data.later.replies.values() for each in row):
        yield Text("Nobody has answered a question of the quiz a second time yet: no gain can be told.")
        return
    rows: list[tuple[Cell, ...]] = []
    for topic in (*data.quiz.topics, ""):
        items = data.quiz.of_topic(topic) if topic else data.quiz.items
        first = np.stack([data.quiz.right(item) for item in items])
        later = np.stack([data.later.right(item) for item in items])
        both = ~(np.isnan(first) | np.isnan(later))
        count = both.sum(axis=0)
        some = count > 0
        if not some.any():
            continue
        before = np.where(both, first, 0).sum(axis=0)[some] / count[some]
        after = np.where(both, later, 0).sum(axis=0)[some] / count[some]
        found = summary(after - before)
        chance = paired_test(after - before, np.random.default_rng(setting.seed))
        title = title_of(topic) if topic else "Total"
        rows.append(
            (title, found.n, float(before.mean()), float(after.mean()), found.mean, found.interval, chance.p)
        )
    yield Table(
        "quiz-gain",
        "Gain: first and newest answers to the same questions",
        (
            Column("", Style.TEXT),
            Column("n"),
            Column("first"),
            Column("newest"),
            Column("gain"),
            Column("95% of gain"),
            Column("p", Style.CHANCE, 3),
        ),
        tuple(rows),
        "Only questions that a student answered more than once.",
    )


def _bank(setting: Setting) -> Iterator[Block]:
    """The questions that lessons and repetition ask: each as often as it was answered."""
    bank = setting.data.bank
    rows: list[tuple[Cell, ...]] = []
    for item in bank.items:
        replies = [each for each in bank.replies[item.id] if each is not None]
        counts = [sum(each.outcome is outcome for each in replies) for outcome in Outcome]
        share = counts[0] / len(replies) if replies else None
        rows.append(
            (
                title_of(item.topic),
                item.id,
                len(replies),
                share,
                wilson_interval(counts[0], len(replies)),
                *counts[1:],
            )
        )
    if rows:
        yield Table(
            "bank",
            "Questions of the lessons, first answers",
            (
                Column("topic", Style.TEXT),
                Column("question", Style.TEXT),
                Column("n"),
                Column("right"),
                Column("95%"),
                Column("wrong"),
                Column("unsure"),
                Column("blank"),
            ),
            tuple(rows),
            grouped=True,
        )


def items(setting: Setting) -> Chapter | None:
    """Item analysis: difficulty, item-rest correlation, distractors, KR-20."""
    sheet = setting.data.quiz
    if not sheet.items:
        return None
    found = [analyse(sheet, item) for item in sheet.items]
    reliability = kr20(sheet)
    blanks = int(np.nansum(sheet.count(Outcome.BLANK)))
    blocks: list[Block] = [_difficulties(found), _distractors(found)]
    blocks += [Caution(f"{each.item.id}: {'; '.join(each.cautions)}.") for each in found if each.cautions]
    if reliability == reliability:
        inflated = " Blanks go together and make it look better than it is." if blanks else ""
        blocks.append(
            Text(
                f"KR-20 = {reliability:.2f}: how consistently the {len(found)} questions measure one thing "
                f"(0.7 and more is usual for comparing groups). {blanks} of the answers are blank.{inflated}"
            )
        )
    blocks += [block for each in found for block in _texts(each)]
    return Chapter("items", "The questions themselves", tuple(blocks))


def _difficulties(found: list[ItemAnalysis]) -> Table:
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (
            title_of(each.item.topic),
            each.item.id,
            each.n,
            each.difficulty,
            each.interval,
            each.with_rest,
        )
        for each in found
    )
    heads = (
        Column("topic", Style.TEXT),
        Column("question", Style.TEXT),
        Column("n"),
        Column("right"),
        Column("95%"),
        Column("with rest r"),
    )
    return Table(
        "items", "How hard each question is, and how it goes with the rest", heads, rows, grouped=True
    )


def _distractors(found: list[ItemAnalysis]) -> Table:
    most = max((max((*each.chosen, len(each.item.options) - 1, 0)) for each in found), default=0) + 1
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (
            title_of(each.item.topic),
            each.item.id,
            *(
                f"{each.chosen.get(option, 0)}{MARKED if option in each.keys else ' '}"
                for option in range(most)
            ),
            each.outcomes[Outcome.NOT_SURE],
            each.outcomes[Outcome.BLANK],
        )
        for each in found
    )
    heads = (
        Column("topic", Style.TEXT),
        Column("question", Style.TEXT),
        *(Column(f"{option + 1}") for option in range(most)),
        Column("unsure"),
        Column("blank"),
    )
    note = (
        f"{MARKED} counted as right. A wrong option that nobody takes can go; one that many take is a lesson."
    )
    return Table("distractors", "Who chose which option", heads, rows, note, grouped=True)


def _texts(each: ItemAnalysis) -> Iterator[Block]:
    """The options in words, of items that need a look."""
    if not each.cautions or not each.item.options:
        return
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (f"{number + 1}{MARKED if number in each.keys else ''}", text, each.chosen.get(number, 0))
        for number, text in enumerate(each.item.options)
    )
    heads = (Column("", Style.TEXT), Column("option", Style.TEXT), Column("chose it"))
    yield Table(f"item-{slug(each.item.id)}", f"{each.item.id}: the options", heads, rows)
