"""A question of the evaluation form as rows of text: the question, and the answers to choose from. Pure."""

from __future__ import annotations

import textwrap
from typing import Final

from rich.cells import cell_len

from kit.document.rows import MARGIN, Row, StyledText, entry_rows, row, text_width
from kit.school.survey import AnswerShape, SurveyQuestion
from kit.tui.rows.quiz_rows import WIDEST_TEXT

POINT_WIDTH: Final = 12
"""Columns of a point of the scale where there is room."""


def question_rows(question: SurveyQuestion, chosen: int | None, width: int) -> list[Row]:
    """The question and, if there are any, its answers. ``chosen``: index of the chosen one; None: it is blank."""
    room = text_width(width, WIDEST_TEXT)
    texts = (
        [(question.group_text, ""), (question.text, "bold")]
        if question.group_text
        else [(question.text, "bold")]
    )
    rows: list[Row] = []
    for text, style in texts:
        rows += [row(), *(row(" " * MARGIN, (line, style)) for line in textwrap.wrap(text, room))]
    return [*rows, row(), *_answer_rows(question, chosen, width)]


def _answer_rows(question: SurveyQuestion, chosen: int | None, width: int) -> list[Row]:
    if question.shape is AnswerShape.TEXT:
        return []
    if question.shape is AnswerShape.SCALE:
        return _scale_rows(question, chosen, text_width(width, WIDEST_TEXT))
    labels = (
        ("yes", "no") if question.shape is AnswerShape.YES_NO else question.shown_options or question.options
    )
    rows: list[Row] = []
    for index, label in enumerate(labels):
        mark, style = (">", "bold") if index == chosen else (" ", "")
        rows += entry_rows(mark, str(index + 1), label, style, text_width(width, WIDEST_TEXT))
    return rows


def _scale_rows(question: SurveyQuestion, chosen: int | None, room: int) -> list[Row]:
    """The points beside each other, and below them what the lowest and the highest mean."""
    points = question.values
    width = max(3, min(POINT_WIDTH, room // len(points)))
    line: list[StyledText] = [(" " * MARGIN, "")]
    for index, point in enumerate(points):
        sign = str(point)
        shown = (
            (("[", "bold"), (sign, "chosen"), ("]", "bold"))
            if index == chosen
            else ((" ", ""), (sign, "press"), (" ", ""))
        )
        line += [*shown, (" " * (width - 3), "")]
    indent, used = " " * (MARGIN + 1), (len(points) - 1) * width + 1
    gap = used - cell_len(question.low) - cell_len(question.high)
    if gap > 0:
        words = [row(indent, (question.low + " " * gap + question.high, "dim"))]
    else:
        words = [
            row(indent, (f"{points[0]} {question.low}", "dim")),
            row(indent, (f"{points[-1]} {question.high}", "dim")),
        ]
    return [tuple(line), *words]
