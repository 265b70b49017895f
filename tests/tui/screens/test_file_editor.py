"""The kit's editor in place of the whole screen."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest
from textual.pilot import Pilot

from kit.school.game.levels import find_level
from kit.school.game.race import DriverKind
from kit.tui.screens.file_editor import FileEditorScreen
from kit.tui.screens.level_pictures import level_beside
from kit.tui.widgets.program_editor import ProgramFile
from kit.tui.widgets.text_rows import TextRows
from tests.tui.lesson_stage import seen, stage, text, until


def test_what_is_not_saved_when_the_kit_is_left_is_there_the_next_time(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text("speed = 1\n")

    async def type_and_end(pilot: Pilot[None]) -> None:
        await seen(pilot, "speed = 1")
        await pilot.press(*"fast")
        pilot.app.exit()

    async def look(pilot: Pilot[None]) -> None:
        await seen(pilot, "fastspeed = 1")
        await seen(pilot, "not saved")

    stage(lambda theme: FileEditorScreen(ProgramFile(file), 1, ""), type_and_end)
    assert file.read_text() == "speed = 1\n"
    stage(lambda theme: FileEditorScreen(ProgramFile(file), 1, ""), look)


def test_what_is_saved_and_is_no_python_is_told_with_its_line(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text("\nspeed = = 1\n")

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "speed = = 1")
        await pilot.press("#", "ctrl+s")
        await seen(pilot, "line 2: invalid syntax")
        assert "as it was saved" not in text(pilot)
        await pilot.press("down", "home", "#")
        await seen(pilot, "as it was saved: line 2: invalid syntax")
        await pilot.press("ctrl+s")
        await until(pilot, lambda: "invalid syntax" not in text(pilot), "it is Python now")

    stage(lambda theme: FileEditorScreen(ProgramFile(file), 1, ""), scene)


@pytest.mark.parametrize("width", [80, 120, 200])
def test_beside_a_program_stands_its_level_where_there_is_room(tmp_path: Path, width: int) -> None:
    file = tmp_path / "mine.py"
    file.write_text("speed = 1\n")
    beside = partial(level_beside, find_level("two-doors"), DriverKind.PROGRAM)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "speed = 1")
        has_level = "by program" in text(pilot)
        assert has_level is (width > 100)
        shown = pilot.app.screen.query_one("#beside", TextRows)
        assert not has_level or shown.region.right <= width
        assert not has_level or "R record" in text(pilot)

    stage(
        lambda theme: FileEditorScreen(ProgramFile(file), 1, "", beside, "braille"), scene, size=(width, 40)
    )
