"""The work on one exercise: its watched file, the check that runs, and the latest result."""

from __future__ import annotations

import re
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from functools import cached_property
from itertools import zip_longest
from pathlib import Path
from typing import Final

from kit.host.failure import syntax_error
from kit.host.file_watcher import FileWatcher
from kit.results.result_blocks import replay_lines
from kit.school.lessons.checking import (
    CheckReport,
    ExerciseCheck,
    has_other_files,
    submission_path,
    untouched_files,
)
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.reading import exercise_criteria, exercise_scene
from kit.school.lessons.records import Exercise, LessonScene
from kit.school.lessons.training_curves import DriveLoop, TestDrive, TrainingCurves

UNANSWERED: Final = re.compile(r"\w+:\s*")
PROGRAM: Final = re.compile("class |def |async def |@")
"""What follows a program's imports begins so."""
"""A line of an answers file that has no answer yet."""
YAML_ENDINGS: Final = (".yaml", ".yml")
TO_WRITE: Final = ("TODO", "# write this")
"""What a starter says of a line that is to be written."""
LARGEST_TEXT: Final = 1_000_000
"""Bytes of a file that somebody may want to edit."""


def files_in(folder: Path) -> Iterator[Path]:
    """The student's files in a folder, without what is hidden, kept by an editor, or made by Python."""
    with suppress(OSError):  # a network drive that is away comes back
        for file in sorted(folder.rglob("*")):
            parts = file.relative_to(folder).parts
            if any(part.startswith(".") or part == "__pycache__" for part in parts) or file.name.endswith(
                "~"
            ):
                continue
            if file.is_file():
                yield file


def _is_text(file: Path) -> bool:
    try:
        if file.stat().st_size > LARGEST_TEXT:
            return False
        file.read_bytes().decode()
        return True
    except (OSError, UnicodeDecodeError):
        return False


class ExerciseAttempt:
    """The student's work on one exercise. ``poll`` it a few times a second; ``close`` it when done.

    Raises ExerciseFilesError where the student's files cannot be laid out.
    """

    def __init__(self, session: LessonSession, exercise: Exercise) -> None:
        self.exercise = exercise
        self.session = session
        self.file: Path = session.install(exercise)
        """What the student edits."""
        self._watch = FileWatcher(submission_path(self.exercise, self.file))
        self._check: ExerciseCheck | None = None
        self._chosen: Path | None = None
        """The file to edit, once the student has chosen one."""
        self._edited_watch = FileWatcher(self.edited_file)
        self._edited_lines: tuple[str, ...] | None = None
        self._curves: TrainingCurves | None = None
        self._drive_loop = DriveLoop()
        self._changed_line = 0
        """The first line that the last save has changed, counted from 1; 0: nothing was saved yet."""

    @cached_property
    def scene(self) -> LessonScene | None:
        """The world in which the program is checked first; None where it drives in none."""
        return exercise_scene(self.exercise)

    @cached_property
    def criteria(self) -> list[tuple[str, float]]:
        """What the check looks at, with the points of each."""
        return exercise_criteria(self.exercise)

    def edited_lines(self) -> tuple[str, ...]:
        """The file to edit as it was read last; empty where it cannot be read."""
        if self._edited_lines is None:
            self._edited_lines = self._read_edited_lines()
        return self._edited_lines

    def reads_anew(self) -> bool:
        """Reads the file to edit again if it was saved and somebody has asked for its lines; says whether."""
        if self._edited_lines is None or not self._edited_watch.has_changed():
            return False
        before, self._edited_lines = self._edited_lines, self._read_edited_lines()
        pairs = enumerate(zip_longest(before, self._edited_lines), 1)
        self._changed_line = next((number for number, (old, new) in pairs if old != new), self._changed_line)
        return True

    def first_todo(self) -> int:
        """The line of the edited file that is to be written first, as the file is now, counted from 1: one that says so, or a
        question without an answer; 1 where there is none."""
        lines = self._read_edited_lines()
        is_yaml = self.edited_file.suffix in YAML_ENDINGS
        return next(
            (
                number
                for number, (text, below) in enumerate(zip(lines, (*lines[1:], ""), strict=True), 1)
                if any(each in text for each in TO_WRITE)
                or (is_yaml and UNANSWERED.fullmatch(text) and not below.startswith((" ", "-")))
            ),
            1,
        )

    def _read_edited_lines(self) -> tuple[str, ...]:
        try:
            text = self.edited_file.read_text(errors="replace")
        except OSError:
            return ()
        return tuple("".join(filter(str.isprintable, line.expandtabs(4))) for line in text.splitlines())

    def files(self, told: str) -> list[Path]:
        """The texts among the files of the exercise, those first that the words of the step name, in the order in which they do."""
        text = told.replace("{file}", self.exercise.file)
        return sorted(
            filter(_is_text, files_in(self.file.parent)), key=lambda file: self._place_in(text, file)
        )

    def suggested_file(self, told: str) -> Path:
        """The file to edit now: the one in which the last check found an error; else the first that is still the starter's, of
        the one to begin with and, if the words of the step name it, the one to hand in; else the one that was edited last."""
        if (wrong := next(filter(self._find_error, self.files(told)), None)) is not None:
            return wrong
        to_edit = [self._first_file, *([self.file] if "{file}" in told else [])]
        untouched = untouched_files(self.exercise, self.file.parent)
        return next((file for file in to_edit if file in untouched), self.edited_file)

    def _place_in(self, text: str, file: Path) -> int:
        """Where a text names a file; its length if it does not."""
        names = (file.relative_to(self.file.parent).as_posix(), file.name)
        found = [text.find(name) for name in names if "." in name]  # else it is a word like others
        return min((at for at in found if at >= 0), default=len(text))

    def choose(self, file: Path) -> None:
        """Has this file be the one to edit."""
        if file != self.edited_file:
            self._chosen, self._edited_lines, self._changed_line = file, None, 0
            self._edited_watch = FileWatcher(file)

    @property
    def line_to_edit(self) -> int:
        """The line of the edited file to begin at, counted from 1: the one that the last check's first error names; else that
        of the first TODO that is left; else the first."""
        return self.error_line or self.first_todo()

    @property
    def line_to_show(self) -> int:
        """The line of the edited file to look at where not all have room, counted from 1: the later one of the last check's first
        error and of what the last save changed; before both the first TODO, or where the program itself begins."""
        if line := max(self.error_line, self._changed_line):
            return line
        if (line := self.first_todo()) > 1:
            return line
        return next((number for number, text in enumerate(self.edited_lines(), 1) if PROGRAM.match(text)), 1)

    @property
    def error_line(self) -> int:
        """The line of the edited file that the last check's first error names; 0 if it names none."""
        found = self._find_error(self.edited_file)
        return 0 if found is None else int(found[1])

    @property
    def error_text(self) -> str:
        """What the last check's first error says that names a line of the edited file; empty if none does."""
        found = self._find_error(self.edited_file)
        return "" if found is None else found.string[found.end() :].lstrip(": ,")

    @property
    def error_column(self) -> int:
        """The column of the edited file's ``error_line`` at which it goes wrong, counted from 1: where Python stops reading it,
        if it does so in that line; else the line's first character."""
        lines, number = self.edited_lines(), self.error_line
        if not 0 < number <= len(lines):
            return 1
        found = syntax_error("\n".join(lines)) if self.edited_file.suffix == ".py" else None
        if found is not None and found.lineno == number and found.offset:
            return max(1, min(found.offset, len(lines[number - 1]) + 1))
        return 1 + len(lines[number - 1]) - len(lines[number - 1].lstrip())

    def _find_error(self, file: Path) -> re.Match[str] | None:
        """Where the last check's first error names a line of a file."""
        report = self.report
        texts = [] if report is None else [report.problem, *(each.rationale for each in report.lost_criteria)]
        name = re.escape(file.name)
        return next(
            (match for text in texts if (match := re.search(rf"\b{name}:(\d+)(?::\d+)?", text))), None
        )

    @property
    def printed_lines(self) -> list[str]:
        """What the student's program printed in the last check."""
        criteria = self.report.criteria if self.report is not None else ()
        logs = dict.fromkeys(each.log for each in criteria if each.log.strip())
        return [line for log in logs for line in log.expandtabs(4).splitlines()]

    @property
    def picture_lines(self) -> list[str]:
        """What the last check drew of a criterion that was lost."""
        return [] if self.report is None else replay_lines(self.report.criteria)

    @property
    def edited_file(self) -> Path:
        """The file to open in an editor."""
        return self._chosen or self._first_file

    @property
    def _first_file(self) -> Path:
        """The one to begin with."""
        return self.file.parent / self.exercise.edited_first if self.exercise.edited_first else self.file

    @property
    def by_hand(self) -> bool:
        """Whether what is handed in is driven, not written."""
        return self.exercise.is_driven

    @property
    def has_others(self) -> bool:
        """Whether there are more files to edit, beside the one."""
        return has_other_files(self.exercise)

    @property
    def seconds(self) -> float | None:
        """How long the check has been running; None while none is."""
        return None if self._check is None else self._check.elapsed_s

    @property
    def progress(self) -> str:
        """One line on what the running check is doing; empty while none runs."""
        return "" if self._check is None else self._check.progress

    @property
    def training_curves(self) -> TrainingCurves | None:
        """Curves of the running check, or of the last one in this step; None if nothing was trained."""
        if self._check is not None:
            self._curves = self._check.training_curves
        return self._curves

    def training_drive(self) -> tuple[TestDrive | None, float | None]:
        """The drive of the newest policy, and the time after its start that is to be seen now; None: its end."""
        newest = None if self.training_curves is None else self.training_curves.drive
        return (
            self._drive_loop.advance(newest, time.monotonic()) if self._check is not None else (newest, None)
        )

    @property
    def report(self) -> CheckReport | None:
        """The newest check's."""
        return self.session.latest_report(self.exercise)

    @property
    def recorded_run(self) -> Path | None:
        """Run of the newest check, or of an earlier pass; None if there is none."""
        return self.session.recorded_run(self.exercise)

    @property
    def has_driven(self) -> bool:
        """Whether there is a drive to check, where a drive is asked for."""
        return self.session.has_driven(self.exercise)

    def start(self) -> None:
        """Starts a check, unless one is running."""
        if self._check is None:
            self._watch = FileWatcher(
                submission_path(self.exercise, self.file)
            )  # what is checked now need not be checked once more
            self._check, self._drive_loop = self.session.start_check(self.exercise), DriveLoop()

    def poll(self) -> bool:
        """Starts a check where the file was saved, in place of one of an older file, and takes in one that has ended; says
        whether one has.

        Raises ProgressError where the disk refuses to note it: the report is there all the same.
        """
        if self._watch.has_changed():
            self.close()
            self.start()
        if self._check is None:
            return False
        report = self._check.poll()
        if report is None:
            return False
        self._curves = self._check.training_curves
        self.close()
        self.session.record(self.exercise, report)
        return True

    def start_over(self) -> Path | None:
        """The exercise as at first; where the former files were kept. Raises ExerciseFilesError."""
        self.close()
        kept = self.session.reset(self.exercise)
        self._watch = FileWatcher(submission_path(self.exercise, self.file))
        return kept

    def close(self) -> None:
        """Ends the check; nothing is noted of one that has not ended."""
        if self._check is not None:
            # It may take a moment to end what it has started. The interpreter waits for this thread.
            threading.Thread(target=self._check.close, name="end of a check").start()
            self._check = None
