"""What the quiz says: feedback, scores by topic, calibration of confidence and the schedule, as blocks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from datetime import date
from typing import Final

from kit.document.blocks import Block, CellStyle, Column, Picture, Table, Text, Tone, ToneText
from kit.school.lessons.reading import lesson_number, lesson_title
from kit.school.quiz.answers import CONFIDENCE_LABELS, AnswerChoice, AnswerOutcome, QuizAnswer
from kit.school.quiz.items import (
    QuestionBank,
    QuizItem,
    QuizTopic,
    lesson_command,
)
from kit.school.quiz.quiz_scores import (
    CALIBRATED_GAP,
    MIN_ANSWERS,
    Calibration,
    OutcomeCounts,
    count_by_topic,
    count_outcomes,
    latest_answers,
    measure_calibration,
)
from kit.school.quiz.quiz_session import QuizRoundPlan, QuizSession, quiz_plan
from kit.school.quiz.schedule import PracticeSchedule, RoundHistory

BAR: Final = 20
"""Width of a bar in columns."""
MAP_BAR: Final = 10
"""Columns of a topic's bar on the map of topics."""

VERDICTS: Final[Mapping[AnswerOutcome, str]] = {
    AnswerOutcome.RIGHT: "Right.",
    AnswerOutcome.WRONG: "Not right: option {} is.",
    AnswerOutcome.NOT_SURE: "Good to know, and not counted as wrong. Option {} is right.",
    AnswerOutcome.BLANK: "Left blank. Option {} is right.",
}
CALIBRATION_HEADING: Final = "How sure, and how often right"
CONFIDENCE_QUESTION: Final = "How sure are you?"
CONFIDENCE_CHOICES: Final = tuple(CONFIDENCE_LABELS.items())
_WORDS: Final = CellStyle.TEXT


def verdict_text(item: QuizItem, choice: AnswerChoice) -> str:
    """States whether the choice is right, and which option is."""
    return VERDICTS[choice.outcome_for(item)].format(item.right_option + 1)


def feedback_text(item: QuizItem, choice: AnswerChoice) -> str:
    """Feedback for the chosen option; for no choice, that of the right option."""
    return item.options[item.right_option if choice.option is None else choice.option].feedback


def follow_up_blocks(item: QuizItem) -> list[Block]:
    """The lesson to repeat and the command to try."""
    folder, _, step = item.lesson_to_repeat.partition("/")
    place = f"lesson {lesson_number(folder)}{step and f', step {step}'}"
    parts = [(f"See {place}:", lesson_command(folder))]
    parts += [("Try:", item.command_to_try)] if item.command_to_try else []
    return [Text(words, Tone.DIM, tail=f" {command}", hang=2, is_tight=True) for words, command in parts]


def days_text(day: date, today: date) -> str:
    """A day relative to today: ``today``, ``tomorrow``, ``in 3 days``."""
    days = (day - today).days
    return "today" if days <= 0 else "tomorrow" if days == 1 else f"in {days} days"


def schedule_blocks(schedule: PracticeSchedule) -> list[Block]:
    """The schedule: for every topic the number of questions today, or the next day."""
    if not schedule.topics:
        return [Text("Nothing is scheduled yet: a topic comes back the day after its first question.")]
    rows = []
    for each in schedule.topics:
        left = each.questions_left(schedule.today)
        words = f"{left} due today" if left else f"again {days_text(each.due, schedule.today)}"
        rows.append((each.topic.label, words))
    blocks: list[Block] = [
        Table("schedule", "", (Column("", _WORDS), Column("", _WORDS)), tuple(rows), is_tight=True)
    ]
    if schedule.practice_days:
        count = len(schedule.practice_days)
        blocks.append(Text(f"Days with a practice finished: {count}. Each day counts once.", is_tight=True))
    return blocks


def today_line(schedule: PracticeSchedule) -> str:
    """The questions due today, in one sentence."""
    due = [
        (each.topic.label, left) for each in schedule.topics if (left := each.questions_left(schedule.today))
    ]
    if due:
        return "Due today: " + ", ".join(f"{left} from {title}" for title, left in due) + "."
    if schedule.next_due is not None:
        return f"Nothing is due today. Next: {days_text(schedule.next_due, schedule.today)}."
    return "Nothing is scheduled yet: begin with the twelve, `kit quiz`."


def tally_line(counts: OutcomeCounts) -> str:
    """Counts of outcomes in words, without those that are zero."""
    parts = [f"{counts.right} of {counts.total} right"]
    for count, words in (
        (counts.wrong, "wrong"),
        (counts.not_sure, "not sure"),
        (counts.blank, "blank"),
        (counts.not_asked, "not asked yet"),
    ):
        if count:
            parts.append(f"{count} {words}")
    return ", ".join(parts)


def topic_table(scores: Mapping[QuizTopic, OutcomeCounts]) -> Table:
    """A table with one row per topic."""
    columns = (
        Column("", _WORDS),
        Column("questions"),
        Column("right"),
        Column("wrong"),
        Column("not sure"),
        Column("blank"),
        Column("not asked", is_optional=True),
    )
    rows = tuple(
        (topic.label, t.total, t.right, t.wrong, t.not_sure, t.blank, t.not_asked)
        for topic, t in scores.items()
    )
    return Table("topics", "", columns, rows, is_ruled=False)


def lesson_table(bank: QuestionBank, answers: Iterable[QuizAnswer]) -> Table:
    """What is known of the questions of each lesson, by the latest answer to each."""
    latest = latest_answers(answers)
    rows = tuple(
        (lesson_number(lesson), lesson_title(lesson), _bar(counts), f"{counts.right} of {counts.total}")
        for lesson in bank.lessons
        for counts in (count_outcomes(bank.lesson_items(lesson), latest),)
    )
    return Table("lessons", "", (Column("", _WORDS),) * 3 + (Column(""),), rows)


def _bar(counts: OutcomeCounts) -> str:
    """The share of right answers."""
    filled = round(MAP_BAR * counts.right / counts.total)
    return "━" * filled + "─" * (MAP_BAR - filled)


def topic_map(bank: QuestionBank, answers: Iterable[QuizAnswer], current: QuizTopic | None = None) -> Table:
    """What is known of each topic, by the latest answer to each of its questions, and which one is asked now, if any."""
    counts = count_by_topic(bank.items, latest_answers(answers))
    rows = tuple(
        (
            ">" if topic is current else "",
            ToneText(topic.label, Tone.BOLD if topic is current else Tone.PLAIN),
            _bar(each),
            f"{each.right} of {each.total}",
        )
        for topic, each in counts.items()
    )
    return Table("topic-map", "", (Column("", _WORDS),) * 3 + (Column(""),), rows)


MARKS: Final = {
    AnswerOutcome.RIGHT: "+",
    AnswerOutcome.WRONG: "x",
    AnswerOutcome.NOT_SURE: "0",
    AnswerOutcome.BLANK: "-",
}
"""A question's mark, by how it was answered."""


def round_blocks(session: QuizSession, number: int) -> tuple[Block, ...]:
    """A mark for each question of a session: how it was answered, which one is asked, which are to come."""
    answered = session.question_number - 1
    latest = [MARKS[each.outcome] for each in session.session_answers][-answered:] if answered else []
    marks = ["*"] * (answered - len(latest)) + latest
    marks += ["."] * (max(number, session.question_count) - len(marks))
    if number > answered:
        marks[number - 1] = ">"
    said = [*(["* answered before"] if "*" in marks else []), "+ right  x wrong  0 not sure  - blank"]
    return Text(" ".join(marks), Tone.BOLD), Picture(tuple(said), indent=0, tone=Tone.DIM, is_tight=True)


def answered_blocks(
    bank: QuestionBank, answers: Sequence[QuizAnswer], *, has_reasons: bool = False
) -> tuple[Block, ...]:
    """The questions that were answered, the last one first, each with the right answer where another one was given, and perhaps
    with the reason."""
    items, blocks = bank.items_by_id(), list[Block]()
    for each in reversed(answers):
        item = items.get(each.item)
        if item is None:
            continue
        blocks.append(Text(item.question, Tone.DIM, lead=MARKS[each.outcome], hang=2, is_tight=True))
        right = item.options[item.right_option]
        if has_reasons or each.outcome is not AnswerOutcome.RIGHT:
            blocks.append(Text(right.text, lead=MARKS[AnswerOutcome.RIGHT], indent=2, hang=2, is_tight=True))
        if has_reasons:
            blocks.append(Text(right.feedback, Tone.DIM, indent=4, is_tight=True))
    return tuple(blocks)


def calibration_blocks(calibration: Calibration) -> list[Block]:
    """Confidence against the share of right answers, one row per level."""
    if not calibration.answers:
        return [Text("You have not yet said how sure you were of any answer.", is_tight=True)]
    rows = []
    for level in calibration.levels:
        share = level.right / level.answers if level.answers else 0.0
        result = f"{level.right} of {level.answers}" if level.answers else "-"
        rows.append((CONFIDENCE_LABELS[level.confidence], result, "━" * round(BAR * share)))
    columns = (Column("", _WORDS), Column(""), Column("", _WORDS))
    return [
        Table("calibration", "", columns, tuple(rows), is_tight=True),
        Text(_calibration_summary(calibration), is_tight=True),
    ]


def _calibration_summary(calibration: Calibration) -> str:
    if calibration.answers < MIN_ANSWERS:
        return f"After {MIN_ANSWERS} such answers this says how well you judge yourself."
    expected, actual = 100 * calibration.expected_share, 100 * calibration.actual_share
    figures = f"{expected:.0f} % expected, {actual:.0f} % right"
    gap = calibration.expected_share - calibration.actual_share
    if abs(gap) < CALIBRATED_GAP:
        return f"You judge yourself well: {figures}."
    return f"You were too sure: {figures}." if gap > 0 else f"You know more than you think: {figures}."


def round_lines(history: RoundHistory) -> list[str]:
    """The result of the last round, and of the first one."""
    lines = [tally_line(count_outcomes(history.items, history.last))]
    if len(history.finished) > 1:
        lines.append(f"The first time: {tally_line(count_outcomes(history.items, history.finished[0]))}.")
    return lines


def closing_blocks(session: QuizSession) -> list[Block]:
    """The end of a session: results by topic, calibration, and what comes next."""
    plan = session.plan
    answers = session.all_answers()
    blocks: list[Block] = []
    if isinstance(plan, QuizRoundPlan):
        history = plan.history(answers)
        scores = count_by_topic(plan.items, history.last)
        first, *rest = round_lines(history)
        blocks += [Text(f"{plan.title}: {first}."), *(Text(each, is_tight=True) for each in rest)]
        answered: Iterable[QuizAnswer] = history.last.values()
    else:
        items = _answered_items(session.bank, session.session_answers)
        scores = count_by_topic(items, latest_answers(session.session_answers))
        if items:
            blocks.append(
                Text(
                    f"Practised: {tally_line(count_outcomes(items, latest_answers(session.session_answers)))}."
                )
            )
        answered = session.session_answers
    if len(scores) > 1:
        blocks.append(topic_table(scores))
    blocks += [Text(f"{CALIBRATION_HEADING}:"), *calibration_blocks(measure_calibration(answered))]
    return [*blocks, Text(today_line(session.build_schedule()))]


def restart_line(plan: QuizRoundPlan) -> str:
    """The command that repeats a finished round."""
    return f"`{plan.command} --again` asks {'them' if len(plan.items) > 1 else 'it'} again."


def scores_blocks(
    bank: QuestionBank, answers: Sequence[QuizAnswer], schedule: PracticeSchedule
) -> list[Block]:
    """All scores of the answers so far."""
    quiz = quiz_plan(bank).history(answers)
    blocks: list[Block] = [Text("The quiz of twelve", Tone.BOLD)]
    if quiz.last:
        blocks += [Text(each, is_tight=True) for each in round_lines(quiz)]
        blocks.append(topic_table(count_by_topic(quiz.items, quiz.last)))
    else:
        blocks.append(Text("Not begun; `kit quiz` asks it.", is_tight=True))
    return [
        *blocks,
        Text("All questions, by the latest answer to each", Tone.BOLD),
        topic_table(count_by_topic(bank.items, latest_answers(answers))),
        Text(CALIBRATION_HEADING, Tone.BOLD),
        *calibration_blocks(measure_calibration(answers)),
        Text("What comes back when", Tone.BOLD),
        *schedule_blocks(schedule),
    ]


def _answered_items(bank: QuestionBank, answers: Iterable[QuizAnswer]) -> list[QuizItem]:
    known = bank.items_by_id()
    return [known[name] for name in latest_answers(answers) if name in known]
