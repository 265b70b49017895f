"""The student's own files of an exercise: laid out once, begun again with a backup, never overwritten unasked."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime
from pathlib import Path
from typing import Final

from kit.school.lessons.reading import solutions_folder
from kit.school.lessons.records import Exercise, Lesson
from kit.workspace import Workspace, write_atomically

STARTER: Final = "starter"
SOLUTION: Final = "solution"


class ExerciseFilesError(Exception):
    """The student's files cannot be laid out; the message says why."""


def exercise_folder(workspace: Workspace, lesson: Lesson, exercise: Exercise) -> Path:
    """Where the student's files of an exercise lie."""
    return workspace.lessons / lesson.name / exercise.name


def exercise_file(workspace: Workspace, lesson: Lesson, exercise: Exercise) -> Path:
    """What the student edits."""
    return exercise_folder(workspace, lesson, exercise) / exercise.file


def install_exercise(workspace: Workspace, lesson: Lesson, exercise: Exercise) -> Path:
    """Makes what is missing of the exercise's files, and touches nothing that is there. Returns the file to edit.

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
        raise ExerciseFilesError(f"{folder}: the exercise cannot be laid out ({error.strerror}).") from None
    return folder / exercise.file


def reset_exercise(workspace: Workspace, lesson: Lesson, exercise: Exercise, *, now: datetime) -> Path | None:
    """Lays the exercise out anew. What was there is kept in a folder beside; returned, or None if nothing was there.

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
                f"{folder}: cannot be kept under another name ({error.strerror})."
            ) from None
    install_exercise(workspace, lesson, exercise)
    return backup


def read_solution(lesson: Lesson, exercise: Exercise) -> dict[str, str]:
    """The reference solution's files: name -> text, the file to edit first; those that are no text are left out.
    Empty where solutions were not installed."""
    try:
        folder = solutions_folder() / lesson.name / exercise.name
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
        yield exercise.file, single.read_bytes()


def _folder_files(folder: Path) -> Iterator[tuple[str, bytes]]:
    for file in sorted(folder.rglob("*")):
        if file.is_file() and "__pycache__" not in file.parts:
            yield file.relative_to(folder).as_posix(), file.read_bytes()
