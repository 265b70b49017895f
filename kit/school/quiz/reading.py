"""Reads ``lessons/NN-name/quiz.yaml`` into records; reports all mistakes of all files with file, line and column."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Final

from kit.plain_text import quoted, suggestion
from kit.school.lessons.reading import UnknownLesson, lesson_names, lessons_folder, with_lesson_numbers
from kit.school.lessons.translation import translation_of
from kit.school.quiz.items import (
    IDEA_COUNT,
    OPTION_COUNT,
    AnswerOption,
    QuestionBank,
    QuizItem,
    QuizTopic,
    build_bank,
)
from kit.world.documents import WorldDocuments
from kit.world.files import AllowedRoot
from kit.world.problems import ProblemCollector
from kit.world.records import SourceLocation
from kit.world.yaml_section import Section

QUIZ_FILE: Final = "quiz.yaml"
MAX_PICTURE_WIDTH: Final = 74
"""Columns of a picture; pictures are not wrapped."""
MAX_PICTURE_HEIGHT: Final = 8
"""Rows of a picture, which shares the screen with question, options and feedback."""

_ID: Final = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")


def read_bank(folder: Path | None = None) -> QuestionBank:
    """Reads every item of every lesson in ``folder`` (by default the kit's own). Raises WorldError with all mistakes."""
    folder = lessons_folder() if folder is None else folder
    order = {name: number for number, name in enumerate(lesson_names(folder))}
    files = sorted(
        folder.glob(f"[0-9]*-*/{QUIZ_FILE}"),
        key=lambda file: (order.get(file.parent.name, len(order)), file.parent.name),
    )
    lessons = [file.parent.name for file in files]
    problems = ProblemCollector()
    items = [item for file in files for item in _read_file(file, lessons, problems)]
    _check_unique(items, problems)
    problems.raise_if_any()
    return build_bank(items)


def _read_file(file: Path, lessons: Collection[str], problems: ProblemCollector) -> list[QuizItem]:
    documents = WorldDocuments(AllowedRoot.of_folder(file.parent), {}, problems)
    section = documents.section(file, SourceLocation(file))
    if section is None:
        return []
    items = list(_read_items(section, file.parent.name, lessons))
    section.finish()
    translation = translation_of(file)
    if translation is not None:
        items = _translated_items(items, translation, documents)
    return [_with_numbers(item, file.parent.parent, problems) for item in items]


def _with_numbers(item: QuizItem, folder: Path, problems: ProblemCollector) -> QuizItem:
    """With the numbers of the lessons that it names; ``folder``: that of all lessons."""
    try:
        return replace(
            item,
            question=with_lesson_numbers(item.question, folder),
            options=tuple(
                replace(option, feedback=with_lesson_numbers(option.feedback, folder))
                for option in item.options
            ),
        )
    except UnknownLesson as error:
        problems.add(item.location, str(error))
        return item


def _translated_items(items: list[QuizItem], file: Path, documents: WorldDocuments) -> list[QuizItem]:
    """The same items in the words of a translation, which names them by their ids; the others as they are."""
    section = documents.section(file, SourceLocation(file))
    if section is None:
        return items
    translated = {item.id: item for item in items}
    for each in section.sections("items", at_least=1):
        name = each.name("id")
        item = translated.get(name)
        if item is None:
            each.error(f"no item {quoted(name)}: {suggestion(name, tuple(translated))}", "id")
            continue
        texts = each.sections("options", length=OPTION_COUNT)
        options = [
            replace(option, text=words.name("text"), feedback=words.text("feedback").strip())
            for option, words in zip(item.options, texts, strict=False)
        ]
        for words in texts:
            words.finish()
        picture = _read_picture(each) if each.has("picture") else item.picture
        translated[name] = replace(
            item,
            question=each.text("question").strip(),
            options=tuple(options) or item.options,
            picture=picture,
        )
        each.finish()
    section.finish()
    return list(translated.values())


def _read_items(section: Section, lesson: str, lessons: Collection[str]) -> Iterator[QuizItem]:
    topics = {topic.value: topic for topic in QuizTopic}
    for each in section.sections("items", at_least=1):
        step, words = _read_taught(each, lesson)
        item = QuizItem(
            id=_read_id(each),
            lesson=lesson,
            topic=each.choice("topic", topics) or QuizTopic.DRIVING,
            idea=each.integer("idea", minimum=1, maximum=IDEA_COUNT) if each.has("idea") else None,
            question=each.text("question").strip(),
            picture=_read_picture(each),
            options=_read_options(each),
            lesson_to_repeat=_read_see(each, step, lessons),
            taught_by=words,
            command_to_try=_read_attempt(each),
            derivation=each.name("derived") if each.has("derived") else "",
            location=each.location,
        )
        each.finish()
        yield item


def _read_id(section: Section) -> str:
    name = section.name("id")
    if name and not _ID.fullmatch(name):
        section.error(f"{quoted('id')} is made of small letters, digits and single hyphens", "id")
    return name


def _read_picture(section: Section) -> tuple[str, ...]:
    rows = tuple(row.rstrip() for row in section.text("picture", "").rstrip().splitlines())
    if len(rows) > MAX_PICTURE_HEIGHT or any(len(row) > MAX_PICTURE_WIDTH for row in rows):
        section.error(
            f"{quoted('picture')} must fit {MAX_PICTURE_WIDTH} columns and {MAX_PICTURE_HEIGHT} rows",
            "picture",
        )
    if not all(row.isascii() for row in rows):
        section.error(f"{quoted('picture')} is drawn in ASCII: some terminals have nothing else", "picture")
    return rows


def _read_options(section: Section) -> tuple[AnswerOption, ...]:
    options = []
    for each in section.sections("options", length=OPTION_COUNT):
        options.append(
            AnswerOption(each.name("text"), each.text("feedback").strip(), each.flag("right", False))
        )
        each.finish()
    if options and sum(option.is_right for option in options) != 1:
        section.error("exactly one option must say right: true", "options")
    if len({option.text.casefold() for option in options}) < len(options):
        section.error("two options say the same", "options")
    return tuple(options)


def _read_taught(section: Section, lesson: str) -> tuple[str, str]:
    """The step that teaches the answer, as LESSON/STEP, and its words; the lesson alone if the item does not say."""
    taught = section.section("taught", None)
    if taught is None:
        return lesson, ""
    step = f"{taught.name('lesson', lesson)}/{taught.integer('step', minimum=1)}"
    words = " ".join(taught.text("words").split())
    taught.finish()
    return step, words


def _read_see(section: Section, taught: str, lessons: Collection[str]) -> str:
    see = section.name("see", taught)
    named, _, step = see.partition("/")
    if named not in lessons:
        section.error(f"there is no lesson {quoted(named)}: {suggestion(named, lessons)}", "see")
    elif "/" in see and not step.isdecimal():
        section.error(f"{quoted('see')} is LESSON or LESSON/STEP, with the step's number", "see")
    return see


def _read_attempt(section: Section) -> str:
    command = section.name("try") if section.has("try") else ""
    if command and not command.startswith("kit "):
        section.error(f"{quoted('try')} must be a command of the kit", "try")
    return command


def _check_unique(items: list[QuizItem], problems: ProblemCollector) -> None:
    seen: dict[str | int, QuizItem] = {}
    for item in items:
        for key, words in (
            (item.id, f"an item {quoted(item.id)}"),
            (item.idea, f"an item of idea {item.idea}"),
        ):
            if not key:
                continue
            if key in seen:
                problems.add(item.location, f"{words} stands in {seen[key].location} already")
            seen.setdefault(key, item)
