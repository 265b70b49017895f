"""Feedback, scores by topic, calibration of confidence and the schedule as lines of plain text, for the screens and the line
mode."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import date
from typing import Final

from kit.school.quiz.items import (
    OPTION_COUNT,
    QuestionBank,
    QuizItem,
    QuizTopic,
    lesson_command,
    lesson_reference,
)
from kit.school.quiz.quiz_session import QuizRoundPlan, QuizSession, quiz_plan
from kit.school.quiz.schedule import (
    CONFIDENCE_LABELS,
    AnswerChoice,
    AnswerOutcome,
    PracticeSchedule,
    QuizAnswer,
    RoundHistory,
)

EXPECTED_SHARES: Final[Mapping[int, float]] = {1: 1 / OPTION_COUNT, 2: 0.5, 3: 0.75, 4: 0.95}
"""Confidence -> share of right answers that it claims; a guess among three options is right one time in three."""
MIN_ANSWERS: Final = 8
"""Answers with a confidence below which calibration is not reported."""
CALIBRATED_GAP: Final = 0.1
"""Largest difference of expected and actual share that counts as calibrated."""


@dataclass(frozen=True, slots=True)
class OutcomeCounts:
    """Number of items by outcome."""

    right: int = 0
    wrong: int = 0
    not_sure: int = 0
    blank: int = 0
    not_asked: int = 0

    @property
    def total(self) -> int:
        return self.right + self.wrong + self.not_sure + self.blank + self.not_asked


@dataclass(frozen=True, slots=True)
class ConfidenceLevel:
    """The answers given with one confidence level."""

    confidence: int
    answers: int
    right: int


@dataclass(frozen=True, slots=True)
class Calibration:
    """Confidence against the share of right answers."""

    levels: tuple[ConfidenceLevel, ...]
    """From the least to the most sure; unused levels have no answers."""

    @property
    def answers(self) -> int:
        return sum(level.answers for level in self.levels)

    @property
    def expected_share(self) -> float:
        """The share of right answers that the confidences claim; 0 without answers."""
        claims = sum(EXPECTED_SHARES[level.confidence] * level.answers for level in self.levels)
        return claims / self.answers if self.answers else 0.0

    @property
    def actual_share(self) -> float:
        """The share of right answers; 0 without answers."""
        return sum(level.right for level in self.levels) / self.answers if self.answers else 0.0


def latest_answers(answers: Iterable[QuizAnswer]) -> dict[str, QuizAnswer]:
    """Item id -> last answer to it."""
    return {answer.item: answer for answer in answers}


def count_outcomes(items: Iterable[QuizItem], by_item: Mapping[str, QuizAnswer]) -> OutcomeCounts:
    """Counts items by outcome."""
    counts = Counter(by_item[item.id].outcome if item.id in by_item else None for item in items)
    return OutcomeCounts(
        counts[AnswerOutcome.RIGHT],
        counts[AnswerOutcome.WRONG],
        counts[AnswerOutcome.NOT_SURE],
        counts[AnswerOutcome.BLANK],
        counts[None],
    )


def count_by_topic(
    items: Iterable[QuizItem], by_item: Mapping[str, QuizAnswer]
) -> dict[QuizTopic, OutcomeCounts]:
    """Counts items by outcome for each topic that has any."""
    of_topic: dict[QuizTopic, list[QuizItem]] = {}
    for item in items:
        of_topic.setdefault(item.topic, []).append(item)
    return {topic: count_outcomes(of_topic[topic], by_item) for topic in QuizTopic if topic in of_topic}


def measure_calibration(answers: Iterable[QuizAnswer]) -> Calibration:
    """Measures calibration over all answers with a confidence."""
    counts: Counter[int] = Counter()
    right: Counter[int] = Counter()
    for answer in answers:
        if answer.confidence is not None:
            counts[answer.confidence] += 1
            right[answer.confidence] += answer.outcome is AnswerOutcome.RIGHT
    return Calibration(tuple(ConfidenceLevel(each, counts[each], right[each]) for each in CONFIDENCE_LABELS))


BAR: Final = 20
"""Width of a bar in columns."""

VERDICTS: Final[Mapping[AnswerOutcome, str]] = {
    AnswerOutcome.RIGHT: "Right.",
    AnswerOutcome.WRONG: "Not right: option {} is.",
    AnswerOutcome.NOT_SURE: "Good to know, and not counted as wrong. Option {} is right.",
    AnswerOutcome.BLANK: "Left blank. Option {} is right.",
}

CALIBRATION_HEADING: Final = "How sure you were, and how often right"
CONFIDENCE_QUESTION: Final = "How sure are you?"
CONFIDENCE_CHOICES: Final = tuple(CONFIDENCE_LABELS.items())


def verdict_text(item: QuizItem, choice: AnswerChoice) -> str:
    """States whether the choice is right, and which option is."""
    return VERDICTS[choice.outcome_for(item)].format(item.right_option + 1)


def feedback_text(item: QuizItem, choice: AnswerChoice) -> str:
    """Feedback for the chosen option; for no choice, that of the right option."""
    return item.options[item.right_option if choice.option is None else choice.option].feedback


def follow_up_lines(item: QuizItem, width: int) -> list[str]:
    """The lesson to repeat and the command to try: in one line where both fit."""
    parts = [f"See {lesson_reference(item.lesson_to_repeat)}: {lesson_command(item.lesson_to_repeat)}"]
    parts += [f"Try: {item.command_to_try}"] if item.command_to_try else []
    line = "   ".join(parts)
    return [line] if len(line) <= width else parts


def days_text(day: date, today: date) -> str:
    """A day relative to today: ``today``, ``tomorrow``, ``in 3 days``."""
    days = (day - today).days
    return "today" if days <= 0 else "tomorrow" if days == 1 else f"in {days} days"


def schedule_lines(schedule: PracticeSchedule) -> list[str]:
    """The schedule: for every topic the number of questions today, or the next day."""
    if not schedule.topics:
        return ["Nothing is scheduled yet: a topic returns the day after its first question."]
    widest = max(len(each.topic.label) for each in schedule.topics)
    lines = []
    for each in schedule.topics:
        left = each.questions_left(schedule.today)
        words = f"{left} due today" if left else f"again {days_text(each.due, schedule.today)}"
        lines.append(f"{each.topic.label:<{widest}}  {words}")
    if schedule.practice_days:
        count = len(schedule.practice_days)
        lines.append(f"Days with a practice finished: {count}. Each day counts once.")
    return lines


def today_line(schedule: PracticeSchedule) -> str:
    """The questions due today, in one line."""
    due = [
        (each.topic.label, left) for each in schedule.topics if (left := each.questions_left(schedule.today))
    ]
    if due:
        return "Due today: " + ", ".join(f"{left} from {title}" for title, left in due) + "."
    if schedule.next_due is not None:
        return f"Nothing is due today. Next: {days_text(schedule.next_due, schedule.today)}."
    return "Nothing is scheduled yet: start with `kit quiz`."


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


def topic_table(scores: Mapping[QuizTopic, OutcomeCounts]) -> list[str]:
    """A table with one row per topic."""
    head = f"{'':<16} {'items':>5} {'right':>6} {'wrong':>6} {'not sure':>9} {'blank':>6} {'not asked':>10}"
    return [
        head,
        *(
            f"{topic.label:<16} {t.total:>5} {t.right:>6} {t.wrong:>6} {t.not_sure:>9} {t.blank:>6} {t.not_asked:>10}"
            for topic, t in scores.items()
        ),
    ]


def calibration_lines(calibration: Calibration) -> list[str]:
    """Confidence against the share of right answers, one line per level."""
    if not calibration.answers:
        return ["No answer says yet how sure you were."]
    lines = []
    for level in calibration.levels:
        share = level.right / level.answers if level.answers else 0.0
        bar = "#" * round(BAR * share)
        result = f"{level.right} of {level.answers}" if level.answers else "-"
        lines.append(f"{CONFIDENCE_LABELS[level.confidence]:<14} {result:>9}  {bar}".rstrip())
    return [*lines, _calibration_summary(calibration)]


def _calibration_summary(calibration: Calibration) -> str:
    if calibration.answers < MIN_ANSWERS:
        return f"After {MIN_ANSWERS} such answers this says how well you judge yourself."
    figures = f"so sure means {calibration.expected_share:.0%}, and {calibration.actual_share:.0%} were right"
    gap = calibration.expected_share - calibration.actual_share
    if abs(gap) < CALIBRATED_GAP:
        return f"You judge yourself well: {figures}."
    return (
        f"You were surer than right: {figures}." if gap > 0 else f"You know more than you trust: {figures}."
    )


def round_lines(history: RoundHistory) -> list[str]:
    """The result of the last round, and of the first one."""
    lines = [tally_line(count_outcomes(history.items, history.last))]
    if len(history.finished) > 1:
        lines.append(f"The first time: {tally_line(count_outcomes(history.items, history.finished[0]))}.")
    return lines


def closing_lines(session: QuizSession) -> list[str]:
    """The end of a session: results by topic, calibration, and what comes next."""
    plan = session.plan
    answers = session.all_answers()
    lines: list[str] = []
    if isinstance(plan, QuizRoundPlan):
        history = plan.history(answers)
        scores = count_by_topic(plan.items, history.last)
        lines += [f"{plan.title}: {round_lines(history)[0]}.", *round_lines(history)[1:]]
        answered: Iterable[QuizAnswer] = history.last.values()
    else:
        items = _answered_items(session.bank, session.session_answers)
        scores = count_by_topic(items, latest_answers(session.session_answers))
        lines.append(
            f"Practised: {tally_line(count_outcomes(items, latest_answers(session.session_answers)))}."
            if items
            else ""
        )
        answered = session.session_answers
    if len(scores) > 1:
        lines += ["", *topic_table(scores)]
    lines += ["", f"{CALIBRATION_HEADING}:", *calibration_lines(measure_calibration(answered))]
    lines += ["", today_line(session.build_schedule())]
    return [line for index, line in enumerate(lines) if line or index]


def restart_line(plan: QuizRoundPlan) -> str:
    """The command that repeats a finished round."""
    return f"`{plan.command} --again` asks {'them' if len(plan.items) > 1 else 'it'} again."


def scores_lines(
    bank: QuestionBank, answers: Sequence[QuizAnswer], schedule: PracticeSchedule
) -> Iterator[str]:
    """All scores of the answers so far."""
    quiz = quiz_plan(bank).history(answers)
    yield "The quiz of twelve"
    if quiz.last:
        yield from (f"  {line}" for line in round_lines(quiz))
        yield from (f"  {line}" for line in topic_table(count_by_topic(quiz.items, quiz.last)))
    else:
        yield "  not begun; `kit quiz` asks it"
    yield ""
    yield "All questions, by the latest answer to each"
    yield from (f"  {line}" for line in topic_table(count_by_topic(bank.items, latest_answers(answers))))
    yield ""
    yield CALIBRATION_HEADING
    yield from (f"  {line}" for line in calibration_lines(measure_calibration(answers)))
    yield ""
    yield "What comes back when"
    yield from (f"  {line}" for line in schedule_lines(schedule))


def wrap_text(text: str, width: int, indent: str = "") -> list[str]:
    """Wraps text to lines, each with the indent."""
    return textwrap.wrap(text, width, initial_indent=indent, subsequent_indent=indent) or [indent]


def _answered_items(bank: QuestionBank, answers: Iterable[QuizAnswer]) -> list[QuizItem]:
    known = bank.items_by_id()
    return [known[name] for name in latest_answers(answers) if name in known]
