"""The list of lessons: the chosen one beside it where there is room, below it where there is none."""

from __future__ import annotations

from pathlib import Path

import pytest
from textual.pilot import Pilot

from kit.controllers import prepare_workspace
from kit.school.game.levels import levels_of_lesson
from kit.school.progress import EventKind, ProgressJournal
from kit.tui.screens.lessons import LessonsScreen
from kit.tui.student_store import StudentStore
from tests.tui.lesson_folder import write_lessons
from tests.tui.lesson_stage import rows, seen, stage, text, until

WALL = "█"
MAP = {*map(chr, range(0x2801, 0x2900)), *map(chr, range(0x2580, 0x25A0))}
"""Characters of walls in large and small pictures of a world."""


@pytest.fixture
def store(tmp_path: Path) -> StudentStore:
    workspace = prepare_workspace(tmp_path / "home")
    with ProgressJournal(workspace.folder) as progress:
        progress.add(EventKind.STEP, "01-colours/1")
    lessons = write_lessons(tmp_path / "lessons", more=2)
    broken = lessons / "04-broken"
    broken.mkdir()
    (broken / "lesson.yaml").write_text("title: [")
    return StudentStore(workspace, lessons)


def test_a_wide_screen_shows_the_chosen_lesson_with_its_steps_and_its_world(store: StudentStore) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, LessonsScreen)
        chosen = screen.chosen
        assert chosen is not None
        assert chosen.lesson is not None
        await seen(pilot, "Afterwards you can:")
        page = text(pilot)
        assert all(step.title[:20] in page for step in chosen.lesson.steps)
        assert "[x]" in page
        await until(pilot, lambda: any(WALL in line[84:] for line in rows(pilot)), "the lesson's world")
        await pilot.press("end")
        await seen(pilot, "04-broken")
        assert not any(WALL in line[84:] for line in rows(pilot))

    stage(lambda theme: LessonsScreen(theme, store, store.read_overview()), scene, size=(200, 50))


@pytest.mark.parametrize(("size", "number"), [((120, 35), "D4"), ((200, 50), "A2")], ids=str)
def test_a_wide_screen_shows_the_maps_of_what_a_lesson_opens_also_where_it_has_no_world(
    tmp_path: Path, size: tuple[int, int], number: str
) -> None:
    """Small as the room is, one map; where there is more, each level's with its title, below the lesson's own world."""
    store = StudentStore(prepare_workspace(tmp_path / "home"))
    at = next(place for place, each in enumerate(store.read_overview().shelf) if each.number == number)
    entry = store.read_overview().shelf[at]
    levels = levels_of_lesson(entry.name)

    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press(*["down"] * at)
        await seen(pilot, entry.title)

        def beside() -> list[str]:
            return [line[76:] for line in rows(pilot)]

        await until(pilot, lambda: any(set(line) & MAP for line in beside()), "a map")
        if size == (200, 50):
            for level in levels:
                await seen(pilot, level.title)
            opened = next(place for place, line in enumerate(beside()) if levels[0].title in line)
            await until(
                pilot, lambda: any(set(line) & MAP for line in beside()[:opened]), "the lesson's world"
            )
            assert any(set(line) & MAP for line in beside()[opened:])

    stage(lambda theme: LessonsScreen(theme, store, store.read_overview()), scene, size=size)


def test_a_small_screen_says_what_the_chosen_lesson_is_about_below_the_list(store: StudentStore) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, LessonsScreen)
        chosen = screen.chosen
        assert chosen is not None
        assert chosen.lesson is not None
        await seen(pilot, chosen.lesson.outcomes[0][:30])
        assert "Afterwards you can:" not in text(pilot)

    stage(lambda theme: LessonsScreen(theme, store, store.read_overview()), scene, size=(80, 24))


def test_a_list_that_does_not_fit_says_which_lines_are_shown(store: StudentStore) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "lines 1 to ")
        shown = int(rows(pilot)[0].split()[-3])
        await pilot.press("end")
        assert rows(pilot)[0].endswith(f"lines {5 - shown} to 4 of 4")

    stage(lambda theme: LessonsScreen(theme, store, store.read_overview()), scene, size=(80, 12))
    stage(
        lambda theme: LessonsScreen(theme, store, store.read_overview()),
        lambda pilot: seen(pilot, "0 of 4 done"),
        size=(80, 24),
    )
