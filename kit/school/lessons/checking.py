"""A student's exercise: its files in the workspace, and its check by the grader's command in a process of its own."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any, Final, Self

from kit.host.python_command import python_command
from kit.results.grading_result import PUBLIC_CASES, CriterionResult, GradingResult, GradingVerdict
from kit.school.lessons.reading import solutions_folder
from kit.school.lessons.records import Exercise, Lesson
from kit.school.lessons.shell_lines import shell_path
from kit.school.lessons.training_curves import TrainingCurves, is_drive_line, read_training_curves
from kit.school.lessons.translation import translated_result, translation_of
from kit.workspace import Workspace, write_atomically

STARTER: Final = "starter"
SOLUTION: Final = "solution"
SOLUTIONS: Final = "solutions"
"""Folder in another author's lesson with a solution and wrong solutions for each exercise."""


class ExerciseFilesError(Exception):
    """The student's files cannot be installed; the message says why."""


def exercise_folder(workspace: Workspace, lesson: Lesson, exercise: Exercise) -> Path:
    """The folder of the student's files of an exercise."""
    return workspace.lessons / lesson.name / exercise.name


def exercise_file(workspace: Workspace, lesson: Lesson, exercise: Exercise) -> Path:
    """The file that the student edits."""
    return exercise_folder(workspace, lesson, exercise) / exercise.file


def has_other_files(exercise: Exercise) -> bool:
    """Whether a folder of files is handed in, not one file."""
    return (exercise.folder / STARTER).is_dir()


def install_exercise(workspace: Workspace, lesson: Lesson, exercise: Exercise) -> Path:
    """Creates the missing files of the exercise, and leaves existing ones alone. Returns the file to edit.

    Raises ExerciseFilesError.
    """
    folder = exercise_folder(workspace, lesson, exercise)
    try:
        for name, content in _starter_files(exercise):
            file = folder / name
            if not file.exists():
                file.parent.mkdir(parents=True, exist_ok=True)
                write_atomically(file, content)
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ExerciseFilesError(f"{folder}: the exercise cannot be installed ({error.strerror}).") from None
    return folder / exercise.file


def untouched_files(exercise: Exercise, folder: Path) -> frozenset[Path]:
    """The files of an exercise that are as the starter has them."""
    untouched = set()
    for name, content in _starter_files(exercise):
        with contextlib.suppress(OSError):
            if (folder / name).read_bytes() == content:
                untouched.add(folder / name)
    return frozenset(untouched)


def is_untouched(file: Path, exercise: Exercise) -> bool:
    """Whether the file to hand in is missing, or still the starter's."""
    try:
        content = file.read_bytes()
    except OSError:
        return True
    single = exercise.folder / f"{STARTER}{Path(exercise.file).suffix}"
    translated = [each.read_bytes() for each in single.parent.glob(f"{STARTER}.??{single.suffix}")]
    starters = [starter for name, starter in _starter_files(exercise) if name == exercise.file]
    return content in (*starters, *translated)


def reset_exercise(workspace: Workspace, lesson: Lesson, exercise: Exercise, *, now: datetime) -> Path | None:
    """Resets the exercise to its starter files. Returns the backup folder of the old files; None if there were none.

    Raises ExerciseFilesError.
    """
    folder = exercise_folder(workspace, lesson, exercise)
    backup = None
    if folder.exists():
        backup = folder.with_name(f"{folder.name}.{now:%Y%m%d-%H%M%S-%f}")
        try:
            folder.rename(backup)
        except OSError as error:
            raise ExerciseFilesError(
                f"{folder}: cannot be renamed to keep a backup ({error.strerror})."
            ) from None
    install_exercise(workspace, lesson, exercise)
    return backup


def read_solution(lesson: Lesson, exercise: Exercise) -> dict[str, str]:
    """The texts of the reference solution's files by name, the file to edit first, without binary files.
    Empty where solutions were not installed."""
    try:
        solutions = lesson.folder / SOLUTIONS if lesson.is_foreign else solutions_folder() / lesson.name
        folder = solutions / exercise.name
    except FileNotFoundError:
        return {}
    single = folder / f"{SOLUTION}{Path(exercise.file).suffix}"
    if single.is_file():
        files = [(exercise.file, single.read_bytes())]
    elif (folder / SOLUTION).is_dir():
        files = list(_folder_files(folder / SOLUTION))
    else:
        return {}
    texts = {}
    for name, content in sorted(files, key=lambda each: each[0] != exercise.file):
        try:
            texts[name] = content.decode()
        except UnicodeDecodeError:
            continue
    return texts


def _starter_files(exercise: Exercise) -> Iterator[tuple[str, bytes]]:
    whole = exercise.folder / STARTER
    if whole.is_dir():
        yield from _folder_files(whole)
        return
    single = exercise.folder / f"{STARTER}{Path(exercise.file).suffix}"
    if single.is_file():
        yield exercise.file, (translation_of(single) or single).read_bytes()


def _folder_files(folder: Path) -> Iterator[tuple[str, bytes]]:
    for file in sorted(folder.rglob("*")):
        if file.is_file() and "__pycache__" not in file.parts:
            yield file.relative_to(folder).as_posix(), file.read_bytes()


TIMEOUT_S: Final = 300.0
"""A check that takes longer hangs, and is stopped [s]."""
PROGRESS_INTERVAL_S: Final = 2.0
"""Between two lines about the progress of a check that is waited for [s]."""
MAX_PROGRESS_BYTES: Final = 1 << 20
"""Bytes of the progress that curves are read from."""
PROGRESS_BYTES: Final = 1024
"""Bytes in which the newest line about the progress is looked for."""


@dataclass(frozen=True, slots=True)
class CheckReport:
    """The outcome of one check of an exercise: the grader's result, or the problem because of which there is none."""

    verdict: GradingVerdict
    """``BROKEN``: the check itself failed, which is never the student's doing."""
    result: GradingResult | None
    seconds: float
    """Duration of the check."""
    problem: str = ""
    """Why there is no result: a broken check, or a file that is missing."""
    recording: Path | None = None
    """Recording of the worst episode, of a work that passed: of the first; None where there is none."""

    @property
    def is_passed(self) -> bool:
        return self.verdict is GradingVerdict.PASS

    @property
    def is_broken(self) -> bool:
        return self.verdict is GradingVerdict.BROKEN

    @property
    def points(self) -> float:
        return 0.0 if self.result is None else self.result.points or 0.0

    @property
    def max_points(self) -> float:
        return 0.0 if self.result is None else self.result.max_points

    @property
    def criteria(self) -> tuple[CriterionResult, ...]:
        return () if self.result is None else self.result.tests

    @property
    def lost_criteria(self) -> tuple[CriterionResult, ...]:
        """The criteria that did not pass, in order."""
        return tuple(each for each in self.criteria if not each.is_passed)

    def as_event(self) -> Mapping[str, Any]:
        """The content of the journal's event."""
        return {
            "points": self.points,
            "max_points": self.max_points,
            "verdict": self.verdict.value,
            "lost": [each.id for each in self.lost_criteria],
            "submission": "" if self.result is None else self.result.submission,
            "seconds": round(self.seconds, 2),
        }


class ExerciseCheck:
    """A running check. Call ``poll`` or ``wait``; leaving the context stops it with every process it started."""

    def __init__(
        self, exercise: Exercise, file: Path, *, recording: Path | None = None, as_class: bool = False
    ) -> None:
        """``file``: the file that the student edits; where the starter is a folder, its folder is submitted.
        ``recording``: where to save the worst episode, in place of an earlier one. ``as_class``: at the confinement level at which a class is
        graded."""
        self._started_at = time.monotonic()
        self._words = exercise.words
        self._recording = recording
        self._stdout = TemporaryFile()  # noqa: SIM115  # lives as long as the check, and `close` closes it
        self._stderr = TemporaryFile()  # noqa: SIM115  # lives as long as the check, and `close` closes it
        self._progress = TemporaryFile()  # noqa: SIM115  # likewise
        self._public_verdict = ""
        self._curves: TrainingCurves | None = None
        self._curves_end = 0
        """Bytes of the progress that they were read from."""
        self._report: CheckReport | None = None
        self._process: subprocess.Popen[bytes] | None = None
        if not file.exists():
            self._report = _without_result(
                f"{shell_path(file)} does not exist. `x` restarts the exercise with new files.",
                GradingVerdict.FAIL,
            )
            return
        if not file.is_file():
            self._report = _without_result(
                f"{shell_path(file)} is not a file. Save your work under that name; `x` restarts the exercise and keeps a copy of "
                "what is there.",
                GradingVerdict.FAIL,
            )
            return
        if recording is not None:
            recording.unlink(missing_ok=True)
        command = python_command("grader", "check", str(submission_path(exercise, file)))
        command += ["--assignment", str(exercise.folder), "--json", "--for-student", "--secret"]
        # Their own program on their own machine needs no confinement, and starts faster without.
        command += [] if as_class else ["--level", "0"]
        command += ["--replay", str(recording)] if recording is not None else []
        command += ["--progress-descriptor", str(self._progress.fileno())]
        try:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=self._stdout,
                stderr=self._stderr,
                # Not in the student's folder: no module that lies there is imported by the grader's own process.
                cwd=exercise.folder,
                start_new_session=True,
                pass_fds=(self._progress.fileno(),),
            )
        except OSError as error:
            self._report = _without_result(
                f"The check could not be started ({error.strerror}).", GradingVerdict.BROKEN
            )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def elapsed_s(self) -> float:
        """Seconds since the start."""
        return time.monotonic() - self._started_at

    @property
    def progress(self) -> str:
        """What the check is doing, in one line: ``episode 2 of 5: office, seed 1``; before it, once that is known, what the
        public cases came to. Empty where nothing was said yet."""
        if self._progress.closed:
            return ""
        end = os.fstat(self._progress.fileno()).st_size
        # Not by seek: the process that writes shares the position.
        newest = os.pread(self._progress.fileno(), PROGRESS_BYTES, max(0, end - PROGRESS_BYTES))
        lines = newest.decode(errors="replace").split("\n")[:-1]
        whole = lines if end <= PROGRESS_BYTES else lines[1:]  # the first one may have lost its beginning
        line = next((each for each in reversed(whole) if not is_drive_line(each)), "")
        self._public_verdict = next(
            (each for each in reversed(whole) if each.startswith(PUBLIC_CASES)), self._public_verdict
        )
        parts = dict.fromkeys(each for each in (self._public_verdict, line) if each)
        return "".join(filter(str.isprintable, "; ".join(parts)))

    @property
    def training_curves(self) -> TrainingCurves | None:
        """The curves of the trainings that it has made so far; None where there are none."""
        if not self._progress.closed:
            end = os.fstat(self._progress.fileno()).st_size
            if end != self._curves_end:
                text = os.pread(self._progress.fileno(), min(end, MAX_PROGRESS_BYTES), 0)
                self._curves = read_training_curves(text.decode(errors="replace"))
                self._curves_end = end
        return self._curves

    @property
    def _newest_drive(self) -> str:
        """Describes the newest drive in words; empty if there is none."""
        curves = self.training_curves
        return "" if curves is None or curves.drive is None else curves.drive.describe()

    def poll(self) -> CheckReport | None:
        """Returns the report; None while the check runs."""
        if self._report is None and self._process is not None:
            if self._process.poll() is not None:
                self._report = self._read_report()
            elif self.elapsed_s > TIMEOUT_S:
                self._kill()
                self._report = _without_result(
                    f"The check did not end within {TIMEOUT_S:g} s and was stopped.", GradingVerdict.BROKEN
                )
        return self._report

    def wait(self, show_progress: Callable[[str], None] | None = None) -> CheckReport:
        """Waits for the report, at most ``TIMEOUT_S``. ``show_progress``: called with ``progress`` when it has changed,
        at most once in ``PROGRESS_INTERVAL_S``, and with the newest drive of a training in words."""
        shown, drive, due_s = "", "", PROGRESS_INTERVAL_S
        while (report := self.poll()) is None:
            if show_progress is not None and self.elapsed_s >= due_s and (progress := self.progress) != shown:
                shown, due_s = progress, self.elapsed_s + PROGRESS_INTERVAL_S
                show_progress(progress)
                newest = self._newest_drive
                if newest not in ("", drive):
                    drive = newest
                    show_progress(newest)
            assert self._process is not None
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(max(0.01, min(1.0, TIMEOUT_S - self.elapsed_s)))
        return report

    def close(self) -> None:
        """Stops the check. May be called twice."""
        self._kill()
        self._stdout.close()
        self._stderr.close()
        self._progress.close()

    def _kill(self) -> None:
        if self._process is None or self._process.poll() is not None:
            return
        with contextlib.suppress(ProcessLookupError):
            # SIGTERM first: the grader then stops the programs it has started.
            os.killpg(self._process.pid, signal.SIGTERM)
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(2.0)
        if self._process.poll() is None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()

    def _read_report(self) -> CheckReport:
        self._stdout.seek(0)
        self._stderr.seek(0)
        errors = self._stderr.read().decode(errors="replace").strip()
        try:
            content = json.loads(self._stdout.read())
            result = translated_result(GradingResult.from_dict(content), self._words)
            return _with_result(result, self.elapsed_s, self._recording)
        except (ValueError, KeyError, TypeError):
            assert self._process is not None
            # Exit code 2: the submission cannot be read, which the student can mend.
            is_refused = self._process.returncode == 2
            last_line = errors.splitlines()[-1] if errors else f"exit code {self._process.returncode}"
            if is_refused:
                return _without_result(errors, GradingVerdict.FAIL)
            return _without_result(f"The check broke: {last_line}", GradingVerdict.BROKEN)


def submission_path(exercise: Exercise, file: Path) -> Path:
    """The path to submit: the file, or its folder where the starter is a folder."""
    return file.parent if has_other_files(exercise) else file


def _without_result(problem: str, verdict: GradingVerdict) -> CheckReport:
    return CheckReport(verdict, None, 0.0, problem)


def _with_result(result: GradingResult, seconds: float, recording: Path | None) -> CheckReport:
    return CheckReport(
        result.verdict,
        result,
        seconds,
        problem="The grader broke; that is not your fault."
        if result.verdict is GradingVerdict.BROKEN
        else "",
        recording=recording if recording is not None and recording.is_file() else None,
    )
