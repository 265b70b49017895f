"""What a student's work does is seen in the lesson: trainings as curves, and the way of a perfect learner."""

from __future__ import annotations

import re
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from textual.pilot import Pilot
from textual.screen import Screen

from kit.school.lessons.checking import install_exercise
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.reading import find_lesson, solutions_folder
from kit.school.progress import EventKind, ProgressJournal
from kit.tui.screens.lesson import LessonScreen
from kit.tui.theme import Theme
from kit.workspace import open_workspace
from tests.tui.lesson_stage import seen, stage, text, until

CURVE = re.compile(r"(\d) (?:training \d|exam [\d.]+; last) (?:0\.\d+|1|0)")


def play_step(
    folder: Path, name: str, exercise: str, scene: Callable[[Pilot[None]], Awaitable[None]]
) -> None:
    """Plays a scene at the step of an exercise, with all steps before it done and the student's file as it lies there."""
    lesson, workspace = find_lesson(name), open_workspace(folder)
    step = next(each for each in lesson.steps if each.exercise is not None and each.exercise.name == exercise)
    with ProgressJournal(workspace.folder) as progress:
        for other in lesson.steps[: step.number - 1]:
            if other.exercise is None:
                progress.add(EventKind.STEP, lesson.step_subject(other))
            else:
                content = {"points": 1.0, "max_points": 1.0, "verdict": "pass"}
                progress.add(EventKind.ATTEMPT, lesson.exercise_subject(other.exercise), content)

        def screen(theme: Theme) -> Screen[None]:
            return LessonScreen(theme, LessonSession(lesson, progress, workspace), workspace)

        stage(screen, scene)


@pytest.mark.long
def test_the_way_of_a_perfect_learner_is_seen_at_once_with_its_return(tmp_path: Path) -> None:
    lesson, workspace = find_lesson("11"), open_workspace(tmp_path)
    exercise = next(each for each in lesson.exercises if each.name == "your_reward")
    work = solutions_folder() / lesson.name / exercise.name / "wrong" / "planned+loops__pay_for_moving.py"
    install_exercise(workspace, lesson, exercise).write_text(work.read_text())

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "your_reward")
        await pilot.press("c")
        await seen(pilot, "Your reward pays")
        assert "#3......G.2#" in text(pilot)

    play_step(tmp_path, "11", "your_reward", scene)


@pytest.mark.long
def test_three_trainings_are_three_curves(tmp_path: Path) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "step")
        await pilot.press("c")
        await seen(pilot, "training 1")
        assert set(CURVE.findall(text(pilot))) <= {"1", "2", "3"}
        await seen(pilot, "steps, turn_")
        moments = {text(pilot)}
        await until(pilot, lambda: len(moments | {text(pilot)}) > 1, "the robot drives")
        await seen(pilot, "3 exam ")
        await seen(pilot, "checked in")
        assert set(CURVE.findall(text(pilot))) == {"1", "2", "3"}

    play_step(tmp_path, "12", "stop", scene)
