"""The gradebook: one row per submission by the rules for late ones, made from the results alone; equal results give equal bytes."""

from __future__ import annotations

import csv
import io
import json
import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from datetime import datetime, tzinfo
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from grader.cohort.lateness import EXAMPLE, Lateness, LatePolicy, parse_time
from grader.cohort.queue import Queue, QueueEntry, UnreadableWork
from grader.cohort.roster import RosterEntry, WorkOwners, look
from grader.reports.cleaning import clean_line, spreadsheet_cell
from kit.document.blocks import Block, Text
from kit.field_types import check_field_types
from kit.plain_text import counted, join_names
from kit.results.grading_result import CriterionStatus, GradingResult, GradingVerdict
from kit.results.result_blocks import format_points


@dataclass(frozen=True, slots=True)
class SubmissionTime:
    """When a submission was handed in, and by which student."""

    at: datetime
    student: str
    """By default the submission's own name."""


def read_submission_times(file: Path, zone: tzinfo | None = None) -> Mapping[str, SubmissionTime]:
    """Reads a CSV file with the columns ``name`` and ``submitted``, and ``student`` if some submit more than once; or Moodle's
    grading worksheet, by its participants.

    ``zone``: of times that name none. Raises ValueError, OSError.
    """
    arrivals: dict[str, SubmissionTime] = {}
    with file.open(newline="", encoding="utf-8-sig") as opened:
        reader = csv.DictReader(opened)
        of_moodle = MOODLE_SUBMITTED in (reader.fieldnames or ())
        for number, row in enumerate(reader, 2):
            name = (
                (row.get("Identifier") or "").removeprefix("Participant ")
                if of_moodle
                else row.get("name") or ""
            )
            submitted = (row.get(MOODLE_SUBMITTED if of_moodle else "submitted") or "").strip()
            if of_moodle and submitted in ("", "-"):
                continue  # who handed in nothing
            if not name:
                raise ValueError(f"{file}:{number}: a row needs a name, and a time such as {EXAMPLE}")
            try:
                at = parse_time(submitted, zone)
            except ValueError as problem:
                raise ValueError(f"{file}:{number}: submitted {problem}") from None
            if name in arrivals:
                raise ValueError(f"{file}:{number}: {name} is there twice")
            arrivals[name] = SubmissionTime(at, (row.get("student") or "").strip() or name)
    return arrivals


MOODLE_SUBMITTED: Final = "Last modified (submission)"


UNREADABLE: Final = "unreadable"
"""What was handed in cannot be read: no grade, not 0, until the teacher has decided."""
WAITING: Final = "waiting"
MISSING: Final = "missing"
"""A student of the roster has handed in nothing: no grade either."""
SAME_ERRORS: Final = 3
"""If this many submissions of a class cannot be read for the same internal error, the grader is at fault."""
MAX_LISTED: Final = 40
"""Submissions that need attention, listed one by one."""


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
    rows = sorted(_rows(queue, policy, submission_times or {}, students), key=lambda row: row.name)
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


def _rows(
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
        return _number(points).replace(".", ",") if decimal_comma else _number(points)

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


def _number(points: float | None) -> str:
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
            finals = f"{_number(was.final) or 'none'} -> {_number(now.final) or 'none'}"
            yield f"{clean_line(name)}: {finals}{f' ({detail})' if detail else ''}"
    if unfinished:
        yield f"{counted(unfinished, 'submission')} not graded again yet: run the same `grader cohort` to go on"


def _criterion_changes(was: GradebookRow, now: GradebookRow) -> Iterator[str]:
    """Yields each criterion whose points or status differ, in the present order."""
    for each in (*now.statuses, *(id_ for id_ in was.statuses if id_ not in now.statuses)):
        points = _number(was.tests.get(each)) or "-", _number(now.tests.get(each)) or "-"
        status = was.statuses.get(each, "-"), now.statuses.get(each, "-")
        if points[0] != points[1]:
            word = "" if status[0] == status[1] else f", {status[0]} -> {status[1]}"
            yield f"{clean_line(each)} {points[0]} -> {points[1]}{word}"
        elif status[0] != status[1]:
            yield f"{clean_line(each)} {status[0]} -> {status[1]}"


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

    A time that belongs to no submission changes nothing. Raises KeyError for an unknown rule, ValueError for a student's name
    that is also that of a submission without a time.
    """
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
