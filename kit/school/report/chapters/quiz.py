"""Chapters on the quiz: scores, and the analysis of its questions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from kit.learning.policies.confidence_intervals import wilson_interval
from kit.school.quiz.schedule import AnswerOutcome
from kit.school.report.chapters.context import (
    SHARE_BOUNDS,
    ReportContext,
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
    p_value_text,
)
from kit.school.report.inference import non_blank, paired_test, shapiro_wilk, summary_statistics
from kit.school.report.measures import AnswerSheet, ItemAnalysis, StudentMeasure, analyse_item, kr20

BINS: Final = 6
RIGHT_MARK: Final = "*"
OUTCOME_COLUMNS: Final = tuple(map(TableColumn, ("n", "right", "95%", "wrong", "unsure", "blank")))


def quiz_chapter(context: ReportContext) -> ReportChapter | None:
    """The chapter on the quiz: scores by topic and question, blanks apart from wrong answers, and gains."""
    answers = context.data.quiz
    if not answers.items:
        return None
    topics = tuple(
        StudentMeasure(topic, topic_title(topic), answers.share_right(answers.topic_items(topic)))
        for topic in answers.topics
    )
    total = StudentMeasure("total", "Total", answers.scores)
    note = "Only a right answer counts; wrong, not sure and blank all count nothing here."
    blocks: list[ReportBlock] = [
        means_table(
            "quiz-topics", "Quiz: share of right answers", (*topics, total), context, SHARE_BOUNDS, note
        ),
        means_bars(
            "quiz-topics-bars", "Quiz: share of right answers", (*topics, total), context, SHARE_BOUNDS
        ),
        _outcome_table(context),
        *(_question_table(context, topic) for topic in answers.topics),
        _score_histogram(answers),
        *_normality_blocks(answers),
        *_gain_blocks(context),
        *_bank_blocks(context),
    ]
    return ReportChapter("quiz", "The quiz", tuple(blocks))


def _outcome_table(context: ReportContext) -> ReportTable:
    """Number of answers by outcome."""
    answers = context.data.quiz
    counts = {outcome: answers.outcome_counts(outcome) for outcome in AnswerOutcome}
    rows: list[tuple[TableCell, ...]] = []
    for group in context.groups:
        sums = [int(np.nansum(counts[outcome][group.members])) for outcome in AnswerOutcome]
        taken = int((~np.isnan(answers.scores[group.members])).sum())
        rows.append((group.name, taken, *sums, sum(sums)))
    heads = (
        TableColumn("group", CellStyle.TEXT),
        TableColumn("n"),
        *(TableColumn(each.value) for each in AnswerOutcome),
        TableColumn("in all"),
    )
    note = "What was not reached of a quiz that was begun counts as blank."
    return ReportTable("quiz-outcomes", "Answers by what became of them", heads, tuple(rows), note)


def _question_table(context: ReportContext, topic: str) -> ReportTable:
    answers = context.data.quiz
    rows: list[tuple[TableCell, ...]] = []
    for item in answers.topic_items(topic):
        right = answers.correctness(item)
        test = context.group_difference_test(right)
        for i, group in enumerate(context.groups):
            replies = [
                each
                for each, inside in zip(answers.replies[item.id], group.members, strict=True)
                if inside and each is not None
            ]
            counts = [sum(each.outcome is outcome for each in replies) for outcome in AnswerOutcome]
            share = counts[0] / len(replies) if replies else None
            p = test.p_value if test is not None and i == len(context.groups) - 1 else ""
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
        TableColumn("question", CellStyle.TEXT),
        TableColumn("group", CellStyle.TEXT),
        *OUTCOME_COLUMNS,
        TableColumn("p", CellStyle.P_VALUE, 3),
    )
    divided = context.division is not None
    return ReportTable(
        f"quiz-{file_name_part(topic)}",
        f"Questions on {topic_title(topic)}",
        heads if divided else heads[:-1],
        tuple(row if divided else row[:-1] for row in rows),
        grouped=True,
    )


def _score_histogram(answers: AnswerSheet) -> Histogram:
    edges = np.linspace(0, 1, BINS + 1)
    counts, _ = np.histogram(non_blank(answers.scores), edges)
    return Histogram(
        "quiz-histogram",
        "Students by quiz score",
        tuple(round(float(edge), 2) for edge in edges),
        tuple(int(count) for count in counts),
    )


def _normality_blocks(answers: AnswerSheet) -> Iterator[ReportBlock]:
    w, p = shapiro_wilk(answers.scores)
    if p == p:
        n = len(non_blank(answers.scores))
        verdict = (
            "is not what a normal distribution gives" if p < 0.05 else "does not speak against a normal one"
        )
        yield ReportText(
            f"Shape of the scores: Shapiro and Wilk's W = {w:.3f}, {p_value_text(p)}, n = {n}. This {verdict}; with few "
            "students it can hardly tell either way."
        )


def _gain_blocks(context: ReportContext) -> Iterator[ReportBlock]:
    """The gain from first to newest answers, of students who answered items again."""
    data = context.data
    if not any(each is not None for row in data.later_quiz.replies.values() for each in row):
        yield ReportText("Nobody has answered a question of the quiz a second time yet: no gain can be told.")
        return
    rows: list[tuple[TableCell, ...]] = []
    for topic in (*data.quiz.topics, ""):
        items = data.quiz.topic_items(topic) if topic else data.quiz.items
        first = np.stack([data.quiz.correctness(item) for item in items])
        later = np.stack([data.later_quiz.correctness(item) for item in items])
        both = ~(np.isnan(first) | np.isnan(later))
        count = both.sum(axis=0)
        some = count > 0
        if not some.any():
            continue
        before = np.where(both, first, 0).sum(axis=0)[some] / count[some]
        after = np.where(both, later, 0).sum(axis=0)[some] / count[some]
        stats = summary_statistics(after - before)
        test = paired_test(after - before, np.random.default_rng(context.seed))
        title = topic_title(topic) if topic else "Total"
        rows.append(
            (
                title,
                stats.n,
                float(before.mean()),
                float(after.mean()),
                stats.mean,
                stats.interval,
                test.p_value,
            )
        )
    yield ReportTable(
        "quiz-gain",
        "Gain: first and newest answers to the same questions",
        (
            TableColumn("", CellStyle.TEXT),
            TableColumn("n"),
            TableColumn("first"),
            TableColumn("newest"),
            TableColumn("gain"),
            TableColumn("95% of gain"),
            TableColumn("p", CellStyle.P_VALUE, 3),
        ),
        tuple(rows),
        "Only questions that a student answered more than once.",
    )


def _bank_blocks(context: ReportContext) -> Iterator[ReportBlock]:
    """The questions that lessons and practice ask."""
    bank = context.data.bank
    rows: list[tuple[TableCell, ...]] = []
    for item in bank.items:
        replies = [each for each in bank.replies[item.id] if each is not None]
        counts = [sum(each.outcome is outcome for each in replies) for outcome in AnswerOutcome]
        share = counts[0] / len(replies) if replies else None
        rows.append(
            (
                topic_title(item.topic),
                item.id,
                len(replies),
                share,
                wilson_interval(counts[0], len(replies)),
                *counts[1:],
            )
        )
    if rows:
        yield ReportTable(
            "bank",
            "Questions of the lessons, first answers",
            (
                TableColumn("topic", CellStyle.TEXT),
                TableColumn("question", CellStyle.TEXT),
                *OUTCOME_COLUMNS,
            ),
            tuple(rows),
            grouped=True,
        )


def items_chapter(context: ReportContext) -> ReportChapter | None:
    """The chapter of item analysis: difficulty, item-rest correlation, distractors, KR-20."""
    answers = context.data.quiz
    if not answers.items:
        return None
    analyses = [analyse_item(answers, item) for item in answers.items]
    reliability = kr20(answers)
    blanks = int(np.nansum(answers.outcome_counts(AnswerOutcome.BLANK)))
    blocks: list[ReportBlock] = [_difficulty_table(analyses), _distractor_table(analyses)]
    blocks += [
        ReportWarning(f"{each.item.id}: {'; '.join(each.warnings)}.") for each in analyses if each.warnings
    ]
    if reliability == reliability:
        inflated = " Blanks go together and make it look better than it is." if blanks else ""
        blocks.append(
            ReportText(
                f"KR-20 = {reliability:.2f}: how consistently the {len(analyses)} questions measure one thing "
                f"(0.7 and more is usual for comparing groups). {blanks} of the answers are blank.{inflated}"
            )
        )
    blocks += [block for each in analyses for block in _option_text_blocks(each)]
    return ReportChapter("items", "The questions themselves", tuple(blocks))


def _difficulty_table(analyses: list[ItemAnalysis]) -> ReportTable:
    rows: tuple[tuple[TableCell, ...], ...] = tuple(
        (
            topic_title(each.item.topic),
            each.item.id,
            each.n,
            each.difficulty,
            each.interval,
            each.rest_correlation,
        )
        for each in analyses
    )
    heads = (
        TableColumn("topic", CellStyle.TEXT),
        TableColumn("question", CellStyle.TEXT),
        TableColumn("n"),
        TableColumn("right"),
        TableColumn("95%"),
        TableColumn("with rest r"),
    )
    return ReportTable(
        "items", "How hard each question is, and how it goes with the rest", heads, rows, grouped=True
    )


def _distractor_table(analyses: list[ItemAnalysis]) -> ReportTable:
    most = (
        max((max((*each.choice_counts, len(each.item.options) - 1, 0)) for each in analyses), default=0) + 1
    )
    rows: tuple[tuple[TableCell, ...], ...] = tuple(
        (
            topic_title(each.item.topic),
            each.item.id,
            *(
                f"{each.choice_counts.get(option, 0)}{RIGHT_MARK if option in each.right_options else ' '}"
                for option in range(most)
            ),
            each.outcomes[AnswerOutcome.NOT_SURE],
            each.outcomes[AnswerOutcome.BLANK],
        )
        for each in analyses
    )
    heads = (
        TableColumn("topic", CellStyle.TEXT),
        TableColumn("question", CellStyle.TEXT),
        *(TableColumn(f"{option + 1}") for option in range(most)),
        TableColumn("unsure"),
        TableColumn("blank"),
    )
    note = f"{RIGHT_MARK} counted as right. A wrong option that nobody takes can go; one that many take is a lesson."
    return ReportTable("distractors", "Who chose which option", heads, rows, note, grouped=True)


def _option_text_blocks(each: ItemAnalysis) -> Iterator[ReportBlock]:
    """The texts of the options, for items with warnings."""
    if not each.warnings or not each.item.options:
        return
    rows: tuple[tuple[TableCell, ...], ...] = tuple(
        (
            f"{number + 1}{RIGHT_MARK if number in each.right_options else ''}",
            text,
            each.choice_counts.get(number, 0),
        )
        for number, text in enumerate(each.item.options)
    )
    heads = (TableColumn("", CellStyle.TEXT), TableColumn("option", CellStyle.TEXT), TableColumn("chose it"))
    yield ReportTable(f"item-{file_name_part(each.item.id)}", f"{each.item.id}: the options", heads, rows)
