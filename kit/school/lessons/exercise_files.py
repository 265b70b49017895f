"""The student's own files of an exercise: installed once, reset with a backup, never overwritten unasked."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime
from pathlib import Path
from typing import Final

from kit.school.lessons.reading import solutions_folder
from kit.school.lessons.records import Exercise, Lesson
from kit.school.lessons.translation import translation_of
from kit.workspace import Workspace, write_atomically

STARTER: Final = "starter"
SOLUTION: Final = "solution"
SOLUTIONS: Final = "solutions"
"""In the folder of a lesson from elsewhere: for each exercise a folder with its solution and its wrong works."""


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
