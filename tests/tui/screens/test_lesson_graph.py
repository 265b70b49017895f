"""A lesson's step in which messages move along a graph: it waits for the prediction, moves, counts and ends."""

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
from tests.tui.lesson_stage import rows, seen, stage, text, until

SCENE = "    scene: {place: turn, controller: random_walk, seed: 1, seconds: 1}\n"
GRAPH = """    graph:
      seconds: 2
      topics:
        - {name: /scan, publisher: /laser, subscribers: [/driver], rate: 10, asked: '"scan"'}
"""


def lesson_with_graph(folder: Path) -> Path:
    lesson = write_lessons(folder) / "01-colours"
    file = lesson / "lesson.yaml"
    assert SCENE in file.read_text()
    file.write_text(file.read_text().replace(SCENE, GRAPH))
    return lesson


@pytest.mark.long
@pytest.mark.parametrize("size", [(80, 24), (120, 36)], ids=str)
def test_it_waits_moves_and_ends_above_the_words(tmp_path: Path, size: tuple[int, int]) -> None:
    lesson, workspace = (
        read_lesson(lesson_with_graph(tmp_path / "lessons")),
        open_workspace(tmp_path / "home"),
    )
    with ProgressJournal(workspace.folder) as journal:

        def screen(theme: Theme) -> Screen[None]:
            return LessonScreen(theme, LessonSession(lesson, journal, workspace), workspace)

        async def scene(pilot: Pilot[None]) -> None:
            await seen(pilot, "waiting for your prediction")
            await seen(pilot, '"scan"')
            assert "●" not in text(pilot)
            await pilot.press("2")
            await seen(pilot, "●")
            await pilot.press("p")
            await until(pilot, lambda: "still, " in text(pilot), "it stands still")
            before = text(pilot)
            await pilot.press(".")
            await until(pilot, lambda: text(pilot) != before, "the dot is one place further")
            await pilot.press("p")
            await seen(pilot, "finished")
            await seen(pilot, "/scan: 20 messages, each to /driver")
            await seen(pilot, "Only a wall makes it turn.")
            graph = next(number for number, line in enumerate(rows(pilot)) if "/driver" in line)
            assert "/laser" in rows(pilot)[graph], "the whole graph has room"
            assert graph < next(number for number, line in enumerate(rows(pilot)) if "A robot stands" in line)
            await pilot.press("n")
            await seen(pilot, "(o) red")
            assert "/scan" not in text(pilot)

        stage(screen, scene, size=size)


@pytest.mark.long
def test_with_reduced_motion_its_end_is_shown_at_once(tmp_path: Path) -> None:
    folder = lesson_with_graph(tmp_path / "lessons")
    sheet = folder / "lesson.yaml"
    sheet.write_text(sheet.read_text().replace("seconds: 2\n", "seconds: 100\n"))
    lesson, workspace = read_lesson(folder), open_workspace(tmp_path / "home")
    with ProgressJournal(workspace.folder) as journal:

        def screen(theme: Theme) -> Screen[None]:
            return LessonScreen(theme, LessonSession(lesson, journal, workspace), workspace)

        async def scene(pilot: Pilot[None]) -> None:
            await seen(pilot, "waiting for your prediction")
            await pilot.press("1")
            await seen(pilot, "/scan: 1000 messages, each to /driver")
            await seen(pilot, "finished")

        stage(screen, scene, environ={"KIT_REDUCE_MOTION": "1"})


def test_line_by_line_its_names_come_after_the_prediction(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lesson = lesson_with_graph(tmp_path / "lessons")
    monkeypatch.setattr("kit.school.lessons.reading.lessons_folder", lambda: lesson.parent)
    command = ["lesson", "1", "--plain", "--workspace", str(tmp_path / "home")]
    output = CliRunner().invoke(main, command, input="2\nq\n").output
    assert output.index('"scan"') < output.index("/scan: 20 messages, each to /driver")
    assert output.count("/scan: 20") == 1
