"""Chapters on work in the lessons, on free-text answers, and on the quiz and its questions."""

from __future__ import annotations

from collections.abc import Iterator
from statistics import median
from typing import Final

import numpy as np

from kit.document.blocks import (
    Block,
    Caution,
    Cell,
    CellStyle,
    Chapter,
    Column,
    Histogram,
    Quote,
    Table,
    Text,
    p_value_text,
)
from kit.learning.policies.confidence_intervals import wilson_interval
from kit.school.quiz.answers import AnswerOutcome
from kit.school.report.chapters.context import (
    SHARE_BOUNDS,
    ReportContext,
    file_name_part,
    means_bars,
    means_table,
    topic_title,
)
from kit.school.report.class_data import MAX_IDLE, ExerciseWork, LessonWork, started_lessons
from kit.school.report.inference import non_blank, paired_test, summary_statistics
from kit.school.report.item_analysis import ItemAnalysis, analyse_item, kr20
from kit.school.report.measures import AnswerSheet, StudentMeasure
from kit.school.report.normality import shapiro_wilk

MAX_NAMED_CRITERIA: Final = 2
"""Largest number of lost criteria named for an exercise."""


def lessons_chapter(context: ReportContext) -> Chapter | None:
    """The chapter on attempts, points and time."""
    work = context.data.work
    names = started_lessons(work)
    if not names:
        return None
    by_lesson = {name: [each[name] for each in work if name in each] for name in names}
    tables = (_lesson_table(by_lesson), _exercise_table(by_lesson), _student_table(context))
    blocks: list[Block] = [table for table in tables if table.rows]
    minutes = int(MAX_IDLE.total_seconds() // 60)
    blocks.append(
        Text(
            f"Time is measured between two entries of a lesson; more than {minutes} minutes without one count as a "
            "pause. Points are the best attempt's. Attempts whose check broke are not counted."
        )
    )
    return Chapter("lessons", "Lessons", tuple(blocks))


def _lesson_table(by_lesson: dict[str, list[LessonWork]]) -> Table:
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (
            name,
            len(some),
            float(median(len(each.steps) for each in some)),
            sum(each.attempt_count for each in some),
            _ratio(sum(each.points for each in some), sum(each.max_points for each in some)),
            _ratio(sum(each.predicted_right for each in some), sum(each.predictions for each in some)),
            sum(each.hint_count for each in some),
            float(median(each.minutes for each in some)),
        )
        for name, some in by_lesson.items()
    )
    heads = (
        Column("lesson", CellStyle.TEXT),
        Column("began"),
        Column("steps", decimals=1),
        Column("attempts"),
        Column("points"),
        Column("predicted"),
        Column("hints"),
        Column("minutes", decimals=1),
    )
    note = "steps, minutes: the median student's. points: of those that were tried for. predicted: rightly."
    return Table("lessons", "By lesson", heads, rows, note)


def _exercise_table(by_lesson: dict[str, list[LessonWork]]) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for lesson, some in by_lesson.items():
        for name in dict.fromkeys(key for each in some for key in each.exercises):
            done = [each.exercises[name] for each in some if name in each.exercises]
            tried = [each for each in done if each.attempts]
            passing = [each.tries_to_pass for each in tried if each.tries_to_pass is not None]
            rows.append(
                (
                    f"{lesson}/{name}",
                    len(tried),
                    len(passing),
                    float(median(passing)) if passing else None,
                    _ratio(sum(each.points for each in tried), sum(each.max_points for each in tried)),
                    sum(each.has_seen_solution for each in done),
                    _most_lost(tried),
                )
            )
    heads = (
        Column("exercise", CellStyle.TEXT),
        Column("tried"),
        Column("passed"),
        Column("at try", decimals=1),
        Column("points"),
        Column("solution"),
        Column("lost most", CellStyle.TEXT),
    )
    note = (
        "at try: the median of who passed. solution: opened. lost most: criteria, and by how many students "
        "they were lost at least once."
    )
    return Table("exercises", "By exercise", heads, tuple(rows), note)


def _most_lost(tried: list[ExerciseWork]) -> str:
    counts: dict[str, int] = {}
    for each in tried:
        for criterion in each.lost_criteria:
            counts[criterion] = counts.get(criterion, 0) + 1
    most = sorted(counts.items(), key=lambda pair: (-pair[1], pair[0]))[:MAX_NAMED_CRITERIA]
    return ", ".join(f"{name} {count}" for name, count in most)


def _student_table(context: ReportContext) -> Table:
    data = context.data
    counts = (
        {outcome: data.quiz.outcome_counts(outcome) for outcome in AnswerOutcome} if data.quiz.items else {}
    )
    rows: list[tuple[Cell, ...]] = []
    for i, name in enumerate(data.names):
        work = data.work[i].values()
        taken = bool(counts) and not np.isnan(counts[AnswerOutcome.RIGHT][i])
        rows.append(
            (
                name,
                len(work),
                sum(each.passed_count for each in work),
                f"{sum(each.defended_count for each in work)}/{sum(each.defence_count for each in work)}",
                sum(each.attempt_count for each in work),
                float(sum(each.points for each in work)),
                sum(each.hint_count for each in work),
                float(sum(each.minutes for each in work)),
                "/".join(f"{counts[outcome][i]:.0f}" for outcome in AnswerOutcome) if taken else None,
            )
        )
    heads = (
        Column("student", CellStyle.TEXT),
        Column("lessons"),
        Column("passed"),
        Column("defended"),
        Column("attempts"),
        Column("points", decimals=1),
        Column("hints"),
        Column("minutes", decimals=0),
        Column("quiz"),
    )
    note = (
        "quiz: right/wrong/not sure/blank. passed: exercises. defended: of which every question about the own program "
        "was right at once, and how often it was asked."
    )
    return Table("students", "By student", heads, tuple(rows), note)


def _ratio(part: float, whole: float) -> float | None:
    return part / whole if whole else None


def free_text_chapter(context: ReportContext) -> Chapter | None:
    """The chapter of free-text answers, question by question, unchanged."""
    blocks: list[Block] = []
    question_id = ""
    for each in context.data.free_text_answers:
        if each.question.id != question_id:
            question_id = each.question.id
            blocks.append(Text(each.question.text))
        blocks.append(Quote(each.student, each.text))
    return Chapter("words", "In their own words", tuple(blocks)) if blocks else None


BINS: Final = 6
RIGHT_MARK: Final = "*"
OUTCOME_COLUMNS: Final = tuple(map(Column, ("n", "right", "95%", "wrong", "unsure", "blank")))


def quiz_chapter(context: ReportContext) -> Chapter | None:
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
    blocks: list[Block] = [
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
    return Chapter("quiz", "The quiz", tuple(blocks))


def _outcome_table(context: ReportContext) -> Table:
    """Number of answers by outcome."""
    answers = context.data.quiz
    counts = {outcome: answers.outcome_counts(outcome) for outcome in AnswerOutcome}
    rows: list[tuple[Cell, ...]] = []
    for group in context.groups:
        sums = [int(np.nansum(counts[outcome][group.members])) for outcome in AnswerOutcome]
        taken = int((~np.isnan(answers.scores[group.members])).sum())
        rows.append((group.name, taken, *sums, sum(sums)))
    heads = (
        Column("group", CellStyle.TEXT),
        Column("n"),
        *(Column(each.value) for each in AnswerOutcome),
        Column("in all"),
    )
    note = "What was not reached of a quiz that was begun counts as blank."
    return Table("quiz-outcomes", "Answers by what became of them", heads, tuple(rows), note)


def _question_table(context: ReportContext, topic: str) -> Table:
    answers = context.data.quiz
    rows: list[tuple[Cell, ...]] = []
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
        Column("question", CellStyle.TEXT),
        Column("group", CellStyle.TEXT),
        *OUTCOME_COLUMNS,
        Column("p", CellStyle.P_VALUE, 3),
    )
    divided = context.division is not None
    return Table(
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


def _normality_blocks(answers: AnswerSheet) -> Iterator[Block]:
    w, p = shapiro_wilk(answers.scores)
    if p == p:
        n = len(non_blank(answers.scores))
        verdict = (
            "is not what a normal distribution gives" if p < 0.05 else "does not speak against a normal one"
        )
        yield Text(
            f"Shape of the scores: Shapiro and Wilk's W = {w:.3f}, {p_value_text(p)}, n = {n}. This {verdict}; with few "
            "students it can hardly tell either way."
        )


def _gain_blocks(context: ReportContext) -> Iterator[Block]:
    """The gain from first to newest answers, of students who answered items again."""
    data = context.data
    if not any(each is not None for row in data.later_quiz.replies.values() for each in row):
        yield Text("Nobody has answered a quiz question a second time yet, so the gain is unknown.")
        return
    rows: list[tuple[Cell, ...]] = []
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
    yield Table(
        "quiz-gain",
        "Gain: first and newest answers to the same questions",
        (
            Column("", CellStyle.TEXT),
            Column("n"),
            Column("first"),
            Column("newest"),
            Column("gain"),
            Column("95% of gain"),
            Column("p", CellStyle.P_VALUE, 3),
        ),
        tuple(rows),
        "Only questions that a student answered more than once.",
    )


def _bank_blocks(context: ReportContext) -> Iterator[Block]:
    """The questions that lessons and practice ask."""
    bank = context.data.bank
    rows: list[tuple[Cell, ...]] = []
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
        yield Table(
            "bank",
            "Questions of the lessons, first answers",
            (
                Column("topic", CellStyle.TEXT),
                Column("question", CellStyle.TEXT),
                *OUTCOME_COLUMNS,
            ),
            tuple(rows),
            grouped=True,
        )


def items_chapter(context: ReportContext) -> Chapter | None:
    """The chapter of item analysis: difficulty, item-rest correlation, distractors, KR-20."""
    answers = context.data.quiz
    if not answers.items:
        return None
    analyses = [analyse_item(answers, item) for item in answers.items]
    reliability = kr20(answers)
    blanks = int(np.nansum(answers.outcome_counts(AnswerOutcome.BLANK)))
    blocks: list[Block] = [_difficulty_table(analyses), _distractor_table(analyses)]
    blocks += [Caution(f"{each.item.id}: {'; '.join(each.warnings)}.") for each in analyses if each.warnings]
    if reliability == reliability:
        inflated = " Blanks go together and make it look better than it is." if blanks else ""
        blocks.append(
            Text(
                f"KR-20 = {reliability:.2f}: how consistently the {len(analyses)} questions measure one thing "
                f"(0.7 and more is usual for comparing groups). {blanks} of the answers are blank.{inflated}"
            )
        )
    blocks += [block for each in analyses for block in _option_text_blocks(each)]
    return Chapter("items", "The questions themselves", tuple(blocks))


def _difficulty_table(analyses: list[ItemAnalysis]) -> Table:
    rows: tuple[tuple[Cell, ...], ...] = tuple(
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
        Column("topic", CellStyle.TEXT),
        Column("question", CellStyle.TEXT),
        Column("n"),
        Column("right"),
        Column("95%"),
        Column("with rest r"),
    )
    return Table(
        "items", "How hard each question is, and how it goes with the rest", heads, rows, grouped=True
    )


def _distractor_table(analyses: list[ItemAnalysis]) -> Table:
    most = (
        max((max((*each.choice_counts, len(each.item.options) - 1, 0)) for each in analyses), default=0) + 1
    )
    rows: tuple[tuple[Cell, ...], ...] = tuple(
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
        Column("topic", CellStyle.TEXT),
        Column("question", CellStyle.TEXT),
        *(Column(f"{option + 1}") for option in range(most)),
        Column("unsure"),
        Column("blank"),
    )
    note = f"{RIGHT_MARK} counted as right. A wrong option that nobody takes can go; one that many take is a lesson."
    return Table("distractors", "Who chose which option", heads, rows, note, grouped=True)


def _option_text_blocks(each: ItemAnalysis) -> Iterator[Block]:
    """The texts of the options, for items with warnings."""
    if not each.warnings or not each.item.options:
        return
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (
            f"{number + 1}{RIGHT_MARK if number in each.right_options else ''}",
            text,
            each.choice_counts.get(number, 0),
        )
        for number, text in enumerate(each.item.options)
    )
    heads = (Column("", CellStyle.TEXT), Column("option", CellStyle.TEXT), Column("chose it"))
    yield Table(f"item-{file_name_part(each.item.id)}", f"{each.item.id}: the options", heads, rows)
