"""Screens as they were when somebody last looked at them: text and style, at 80x24 and 200x50, in 16 colours.

After a change that is meant, look at the screens (``contact_sheet.py``), write the files again and read what differs:

    REWRITE_GOLDEN=1 python -m pytest -m "long or not long" tests/tui/test_golden_screens.py
    git diff tests/tui/golden
"""

from __future__ import annotations

import asyncio
import os
from collections.abc import Awaitable, Callable
from itertools import groupby
from pathlib import Path
from typing import Any, Final

import pytest
from rich.style import Style
from textual.pilot import Pilot
from textual.screen import Screen

from kit.controllers import Workspace, prepare_workspace
from kit.layers.case_sources import open_task
from kit.school.game import leaderboard
from kit.school.progress import ProgressJournal
from kit.school.quiz.items import read_bank
from kit.school.quiz.quiz_dialogue import QuizDialogue
from kit.school.quiz.quiz_session import QuizSession, lesson_plan
from kit.tui.screens.dialogue import DialogueScreen
from kit.tui.screens.layers import LayersScreen
from kit.tui.screens.levels import LevelsScreen
from kit.tui.screens.start import StartScreen
from kit.tui.screens.trainings import TrainingsScreen
from kit.tui.student_store import StudentStore
from kit.tui.theme import Theme
from kit.tui.widgets.task_preview import TaskPreview
from tests.tui.lesson_folder import write_lessons
from tests.tui.lesson_stage import ROBOT, rows, seen, stage, until

pytestmark = pytest.mark.long

GOLDEN: Final = Path(__file__).with_name("golden")
SIZES: Final = ((80, 24), (200, 50))

Make = Callable[[Theme, Workspace, ProgressJournal], Screen[Any]]
Ready = Callable[[Pilot[None], Screen[Any]], Awaitable[None]]


def open_start(theme: Theme, workspace: Workspace, progress: ProgressJournal) -> Screen[Any]:
    lessons = write_lessons(workspace.folder.parent / "lessons", more=2)
    return StartScreen(theme, StudentStore(workspace, lessons))


async def start_is_ready(pilot: Pilot[None], screen: Screen[Any]) -> None:
    await seen(pilot, "0 of 3 done")
    await seen(pilot, "today's maze")  # the last that is read
    await until(pilot, lambda: set(ROBOT) & set("".join(rows(pilot))), "a robot")


async def lesson_is_ready(pilot: Pilot[None], screen: Screen[Any]) -> None:
    await start_is_ready(pilot, screen)
    await pilot.press("enter")
    await seen(pilot, "step 1 of")
    await until(pilot, lambda: set(ROBOT) & set("".join(rows(pilot))), "a robot")


def open_levels(theme: Theme, workspace: Workspace, progress: ProgressJournal) -> Screen[Any]:
    return LevelsScreen(theme, progress, workspace)


async def levels_are_ready(pilot: Pilot[None], screen: Screen[Any]) -> None:
    assert isinstance(screen, LevelsScreen)
    await seen(pilot, "bronze at")
    await until(
        pilot, lambda: all(place.level in screen._pictures for place in screen._map_places()), "pictures"
    )
    if screen.has_class("-wide"):
        await until(pilot, lambda: set(ROBOT) & set("".join(rows(pilot))), "a robot")


def open_quiz(theme: Theme, workspace: Workspace, progress: ProgressJournal) -> Screen[Any]:
    bank = read_bank()
    return DialogueScreen(
        QuizDialogue(QuizSession(progress, bank, lesson_plan(bank, bank.items[0].lesson), seed=1))
    )


async def quiz_is_answered(pilot: Pilot[None], screen: Screen[Any]) -> None:
    await pilot.press("1", "2")
    await until(pilot, lambda: "next" in rows(pilot)[-1], "what is said to the answer")


def open_layers(theme: Theme, workspace: Workspace, progress: ProgressJournal) -> Screen[Any]:
    return LayersScreen(theme, open_task("slides-lasers"), "slides-lasers", saved_to=workspace.worlds)


async def second_layer_is_shown(pilot: Pilot[None], screen: Screen[Any]) -> None:
    assert isinstance(screen, LayersScreen)
    await until(pilot, lambda: screen.is_solved, "a plan")
    await pilot.press("2", "right")
    await seen(pilot, "layer 2 of")


def open_trainings(theme: Theme, workspace: Workspace, progress: ProgressJournal) -> Screen[Any]:
    return TrainingsScreen(theme, workspace.runs)


async def list_is_read(pilot: Pilot[None], screen: Screen[Any]) -> None:
    await seen(pilot, "No trainings yet")
    if screen.query_one(TaskPreview).display:  # which reads its task in a thread
        await seen(pilot, "earns the sum of these terms")


VISITS: Final[dict[str, tuple[Make, Ready]]] = {
    "start": (open_start, start_is_ready),
    "lesson": (open_start, lesson_is_ready),
    "levels": (open_levels, levels_are_ready),
    "quiz": (open_quiz, quiz_is_answered),
    "layers": (open_layers, second_layer_is_shown),
    "trainings": (open_trainings, list_is_read),
}


def style_name(style: Style | None) -> str:
    """What of a style is seen in 16 colours."""
    if style is None:
        return ""
    words = [word for word in ("bold", "dim", "reverse", "underline") if getattr(style, word)]
    if style.color is not None and not style.color.is_default:
        words.append(style.color.name)
    if style.bgcolor is not None and not style.bgcolor.is_default:
        words.append(f"on {style.bgcolor.name}")
    return " ".join(words)


def picture(screen: Screen[Any]) -> str:
    """The rows of text, then of each row the columns that are not plain."""
    texts, styles = [], []
    for number, strip in enumerate(screen._compositor.render_strips()):
        texts.append(strip.text.rstrip())
        cells = [style_name(segment.style) for segment in strip for _ in range(segment.cell_length)]
        at, runs = 0, []
        for name, run in groupby(cells):
            start, at = at, at + len(list(run))
            if name:
                runs.append(f"{start}-{at - 1} {name}")
        if runs:
            styles.append(f"{number}: {', '.join(runs)}")
    return "\n".join((*texts, "=" * 20, *styles, ""))


@pytest.mark.parametrize("size", SIZES, ids=lambda size: f"{size[0]}x{size[1]}")
@pytest.mark.parametrize("name", VISITS)
def test_a_screen_looks_as_it_did_when_it_was_last_looked_at(
    name: str, size: tuple[int, int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(leaderboard.FOLDER_VARIABLE, str(tmp_path / "hall"))
    make, ready = VISITS[name]
    workspace = prepare_workspace(tmp_path / "home")
    shown = ""

    async def scene(pilot: Pilot[None]) -> None:
        nonlocal shown
        await ready(pilot, pilot.app.screen)
        while shown != (now := picture(pilot.app.screen)):  # until it has come to rest
            shown = now
            await pilot.pause()
            await asyncio.sleep(0.3)

    with ProgressJournal(tmp_path) as progress:
        stage(
            lambda theme: make(theme, workspace, progress),
            scene,
            size=size,
            environ={"KIT_REDUCE_MOTION": "1", "KIT_COLOR": "16"},
        )
    file = GOLDEN / f"{name}_{size[0]}x{size[1]}.txt"
    if os.environ.get("REWRITE_GOLDEN"):
        file.write_text(shown, encoding="utf-8")
    assert shown == file.read_text(encoding="utf-8")
