"""The gradebook: one row per submission by the rules for late ones, made from the results alone; equal results give equal bytes."""

from __future__ import annotations

import csv
import io
import json
import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime, tzinfo
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

from grader.cohort.queue import Queue, QueueEntry, UnreadableWork
from grader.reports.cleaning import clean_line, spreadsheet_cell
from kit.document.blocks import Block, Text
from kit.school.result import CriterionStatus, GradingResult, GradingVerdict, format_points
from kit.world.documents import open_document

DAY = 86400.0
"""s"""


@dataclass(frozen=True, slots=True)
class LatePolicy:
    """How many points lateness costs."""

    due: datetime
    grace_s: float = 0.0
    per_day: float = 0.1
    """Share of the points lost for each day begun."""
    least: float = 0.0
    """Share that is always kept, until ``latest_days``."""
    latest_days: float | None = None
    """Days after which nothing counts; None for no such limit."""
    zone: tzinfo | None = None
    """In which times are read that name none."""

    @property
    def due_text(self) -> str:
        """How the due date was read."""
        zone = "" if self.zone is None else f" {self.zone}"
        return f"due {self.due.isoformat(sep=' ')}{zone}"

    def kept(self, submitted: datetime) -> float:
        """Returns the share of its points that a submission keeps."""
        # In one zone Python subtracts what clocks show, and they skip or repeat an hour twice a year.
        late = (submitted.astimezone(UTC) - self.due.astimezone(UTC)).total_seconds() - self.grace_s
        if late <= 0:
            return 1.0
        if self.latest_days is not None and late > self.latest_days * DAY:
            return 0.0
        return max(self.least, 1.0 - self.per_day * math.ceil(late / DAY), 0.0)


def read_policy(file: Path) -> LatePolicy:
    """Reads ``due``, ``zone``, ``grace_minutes``, ``per_day``, ``least`` and ``latest_days`` from a YAML file.

    ``due`` is a time with its offset, or in ``zone``; a date alone means the end of that day. Raises WorldError.
    """
    with open_document(file) as section:
        zone = None
        if section.has("zone"):
            zone = find_zone(section.name("zone"))
            if zone is None:
                section.error("must be a time zone such as Europe/Lisbon, or UTC", "zone")
        due = None
        try:
            due = parse_time(section.name("due"), zone, whole_day=True)
        except ValueError as problem:
            section.error(str(problem), "due")
        return LatePolicy(
            due or datetime.now(UTC),
            60 * section.number("grace_minutes", 0.0, minimum=0),
            section.number("per_day", 0.1, minimum=0, maximum=1),
            section.number("least", 0.0, minimum=0, maximum=1),
            section.number("latest_days", minimum=0) if section.has("latest_days") else None,
            zone,
        )


@dataclass(frozen=True, slots=True)
class SubmissionTime:
    """When a submission was handed in, and by which student."""

    at: datetime
    student: str
    """By default the submission's own name."""


def read_submission_times(file: Path, zone: tzinfo | None = None) -> Mapping[str, SubmissionTime]:
    """Reads a CSV file with the columns ``name`` and ``submitted``, and ``student`` if some submit more than once.

    ``zone``: of times that name none. Raises ValueError, OSError.
    """
    arrivals = {}
    with file.open(newline="", encoding="utf-8-sig") as opened:
        for number, row in enumerate(csv.DictReader(opened), 2):
            name = row.get("name") or ""
            if not name:
                raise ValueError(f"{file}:{number}: a row needs a name, and a time such as {EXAMPLE}")
            try:
                at = parse_time(row.get("submitted") or "", zone)
            except ValueError as problem:
                raise ValueError(f"{file}:{number}: submitted {problem}") from None
            if name in arrivals:
                raise ValueError(f"{file}:{number}: {name} is there twice")
            arrivals[name] = SubmissionTime(at, (row.get("student") or "").strip() or name)
    return arrivals


EXAMPLE: Final = "2026-11-30T23:59:00+01:00"


def find_zone(name: str) -> tzinfo | None:
    """The time zone of a name of the IANA's; None for a name of none, or one that this machine does not know."""
    if name == "UTC":
        return UTC
    try:
        return ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError):
        return None


def parse_time(text: str, zone: tzinfo | None = None, *, whole_day: bool = False) -> datetime:
    """Parses a date and time with its offset, or in ``zone``. ``whole_day``: a date alone is the end of that day.

    Raises ValueError for anything else, also for a time that can be read in two ways: in no zone, of a day alone, or in
    the hour that clocks skip or repeat. The message begins with a verb.
    """
    text = text.strip()
    try:
        at = datetime.fromisoformat(text)
    except ValueError:
        raise ValueError(f"must be a date and time such as {EXAMPLE}") from None
    is_day = ":" not in text and "T" not in text.upper()
    if is_day and not whole_day:
        raise ValueError(f"names a day and no time ({text}): write when, such as {EXAMPLE}")
    if is_day:
        at = at.replace(hour=23, minute=59, second=59)
    if at.tzinfo is not None:
        return at
    if zone is None:
        raise ValueError(
            f"names no time zone ({text}): write it, such as {at.isoformat()}+01:00 or {at.isoformat()}Z, "
            "or give the late rules a zone, such as `zone: Europe/Lisbon`"
        )
    first, second = (at.replace(tzinfo=zone, fold=fold) for fold in (0, 1))
    if first.utcoffset() != second.utcoffset():
        kind = "twice" if first.utcoffset() > second.utcoffset() else "never"  # type: ignore[operator]  # both have one
        raise ValueError(f"comes {kind} in {zone} on that day ({text}): write its offset, such as {EXAMPLE}")
    return first


UNREADABLE: Final = "unreadable"
"""What was handed in cannot be read: no grade, not 0, until the teacher has decided."""
WAITING: Final = "waiting"
SAME_ERRORS: Final = 3
"""If this many submissions of a class cannot be read for the same internal error, the grader is at fault."""
MAX_LISTED: Final = 40
"""Submissions that need attention, listed one by one."""


@dataclass(frozen=True, slots=True)
class GradebookRow:
    """The grade of one submission."""

    name: str
    verdict: str
    """``pass``, ``fail``, ``broken``, ``unreadable`` or ``waiting``."""
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
    error: str = ""
    """The internal error for which the submission cannot be read; empty for a known reason."""


def gradebook_rows(
    queue: Queue,
    policy: LatePolicy | None = None,
    submission_times: Mapping[str, SubmissionTime] | None = None,
) -> tuple[GradebookRow, ...]:
    """Returns one row per submission, sorted by name."""
    rows = sorted(_rows(queue, policy, submission_times or {}), key=lambda row: row.name)
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


def _rows(
    queue: Queue, policy: LatePolicy | None, submission_times: Mapping[str, SubmissionTime]
) -> Iterator[GradebookRow]:
    assignment = queue.assignment()
    most = round(assignment.max_points, 6)
    without_secrets = assignment.has_secrets and not queue.grading_options().secret
    for entry in queue.entries():
        submitted = submission_times.get(entry.name)
        kept = policy.kept(submitted.at) if policy is not None and submitted is not None else 1.0
        blank = GradebookRow(entry.name, WAITING, None, most, kept, None, {}, {}, "", "")
        result = None if entry.key is None else queue.result(entry.key)
        if result is not None:
            yield _graded_row(blank, entry, result, without_secrets=without_secrets)
            continue
        unreadable = (
            UnreadableWork(entry.refused, entry.error) if entry.key is None else queue.unreadable(entry.key)
        )
        if unreadable is None:
            yield blank
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
        statuses={test.id: test.status.value for test in result.tests},
        note=" ".join(filter(None, (clean_line(lost), clean_line(entry.note)))),
        submission=result.submission,
        level=result.level,
    )


def as_json(table: Sequence[GradebookRow]) -> str:
    return json.dumps([asdict(row) for row in table], indent=1, sort_keys=True, allow_nan=False) + "\n"


def as_csv(table: Sequence[GradebookRow]) -> str:
    """Formats the rows for a spreadsheet, without formulas."""
    criteria = sorted({identity for row in table for identity in row.tests})
    out = io.StringIO()
    # In quotes, a cell stays one cell where another sign than the comma separates them.
    writer = csv.writer(out, lineterminator="\n", quoting=csv.QUOTE_ALL)
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
        UNREADABLE,
        WAITING,
    ]
    counts: dict[str, Any] = {kind: sum(row.verdict == kind for row in table) for kind in kinds}
    text = ", ".join(f"{count} {kind}" for kind, count in counts.items() if count) or "nobody"
    levels = sorted({row.level for row in table if row.level is not None})
    if not levels:
        return text
    word = "level" if len(levels) == 1 else "levels"
    return f"{text}, at confinement {word} {', '.join(map(str, levels))}"


def attention_blocks(table: Sequence[GradebookRow]) -> list[Block]:
    """Each submission that has no grade and why: first the unreadable ones, then the grader's faults."""
    order = (UNREADABLE, GradingVerdict.BROKEN.value)
    rows = sorted(
        (row for row in table if row.verdict in order), key=lambda row: (order.index(row.verdict), row.name)
    )
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


def unjudged_line(table: Sequence[GradebookRow], max_points: float) -> str:
    """Returns a sentence on the points that could not be earned without secret seeds; empty if there are none."""
    judged = max((row.max_points for row in table if row.points is not None), default=max_points)
    left = max_points - judged
    if left <= 1e-9:
        return ""
    return f"{format_points(left)} of {format_points(max_points)} points were not graded; nobody loses them."


SortKey = tuple[float, float, str]


def _latest(row: GradebookRow, submitted: SubmissionTime) -> SortKey:
    return submitted.at.timestamp(), 0.0, row.name


def _latest_in_time(row: GradebookRow, submitted: SubmissionTime) -> SortKey:
    return row.kept, submitted.at.timestamp(), row.name


def _best(row: GradebookRow, submitted: SubmissionTime) -> SortKey:
    # A missing grade ranks first: the teacher must see it before another submission counts.
    return float("inf") if row.final is None else row.final, submitted.at.timestamp(), row.name


RULES: Final[Mapping[str, tuple[str, Callable[[GradebookRow, SubmissionTime], SortKey]]]] = MappingProxyType(
    {
        "latest": ("the latest", _latest),
        "in-time": ("the latest of those that lost least by lateness", _latest_in_time),
        "best": ("the best", _best),
    }
)
"""Description of the chosen submission, and the sort key that is largest for it, by rule."""


def choose_submissions(
    table: Sequence[GradebookRow], submission_times: Mapping[str, SubmissionTime], rule: str
) -> tuple[GradebookRow, ...]:
    """Returns one row per student, under the student's name. A submission without a time counts as a student of its own.

    Raises KeyError for an unknown rule, ValueError for a time that belongs to no submission.
    """
    unknown = sorted(submission_times.keys() - {row.name for row in table})
    if unknown:
        raise ValueError(f"no submission is named {unknown[0]}; there are {len(table)} in the queue")
    return tuple(sorted(_chosen(table, submission_times, rule), key=lambda row: row.name))


def _chosen(
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
