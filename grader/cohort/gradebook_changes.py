"""What differs between two gradebooks, criterion by criterion."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from grader.cohort.gradebook import WAITING, GradebookRow, points_text
from grader.reports.cleaning import clean_line
from kit.plain_text import counted


def changes(before: Sequence[GradebookRow], after: Sequence[GradebookRow]) -> Iterator[str]:
    """Yields a line for each difference between two gradebooks, criterion by criterion, to be read before the new one is
    published. What is not graded yet is no difference: its number is said last."""
    old, new = {row.name: row for row in before}, {row.name: row for row in after}
    unfinished = 0
    for name in sorted(old.keys() | new.keys()):
        was, now = old.get(name), new.get(name)
        if was is None or now is None:
            yield f"{clean_line(name)}: {'new' if was is None else 'gone'}"
        elif now.verdict == WAITING:
            unfinished += was.verdict != WAITING
        elif (was.final, was.verdict, dict(was.statuses), dict(was.tests)) != (
            now.final,
            now.verdict,
            dict(now.statuses),
            dict(now.tests),
        ):
            detail = ", ".join(_criterion_changes(was, now))
            finals = f"{points_text(was.final) or 'none'} -> {points_text(now.final) or 'none'}"
            yield f"{clean_line(name)}: {finals}{f' ({detail})' if detail else ''}"
    if unfinished:
        yield f"{counted(unfinished, 'submission')} not graded again yet: run the same `grader cohort` to go on"


def _criterion_changes(was: GradebookRow, now: GradebookRow) -> Iterator[str]:
    """Yields each criterion whose points or status differ, in the present order."""
    for each in (*now.statuses, *(id_ for id_ in was.statuses if id_ not in now.statuses)):
        points = points_text(was.tests.get(each)) or "-", points_text(now.tests.get(each)) or "-"
        status = was.statuses.get(each, "-"), now.statuses.get(each, "-")
        if points[0] != points[1]:
            word = "" if status[0] == status[1] else f", {status[0]} -> {status[1]}"
            yield f"{clean_line(each)} {points[0]} -> {points[1]}{word}"
        elif status[0] != status[1]:
            yield f"{clean_line(each)} {status[0]} -> {status[1]}"
