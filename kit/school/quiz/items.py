"""The records of the quiz, and the reader of ``lessons/NN-name/quiz.yaml``, which reports all mistakes with their places."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import Final

from kit.plain_text import quoted, suggestion
from kit.school.lessons.reading import (
    UnknownLesson,
    find_lesson_name,
    lesson_names,
    lesson_number,
    lesson_title,
    lessons_folder,
    unknown_lesson,
    with_lesson_numbers,
)
from kit.school.lessons.translation import translation_of
from kit.world.documents import AllowedRoot, WorldDocuments
from kit.world.problems import ProblemCollector
from kit.world.records import SourceLocation
from kit.world.yaml_section import Section

OPTION_COUNT: Final = 3
"""Options per item: as many as there are observed misconceptions for; more would be fillers (Rodriguez 2005)."""

IDEA_COUNT: Final = 12
"""Number of ideas in the quiz; each has exactly one item."""


class QuizTopic(StrEnum):
    """The topic of an item: the unit of scores and of the schedule."""

    DRIVING = "driving"
    ROS2 = "ros2"
    FLATLAND = "flatland"
    LAYERS = "layers"
    RL = "rl"
    FIELDS = "fields"

    @property
    def label(self) -> str:
        """The topic's name on screen."""
        return _LABELS[self]

    @property
    def has_worlds(self) -> bool:
        """Whether its questions are about robots in a world, so that a picture of one bears on them."""
        return self in (QuizTopic.DRIVING, QuizTopic.FLATLAND, QuizTopic.FIELDS)


_LABELS: Final[Mapping[QuizTopic, str]] = {
    QuizTopic.DRIVING: "driving",
    QuizTopic.ROS2: "ROS 2",
    QuizTopic.FLATLAND: "Flatland worlds",
    QuizTopic.LAYERS: "layers",
    QuizTopic.RL: "learning",
    QuizTopic.FIELDS: "potential fields",
}


@dataclass(frozen=True, slots=True)
class AnswerOption:
    """One option of an item."""

    text: str
    feedback: str
    """Feedback for choosing it: the name of the misconception, or why it is right."""
    is_right: bool


@dataclass(frozen=True, slots=True)
class QuizItem:
    """One question."""

    id: str
    lesson: str
    """The lesson whose folder holds it."""
    topic: QuizTopic
    idea: int | None
    """1 to 12 for the items of the quiz."""
    question: str
    picture: tuple[str, ...]
    """Rows of ASCII characters; empty: no picture."""
    options: tuple[AnswerOption, ...]
    lesson_to_repeat: str
    """LESSON/STEP: the step that teaches the answer; or the lesson, where no step is named."""
    command_to_try: str
    """A command that demonstrates the answer; may be empty."""
    derivation: str
    """Name of the tests' derivation that computes its answer; empty: it cannot be derived."""
    location: SourceLocation
    taught_by: str = ""
    """Words of the step to repeat that teach the answer."""

    @property
    def right_option(self) -> int:
        """Index of the right option, from 0."""
        return next(index for index, option in enumerate(self.options) if option.is_right)


class LessonWithoutQuestions(LookupError):
    """No lesson of that name has questions; the message offers the nearest one."""


@dataclass(frozen=True, slots=True)
class QuestionBank:
    """All items, lesson by lesson."""

    items: tuple[QuizItem, ...]

    @property
    def lessons(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(item.lesson for item in self.items))

    @property
    def quiz_items(self) -> tuple[QuizItem, ...]:
        """The quiz: one item for each idea, in the ideas' order."""
        return tuple(sorted((item for item in self.items if item.idea), key=lambda item: item.idea or 0))

    def items_by_id(self) -> dict[str, QuizItem]:
        return {item.id: item for item in self.items}

    def lesson_items(self, lesson: str) -> tuple[QuizItem, ...]:
        return tuple(item for item in self.items if item.lesson == lesson)

    def topic_items(self, topic: QuizTopic) -> tuple[QuizItem, ...]:
        return tuple(item for item in self.items if item.topic is topic)

    def find_lesson(self, name: str) -> str:
        """Finds a lesson by its number or its name, as ``kit lesson`` does. Raises LessonWithoutQuestions."""
        found = find_lesson_name(name, self.lessons)
        if found is not None:
            return found
        raise LessonWithoutQuestions(unknown_lesson(name, self.lessons))


def lesson_reference(lesson: str) -> str:
    """A lesson or its step in a sentence: ``02-nodes-and-topics/3`` is "lesson A3, Nodes and topics, step 3"."""
    folder, _, step = lesson.partition("/")
    words = f"lesson {lesson_number(folder)}, {lesson_title(folder)}"
    return f"{words}, step {step}" if step else words


def lesson_command(lesson: str) -> str:
    """The command that opens a lesson, named as for ``lesson_reference``."""
    return f"kit lesson {lesson_number(lesson.partition('/')[0])}"


def build_bank(items: Iterable[QuizItem]) -> QuestionBank:
    """Puts the items of each lesson together, in the order in which the lessons come first."""
    by_lesson: dict[str, list[QuizItem]] = {}
    for item in items:
        by_lesson.setdefault(item.lesson, []).append(item)
    return QuestionBank(tuple(item for each in by_lesson.values() for item in each))


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
    """Inserts the numbers of the lessons that an item names; ``folder``: the folder of all lessons."""
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
    """The items in the words of a translation, which names them by their ids; items without one as they are."""
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
            lesson_to_repeat=_read_lesson_to_repeat(each, step, lessons),
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
        section.error("two options say the same thing", "options")
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


def _read_lesson_to_repeat(section: Section, taught: str, lessons: Collection[str]) -> str:
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
                problems.add(item.location, f"{words} is already in {seen[key].location}")
            seen.setdefault(key, item)
