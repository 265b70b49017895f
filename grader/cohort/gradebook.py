"""The gradebook: one row per submission, made from the results alone; equal results give equal bytes."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final

from grader.cohort.late import LatePolicy, SubmissionTime
from grader.cohort.queue import Queue
from grader.reports.cleaning import clean_line, spreadsheet_cell
from kit.school.result import CriterionStatus, GradingVerdict, format_points

REFUSED: Final = "refused"
WAITING: Final = "waiting"


@dataclass(frozen=True, slots=True)
class GradebookRow:
    """The grade of one submission."""

    name: str
    verdict: str
    """``pass``, ``fail``, ``broken``, ``refused`` or ``waiting``."""
    points: float | None
    """Before lateness; None where there is no grade."""
    max_points: float
    kept: float
    """The share of points kept after lateness."""
    final: float | None
    tests: Mapping[str, float]
    statuses: Mapping[str, str]
    note: str
    submission: str
    level: int | None = None
    """The confinement level of the program; None without a result, and in older gradebooks."""


def gradebook_rows(
    queue: Queue,
    policy: LatePolicy | None = None,
    submission_times: Mapping[str, SubmissionTime] | None = None,
) -> tuple[GradebookRow, ...]:
    """Returns one row per submission, sorted by name."""
    return tuple(sorted(_rows(queue, policy, submission_times or {}), key=lambda row: row.name))


def _rows(
    queue: Queue, policy: LatePolicy | None, submission_times: Mapping[str, SubmissionTime]
) -> Iterator[GradebookRow]:
    most = round(queue.assignment().max_points, 6)
    for entry in queue.entries():
        submitted = submission_times.get(entry.name)
        kept = policy.kept(submitted.at) if policy is not None and submitted is not None else 1.0
        if entry.key is None:
            yield GradebookRow(
                entry.name, REFUSED, 0.0, most, kept, 0.0, {}, {}, clean_line(entry.refused), ""
            )
            continue
        result = queue.result(entry.key)
        if result is None:
            yield GradebookRow(entry.name, WAITING, None, most, kept, None, {}, {}, "", "")
            continue
        points = result.points
        yield GradebookRow(
            entry.name,
            result.verdict.value,
            points,
            most,
            kept,
            None if points is None else round(points * kept, 6),
            {test.id: test.points for test in result.tests},
            {test.id: test.status.value for test in result.tests},
            clean_line(
                next((test.rationale for test in result.tests if test.status is not CriterionStatus.PASS), "")
            ),
            result.submission,
            result.level,
        )


def as_json(table: Sequence[GradebookRow]) -> str:
    return json.dumps([asdict(row) for row in table], indent=1, sort_keys=True, allow_nan=False) + "\n"


def as_csv(table: Sequence[GradebookRow]) -> str:
    """Formats the rows for a spreadsheet, without formulas."""
    criteria = sorted({identity for row in table for identity in row.tests})
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(
        ["name", "verdict", "final", "points", "max_points", "kept", *map(spreadsheet_cell, criteria), "note"]
    )
    for row in table:
        tests = [_number(row.tests.get(identity)) for identity in criteria]
        sums = [
            _number(row.final),
            _number(row.points),
            format_points(row.max_points),
            format_points(row.kept),
        ]
        writer.writerow([spreadsheet_cell(row.name), row.verdict, *sums, *tests, spreadsheet_cell(row.note)])
    return out.getvalue()


def _number(points: float | None) -> str:
    return "" if points is None else format_points(points)


def read_json(text: str) -> tuple[GradebookRow, ...]:
    """Reads what ``as_json`` wrote. Raises ValueError for anything else."""
    try:
        return tuple(GradebookRow(**each) for each in json.loads(text))
    except (TypeError, ValueError):
        raise ValueError("not a gradebook in JSON") from None


def changes(before: Sequence[GradebookRow], after: Sequence[GradebookRow]) -> Iterator[str]:
    """Yields a line for each difference between two gradebooks, to be read before the new one is published."""
    old, new = {row.name: row for row in before}, {row.name: row for row in after}
    for name in sorted(old.keys() | new.keys()):
        was, now = old.get(name), new.get(name)
        if was is None or now is None:
            yield f"{clean_line(name)}: {'new' if was is None else 'gone'}"
        elif (was.final, was.verdict, dict(was.statuses)) != (now.final, now.verdict, dict(now.statuses)):
            tests = [
                f"{each} {was.statuses.get(each, '-')} -> {now.statuses.get(each, '-')}"
                for each in sorted(was.statuses.keys() | now.statuses.keys())
                if was.statuses.get(each) != now.statuses.get(each)
            ]
            detail = f" ({', '.join(tests)})" if tests else ""
            yield f"{clean_line(name)}: {_number(was.final) or 'none'} -> {_number(now.final) or 'none'}{detail}"


def summary(table: Sequence[GradebookRow]) -> str:
    """One line: how many of each verdict, and the confinement levels of their programs."""
    kinds = [
        GradingVerdict.PASS.value,
        GradingVerdict.FAIL.value,
        GradingVerdict.BROKEN.value,
        REFUSED,
        WAITING,
    ]
    counts: dict[str, Any] = {kind: sum(row.verdict == kind for row in table) for kind in kinds}
    text = ", ".join(f"{count} {kind}" for kind, count in counts.items() if count) or "nobody"
    levels = sorted({row.level for row in table if row.level is not None})
    if not levels:
        return text
    word = "level" if len(levels) == 1 else "levels"
    return f"{text}, at confinement {word} {', '.join(map(str, levels))}"
