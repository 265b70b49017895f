"""An exercise on the bench: any of its files that is saved has it checked; one that a moment brings does not."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from kit.results.grading_result import PUBLIC_CASES
from kit.school.lessons import exercise_work
from kit.school.lessons.checking import ExerciseCheck, read_solution
from kit.school.lessons.exercise_work import ExerciseAttempt, FolderWatch
from kit.school.lessons.lesson_session import LessonSession
from kit.school.progress import ProgressJournal
from kit.workspace import open_workspace
from tests.kit_content import kit_lesson


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "maps").mkdir()
    for name in ("world.yaml", "maps/hall.yaml"):
        (tmp_path / name).write_text("as it was")
    return tmp_path


@pytest.fixture
def noticed(folder: Path) -> Callable[[], bool]:
    """Whether a save is noticed within a little while."""
    return look_in(folder)


def look_in(folder: Path) -> Callable[[], bool]:
    watch = FolderWatch(folder / "world.yaml")

    def look() -> bool:
        end = time.monotonic() + 1.5
        while time.monotonic() < end:
            if watch.has_changed():
                return True
            time.sleep(0.02)
        return False

    return look


@pytest.mark.long
def test_each_file_counts(folder: Path, noticed: Callable[[], bool]) -> None:
    for name in ("world.yaml", "maps/hall.yaml"):
        (folder / name).write_text("mended, and longer")
        assert noticed(), name
    assert not noticed()


@pytest.mark.long
def test_what_editors_and_checks_leave_does_not(folder: Path, noticed: Callable[[], bool]) -> None:
    (folder / "__pycache__").mkdir()
    for name in (".world.yaml.swp", ".worst.npz", "world.yaml~", "__pycache__/x.pyc", "4913"):
        (folder / name).write_text("for a moment")
    assert not noticed()


@pytest.mark.long
def test_a_new_file_counts_from_its_next_save_on(folder: Path, noticed: Callable[[], bool]) -> None:
    (folder / "pen.dat").write_text("0 0 1 1")
    assert not noticed()
    (folder / "pen.dat").write_text("0 0 1 1, and more")
    assert noticed()


@pytest.mark.long
def test_so_many_files_are_watched(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exercise_work, "MOST_FILES", 3)  # world.yaml, the one in maps, and one more
    for name in ("one", "two"):
        (folder / f"room_{name}.yaml").write_text("as it was")
    noticed = look_in(folder)
    for name, is_watched in (("world", True), ("room_one", True), ("room_two", False)):
        (folder / f"{name}.yaml").write_text("mended, and longer")
        assert noticed() == is_watched, name


@pytest.mark.long
def test_a_folder_that_goes_away_is_no_save(folder: Path, noticed: Callable[[], bool]) -> None:
    (folder / "maps" / "hall.yaml").unlink()
    (folder / "maps").rmdir()
    assert not noticed()


def test_an_editor_begins_at_the_first_todo_and_then_at_the_error(tmp_path: Path) -> None:
    lesson = kit_lesson("02-nodes-and-topics")
    exercise = lesson.exercises[0]
    with ProgressJournal(tmp_path) as journal:
        session = LessonSession(lesson, journal, open_workspace(tmp_path))
        model = ExerciseAttempt(session, exercise)
        lines = model.file.read_text().splitlines()
        assert "TODO" in lines[model.line_to_edit - 1]
        assert not any("TODO" in line for line in lines[: model.line_to_edit - 1])
        model.file.write_text("\n".join([*lines[:4], "oh no", *lines[4:]]))
        with session.start_check(exercise) as running:
            session.record(exercise, running.wait())
        assert model.line_to_edit == 5
        model.file.write_text("nothing is open here")
        session.reset(exercise)
        model.file.write_text("pass\n\npass")
        assert model.line_to_edit == 1


@pytest.mark.long
@pytest.mark.parametrize(
    ("old", "new", "verdict"), [("", "", "all passed"), ("max(table", "min(table", "of 3 criteria passed")]
)
def test_the_public_verdict_is_told_before_the_secret_cases(
    old: str, new: str, verdict: str, tmp_path: Path
) -> None:
    """What is told then stays in sight while the rest runs."""
    lesson = kit_lesson("20-q-learning")
    exercise = next(each for each in lesson.exercises if each.name == "agent")
    file = tmp_path / "agent.py"
    file.write_text(read_solution(lesson, exercise)["agent.py"].replace(old, new))
    seen: set[str] = set()
    with ExerciseCheck(exercise, file) as check:
        while check.poll() is None:
            seen.add(check.progress)
        written = os.pread(check._progress.fileno(), 1 << 16, 0).decode().splitlines()
    [at] = [number for number, line in enumerate(written) if line.startswith(PUBLIC_CASES)]
    assert verdict in written[at]
    assert not any("secret" in line for line in written[:at])
    assert any("secret" in line for line in written[at:])
    assert all(each.startswith(PUBLIC_CASES) for each in seen if "secret" in each)
