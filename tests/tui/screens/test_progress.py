"""The page of progress: one page where there is room, all of it below each other where there is none."""

from __future__ import annotations

from pathlib import Path

import pytest
from textual.pilot import Pilot

from kit.controllers import prepare_workspace
from kit.school.progress import EventKind, ProgressJournal
from kit.tui.rows.progress_rows import STARS_LEGEND, summary_rows
from kit.tui.screens.progress import ProgressScreen
from kit.tui.student_store import StudentStore
from tests.tui.lesson_folder import write_lessons
from tests.tui.lesson_stage import rows, seen, stage, text


@pytest.mark.parametrize("count", [None, 3], ids=["the kit's", "begun"])
def test_all_lessons_stand_on_one_page_beside_the_rest_at_120x35(tmp_path: Path, count: int | None) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    folder = None if count is None else write_lessons(tmp_path / "lessons", more=count)
    if count is not None:
        with ProgressJournal(workspace.folder) as progress:
            progress.add(EventKind.STEP, "01-colours/1")
    store = StudentStore(workspace, folder) if folder else StudentStore(workspace)
    shelf = store.read_overview().shelf
    summary = summary_rows((), ["Nothing answered yet."], shelf, "home")

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, STARS_LEGEND[0])
        assert rows(pilot)[0].strip() == "Progress"  # it does not scroll
        assert all(each.title[:40] in text(pilot) for each in shelf)
        begun = [each for each in shelf if each.has_started and each.progress is not None]
        for each in begun:
            assert any(f"[~] {each.title} " in line and "..." in line for line in rows(pilot))

    stage(lambda theme: ProgressScreen(summary, shelf), scene, size=(120, 35))


def test_a_lesson_that_was_begun_names_its_exercises_where_lessons_stand_below(tmp_path: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    with ProgressJournal(workspace.folder) as progress:
        progress.add(EventKind.STEP, "01-colours/1")
    store = StudentStore(workspace, write_lessons(tmp_path / "lessons", more=2))
    shelf = store.read_overview().shelf

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Quiz")
        await pilot.press("end")
        first = shelf[0].progress
        assert first is not None
        await seen(pilot, f"{first.lesson.exercises[0].name} ...")

    stage(lambda theme: ProgressScreen(summary_rows((), (), shelf, "home"), shelf), scene, size=(80, 24))
