"""The teacher's guide: what each lesson teaches, how long it takes, and what students get wrong; made from the lessons and
from the wrong works beside their solutions.

A wrong work is called ``CRITERIA__why``: the criteria that it must lose, joined by ``+``, and what somebody believed who
wrote it. One that was written for a sentence of its lesson quotes it, in a comment that begins with ``Lesson:``.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final, NamedTuple

from kit.school.lessons.reading import lesson_names, lessons_folder, read_lesson, read_units, solutions_folder
from kit.school.lessons.records import Lesson, StepKind

QUOTE: Final = "# Lesson: "
NO_TEXT: Final = (".npz", ".png", ".dat")
EDITS: Final = ".diff"
ADDED: Final = "+"
"""Ending of a wrong work that is written as edits of its solution, and what a line that it adds begins with."""
WRONG_FOLDER: Final = "wrong"


class Misconception(NamedTuple):
    """One wrong work."""

    lesson: str
    exercise: str
    criteria: tuple[str, ...]
    """What it must lose."""
    why: str
    """The reason in words."""
    sentence: str
    """The lesson's sentence that it misses; empty where none is quoted."""


def misconceptions(lessons: Sequence[Lesson] | None = None) -> tuple[Misconception, ...]:
    """All wrong works of all exercises, in the lessons' order; none where solutions were not installed.

    ``lessons``: by default all of the kit's.
    """
    if lessons is None:
        lessons = [read_lesson(lessons_folder() / name) for name in lesson_names()]
    try:
        solutions = solutions_folder()
    except FileNotFoundError:
        return ()
    folders = [
        (each, one, solutions / each.name / one.name / WRONG_FOLDER)
        for each in lessons
        for one in each.exercises
    ]
    return tuple(
        _misconception(lesson.name, exercise.name, work)
        for lesson, exercise, folder in folders
        if folder.is_dir()
        for work in sorted(folder.iterdir())
        if work.name[0] not in "._"
    )


def _misconception(lesson: str, exercise: str, work: Path) -> Misconception:
    criteria, _, why = (work.name if work.is_dir() else work.stem).partition("__")
    return Misconception(lesson, exercise, tuple(criteria.split("+")), why.replace("_", " "), _sentence(work))


def _sentence(work: Path) -> str:
    files = [file for file in sorted(work.rglob("*")) if file.is_file()] if work.is_dir() else [work]
    lines = (
        line.removeprefix(ADDED if file.suffix == EDITS else "")
        for file in files
        if file.suffix not in NO_TEXT
        for line in file.read_text().splitlines()
    )
    return next((line.removeprefix(QUOTE) for line in lines if line.startswith(QUOTE)), "")


WIDTH: Final = 78
INTRODUCTION: Final = """\
Each lesson goes from a prediction to a program of the student's own: predict, run, read, change, make. A prediction
costs nothing and is recorded before anything moves. Every exercise is checked at once by the same grader that marks a
class, as often as a student likes, with hints in steps.

## In one room

- Have students install the day before: `pip install`, then `kit doctor` says what is missing on each machine.
- Begin together with the prediction of step 1. Ask for hands before anybody presses a key, and talk about the wrong
  answers first: each stands for something that students do believe.
- Walk round with the list of mistakes below. Each is a work that somebody handed in or could have; the lesson's check
  names it, but a question of yours teaches more than a hint.
- Who is ahead races on the level of the game that the lesson opens (`kit game`), or writes a second solution.
- Keep the last five minutes for `kit quiz LESSON`: three to five questions on what the lesson taught.

## At a distance

- Everything runs in a terminal, also over ssh and without a graphical screen. `kit lesson NUMBER --plain` is the same
  lesson line by line, for screen readers and slow links; `KIT_REDUCE_MOTION=1` stills what moves by itself.
- Students hand in one file: `kit progress export FILE`. `kit class report FILES` makes the report of a class of them:
  who finished what, which questions went wrong, where hints were needed.
- Exercises are marked again, with secret seeds, by `grader cohort`; a student's own points are never taken on trust.
- `kit form before` and `kit form after` ask what they knew and what they learned; both go into the report.
"""


def teachers_guide(names: Sequence[str] = ()) -> str:
    """The guide as Markdown, at most ``WIDTH`` columns wide. ``names``: of lessons; by default all, with the introduction.

    Raises WorldError where a lesson cannot be read, and FileNotFoundError where none were installed.
    """
    chosen = tuple(names) or lesson_names()
    lessons = {name: read_lesson(lessons_folder() / name) for name in chosen}
    mistakes = misconceptions(tuple(lessons.values()))
    blocks = [] if names else list(_introduction(tuple(lessons.values())))
    openers = {unit.lessons[0]: unit for unit in read_units() if unit.lessons}
    for name, lesson in lessons.items():
        if name in openers and not names:
            blocks += [f"## {openers[name].letter}  {openers[name].title}", _wrapped(openers[name].opener)]
        blocks += _lesson_blocks(lesson, [each for each in mistakes if each.lesson == name])
    return "\n\n".join(blocks) + "\n"


def _introduction(lessons: Sequence[Lesson]) -> Iterator[str]:
    yield "# Teacher's guide"
    minutes = sum(each.minutes for each in lessons)
    yield _wrapped(
        f"{len(lessons)} lessons, about {round(minutes / 60)} hours. `kit class guide` prints this page from the lessons "
        "themselves, `kit class guide NUMBER` the part of one."
    )
    for block in INTRODUCTION.strip().split("\n\n"):
        yield block if block.startswith("#") else _rewrapped(block)


def _lesson_blocks(lesson: Lesson, mistakes: Sequence[Misconception]) -> Iterator[str]:
    yield f"### {lesson.number} {lesson.title}, {lesson.minutes} minutes"
    yield _wrapped(lesson.summary)
    yield "Afterwards a student can:"
    yield "\n".join(_entry(each) for each in lesson.outcomes)
    wrong = [
        _entry(
            f"Step {step.number}, “{step.question}” They say: {option.text} Say: {' '.join(option.feedback.split())}"
        )
        for step in lesson.steps
        if step.kind is StepKind.PREDICT
        for option in step.options
        if not option.is_right
    ]
    if wrong:
        yield "Predicted wrongly:"
        yield "\n".join(wrong)
    for step in lesson.steps:
        if step.exercise is None:
            continue
        yield _wrapped(f"Step {step.number}, {step.title} (`{step.exercise.name}`): {step.goal}. Mistakes:")
        own = [each for each in mistakes if each.exercise == step.exercise.name]
        yield "\n".join(_entry(_mistake_text(each)) for each in own) or "- none is on record"


def _mistake_text(mistake: Misconception) -> str:
    sentence = f" The lesson says: “{mistake.sentence}”" if mistake.sentence else ""
    return f"{mistake.why}; loses {', '.join(mistake.criteria)}.{sentence}"


def _entry(text: str) -> str:
    return textwrap.fill(
        " ".join(text.split()), WIDTH, initial_indent="- ", subsequent_indent="  ", break_long_words=False,
        break_on_hyphens=False,
    )  # fmt: skip


def _wrapped(text: str) -> str:
    return textwrap.fill(" ".join(text.split()), WIDTH, break_long_words=False, break_on_hyphens=False)


def _rewrapped(block: str) -> str:
    """A paragraph, or the entries of a list, in lines of the guide's width."""
    if not block.startswith("- "):
        return _wrapped(block)
    return "\n".join(
        _entry(each.removeprefix("- ")) for each in block.replace("\n- ", "\n\0- ").split("\n\0")
    )
