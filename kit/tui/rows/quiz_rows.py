"""A quiz question as rows of text: asked, then how sure, then what is said to the answer, all in one place. Pure.

The questions of a program's defence as rows: one at a time, and in the end all with what was right. Pure.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Final

from kit.document.rows import MARGIN, Row, entry_rows, row, text_width
from kit.plain_text import counted
from kit.school.lessons.defence import Defence, DefenceQuestion
from kit.school.quiz.items import QuizItem
from kit.school.quiz.quiz_text import (
    CONFIDENCE_CHOICES,
    CONFIDENCE_QUESTION,
    feedback_text,
    follow_up_lines,
    verdict_text,
)
from kit.school.quiz.schedule import AnswerChoice, AnswerOutcome

WIDEST: Final = 92
"""Columns of a question, however wide the terminal."""
WIDEST_TEXT: Final = WIDEST - 2 * MARGIN
LEAST_ROWS_IN_MIDDLE: Final = 24
"""A screen with no more rows shows the question at its top."""

ROOMY_ROWS: Final = 36
"""A screen with no fewer rows has room for empty ones between options."""

_LOOKS: Final = {
    AnswerOutcome.RIGHT: "good",
    AnswerOutcome.WRONG: "bad",
    AnswerOutcome.NOT_SURE: "bold",
    AnswerOutcome.BLANK: "bold",
}


def question_rows(item: QuizItem, width: int) -> list[Row]:
    """The question and its picture."""
    room = text_width(width, WIDEST_TEXT)
    rows = [row(" " * MARGIN + line) for line in textwrap.wrap(item.question, room)]
    if item.picture:
        rows += [row(), *(row(f"{'':{2 * MARGIN}}{line}".rstrip()) for line in item.picture)]
    return [*rows, row()]


def option_rows(
    item: QuizItem,
    width: int,
    choice: AnswerChoice | None = None,
    *,
    told: bool = False,
    is_roomy: bool = False,
) -> list[Row]:
    """The options, ``>`` before the chosen one; once it is told, ``+`` before the right and ``x`` before a wrong one.
    ``is_roomy``: with an empty row after each."""
    rows: list[Row] = []
    room = text_width(width, WIDEST_TEXT)
    for index, option in enumerate(item.options):
        chosen = choice is not None and choice.option == index
        mark, style = (">", "bold") if chosen else (" ", "")
        if told and option.is_right:
            mark, style = "+", "good"
        elif told:
            mark, style = ("x", "bad") if chosen else (" ", "dim")
        rows += entry_rows(mark, str(index + 1), option.text, style, room)
        rows += [row()] * is_roomy
    if not told:
        rows += entry_rows(" ", "0", "I am not sure", "dim", room)
    return rows


def sure_rows() -> list[Row]:
    """How sure one is."""
    parts: list[str | tuple[str, str]] = [" " * MARGIN, (CONFIDENCE_QUESTION, "bold")]
    for number, text in CONFIDENCE_CHOICES:
        parts += ["  ", (str(number), "press"), f" {text}"]
    return [row(), row(*parts)]


def told_rows(item: QuizItem, choice: AnswerChoice, width: int, *, is_roomy: bool = False) -> list[Row]:
    """The verdict, what is said to the choice, and where to go from here."""
    room = text_width(width, WIDEST_TEXT)
    style = _LOOKS[choice.outcome_for(item)]
    lines = textwrap.wrap(feedback_text(item, choice), room)
    follow_up = [part for line in follow_up_lines(item, room) for part in textwrap.wrap(line, room + MARGIN)]
    return [
        row(),
        row(" " * MARGIN, (verdict_text(item, choice), style)),
        *(row(" " * MARGIN + line) for line in lines),
        *([row()] * is_roomy),
        *(row((" " * MARGIN + line, "dim")) for line in follow_up),
    ]


def centred(rows: Sequence[Row], width: int, room: int) -> list[Row]:
    """The rows as a column in the middle of a wide screen, lower on a high one. The place depends on the screen alone:
    nothing moves as rows are added.

    >>> centred([row("one")], 100, 20)
    [(('    ', ''), ('one', ''))]
    """
    left = left_column(width)
    above = max(0, min((room - LEAST_ROWS_IN_MIDDLE) // 3, room - len(rows)))
    return [row()] * above + [(row(" " * left) + each if left and each else each) for each in rows]


def left_column(width: int) -> int:
    """The column at which ``centred`` begins."""
    return max(0, (width - WIDEST) // 2)


def defence_rows(defence: Defence, answers: Sequence[int], width: int) -> list[Row]:
    """The question that is asked now, or all of them with answers once there is nothing more to ask."""
    if len(answers) == len(defence.questions):
        return _outcome_rows(defence, answers, width)
    question = defence.questions[len(answers)]
    where = f"Question {len(answers) + 1} of {len(defence.questions)}. The robot starts where you see it."
    made = [row(" " * MARGIN, (where, "dim")), *_wrapped(question.text, "bold", width)]
    made += [
        row(" " * MARGIN, (str(number), "press"), f"  {text}")
        for number, text in enumerate(question.options, 1)
    ]
    return made


def _outcome_rows(defence: Defence, answers: Sequence[int], width: int) -> list[Row]:
    made: list[Row] = []
    for question, answer in zip(defence.questions, answers, strict=True):
        made += _wrapped(question.text, "", width)
        made.append(row(" " * MARGIN, _answer_text(question, answer)))
    right = defence.right_count(answers)
    if right == len(defence.questions):
        made.append(row(" " * MARGIN, ("All correct: one more star. You know your program.", "good")))
    else:
        said = f"{right} of {counted(len(defence.questions), 'answer')} right. Another start is asked about next time."
        made.append(row(" " * MARGIN, (said, "bold")))
    return made


def _answer_text(question: DefenceQuestion, answer: int) -> tuple[str, str]:
    if answer == question.right:
        return f"+ {question.options[answer]}", "good"
    return f"x {question.options[answer]} Correct: {question.options[question.right]}", "bad"


def _wrapped(text: str, style: str, width: int) -> list[Row]:
    return [row(" " * MARGIN, (line, style)) for line in textwrap.wrap(text, max(20, width - 2 * MARGIN))]
