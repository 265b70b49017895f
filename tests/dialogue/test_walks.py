"""A key goes from the keyboard to the disk through the modules that CONTRIBUTING names, and through no others."""

from __future__ import annotations

import inspect
import io
import sys
from itertools import groupby
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot

import kit
from kit.cli.dialogue import run_dialogue
from kit.school.progress import ProgressEvent, ProgressJournal
from tests.dialogue.test_both_faces import CASES
from tests.test_readme import walks
from tests.tui.lesson_stage import stage, until

ROOT = Path(kit.__file__).parents[1]
TITLES = {"quiz": "an answer of the quiz", "lesson": "a prediction in a lesson"}


@pytest.fixture
def passed(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """The modules of the kit that were on the way when something was written, for each writing."""
    ways: list[list[str]] = []
    add = ProgressJournal.add

    def recorded(self: ProgressJournal, *args: Any, **options: Any) -> ProgressEvent:
        files = [Path(frame.filename) for frame in reversed(inspect.stack()[1:])]
        named = [str(file.relative_to(ROOT)) for file in files if file.is_relative_to(ROOT / "kit")]
        ways.append([*(name for name, _ in groupby(named)), "kit/school/progress.py"])
        return add(self, *args, **options)

    monkeypatch.setattr(ProgressJournal, "add", recorded)
    return ways


def written_walk(name: str) -> list[str]:
    """The modules of the walk in their order; a screen and lines begin it."""
    (steps,) = (steps for title, steps in walks().items() if title.endswith(TITLES[name]))
    return [module for step in steps for module in step if module != "kit/tui/screens/lesson.py"]


@pytest.mark.parametrize("name", TITLES)
def test_a_key_passes_what_its_walk_names(name: str, tmp_path: Path, passed: list[list[str]]) -> None:
    case = CASES[name]

    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("1")
        await pilot.press("2")
        await until(pilot, lambda: bool(passed), "the answer on the disk")

    with ProgressJournal(tmp_path) as journal:
        stage(lambda theme: case.screen(theme, journal, tmp_path), scene)
    assert passed[0] == [each for each in written_walk(name) if not each.startswith("kit/cli/")]


@pytest.mark.parametrize("name", TITLES)
def test_a_line_passes_what_its_walk_names(
    name: str, tmp_path: Path, passed: list[list[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("1\n2\nq\n"))
    with ProgressJournal(tmp_path) as journal:
        run_dialogue(CASES[name].dialogue(journal, tmp_path))
    inside = [each for each in written_walk(name) if not each.startswith(("kit/tui/", "kit/cli/"))]
    assert passed[0] == ["kit/cli/dialogue.py", *inside]
