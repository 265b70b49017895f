"""The queue of a cohort in a folder, and its workers: ``manifest.json``, ``assignment/``, ``jobs/KEY.json``, ``results/KEY.json``,
``findings/KEY.json``."""

from __future__ import annotations

import base64
import hashlib
import json
import shutil
import sys
from collections.abc import Iterator, Sequence
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

MANIFEST: Final = "manifest.json"
GRACE_S: Final = 120.0
"""Wall clock that a worker gets for a job besides what the submission may take [s]: to start, to judge and to save."""


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

    def manifest(self) -> dict[str, Any]:
        try:
            content: dict[str, Any] = json.loads((self.folder / MANIFEST).read_bytes())
        except (OSError, ValueError):
            raise QueueError(
                f"{self.folder}: not a queue of the grader; `grader cohort` creates one."
            ) from None
        return content

    def level(self) -> Level:
        """The confinement level of every program."""
        return Level(self.manifest()["level"])

    def grading_options(self) -> GradingOptions:
        """How every job is graded."""
        manifest = self.manifest()
        return GradingOptions(
            self.level(), bool(manifest["secret"]), bool(manifest["examples"]), may_lower_level=False
        )

    def passed_over(self) -> tuple[str, ...]:
        """The names in the folder of works that were not taken for works."""
        return tuple(self.manifest()["passed_over"])

    def entries(self) -> tuple[QueueEntry, ...]:
        return tuple(QueueEntry(**each) for each in self.manifest()["entries"])

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

    def keys(self) -> list[str]:
        return sorted({entry.key for entry in self.entries() if entry.key is not None})

    def run_job(self, key: str) -> GradingResult | None:
        """Grades one job and saves its result. Returns None, and saves why, if the work cannot be read."""
        try:
            return self._grade(key)
        except SubmissionRefused as refused:
            self.save_unreadable(key, refused)
            return None

    def _grade(self, key: str) -> GradingResult:
        manifest = self.manifest()
        assignment = _assignment(self.folder, manifest["assignment_version"])
        submission, options = self.submission(key), self.grading_options()
        result, findings = grade_and_keep(assignment, submission, options)
        for _ in range(MAX_TRIES - 1):  # a failure of the student's program is never retried
            if result.verdict is not GradingVerdict.BROKEN:
                break
            result, findings = grade_and_keep(assignment, submission, options)
        if findings is not None:
            file = self.findings_file(findings_key(submission, assignment, options))
            write_atomically(file, (json.dumps(findings.as_dict()) + "\n").encode())
        self.save_result(key, result)
        return result

    def record_loss(self, key: str) -> None:
        """Saves for a job that it has no grade; unless its worker had saved the result before it died."""
        if self.is_waiting(key):
            self.save_result(key, _incident_result(self, key))

    def submission(self, key: str) -> Submission:
        content = json.loads(self.job(key).read_bytes())
        files = {name: base64.b64decode(data) for name, data in content["files"].items()}
        return Submission(content["name"], content["main"], files)

    def save_result(self, key: str, result: GradingResult) -> None:
        """Saves a job's result. One without a grade never takes the place of a grade, however late it comes."""
        if result.verdict is GradingVerdict.BROKEN and self._has_grade(key):
            return
        write_atomically(
            self.result_file(key), (json.dumps(result.as_dict(), allow_nan=False) + "\n").encode()
        )

    def _has_grade(self, key: str) -> bool:
        known = self.result(key)
        return known is not None and known.verdict is not GradingVerdict.BROKEN

    def save_unreadable(self, key: str, refused: SubmissionRefused) -> None:
        """Saves instead of a result that the work cannot be read."""
        work = UnreadableWork(
            str(refused), refused.error if isinstance(refused, SubmissionUnreadable) else ""
        )
        write_atomically(self.result_file(key), (json.dumps(asdict(work)) + "\n").encode())


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
        try:
            content = read_result(queue.findings_file(findings_key(submission, assignment, options)))
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
    content = {
        "assignment": assignment.id,
        "assignment_version": assignment.version,
        "grader_version": grader_version(),
        "secret": options.secret,
        "examples": options.examples,
        "level": int(level),
        "passed_over": passed_over,
        "entries": [asdict(each) for each in entries],
    }
    write_atomically(queue.folder / MANIFEST, (json.dumps(content, indent=1) + "\n").encode())
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
        if not queue.job(key).exists():
            files = {each: base64.b64encode(data).decode() for each, data in sorted(submission.files.items())}
            job = {"name": name, "main": submission.main, "files": files}
            write_atomically(queue.job(key), json.dumps(job).encode())
        yield QueueEntry(name, key, note=submission.note)


def _copy_assignment(queue: Queue, assignment: Assignment) -> None:
    """Copies the present assignment beside the jobs, completely or not at all."""
    target = queue.assignment_folder
    if target.exists():
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
