"""Which of a student's submissions counts."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Final

from grader.cohort.gradebook import GradebookRow
from grader.cohort.submission_times import SubmissionTime

SortKey = tuple[float, float, str]


def _rank_by_time(row: GradebookRow, submitted: SubmissionTime) -> SortKey:
    return submitted.at.timestamp(), 0.0, row.name


def _latest_in_time(row: GradebookRow, submitted: SubmissionTime) -> SortKey:
    return row.kept, submitted.at.timestamp(), row.name


def _rank_by_points(row: GradebookRow, submitted: SubmissionTime) -> SortKey:
    # A missing grade ranks first: the teacher must see it before another submission counts.
    return float("inf") if row.final is None else row.final, submitted.at.timestamp(), row.name


RULES: Final[Mapping[str, tuple[str, Callable[[GradebookRow, SubmissionTime], SortKey]]]] = MappingProxyType(
    {
        "latest": ("the latest", _rank_by_time),
        "in-time": ("the latest of those that lost least by lateness", _latest_in_time),
        "best": ("the best", _rank_by_points),
    }
)
"""Description of the chosen submission, and the sort key that is largest for it, by rule."""


def choose_submissions(
    table: Sequence[GradebookRow], submission_times: Mapping[str, SubmissionTime], rule: str
) -> tuple[GradebookRow, ...]:
    """Returns one row per student, under the student's name. A submission without a time counts as a student of its own.

    A time that belongs to no submission changes nothing. Raises KeyError for an unknown rule, ValueError for a student's name
    that is also that of a submission without a time.
    """
    return tuple(sorted(_choose_rows(table, submission_times, rule), key=lambda row: row.name))


def _choose_rows(
    table: Sequence[GradebookRow], submission_times: Mapping[str, SubmissionTime], rule: str
) -> Iterator[GradebookRow]:
    rule_text, rank = RULES[rule]
    by_student: dict[str, list[GradebookRow]] = {}
    for row in table:
        submitted = submission_times.get(row.name)
        by_student.setdefault(row.name if submitted is None else submitted.student, []).append(row)
    for student, submissions in by_student.items():
        if len(submissions) == 1:
            yield replace(submissions[0], name=student)
            continue
        unknown = [row.name for row in submissions if row.name not in submission_times]
        if unknown:
            raise ValueError(
                f"{student} is a student and the name of a submission without a time: {unknown[0]}"
            )
        chosen = max(submissions, key=lambda row: rank(row, submission_times[row.name]))
        note = f"{chosen.name}, {rule_text} of {len(submissions)}"
        yield replace(chosen, name=student, note=f"{note}. {chosen.note}" if chosen.note else note)
