"""The page of progress: one page where there is room, all of it below each other where there is none."""

from __future__ import annotations

from datetime import date, timedelta
from pathlib import Path

import pytest
from textual.pilot import Pilot

from kit.controllers import prepare_workspace
from kit.document.layout import Page, rows_of
from kit.document.rows import row_text, row_width
from kit.school.badges import Badge
from kit.school.progress import EventKind, ProgressJournal
from kit.tui.rows.progress_rows import BUSY, STARS_LEGEND, calendar_rows, export_blocks
from kit.tui.screens.progress import ProgressScreen, ProgressSummary
from kit.tui.student_store import StudentStore
from tests.tui.lesson_folder import write_lessons
from tests.tui.lesson_stage import rows, seen, stage, text

MONDAY = date(2026, 11, 30)


@pytest.mark.parametrize("count", [None, 3], ids=["the kit's", "begun"])
@pytest.mark.parametrize("size", [(120, 35), (200, 50)], ids=lambda size: f"{size[0]}x{size[1]}")
def test_all_lessons_stand_on_one_page_beside_the_rest(
    tmp_path: Path, count: int | None, size: tuple[int, int]
) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    folder = None if count is None else write_lessons(tmp_path / "lessons", more=count)
    if count is not None:
        with ProgressJournal(workspace.folder) as progress:
            progress.add(EventKind.STEP, "01-colours/1")
    store = StudentStore(workspace, folder) if folder else StudentStore(workspace)
    shelf = store.read_overview().shelf

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, STARS_LEGEND[0])
        assert rows(pilot)[0].strip() == "Progress"  # it does not scroll
        assert all(each.title[:40] in text(pilot) for each in shelf)
        begun = [each for each in shelf if each.has_started and each.progress is not None]
        for each in begun:
            assert any(f"[~] {each.title} " in line and "..." in line for line in rows(pilot))

    stage(lambda theme: ProgressScreen(ProgressSummary(shelf, "home", MONDAY)), scene, size=size)


def test_a_lesson_that_was_begun_names_its_exercises_where_lessons_stand_below(tmp_path: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    with ProgressJournal(workspace.folder) as progress:
        progress.add(EventKind.STEP, "01-colours/1")
    store = StudentStore(workspace, write_lessons(tmp_path / "lessons", more=2))
    shelf = store.read_overview().shelf

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "quiz")
        await pilot.press("end")
        first = shelf[0].progress
        assert first is not None
        await seen(pilot, f"{first.lesson.exercises[0].name} ...")

    stage(lambda theme: ProgressScreen(ProgressSummary(shelf, "home", MONDAY)), scene, size=(80, 24))


@pytest.mark.parametrize("size", [(200, 50), (200, 40)], ids=str)
def test_a_high_screen_names_the_badges_that_are_not_yet_begun(size: tuple[int, int]) -> None:
    told = ProgressSummary((), "home", MONDAY, badges=(Badge("Foresight", "predictions", 0, 10),))

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, STARS_LEGEND[0])
        assert ("0 of 10" in text(pilot)) is (size[1] == 50)

    stage(lambda theme: ProgressScreen(told), scene, size=size)


def test_how_to_export_is_no_narrower_than_its_column() -> None:
    for columns, count in ((116, 3), (76, 4)):
        shown = rows_of(export_blocks("~/robot-kit"), Page(columns))
        assert len(shown) == count
        assert max(map(row_width, shown)) <= columns


def test_the_calendar_ends_today_and_shows_how_busy_each_day_was() -> None:
    (some, light), *_, (many, full) = BUSY
    days = {MONDAY: many, MONDAY - timedelta(days=2): some}
    months, monday, *others, legend = map(row_text, calendar_rows(days, MONDAY, 60))
    saturday = others[4]
    assert "Nov" in months
    assert monday.endswith(full)
    assert saturday.endswith(f"{light}"), "days to come are blank"
    assert saturday.rindex(light) == monday.rindex(full) - 2, "a week is a column"
    assert sum(line.count(sign) for line in (monday, *others) for _, sign in BUSY) == 2
    assert light in legend
    assert max(map(len, (months, monday, *others))) <= 60


@pytest.mark.parametrize(
    ("today", "is_named"), [(MONDAY, False), (MONDAY + timedelta(days=1), True)], ids=str
)
def test_a_month_is_named_above_the_week_in_which_it_begins(today: date, is_named: bool) -> None:
    """The first of December is a Tuesday."""
    months, monday, *_ = map(row_text, calendar_rows({MONDAY: BUSY[-1][0]}, today, 60))
    this_week = monday.index(BUSY[-1][1])
    assert (months.find("Dec") == this_week) is is_named
    assert months.index("Nov") < this_week


def test_progress_has_a_help_page() -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "? help")
        await pilot.press("question_mark")
        await seen(pilot, "done, begun, not begun")

    stage(lambda theme: ProgressScreen(ProgressSummary((), "home", MONDAY)), scene, size=(80, 24))
