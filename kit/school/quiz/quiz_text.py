"""What both faces say of answers, scores and the schedule: lines of plain text, no wider than asked."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import date
from typing import Final

from kit.school.quiz.answers import SURENESS, Answer, Choice, Outcome
from kit.school.quiz.items import Bank, Item, Topic, lesson_command, lesson_title
from kit.school.quiz.quiz_session import InRounds, Sitting, the_twelve
from kit.school.quiz.rounds import Rounds
from kit.school.quiz.schedule import Schedule
from kit.school.quiz.scores import (
    ENOUGH,
    WELL_JUDGED,
    Calibration,
    Tally,
    by_topic,
    calibration,
    latest,
    tally,
)

BAR: Final = 20
"""Columns of a bar."""

VERDICTS: Final[Mapping[Outcome, str]] = {
    Outcome.RIGHT: "Right.",
    Outcome.WRONG: "Not right: option {} is.",
    Outcome.NOT_SURE: "Good to know, and not counted as wrong. Option {} is right.",
    Outcome.BLANK: "Left blank. Option {} is right.",
}

CALIBRATION: Final = "How sure you were, and how often right"
SURE_QUESTION: Final = "How sure are you?"
SURE_CHOICES: Final = tuple(SURENESS.items())


def verdict(item: Item, choice: Choice) -> str:
    """Right or not, and which is."""
    return VERDICTS[choice.outcome(item)].format(item.right + 1)


def feedback(item: Item, choice: Choice) -> str:
    """What to say to the choice; to none, what is said to the right one."""
    return item.options[item.right if choice.option is None else choice.option].feedback


def ways_on(item: Item, width: int) -> list[str]:
    """Where to go from here, the lesson and what to type: in one line where both fit."""
    parts = [f"See {lesson_title(item.see)}: {lesson_command(item.see)}"]
    parts += [f"Try: {item.attempt}"] if item.attempt else []
    line = "   ".join(parts)
    return [line] if len(line) <= width else parts


def in_days(day: date, today: date) -> str:
    """When that is."""
    days = (day - today).days
    return "today" if days <= 0 else "tomorrow" if days == 1 else f"in {days} days"


def schedule_lines(schedule: Schedule) -> list[str]:
    """The visible schedule: every topic, how many questions today, or when next."""
    if not schedule.standings:
        return ["Nothing is scheduled yet: a topic comes back from the day after its first question on."]
    widest = max(len(each.topic.label) for each in schedule.standings)
    lines = []
    for each in schedule.standings:
        left = each.left(schedule.today)
        words = f"{left} due today" if left else f"again {in_days(each.due, schedule.today)}"
        lines.append(f"{each.topic.label:<{widest}}  {words}")
    if schedule.days:
        count = len(schedule.days)
        lines.append(f"Days with a practice finished: {count}. Each day counts once.")
    return lines


def today_line(schedule: Schedule) -> str:
    """What is due, in one line."""
    due = [(each.topic.label, left) for each in schedule.standings if (left := each.left(schedule.today))]
    if due:
        return "Due today: " + ", ".join(f"{left} from {title}" for title, left in due) + "."
    if schedule.next_day is not None:
        return f"Nothing is due today. Next: {in_days(schedule.next_day, schedule.today)}."
    return "Nothing is scheduled yet: `kit quiz` begins."


def tally_line(counts: Tally) -> str:
    """A result in words: what did not happen is left out."""
    parts = [f"{counts.right} of {counts.items} right"]
    for count, words in (
        (counts.wrong, "wrong"),
        (counts.not_sure, "not sure"),
        (counts.blank, "blank"),
        (counts.not_asked, "not asked yet"),
    ):
        if count:
            parts.append(f"{count} {words}")
    return ", ".join(parts)


def topic_table(scores: Mapping[Topic, Tally]) -> list[str]:
    """One row a topic."""
    head = f"{'':<16} {'items':>5} {'right':>6} {'wrong':>6} {'not sure':>9} {'blank':>6} {'not asked':>10}"
    return [
        head,
        *(
            f"{topic.label:<16} {t.items:>5} {t.right:>6} {t.wrong:>6} {t.not_sure:>9} {t.blank:>6} {t.not_asked:>10}"
            for topic, t in scores.items()
        ),
    ]


def calibration_lines(found: Calibration) -> list[str]:
    """How sure, and how often right."""
    if not found.answers:
        return ["No answer says yet how sure you were."]
    lines = []
    for level in found.levels:
        share = level.right / level.answers if level.answers else 0.0
        bar = "#" * round(BAR * share)
        result = f"{level.right} of {level.answers}" if level.answers else "-"
        lines.append(f"{SURENESS[level.confidence]:<14} {result:>9}  {bar}".rstrip())
    return [*lines, _judged(found)]


def _judged(found: Calibration) -> str:
    if found.answers < ENOUGH:
        return f"After {ENOUGH} such answers this says how well you judge yourself."
    figures = f"so sure means {found.claimed:.0%}, and {found.reached:.0%} were right"
    gap = found.claimed - found.reached
    if abs(gap) < WELL_JUDGED:
        return f"You judge yourself well: {figures}."
    return (
        f"You were surer than right: {figures}." if gap > 0 else f"You know more than you trust: {figures}."
    )


def round_lines(rounds: Rounds) -> list[str]:
    """How the last round came out, and the one before all others."""
    lines = [tally_line(tally(rounds.items, rounds.last))]
    if len(rounds.finished) > 1:
        lines.append(f"The first time: {tally_line(tally(rounds.items, rounds.finished[0]))}.")
    return lines


def closing_lines(sitting: Sitting) -> list[str]:
    """What is said at the end of a sitting: its result by topic, how sure one was, what comes next."""
    plan = sitting.plan
    answers = sitting.answers()
    lines: list[str] = []
    if isinstance(plan, InRounds):
        rounds = plan.rounds(answers)
        scores = by_topic(plan.items, rounds.last)
        lines += [f"{plan.title}: {round_lines(rounds)[0]}.", *round_lines(rounds)[1:]]
        answered: Iterable[Answer] = rounds.last.values()
    else:
        items = _items(sitting.bank, sitting.given)
        scores = by_topic(items, latest(sitting.given))
        lines.append(f"Practised: {tally_line(tally(items, latest(sitting.given)))}." if items else "")
        answered = sitting.given
    if len(scores) > 1:
        lines += ["", *topic_table(scores)]
    lines += ["", f"{CALIBRATION}:", *calibration_lines(calibration(answered))]
    lines += ["", today_line(sitting.schedule())]
    return [line for index, line in enumerate(lines) if line or index]


def again_line(plan: InRounds) -> str:
    """How to go through a finished round once more."""
    return f"`{plan.command} --again` asks {'them' if len(plan.items) > 1 else 'it'} anew."


def scores_lines(bank: Bank, answers: Sequence[Answer], schedule: Schedule) -> Iterator[str]:
    """Everything there is to know of the answers so far."""
    quiz = the_twelve(bank).rounds(answers)
    yield "The quiz of twelve"
    if quiz.last:
        yield from (f"  {line}" for line in round_lines(quiz))
        yield from (f"  {line}" for line in topic_table(by_topic(quiz.items, quiz.last)))
    else:
        yield "  not begun; `kit quiz` asks it"
    yield ""
    yield "All questions, by the latest answer to each"
    yield from (f"  {line}" for line in topic_table(by_topic(bank.items, latest(answers))))
    yield ""
    yield CALIBRATION
    yield from (f"  {line}" for line in calibration_lines(calibration(answers)))
    yield ""
    yield "What comes back when"
    yield from (f"  {line}" for line in schedule_lines(schedule))


def wrapped(text: str, width: int, indent: str = "") -> list[str]:
    """The text in lines, each after the indent."""
    return textwrap.wrap(text, width, initial_indent=indent, subsequent_indent=indent) or [indent]


def _items(bank: Bank, answers: Iterable[Answer]) -> list[Item]:
    known = bank.by_id()
    return [known[name] for name in latest(answers) if name in known]
