"""A lesson that trains shows it: three trainings are three curves, which grow while the check runs and stay beside its verdict."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from textual.pilot import Pilot
from textual.screen import Screen

from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.reading import find_lesson
from kit.school.progress import EventKind, ProgressJournal
from kit.tui.screens.lesson import LessonScreen
from kit.tui.theme import Theme
from kit.workspace import open_workspace
from tests.tui.lesson_stage import seen, stage, text, until

CURVE = re.compile(r"\d training (\d) (?:0\.\d+|1|0)")


@pytest.mark.long
def test_three_trainings_are_three_curves(tmp_path: Path) -> None:
    lesson, workspace = find_lesson("12"), open_workspace(tmp_path / "home")
    step = next(each for each in lesson.steps if each.exercise is not None and each.exercise.name == "stop")
    with ProgressJournal(workspace.folder) as progress:
        for other in lesson.steps[: step.number - 1]:
            if other.exercise is None:
                progress.add(EventKind.STEP, lesson.step_subject(other))
            else:
                content = {"points": 1.0, "max_points": 1.0, "verdict": "pass"}
                progress.add(EventKind.ATTEMPT, lesson.exercise_subject(other.exercise), content)

        def screen(theme: Theme) -> Screen[None]:
            return LessonScreen(theme, LessonSession(lesson, progress, workspace), workspace)

        async def scene(pilot: Pilot[None]) -> None:
            await seen(pilot, step.title)
            await pilot.press("c")
            await seen(pilot, "training 1")
            assert set(CURVE.findall(text(pilot))) <= {"1", "2", "3"}
            await seen(pilot, "3 training 3")
            await until(pilot, lambda: " s: training" not in text(pilot), "the check is over")
            assert set(CURVE.findall(text(pilot))) == {"1", "2", "3"}

        stage(screen, scene)
