"""Lessons, questions and the form in another language: ``lesson.pt.yaml`` beside ``lesson.yaml``, and so for the others.

A translation holds words and nothing else: the steps, scenes, commands and exercises stay those of the original, so that
progress and grades do not depend on the language. ``KIT_LANG`` names it by two letters; what has no translation is shown
as it was written.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from kit.plain_text import quoted
from kit.school.lessons.records import Lesson, LessonStep, PredictionOption
from kit.world.yaml_section import Section

VARIABLE: Final = "KIT_LANG"
_CODE: Final = re.compile(r"[a-z]{2}")


def chosen_language() -> str:
    """The two letters that ``KIT_LANG`` begins with, such as ``pt`` of ``pt_PT.UTF-8``; empty where it is not set."""
    found = _CODE.match(os.environ.get(VARIABLE, "").lower())
    return found[0] if found else ""


def translation_of(file: Path, language: str | None = None) -> Path | None:
    """The translation of a file that lies beside it; None where there is none. ``language``: by default the chosen one.

    >>> translation_of(Path("lessons/01-drive/lesson.yaml"), "pt")
    PosixPath('lessons/01-drive/lesson.pt.yaml')
    """
    language = chosen_language() if language is None else language
    found = file.with_name(f"{file.stem}.{language}{file.suffix}")
    return found if language and found.is_file() else None


def translate_lesson(lesson: Lesson, section: Section) -> tuple[Lesson, Sequence[tuple[Section, LessonStep]]]:
    """Puts the words of a translation into a lesson. Returns also each step with the section that its words are from."""
    outcomes = section.texts("outcomes", at_least=1)
    if len(outcomes) != len(lesson.outcomes):
        section.error(f"there are {len(lesson.outcomes)} outcomes", "outcomes")
    sections = section.sections("steps", at_least=1)
    if len(sections) != len(lesson.steps):
        section.error(f"there are {len(lesson.steps)} steps", "steps")
    steps = [(each, _translated_step(step, each)) for step, each in zip(lesson.steps, sections, strict=False)]
    translated = replace(
        lesson,
        title=section.name("title"),
        summary=section.name("summary"),
        outcomes=outcomes,
        steps=tuple(step for _, step in steps) or lesson.steps,
    )
    section.finish()
    return translated, steps


def _translated_step(step: LessonStep, section: Section) -> LessonStep:
    translated = replace(
        step,
        title=section.name("title"),
        goal=section.name("goal"),
        text=section.text("text").strip("\n"),
        picture=section.text("picture", step.picture).rstrip("\n"),
        question=section.text("question", "") if step.question else "",
        options=tuple(_translated_options(step.options, section)),
        claims=(),  # what they say is derived in the original
    )
    missing = [name for name in ("{file}", "{folder}") if (name in step.text) != (name in translated.text)]
    if missing:
        section.error(f"{missing[0]} stands in the original or here, not in both", "text")
    for command in step.commands:
        if command.line in step.text and command.line not in translated.text:
            section.error(f"the command {quoted(command.line)} is missing", "text")
    section.finish()
    return translated


def _translated_options(options: Sequence[PredictionOption], section: Section) -> Iterator[PredictionOption]:
    sections = section.sections("options", ())
    if len(sections) != len(options):
        section.error(f"there are {len(options)} options", "options")
    for option, each in zip(options, sections, strict=False):
        yield PredictionOption(each.text("text"), option.is_right, each.text("feedback"))
        each.finish()


def translated_words(section: Section) -> dict[str, str]:
    """Reads a file whose ``words`` are pairs of an original text (``of``) and its translation (``is``)."""
    words: dict[str, str] = {}
    for each in section.sections("words", at_least=1):
        words[" ".join(each.text("of").split())] = each.text("is").strip()
        each.finish()
    section.finish()
    return words
