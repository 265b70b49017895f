"""Which of a student's submissions counts, where there are several. Chosen when a gradebook is written, never before."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Final

from grader.cohort.gradebook import Row
from grader.cohort.late import Arrival

Rank = tuple[float, float, str]


def _latest(row: Row, came: Arrival) -> Rank:
    return came.at.timestamp(), 0.0, row.name


def _latest_in_time(row: Row, came: Arrival) -> Rank:
    return row.kept, came.at.timestamp(), row.name


def _best(row: Row, came: Arrival) -> Rank:
    # Without a grade nothing is known: somebody has to look before another one counts.
    return float("inf") if row.final is None else row.final, came.at.timestamp(), row.name


RULES: Final[Mapping[str, tuple[str, Callable[[Row, Arrival], Rank]]]] = MappingProxyType(
    {
        "latest": ("the latest", _latest),
        "in-time": ("the latest of those that lost least by lateness", _latest_in_time),
        "best": ("the best", _best),
    }
)
"""Each rule: what is said of the one that counts, and the rank that is highest for it."""


def chosen(table: Sequence[Row], arrivals: Mapping[str, Arrival], rule: str) -> tuple[Row, ...]:
    """One row for each student, under the student's name. What has no arrival is its own student's.

    KeyError if there is no such rule; ValueError where an arrival belongs to no submission.
    """
    strange = sorted(arrivals.keys() - {row.name for row in table})
    if strange:
        raise ValueError(f"no submission is named {strange[0]}; there are {len(table)} in the queue")
    return tuple(sorted(_chosen(table, arrivals, rule), key=lambda row: row.name))


def _chosen(table: Sequence[Row], arrivals: Mapping[str, Arrival], rule: str) -> Iterator[Row]:
    said, rank = RULES[rule]
    by_student: dict[str, list[Row]] = {}
    for row in table:
        came = arrivals.get(row.name)
        by_student.setdefault(row.name if came is None else came.student, []).append(row)
    for student, own in by_student.items():
        if len(own) == 1:
            yield replace(own[0], name=student)
            continue
        unknown = [row.name for row in own if row.name not in arrivals]
        if unknown:
            raise ValueError(
                f"{student} is a student and the name of a submission without a time: {unknown[0]}"
            )
        counts = max(own, key=lambda row: rank(row, arrivals[row.name]))
        note = f"{counts.name}, {said} of {len(own)}"
        yield replace(counts, name=student, note=f"{note}. {counts.note}" if counts.note else note)
