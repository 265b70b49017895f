"""A small lesson of our own: one prediction, one explanation, one exercise about answers."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.reading import read_lesson
from kit.school.lessons.records import Lesson
from kit.school.progress import ProgressJournal
from kit.workspace import Workspace, open_workspace

LESSON = """
title: Colours
summary: What a traffic light says.
minutes: 5
outcomes: [Read a light]
carries: [light]
steps:
  - kind: predict
    title: What comes next?
    goal: Foresee the light
    text: The light is red.
    picture: |
      (o)
    question: What comes next?
    options:
      - {text: Green, right: true, feedback: After red comes green here.}
      - {text: Red, feedback: It is red already.}
  - kind: explain
    title: Why
    goal: See why
    text: |
      It goes round. `kit maps` lists something else.
    commands: [{line: kit maps}]
  - kind: make
    title: Say it
    goal: Write it down
    text: Write the colour into {file}.
    exercise: colour
    file: answers.yaml
    seconds: 20
"""
SHEET = """
title: Colour
kind: answers
submit: answers.yaml
level: 0
questions: {colour: {ask: Which colour means go?}}
checks:
  - {check: answers, id: colour, title: The colour, points: 2, hints: [Look up., It grows on trees., It is green.]}
"""
SECRET = """
answers: {colour: {right: [green], feedback: {red: That one means stop.}}}
"""


def write_lesson(lessons: Path, sheet: str = LESSON) -> Path:
    """A lesson's folder, and beside it the list of outcomes."""
    folder = lessons / "01-colours"
    (folder / "colour").mkdir(parents=True)
    (lessons / "outcomes.yaml").write_text("light: Read a light\n")
    (folder / "lesson.yaml").write_text(sheet)
    (folder / "colour" / "assignment.yaml").write_text(SHEET)
    (folder / "colour" / "secret.yaml").write_text(SECRET)
    (folder / "colour" / "starter.yaml").write_text("colour:\n")
    return folder


@pytest.fixture
def lesson(tmp_path: Path) -> Lesson:
    return read_lesson(write_lesson(tmp_path / "lessons"))


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    return open_workspace(tmp_path / "workspace")


@pytest.fixture
def journal(workspace: Workspace) -> Iterator[ProgressJournal]:
    with ProgressJournal(workspace.folder) as opened:
        yield opened


@pytest.fixture
def session(lesson: Lesson, journal: ProgressJournal, workspace: Workspace) -> LessonSession:
    return LessonSession(lesson, journal, workspace)
