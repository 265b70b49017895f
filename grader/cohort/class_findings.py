"""What a teacher should look at in a class's grades: works without one, equal works, points that could not be earned."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from grader.cohort.gradebook import MISSING, UNREADABLE, WAITING, GradebookRow
from grader.reports.cleaning import clean_line
from kit.document.blocks import Block, Text
from kit.plain_text import counted, join_names
from kit.results.grading_result import GradingVerdict
from kit.results.result_blocks import format_points

MAX_LISTED: Final = 40
"""Submissions that need attention, listed one by one."""


def attention_blocks(table: Sequence[GradebookRow]) -> list[Block]:
    """Each submission that has no grade and why: first the unreadable ones, then the grader's faults, then those for which a
    worker has left what is no result."""
    order = (UNREADABLE, GradingVerdict.BROKEN.value, WAITING)
    rows = [row for row in table if row.verdict in order and (row.verdict != WAITING or row.note)]
    rows.sort(key=lambda row: (order.index(row.verdict), row.name))
    if not rows:
        return []
    verbs = ("has", "needs") if len(rows) == 1 else ("have", "need")
    told = [f"{clean_line(row.name)}: {row.verdict}. {row.note}" for row in rows[:MAX_LISTED]]
    if len(rows) > MAX_LISTED:
        told.append(f"and {len(rows) - MAX_LISTED} more: see the gradebook")
    return [
        Text(f"{len(rows)} {verbs[0]} no grade and {verbs[1]} your attention:"),
        *(Text(each, indent=2, hang=2, is_tight=True) for each in told),
    ]


def passed_over_line(names: Sequence[str], done: str) -> str:
    """Returns a sentence that names what was not taken for a work; empty if there is nothing. ``done``: what is done to works."""
    if not names:
        return ""
    shown = join_names(tuple(clean_line(each, 80) for each in names), 8)
    return f"Not {done}: {shown}."


def equal_works(table: Sequence[GradebookRow]) -> tuple[tuple[GradebookRow, ...], ...]:
    """Returns the rows whose works are the same to the byte, together; those of one group's work are no finding."""
    by_digest: dict[str, dict[str, GradebookRow]] = {}
    for row in table:
        if row.submission:
            by_digest.setdefault(row.submission, {}).setdefault(row.work, row)
    return tuple(tuple(works.values()) for works in by_digest.values() if len(works) > 1)


def class_blocks(table: Sequence[GradebookRow]) -> list[Block]:
    """Returns what a teacher should look at besides missing grades: equal works, works that fit nobody, students without one."""
    strangers = [row.name for row in table if row.student is None]
    has_roster = len(strangers) < len(table)
    missing = [row.name for row in table if row.verdict == MISSING]
    told = [
        f"The same work to the byte: {join_names(tuple(clean_line(row.name) for row in rows), 8)}."
        for rows in equal_works(table)
    ]
    if has_roster and strangers:
        shown = join_names(tuple(map(clean_line, strangers)), 8)
        told.append(f"{counted(len(strangers), 'work')} of nobody in the roster: {shown}.")
    if missing:
        told.append(f"{len(missing)} handed in nothing: {join_names(tuple(map(clean_line, missing)), 12)}.")
    return [Text(each, is_tight=True) for each in told]


def unjudged_line(table: Sequence[GradebookRow], max_points: float) -> str:
    """Returns a sentence on the points that could not be earned without secret seeds; empty if there are none."""
    judged = max((row.max_points for row in table if row.points is not None), default=max_points)
    left = max_points - judged
    if left <= 1e-9:
        return ""
    return f"{format_points(left)} of {format_points(max_points)} points were not graded; nobody loses them."
