"""What each question of the quiz tells in a class: its difficulty, its correlation with the rest, the options chosen.

The measures are the classical ones: G. F. Kuder and M. W. Richardson, "The theory of the estimation of test
reliability", Psychometrika 2 (1937), formula 20; the corrected item-total correlation.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from typing import Final

from kit.arrays import FloatArray
from kit.learning.policies.confidence_intervals import ConfidenceInterval, wilson_interval
from kit.school.quiz.answers import AnswerOutcome
from kit.school.report.inference import correlation, non_blank
from kit.school.report.measures import AnswerSheet, ReportItem

MIN_REST_CORRELATION: Final = 0.15
"""An item with a lower correlation with the rest of the quiz gets a warning."""
MIN_DIFFICULTY: Final = 0.2
MAX_DIFFICULTY: Final = 0.95


@dataclass(frozen=True, slots=True)
class ItemAnalysis:
    """The analysis of one item in a class."""

    item: ReportItem
    n: int
    """Number of students who took the quiz."""
    outcomes: dict[AnswerOutcome, int]
    choice_counts: dict[int, int]
    """Option index, from 0 -> number of students who chose it."""
    right_options: frozenset[int]
    """Indices of the options that were counted as right."""
    difficulty: float
    """Share of right answers; NaN where no student took the quiz."""
    interval: ConfidenceInterval
    """95 percent interval of that share, by Wilson."""
    rest_correlation: float
    """Correlation with the rest of the quiz; NaN where one of them does not vary."""

    @property
    def warnings(self) -> tuple[str, ...]:
        """Properties that a teacher should check."""
        right = sum(self.choice_counts.get(key, 0) for key in self.right_options)
        lures = [
            option + 1
            for option, n in self.choice_counts.items()
            if option not in self.right_options and n > right
        ]
        checks = (
            (len(self.right_options) > 1, f"{len(self.right_options)} different options counted as right"),
            (
                bool(lures),
                f"option{'s' * (len(lures) > 1)} {', '.join(map(str, sorted(lures)))} drew more than the right one",
            ),
            (self.difficulty < MIN_DIFFICULTY, f"only {self.difficulty:.0%} had it right"),
            (self.difficulty > MAX_DIFFICULTY, "nearly everyone had it right: it does not discriminate"),
            (
                self.rest_correlation < MIN_REST_CORRELATION,
                f"goes with the rest by r = {round(self.rest_correlation, 2) + 0.0:.2f} only",
            ),
        )
        return tuple(text for holds, text in checks if holds)


def analyse_item(quiz: AnswerSheet, item: ReportItem) -> ItemAnalysis:
    """Analyses an item among the others of the quiz."""
    replies = [each for each in quiz.replies[item.id] if each is not None]
    right = quiz.correctness(item)
    rest = [other for other in quiz.items if other != item]
    hits = sum(each.outcome is AnswerOutcome.RIGHT for each in replies)
    return ItemAnalysis(
        item,
        n=len(replies),
        outcomes={outcome: sum(each.outcome is outcome for each in replies) for outcome in AnswerOutcome},
        choice_counts=dict(
            sorted(Counter(each.chosen for each in replies if each.chosen is not None).items())
        ),
        right_options=frozenset(
            each.chosen for each in replies if each.outcome is AnswerOutcome.RIGHT and each.chosen is not None
        ),
        difficulty=hits / len(replies) if replies else math.nan,
        interval=wilson_interval(hits, len(replies)),
        rest_correlation=correlation(right, quiz.share_right(rest)) if rest else math.nan,
    )


def kr20(quiz: AnswerSheet) -> float:
    """Internal consistency of the quiz, at most 1; NaN below two items or where all scores are equal."""
    columns = [non_blank(quiz.correctness(item)) for item in quiz.items]
    k = len(columns)
    if k < 2 or len(columns[0]) < 2:
        return math.nan
    totals: FloatArray = sum(columns[1:], columns[0])
    spread = float(totals.var())
    if spread <= 0:
        return math.nan
    return k / (k - 1) * (1 - sum(float(column.mean() * (1 - column.mean())) for column in columns) / spread)
