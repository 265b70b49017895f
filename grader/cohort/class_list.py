"""One row per student of the roster: whose work counts, a teacher's own marks, and who has handed in nothing.

Nothing here stops a gradebook: what fits nobody, or several, is said in a remark, and the rest goes on.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from grader.cohort.choice_rules import RULES, choose_submissions
from grader.cohort.gradebook import MISSING, GradebookRow, gradebook_rows, time_of
from grader.cohort.lateness import LatePolicy
from grader.cohort.marks import ManualMark
from grader.cohort.queue import Queue
from grader.cohort.roster import Roster, RosterEntry, WorkOwners, owners_of
from grader.cohort.submission_times import SubmissionTime
from grader.look_alikes import look
from grader.reports.cleaning import clean_line
from kit.plain_text import counted, join_names, suggestion
from kit.results.result_blocks import format_points


@dataclass(frozen=True, slots=True)
class ClassRules:
    """What decides, besides the results, which grade a student has."""

    policy: LatePolicy | None = None
    submission_times: Mapping[str, SubmissionTime] | None = None
    choose: str = "latest"
    """Which of several submissions counts; one of ``RULES``."""
    roster: Roster | None = None
    marks: Mapping[str, ManualMark] | None = None


@dataclass(frozen=True, slots=True)
class ClassTable:
    """The gradebook of a class."""

    rows: tuple[GradebookRow, ...]
    """One per student; without a roster one per submission, or per student that the times name."""
    remarks: tuple[str, ...]
    """What did not fit, each in one line with the way out."""


def class_table(queue: Queue, rules: ClassRules) -> ClassTable:
    """Returns the gradebook of a class. Raises QueueError, and ValueError as ``choose_submissions``."""
    times = rules.submission_times or {}
    remarks: list[str] = []
    names = [entry.name for entry in queue.entries()]
    owners = None if rules.roster is None else owners_of(_owner_names(names, times), rules.roster)
    if owners is not None:
        owners = WorkOwners(
            {name: owners.students[_owner_name(name, times)] for name in names}, owners.ambiguous
        )
    table = gradebook_rows(queue, rules.policy, times, owners)
    if rules.roster is None or owners is None:
        rows = choose_submissions(table, times, rules.choose)
    else:
        rows = tuple(_student_rows(table, owners, times, rules.choose, rules.roster))
        remarks += _owner_remarks(owners)
    remarks += _time_remarks(names, owners, rules)
    if rules.policy is not None:
        remarks += _extension_remarks(rows, rules.policy)
    most = {test.id: test.points for test in queue.assignment().tests}
    marked, more = with_marks(rows, rules.marks or {}, rules.roster, most)
    return ClassTable(tuple(sorted(marked, key=lambda row: look(row.name))), (*remarks, *more))


def _owner_name(work: str, times: Mapping[str, SubmissionTime]) -> str:
    """What says whose a work is: the student that the times name, else the work's own name."""
    return times[work].student if work in times else work


def _owner_names(works: Sequence[str], times: Mapping[str, SubmissionTime]) -> list[str]:
    return [_owner_name(each, times) for each in works]


def _student_rows(
    table: Sequence[GradebookRow],
    owners: WorkOwners,
    times: Mapping[str, SubmissionTime],
    rule: str,
    roster: Roster,
) -> Iterator[GradebookRow]:
    """Yields a row for each student, then one for each work that fits nobody."""
    labels = Counter(look(each.label) for each in roster.students.values())
    works: dict[RosterEntry, list[GradebookRow]] = {}
    for row in table:
        for student in owners.students[row.name]:
            works.setdefault(student, []).append(row)
    most = max((row.max_points for row in table), default=0.0)
    for student in roster.students.values():
        known = next((key for key in student.keys if key != student.label), "")
        name = f"{student.label} ({known})" if labels[look(student.label)] > 1 and known else student.label
        found = works.get(student, [])
        if not found:
            yield GradebookRow(name, MISSING, None, most, 1.0, None, {}, {}, "", "", student=student)
            continue
        chosen = _chosen_of(found, student, times, rule)
        yield replace(chosen, name=name, student=student)
    yield from (row for row in table if not owners.students[row.name])


def _chosen_of(
    rows: Sequence[GradebookRow], student: RosterEntry, times: Mapping[str, SubmissionTime], rule: str
) -> GradebookRow:
    """Returns the submission of a student that counts. Without all their times, it is the best."""
    if len(rows) == 1:
        return rows[0]
    submitted = {row.work: time_of(row.work, (student,), times) for row in rows}
    text, rank = RULES[rule]
    if any(each is None for each in submitted.values()):
        text = "the best, since their times are not known,"
        # A missing grade comes first: the teacher must see it before another submission counts.
        chosen = max(rows, key=lambda row: (math.inf if row.final is None else row.final, row.name))
        if chosen.final is None:
            text = "which has no grade yet,"
    else:
        chosen = max(rows, key=lambda row: rank(row, submitted[row.work]))  # type: ignore[arg-type]  # none is None
    note = f"{chosen.work}, {text} of {len(rows)}"
    return replace(chosen, note=f"{note}. {chosen.note}" if chosen.note else note)


def _owner_remarks(owners: WorkOwners) -> Iterator[str]:
    for work, students in owners.ambiguous.items():
        known = join_names(tuple(each.email or each.id or each.login or each.label for each in students))
        yield (
            f"{clean_line(work)} fits {len(students)} students ({known}) and counts for none: give the file or folder the "
            "e-mail address, id or login for a name, or name the student in the times file"
        )


def _time_remarks(names: Sequence[str], owners: WorkOwners | None, rules: ClassRules) -> Iterator[str]:
    times = rules.submission_times or {}
    students = () if rules.roster is None else tuple(rules.roster.students.values())
    known = {look(name) for name in names} | {look(key) for each in students for key in each.keys}
    strange = sorted(name for name in times if look(name) not in known)
    if strange:
        yield f"{counted(len(strange), 'time')} of no submission: {join_names(tuple(map(clean_line, strange)), 5)}"
    if rules.policy is not None:
        owned = {} if owners is None else owners.students
        timeless = [name for name in names if time_of(name, owned.get(name, ()), times) is None]
        if timeless:
            shown = join_names(tuple(map(clean_line, timeless)), 5)
            yield f"{len(timeless)} without a time count as in time: {shown}"


def _extension_remarks(rows: Sequence[GradebookRow], policy: LatePolicy) -> Iterator[str]:
    known = {look(key) for row in rows for key in _names_of(row)}
    for name in policy.extensions:
        if look(name) not in known:
            yield f"{policy.locations[name]}: an extension for nobody: {suggestion(name, sorted(known))}"


def _names_of(row: GradebookRow) -> Iterator[str]:
    """Yields everything by which a teacher may mean the student of a row."""
    yield row.name
    if row.work:
        yield row.work
    if row.student is not None:
        yield from row.student.keys
        if row.student.group:
            yield row.student.group


def with_marks(
    rows: Sequence[GradebookRow],
    marks: Mapping[str, ManualMark],
    roster: Roster | None,
    most: Mapping[str, float],
) -> tuple[list[GradebookRow], list[str]]:
    """Returns the rows with a teacher's marks, and a remark for each mark that does not fit (any more).

    ``most``: the most points of each criterion.
    """
    found, remarks = list(rows), []
    for name, mark in marks.items():
        at = [i for i, row in enumerate(rows) if look(name) in map(look, _names_of(row))]
        is_group = bool(at) and all(
            row.student is not None and look(row.student.group) == look(name) for row in (rows[i] for i in at)
        )
        if not at:
            near = suggestion(name, sorted({key for row in rows for key in _names_of(row)}))
            remarks.append(f"{mark.location}: a mark for nobody: {near}")
        elif len(at) > 1 and not is_group:
            remarks.append(
                f"{mark.location}: {clean_line(name)} fits {len(at)} students: write the e-mail address, id or login"
            )
        else:
            for i in at:
                found[i] = _with_mark(found[i], mark, most)
        remarks += _mark_errors(mark, most)
    return found, list(dict.fromkeys(remarks))


def _mark_errors(mark: ManualMark, most: Mapping[str, float]) -> Iterator[str]:
    """Yields what a mark says of criteria that there are not, and points above the most."""
    for criterion in (*mark.points, *mark.comments):
        if criterion not in most:
            yield f"{mark.location}: no criterion {clean_line(criterion)}: {suggestion(criterion, list(most))}"
    for criterion, points in mark.points.items():
        if points > most.get(criterion, math.inf):
            given, worth = format_points(points), format_points(most[criterion])
            yield f"{mark.location}: {given} points for {clean_line(criterion)}, which is worth {worth}: not used"


def _with_mark(row: GradebookRow, mark: ManualMark, most: Mapping[str, float]) -> GradebookRow:
    given = {each: points for each, points in mark.points.items() if points <= most.get(each, -1.0)}
    comments = {each: text for each, text in mark.comments.items() if each in most}
    if mark.comment:
        comments[""] = mark.comment
    tests = {**row.tests, **given}
    points, final = row.points, row.final
    if given or mark.extra:
        points = round(max(0.0, math.fsum(tests.values()) + mark.extra), 6)
        final = round(points * row.kept, 6)
    return replace(
        row,
        points=points,
        final=final if mark.final is None else mark.final,
        tests=tests,
        maxima={**row.maxima, **{each: most[each] for each in given}},
        marked=tuple(sorted(given)),
        comments=comments,
        extra=mark.extra,
    )
