"""The defence as rows: one question at a time, and in the end all with what was right. Pure."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from kit.document.rows import MARGIN, Row, row
from kit.plain_text import counted
from kit.school.lessons.defence import Defence, DefenceQuestion


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
