"""The queue of a cohort in a folder, and its workers: ``manifest.json``, ``assignment/``, ``jobs/KEY.json``, ``results/KEY.json``,
``findings/KEY.json``."""

from __future__ import annotations

import base64
import hashlib
import json
import os
import re
import shutil
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, ClassVar, Final

from grader.assignment import Assignment
from grader.evidence.findings import Findings
from grader.grading import GradingOptions, grade_and_keep, judge_findings
from grader.grading_level import level_for_untrusted
from grader.look_alikes import distinct_name
from grader.reading import read_assignment
from grader.shown_names import readable_name
from grader.submission import Submission, read_submission, submission_name
from grader.submitted_files import SubmissionRefused, SubmissionUnreadable, is_ignored_name
from grader.version import grader_version
from kit.field_types import check_field_types
from kit.host.job_executors import MAX_TRIES, read_result
from kit.host.job_folder import JobFolder
from kit.host.python_command import python_command
from kit.host.sandbox.sandbox_config import Level
from kit.plain_text import quoted
from kit.results.grading_result import (
    PUBLIC_SEEDS,
    SCHEMA,
    WITH_SECRET,
    CriterionResult,
    CriterionStatus,
    GradingResult,
    GradingVerdict,
)
from kit.workspace import draft_folder, make_private_folder, write_atomically
from kit.world.problems import WorldError

MANIFEST: Final = "manifest.json"
GRACE_S: Final = 120.0
"""Wall clock that a worker gets for a job besides what the submission may take [s]: to start, to judge and to save."""
_KEY: Final = re.compile(r"[0-9a-f]{32}")


class QueueError(Exception):
    """The queue folder cannot be used; the message says why."""


@dataclass(frozen=True, slots=True)
class QueueEntry:
    """One submission of the cohort."""

    name: str
    key: str | None
    """The key of its job; None if it cannot be read."""
    refused: str = ""
    """Why it cannot be read, and the way out, for the student."""
    note: str = ""
    """What was ignored of it."""
    error: str = ""
    """The internal error with which reading it ended; empty if it was refused for a known reason."""


@dataclass(frozen=True, slots=True)
class QueueManifest:
    """What a queue grades, and how."""

    assignment: str
    assignment_version: str
    grader_version: str
    secret: bool
    examples: bool
    level: int
    """The confinement level of every program."""
    passed_over: tuple[str, ...]
    """The names in the folder of works that were not taken for works."""
    entries: tuple[QueueEntry, ...]

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> QueueManifest:
        """Reads what ``asdict`` gave. Raises KeyError, TypeError or ValueError for other data."""
        entries = content["entries"]
        check_field_types(cls, {**content, "entries": ()})
        for each in entries:
            check_field_types(QueueEntry, each)
            if each["key"] is not None and not _KEY.fullmatch(each["key"]):
                raise ValueError(f"{quoted(each['key'])} is no key")
        Level(content["level"])
        return cls(**{**content, "entries": tuple(QueueEntry(**each) for each in entries)})

    def grading_options(self) -> GradingOptions:
        """How every job is graded."""
        return GradingOptions(Level(self.level), self.secret, self.examples, may_lower_level=False)


@dataclass(frozen=True, slots=True)
class UnreadableWork:
    """Instead of a result: what was handed in could not be read when it was graded."""

    unreadable: str
    """Why, and the way out, for the student."""
    error: str = ""
    """The internal error, as in ``QueueEntry``."""


@dataclass(frozen=True, slots=True)
class Queue(JobFolder):
    """A queue folder."""

    job_name: ClassVar[str] = "grader"

    @property
    def worker_command(self) -> list[str]:
        return python_command("grader", "worker", str(self.folder.absolute()))

    @property
    def shard_command(self) -> list[str]:
        return python_command("grader", "work", str(self.folder.absolute()))

    @property
    def limit_s(self) -> float:
        return MAX_TRIES * (self.assignment().submission_limit_s + GRACE_S)

    @property
    def assignment_folder(self) -> Path:
        return self.folder / "assignment"

    def job(self, key: str) -> Path:
        return self.folder / "jobs" / f"{key}.json"

    def findings_file(self, key: str) -> Path:
        """Where what was found about a submission is kept; see ``findings_key``."""
        return self.folder / "findings" / f"{key}.json"

    def result_file(self, key: str) -> Path:
        return self.folder / "results" / f"{key}.json"

    def assignment(self) -> Assignment:
        """Reads the assignment as it was when the queue was made. Raises WorldError."""
        return read_assignment(self.assignment_folder)

    def manifest(self) -> QueueManifest:
        """Raises QueueError."""
        try:
            return QueueManifest.from_dict(read_result(self.folder / MANIFEST))
        except FileNotFoundError:
            problem = "not a queue of the grader; `grader cohort` creates one."
            raise QueueError(f"{self.folder}: {problem}") from None
        except (OSError, KeyError, TypeError, ValueError):
            problem = "it cannot be read; `grader cohort` makes it again, and keeps all results."
            raise QueueError(f"{self.folder / MANIFEST}: {problem}") from None

    def grading_options(self) -> GradingOptions:
        """How every job is graded."""
        return self.manifest().grading_options()

    def entries(self) -> tuple[QueueEntry, ...]:
        return self.manifest().entries

    def result(self, key: str) -> GradingResult | None:
        """Returns a job's result; None if there is none that can be read and is this job's, so that it is graded again."""
        try:
            result = GradingResult.from_dict(read_result(self.result_file(key)))
        except (OSError, KeyError, TypeError, ValueError):
            return None
        return result if self._is_result_of(key, result) else None

    def _is_result_of(self, key: str, result: GradingResult) -> bool:
        """Whether a worker has graded this job, and not another submission, at another level, by another assignment."""
        keys = (
            _key_of(
                result.submission,
                result.assignment_version,
                result.grader_version,
                is_secret=result.seeds == WITH_SECRET,
                has_examples=has_examples,
                level=result.level,
            )
            for has_examples in (False, True)
        )
        if key not in keys:
            return False
        assignment = _assignment(self.folder, result.assignment_version)
        wanted = [(each.id, each.points) for each in assignment.tests]
        return [(each.id, each.max_points) for each in result.tests] == wanted

    def unreadable(self, key: str) -> UnreadableWork | None:
        """Returns why a job's work could not be read; None if it could, or has not been tried."""
        try:
            content = read_result(self.result_file(key))
            check_field_types(UnreadableWork, content)
            return UnreadableWork(**content)
        except (OSError, KeyError, TypeError, ValueError):
            return None

    def is_waiting(self, key: str) -> bool:
        return self.result(key) is None and self.unreadable(key) is None

    def refused_result(self, key: str) -> str:
        """Names the file that a worker has left for a job that is waiting all the same; empty if there is none."""
        file = self.result_file(key)
        return f"{file}: it cannot be read, or is another job's" if os.path.lexists(file) else ""

    def keys(self) -> list[str]:
        return sorted({entry.key for entry in self.entries() if entry.key is not None})

    def run_job(self, key: str) -> GradingResult | None:
        """Grades one job and saves its result. Returns None, and saves why, if the work cannot be read. Raises QueueError."""
        try:
            return self._grade(key)
        except SubmissionRefused as refused:
            self.save_unreadable(key, refused)
            return None

    def _grade(self, key: str) -> GradingResult:
        manifest = self.manifest()
        assignment = _assignment(self.folder, manifest.assignment_version)
        submission, options = self.submission(key), manifest.grading_options()
        result, findings = grade_and_keep(assignment, submission, options)
        for _ in range(MAX_TRIES - 1):  # a failure of the student's program is never retried
            if result.verdict is not GradingVerdict.BROKEN:
                break
            result, findings = grade_and_keep(assignment, submission, options)
        if findings is not None:
            of = findings_key(submission, assignment, options)
            _write(self.findings_file(of), {"of": of, **findings.as_dict()})
        self.save_result(key, result)
        return result

    def record_loss(self, key: str) -> None:
        """Saves for a job that it has no grade; unless its worker had saved the result before it died."""
        if self.is_waiting(key):
            # A job that cannot be read itself stays waiting until it is written again.
            with suppress(QueueError):
                self.save_result(key, _incident_result(self, key))

    def submission(self, key: str) -> Submission:
        """Returns the work of a job. Raises QueueError if this machine cannot grade it as the queue means it."""
        manifest = self.manifest()
        if manifest.grader_version != grader_version():
            raise QueueError(
                f"{self.folder}: version {quoted(manifest.grader_version)} of the grader has made this queue, and this machine "
                f"has {grader_version()}: install the same on all machines."
            )
        submission = self._read_job(key)
        assignment = _assignment(self.folder, manifest.assignment_version)
        if submission is None or job_key(submission, assignment, manifest.grading_options()) != key:
            raise QueueError(f"{self.job(key)}: it is damaged; `grader cohort` writes it again.")
        return submission

    def has_job(self, key: str, submission: Submission) -> bool:
        """Whether the file of a job holds this work."""
        known = self._read_job(key)
        return known is not None and known.digest == submission.digest

    def _read_job(self, key: str) -> Submission | None:
        try:
            content = read_result(self.job(key))
            files = {name: base64.b64decode(data) for name, data in content["files"].items()}
            return Submission(content["name"], content["main"], files)
        except (OSError, KeyError, TypeError, ValueError, AttributeError):
            return None

    def save_result(self, key: str, result: GradingResult) -> None:
        """Saves a job's result. One without a grade never takes the place of a grade, however late it comes."""
        if result.verdict is GradingVerdict.BROKEN and self._has_grade(key):
            return
        _write(self.result_file(key), result.as_dict())

    def _has_grade(self, key: str) -> bool:
        known = self.result(key)
        return known is not None and known.verdict is not GradingVerdict.BROKEN

    def save_unreadable(self, key: str, refused: SubmissionRefused) -> None:
        """Saves instead of a result that the work cannot be read."""
        work = UnreadableWork(
            str(refused), refused.error if isinstance(refused, SubmissionUnreadable) else ""
        )
        _write(self.result_file(key), asdict(work))


def _write(file: Path, content: Mapping[str, Any]) -> None:
    """Writes a file of a queue. What lies there and is no file is replaced, and nothing behind a link is touched."""
    write_atomically(file, (json.dumps(content, allow_nan=False) + "\n").encode(), follows_links=False)


def job_key(submission: Submission, assignment: Assignment, options: GradingOptions) -> str:
    """Returns one name for everything that decides a result."""
    return _key_of(
        submission.digest,
        assignment.version,
        grader_version(),
        is_secret=options.secret,
        has_examples=options.examples,
        level=int(level_for_untrusted(assignment, options.level)),
    )


def findings_key(submission: Submission, assignment: Assignment, options: GradingOptions) -> str:
    """Returns one name for everything that decides what is found about a submission, whatever that is worth."""
    return _key_of(
        submission.digest,
        assignment.evidence_version,
        grader_version(),
        is_secret=options.secret,
        has_examples=options.examples,
        level=int(level_for_untrusted(assignment, options.level)),
    )


def judge_anew(queue: Queue) -> int:
    """Judges the waiting jobs about whose works everything is known already, and returns how many: after a change of points
    or words no program is run again."""
    assignment, options, judged = queue.assignment(), queue.grading_options(), 0
    for key in queue.waiting():
        submission = queue.submission(key)
        of = findings_key(submission, assignment, options)
        try:
            content = read_result(queue.findings_file(of))
            if content["of"] != of:
                raise ValueError("findings about another submission")
            findings = Findings.from_dict(content)
        except (OSError, KeyError, TypeError, ValueError):
            continue
        result = judge_findings(assignment, submission, options, findings)
        if result is not None:
            queue.save_result(key, result)
            judged += 1
    return judged


def _key_of(
    submission: str, assignment: str, grader: str, *, is_secret: bool, has_examples: bool, level: int
) -> str:
    parts = (submission, assignment, grader, SCHEMA, is_secret, has_examples, level)
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:32]


def prepare_queue(
    queue: Queue, cohort: Path, assignment: Assignment, options: GradingOptions
) -> tuple[QueueEntry, ...]:
    """Makes or updates the queue for all submissions in the folder ``cohort``. Results that still apply are kept.

    Raises QueueError, OSError.
    """
    for folder in (queue.folder, *(queue.folder / name for name in ("jobs", "results", "findings"))):
        make_private_folder(folder)
    _copy_assignment(queue, assignment)
    works, passed_over = works_in(cohort)
    entries = tuple(_queue_entries(queue, works, assignment, options))
    level = level_for_untrusted(assignment, options.level)
    manifest = QueueManifest(
        assignment.id,
        assignment.version,
        grader_version(),
        options.secret,
        options.examples,
        int(level),
        tuple(passed_over),
        entries,
    )
    _write(queue.folder / MANIFEST, asdict(manifest))
    return entries


def works_in(cohort: Path) -> tuple[list[Path], list[str]]:
    """Returns what was handed in, and the names of what is passed over: those that begin with a dot, and what computers leave
    beside works. Raises OSError."""
    works, passed_over = [], []
    for path in sorted(cohort.iterdir()):
        if is_ignored_name(path.name):
            passed_over.append(readable_name(path.name))
        else:
            works.append(path)
    return works, passed_over


def _queue_entries(
    queue: Queue, works: Sequence[Path], assignment: Assignment, options: GradingOptions
) -> Iterator[QueueEntry]:
    names: set[str] = set()
    for path in works:
        name = distinct_name(names, submission_name(path), readable_name(path.name))
        try:
            submission = read_submission(path, assignment.submit)
        except SubmissionUnreadable as unreadable:
            yield QueueEntry(name, None, str(unreadable), error=unreadable.error)
            continue
        except SubmissionRefused as refused:
            yield QueueEntry(name, None, str(refused))
            continue
        key = job_key(submission, assignment, options)
        if not queue.has_job(key, submission):
            files = {each: base64.b64encode(data).decode() for each, data in sorted(submission.files.items())}
            _write(queue.job(key), {"name": name, "main": submission.main, "files": files})
        yield QueueEntry(name, key, note=submission.note)


def _copy_assignment(queue: Queue, assignment: Assignment) -> None:
    """Copies the present assignment beside the jobs, completely or not at all."""
    target = queue.assignment_folder
    if target.exists():
        with suppress(WorldError):  # the copy is damaged
            if read_assignment(target).version == assignment.version:
                return
        shutil.rmtree(target)
    with draft_folder(queue.folder) as draft:
        shutil.copytree(assignment.folder, draft, dirs_exist_ok=True)
        draft.rename(target)


@cache
def _assignment(folder: Path, version: str) -> Assignment:
    return Queue(folder).assignment()


def _incident_result(queue: Queue, key: str) -> GradingResult:
    """Returns the result of a job whose worker died every time: no grade, and a notice to the teacher."""
    assignment, submission, options = queue.assignment(), queue.submission(key), queue.grading_options()
    tests = tuple(
        replace(
            CriterionResult(
                each.id, each.title, CriterionStatus.GRADER_ERROR, 0.0, each.points, each.visibility
            ),
            rationale="The grader failed while it graded this. You lost no points; your teacher will be informed.",
        )
        for each in assignment.tests
    )
    return GradingResult(
        assignment.id,
        assignment.version,
        submission.digest,
        grader_version(),
        WITH_SECRET if options.secret else PUBLIC_SEEDS,
        int(options.level or 0),
        sys.platform,
        tests,
    )
