"""The queue folder: ``manifest.json``, ``assignment/``, ``jobs/KEY.json``, ``results/KEY.json``."""

from __future__ import annotations

import base64
import hashlib
import json
import shutil
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

from grader.assignment import Assignment
from grader.grading import GradingOptions, level_for_untrusted
from grader.reading import read_assignment
from grader.submission import Submission, read_submission, submission_name
from grader.submitted_files import IGNORED_NAMES, SubmissionRefused, SubmissionUnreadable
from grader.version import grader_version
from kit.host.job_executors import in_shard
from kit.host.sandbox.confinement import Level
from kit.school.result import SCHEMA, GradingResult
from kit.workspace import write_atomically

MANIFEST: Final = "manifest.json"


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
class Queue:
    """A queue folder."""

    folder: Path

    @property
    def assignment_folder(self) -> Path:
        return self.folder / "assignment"

    def job(self, key: str) -> Path:
        return self.folder / "jobs" / f"{key}.json"

    def result_file(self, key: str) -> Path:
        return self.folder / "results" / f"{key}.json"

    def assignment(self) -> Assignment:
        """Reads the assignment as it was when the queue was made. Raises WorldError."""
        return read_assignment(self.assignment_folder)

    def manifest(self) -> dict[str, Any]:
        try:
            content: dict[str, Any] = json.loads((self.folder / MANIFEST).read_bytes())
        except (OSError, ValueError):
            raise QueueError(f"{self.folder}: no queue of the grader; `grader cohort` makes one.") from None
        return content

    def level(self) -> Level:
        """The confinement level of every program. Raises QueueError if it is 0 without a request for that."""
        content = self.manifest()
        level = Level(content["level"])
        if level == Level.LIMITED and not content.get("level_0_asked"):
            raise QueueError(
                f"{self.folder}: an older queue with level 0, which was not requested. Run `grader cohort` again: "
                "it grades at level 1 or higher, or at 0 if you say --level 0."
            )
        return level

    def grading_options(self) -> GradingOptions:
        return GradingOptions(self.level(), bool(self.manifest()["secret"]), may_lower_level=False)

    def entries(self) -> tuple[QueueEntry, ...]:
        return tuple(QueueEntry(**each) for each in self.manifest()["entries"])

    def result(self, key: str) -> GradingResult | None:
        """Returns a job's result; None if there is none that can be read, so that it is graded again."""
        try:
            return GradingResult.from_dict(json.loads(self.result_file(key).read_bytes()))
        except (OSError, KeyError, TypeError, ValueError):
            return None

    def unreadable(self, key: str) -> UnreadableWork | None:
        """Returns why a job's work could not be read; None if it could, or has not been tried."""
        try:
            return UnreadableWork(**json.loads(self.result_file(key).read_bytes()))
        except (OSError, TypeError, ValueError):
            return None

    def is_waiting(self, key: str) -> bool:
        """True if a job has no result yet."""
        return self.result(key) is None and self.unreadable(key) is None

    def waiting(self, shard: tuple[int, int] = (0, 1)) -> tuple[str, ...]:
        """Returns the keys without a result that belong to shard ``i`` of ``n``."""
        keys = sorted({entry.key for entry in self.entries() if entry.key is not None})
        return tuple(key for key in keys if in_shard(key, shard) and self.is_waiting(key))

    def submission(self, key: str) -> Submission:
        content = json.loads(self.job(key).read_bytes())
        files = {name: base64.b64decode(data) for name, data in content["files"].items()}
        return Submission(content["name"], content["main"], files)

    def save_result(self, key: str, result: GradingResult) -> None:
        write_atomically(
            self.result_file(key), (json.dumps(result.as_dict(), allow_nan=False) + "\n").encode()
        )

    def save_unreadable(self, key: str, refused: SubmissionRefused) -> None:
        """Saves instead of a result that the work cannot be read."""
        work = UnreadableWork(
            str(refused), refused.error if isinstance(refused, SubmissionUnreadable) else ""
        )
        write_atomically(self.result_file(key), (json.dumps(asdict(work)) + "\n").encode())


def job_key(submission: Submission, assignment: Assignment, options: GradingOptions) -> str:
    """What decides a result, as one name."""
    level = level_for_untrusted(assignment, options.level)
    parts = (submission.digest, assignment.version, grader_version(), SCHEMA, options.secret, int(level))
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:32]


def prepare_queue(
    queue: Queue, cohort: Path, assignment: Assignment, options: GradingOptions
) -> tuple[QueueEntry, ...]:
    """Makes or updates the queue for all submissions in the folder ``cohort``. Results that still apply are kept.

    Raises QueueError, OSError.
    """
    for part in ("jobs", "results"):
        (queue.folder / part).mkdir(parents=True, exist_ok=True)
    _copy_assignment(queue, assignment)
    entries = tuple(_entries(queue, cohort, assignment, options))
    level = level_for_untrusted(assignment, options.level)
    content = {
        "assignment": assignment.id,
        "assignment_version": assignment.version,
        "grader_version": grader_version(),
        "secret": options.secret,
        "level": int(level),
        "level_0_asked": options.level == Level.LIMITED,
        "entries": [asdict(each) for each in entries],
    }
    write_atomically(queue.folder / MANIFEST, (json.dumps(content, indent=1) + "\n").encode())
    return entries


def _entries(
    queue: Queue, cohort: Path, assignment: Assignment, options: GradingOptions
) -> Iterator[QueueEntry]:
    names: set[str] = set()
    for path in sorted(cohort.iterdir()):
        if path.name.startswith(".") or path.name.lower() in IGNORED_NAMES:
            continue
        name = submission_name(path)
        if name in names:
            name = path.name
        names.add(name)
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
    coming = queue.folder / "assignment.coming"
    shutil.rmtree(coming, ignore_errors=True)
    shutil.copytree(assignment.folder, coming)
    coming.rename(target)
