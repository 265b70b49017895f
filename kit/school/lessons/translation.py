"""Lessons, questions and the form in another language: ``lesson.pt.yaml`` beside ``lesson.yaml``, and so for the others.

A translation holds words and nothing else: the steps, scenes, commands and exercises stay those of the original, so that
progress and grades do not depend on the language. ``KIT_LANG`` names it by two letters; what has no translation is shown
as it was written.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from kit.plain_text import quoted
from kit.results.grading_result import CriterionResult, GradingResult
from kit.school.lessons.records import Lesson, LessonStep, PredictionOption
from kit.world.yaml_section import Section

VARIABLE: Final = "KIT_LANG"
ORIGINAL: Final = "en"
"""The language of what is not translated."""
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


def missing_language(file: Path, language: str | None = None) -> str:
    """The language that is asked for and that a file has no translation into; empty where nothing is missing.

    >>> missing_language(Path("lessons/01-drive/lesson.yaml"), "xx"), missing_language(Path("lesson.yaml"), "en")
    ('xx', '')
    """
    language = chosen_language() if language is None else language
    is_there = language in ("", ORIGINAL) or translation_of(file, language) is not None
    return "" if is_there else language


def missing_translation_text(language: str) -> str:
    """What to say of a text that is shown as it was written; empty where ``language`` is."""
    return f"{VARIABLE} asks for {quoted(language)}: this is not translated yet, so it is in English." * bool(
        language
    )


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
        section.error(f"{missing[0]} is in the original or here, not in both", "text")
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


def translated_criteria(original: Section, section: Section) -> dict[str, str]:
    """The titles and hints of an exercise's criteria, and what its questions ask, by what they are in the ``original``
    assignment, with single blanks. ``section``: the translation, whose ``checks`` stand in the same order, with as many
    hints, and whose ``questions`` have the same names."""
    words: dict[str, str] = {}
    section.name("title")
    asked = original.section("questions", None)
    if asked is not None:
        questions = section.section("questions")
        words = {_key(asked.section(each).text("ask")): questions.text(each) for each in tuple(asked.keys())}
        questions.finish()
    for theirs, ours in _pairs(original, section, "checks"):
        words[_key(theirs.name("title"))] = ours.name("title")
        hints = theirs.texts("hints", ())
        made = tuple(each.text("hint") for each in theirs.sections("mistakes", ()))
        for key, texts in (("hints", hints), ("mistakes", made)):
            translated = ours.texts(key, ())
            if len(translated) != len(texts):
                ours.error(f"there are {len(texts)} {key}", key)
            words |= {_key(of): said.strip() for of, said in zip(texts, translated, strict=False)}
        ours.finish()
    return words


def _pairs(original: Section, section: Section, key: str) -> Iterator[tuple[Section, Section]]:
    theirs, ours = original.sections(key, at_least=1), section.sections(key, at_least=1)
    if len(theirs) != len(ours):
        section.error(f"there are {len(theirs)} {key}", key)
    return zip(theirs, ours, strict=False)


def translated_result(result: GradingResult, words: Mapping[str, str]) -> GradingResult:
    """A result with the titles and hints of its criteria in another language; see ``Exercise.words``."""
    return replace(result, tests=tuple(_translated_criterion(each, words) for each in result.tests))


def _translated_criterion(criterion: CriterionResult, words: Mapping[str, str]) -> CriterionResult:
    rationale = criterion.rationale
    for of, said in words.items():
        # It may name another criterion by its title, and what was asked.
        rationale = rationale.replace(f"“{of}”", f"“{said}”").replace(f": {of}", f": {said}")
    return replace(
        criterion,
        title=words.get(_key(criterion.title), criterion.title),
        hints=tuple(words.get(_key(each), each) for each in criterion.hints),
        rationale=rationale,
    )


def _key(text: str) -> str:
    return " ".join(text.split())


def translated_words(section: Section) -> dict[str, str]:
    """Reads a file whose ``words`` are pairs of an original text (``of``) and its translation (``is``)."""
    words: dict[str, str] = {}
    for each in section.sections("words", at_least=1):
        words[_key(each.text("of"))] = each.text("is").strip()
        each.finish()
    return words
