"""A lesson's step in which tables learn: it waits for the prediction, can be stilled and stepped, and ends."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner
from textual.pilot import Pilot
from textual.screen import Screen

from kit.cli import main
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.reading import read_lesson
from kit.school.progress import ProgressJournal
from kit.tui.screens.lesson import LessonScreen
from kit.tui.theme import Theme
from kit.workspace import open_workspace
from tests.tui.lesson_folder import write_lessons
from tests.tui.lesson_stage import seen, stage, text, until

SCENE = "    scene: {place: turn, controller: random_walk, seed: 1, seconds: 1}\n"
LEARNING = """    learning:
      learners: [{title: Table}]
      episodes: 3
      seconds: 1.5
      map: |
        S..G
"""


def lesson_with_tables(folder: Path) -> Path:
    lesson = write_lessons(folder) / "01-colours"
    file = lesson / "lesson.yaml"
    assert SCENE in file.read_text()
    file.write_text(file.read_text().replace(SCENE, LEARNING))
    return lesson


@pytest.mark.long
def test_it_waits_stands_still_steps_and_ends(tmp_path: Path) -> None:
    lesson, workspace = (
        read_lesson(lesson_with_tables(tmp_path / "lessons")),
        open_workspace(tmp_path / "home"),
    )
    with ProgressJournal(workspace.folder) as journal:

        def screen(theme: Theme) -> Screen[None]:
            return LessonScreen(theme, LessonSession(lesson, journal, workspace), workspace)

        async def scene(pilot: Pilot[None]) -> None:
            await seen(pilot, "waiting for your prediction")
            await seen(pilot, "Nothing is learned yet")
            await pilot.press("p", ".")
            assert "Nothing is learned yet" in text(pilot)
            await pilot.press("2")
            await pilot.press("p")
            await until(pilot, lambda: "still, " in text(pilot), "it stands still")
            before = text(pilot)
            await pilot.press(".")
            await until(pilot, lambda: text(pilot) != before, "one update")
            assert "Only a wall makes it turn." not in text(pilot)
            await pilot.press("p")
            await seen(pilot, "finished")
            await seen(pilot, "Table: 3 of 3 episodes")
            await seen(pilot, "Only a wall makes it turn.")
            await pilot.press("n")
            await seen(pilot, "(o) red")
            assert "Table" not in text(pilot)

        stage(screen, scene)


def test_line_by_line_it_is_shown_after_the_prediction(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lesson = lesson_with_tables(tmp_path / "lessons")
    monkeypatch.setattr("kit.school.lessons.reading.lessons_folder", lambda: lesson.parent)
    command = ["lesson", "1", "--plain", "--workspace", str(tmp_path / "home")]
    output = CliRunner().invoke(main, command, input="r\n2\nr\nq\n").output
    assert output.index("Predict first") < output.index("Table: 1 of 3 episodes")
    assert output.count("Table, after 3 episodes: the best moves") == 2
