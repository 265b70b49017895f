"""The gradebook: one row per submission by the rules for late ones, made from the results alone; equal results give equal bytes."""

from __future__ import annotations

import csv
import io
import json
import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any, Final

from grader.cohort.lateness import Lateness, LatePolicy
from grader.cohort.queue import Queue, QueueEntry, UnreadableWork
from grader.cohort.roster import RosterEntry, WorkOwners
from grader.cohort.submission_times import SubmissionTime
from grader.look_alikes import look
from grader.reports.cleaning import clean_line, spreadsheet_cell
from kit.field_types import check_field_types
from kit.results.grading_result import CriterionStatus, GradingResult, GradingVerdict
from kit.results.result_blocks import format_points

UNREADABLE: Final = "unreadable"
"""What was handed in cannot be read: no grade, not 0, until the teacher has decided."""
WAITING: Final = "waiting"
MISSING: Final = "missing"
"""A student of the roster has handed in nothing: no grade either."""
SAME_ERRORS: Final = 3
"""If this many submissions of a class cannot be read for the same internal error, the grader is at fault."""


@dataclass(frozen=True, slots=True)
class GradebookRow:
    """The grade of one submission."""

    name: str
    verdict: str
    """``pass``, ``fail``, ``broken``, ``unreadable``, ``waiting`` or ``missing``."""
    points: float | None
    """Before lateness; None where there is no grade."""
    max_points: float
    """Without the criteria that only secret seeds can judge, where these were not used: they are not lost."""
    kept: float
    """The share of points kept after lateness."""
    final: float | None
    tests: Mapping[str, float]
    statuses: Mapping[str, str]
    note: str
    submission: str
    level: int | None = None
    """The confinement level of the program; None without a result."""
    work: str = ""
    """The submission's own name, where the row is under its student's; empty for one who has handed in nothing."""
    student: RosterEntry | None = None
    """As the roster has it; None without a roster, and for a work that fits nobody."""
    feedback: str = ""
    """The first reason for lost points that the student may see."""
    late: str = ""
    """How late it was and what that cost; empty if it was in time."""
    maxima: Mapping[str, float] = field(default_factory=dict)
    """The most points of each criterion in ``tests``."""
    marked: tuple[str, ...] = ()
    """The criteria whose points a teacher has set."""
    comments: Mapping[str, str] = field(default_factory=dict)
    """A teacher's comments by criterion; that on the whole has an empty name."""
    extra: float = 0.0
    """Points that a teacher has given on top."""
    error: str = ""
    """The internal error for which the submission cannot be read; empty for a known reason."""


def gradebook_rows(
    queue: Queue,
    policy: LatePolicy | None = None,
    submission_times: Mapping[str, SubmissionTime] | None = None,
    owners: WorkOwners | None = None,
) -> tuple[GradebookRow, ...]:
    """Returns one row per submission, sorted by name. ``owners``: whose each is, by a roster."""
    students = {} if owners is None else owners.students
    rows = sorted(_gradebook_rows(queue, policy, submission_times or {}, students), key=lambda row: row.name)
    errors = Counter(row.error for row in rows if row.error)
    return tuple(
        _as_grader_fault(row, errors[row.error]) if errors[row.error] >= SAME_ERRORS else row for row in rows
    )


def _as_grader_fault(row: GradebookRow, count: int) -> GradebookRow:
    note = (
        f"The grader's fault: {count} submissions of this class cannot be read, all for the same error ({row.error}). "
        "Report it to those who maintain the grader, and grade the class again with its next version."
    )
    return replace(row, verdict=GradingVerdict.BROKEN.value, note=note)


def time_of(
    work: str, students: Sequence[RosterEntry], submission_times: Mapping[str, SubmissionTime]
) -> SubmissionTime | None:
    """Returns when a work was handed in: by its own name, or else by anything by which its students are known."""
    if work in submission_times or not students:
        return submission_times.get(work)
    known = {look(name): submitted for name, submitted in submission_times.items()}
    keys = (look(key) for each in students for key in each.keys)
    return next((known[key] for key in keys if key in known), None)


def _gradebook_rows(
    queue: Queue,
    policy: LatePolicy | None,
    submission_times: Mapping[str, SubmissionTime],
    owners: Mapping[str, tuple[RosterEntry, ...]],
) -> Iterator[GradebookRow]:
    assignment = queue.assignment()
    most = round(assignment.max_points, 6)
    without_secrets = assignment.has_secrets and not queue.grading_options().secret
    for entry in queue.entries():
        students = owners.get(entry.name, ())
        submitted = time_of(entry.name, students, submission_times)
        lateness = Lateness()
        if policy is not None and submitted is not None:
            names = [entry.name, submitted.student]
            names += [key for each in students for key in (*each.keys, each.group) if key]
            lateness = policy.lateness(submitted.at, policy.extension_of(names))
        blank = GradebookRow(
            entry.name,
            WAITING,
            None,
            most,
            lateness.kept,
            None,
            {},
            {},
            "",
            "",
            work=entry.name,
            late=lateness.text(),
        )
        result = None if entry.key is None else queue.result(entry.key)
        if result is not None:
            yield _graded_row(blank, entry, result, without_secrets=without_secrets)
            continue
        unreadable = (
            UnreadableWork(entry.refused, entry.error) if entry.key is None else queue.unreadable(entry.key)
        )
        if unreadable is None:
            yield replace(blank, note=clean_line(queue.refused_result(entry.key or "")))
        else:
            note = clean_line(unreadable.unreadable)
            yield replace(blank, verdict=UNREADABLE, note=note, error=clean_line(unreadable.error))


def _graded_row(
    blank: GradebookRow, entry: QueueEntry, result: GradingResult, *, without_secrets: bool
) -> GradebookRow:
    points = result.points
    lost = next((test.rationale for test in result.tests if test.status is not CriterionStatus.PASS), "")
    judged = [
        test
        for test in result.tests
        if not without_secrets or test.status is not CriterionStatus.SKIPPED or test.depends_on is not None
    ]
    return replace(
        blank,
        verdict=result.verdict.value,
        points=points,
        max_points=round(math.fsum(test.max_points for test in judged), 6),
        final=None if points is None else round(points * blank.kept, 6),
        tests={test.id: test.points for test in judged},
        maxima={test.id: test.max_points for test in judged},
        statuses={test.id: test.status.value for test in result.tests},
        note=" ".join(filter(None, (clean_line(lost), clean_line(entry.note)))),
        feedback=next(
            (
                clean_line(test.rationale, 600)
                for test in result.for_student().tests
                if not test.is_passed and test.rationale
            ),
            "",
        ),
        submission=result.submission,
        level=result.level,
    )


def as_json(table: Sequence[GradebookRow]) -> str:
    return json.dumps([asdict(row) for row in table], indent=1, sort_keys=True, allow_nan=False) + "\n"


def as_csv(table: Sequence[GradebookRow], *, decimal_comma: bool = False) -> str:
    """Formats the rows for a spreadsheet, without formulas. ``decimal_comma``: as spreadsheets expect it where numbers have
    one, with semicolons between columns."""
    criteria = sorted({identity for row in table for identity in row.tests})
    has_students = any(row.student is not None for row in table)
    of_student = ("email", "id", "login", "group") if has_students else ()
    out = io.StringIO()
    # In quotes, a cell stays one cell where another sign than the comma separates them.
    writer = csv.writer(
        out, delimiter=";" if decimal_comma else ",", lineterminator="\n", quoting=csv.QUOTE_ALL
    )

    def number(points: float | None) -> str:
        return points_text(points).replace(".", ",") if decimal_comma else points_text(points)

    writer.writerow(
        [
            "name",
            *of_student,
            *("verdict", "final", "points", "max_points", "kept", "extra"),
            *map(spreadsheet_cell, criteria),
            *("late", "comment", "note"),
        ]
    )
    for row in table:
        tests = [number(row.tests.get(identity)) for identity in criteria]
        sums = [number(each) for each in (row.final, row.points, row.max_points, row.kept, row.extra or None)]
        known = [spreadsheet_cell(getattr(row.student, each, "")) for each in of_student]
        told = map(spreadsheet_cell, (late_text(row), comment_text(row), row.note))
        writer.writerow([spreadsheet_cell(row.name), *known, row.verdict, *sums, *tests, *told])
    return out.getvalue()


def late_text(row: GradebookRow) -> str:
    """Returns how late a work was and how many points that costs; empty if it was in time."""
    if not row.late or not row.points or row.kept >= 1.0:
        return row.late
    lost = format_points(row.points * (1.0 - row.kept))
    return f"{row.late} That costs {lost} of {format_points(row.points)} points."


def comment_text(row: GradebookRow) -> str:
    """Returns a teacher's comments in one text."""
    return " ".join(f"{each}: {text}" if each else text for each, text in row.comments.items())


def points_text(points: float | None) -> str:
    return "" if points is None else format_points(points)


def read_json(text: str) -> tuple[GradebookRow, ...]:
    """Reads what ``as_json`` wrote. Raises ValueError for anything else."""
    try:
        return tuple(map(_row_from_json, json.loads(text)))
    except (TypeError, KeyError, ValueError):
        raise ValueError("not a gradebook in JSON") from None


def _row_from_json(content: Mapping[str, Any]) -> GradebookRow:
    student = None if content["student"] is None else RosterEntry(**content["student"])
    read = {**content, "student": student, "marked": tuple(content["marked"])}
    check_field_types(GradebookRow, read)
    return GradebookRow(**read)


def summary(table: Sequence[GradebookRow]) -> str:
    """One line: how many of each verdict, and the confinement levels of their programs."""
    kinds = [
        GradingVerdict.PASS.value,
        GradingVerdict.FAIL.value,
        GradingVerdict.BROKEN.value,
        UNREADABLE,
        WAITING,
        MISSING,
    ]
    counts: dict[str, Any] = {kind: sum(row.verdict == kind for row in table) for kind in kinds}
    text = ", ".join(f"{count} {kind}" for kind, count in counts.items() if count) or "nobody"
    levels = sorted({row.level for row in table if row.level is not None})
    if not levels:
        return text
    word = "level" if len(levels) == 1 else "levels"
    return f"{text}, at confinement {word} {', '.join(map(str, levels))}"
