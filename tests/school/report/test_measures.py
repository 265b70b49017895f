"""A class's replies as arrays: who took the quiz, and who did not."""

from __future__ import annotations

import math

from kit.school.quiz.answers import AnswerOutcome
from kit.school.report.measures import BLANK, AnswerSheet, ItemReply, ReportItem

RIGHT, WRONG = ItemReply(AnswerOutcome.RIGHT), ItemReply(AnswerOutcome.WRONG)


def test_scores_count_only_who_took_the_quiz() -> None:
    items = ReportItem("one", "ros2"), ReportItem("two", "ros2")
    sheet = AnswerSheet(items, {"one": (RIGHT, BLANK, None), "two": (RIGHT, WRONG, None)})
    assert sheet.scores[:2].tolist() == [1.0, 0.0]
    assert math.isnan(sheet.scores[2])
    assert sheet.outcome_counts(AnswerOutcome.BLANK)[:2].tolist() == [0, 1]
    assert math.isnan(sheet.outcome_counts(AnswerOutcome.RIGHT)[2])
