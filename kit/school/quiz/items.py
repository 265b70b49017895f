"""The records of the quiz: items with one question, three options of which one is right, and feedback for each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Final

from kit.plain_text import quoted, suggestion
from kit.school.lessons.reading import find_lesson_name, lesson_number
from kit.world.records import SourceLocation

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
        raise LessonWithoutQuestions(
            f"no lesson {quoted(name)} has questions: {suggestion(name, self.lessons)}"
        )


def lesson_title(lesson: str) -> str:
    """A lesson's title in a sentence: ``02-nodes-and-topics/3`` is "lesson A3, nodes and topics, step 3"."""
    folder, _, step = lesson.partition("/")
    words = f"lesson {lesson_number(folder)}, {folder.partition('-')[2].replace('-', ' ')}"
    return f"{words}, step {step}" if step else words


def lesson_command(lesson: str) -> str:
    """The command that opens a lesson."""
    return f"kit lesson {lesson_number(lesson)}"


def build_bank(items: Iterable[QuizItem]) -> QuestionBank:
    """Puts the items of each lesson together, in the order in which the lessons come first."""
    by_lesson: dict[str, list[QuizItem]] = {}
    for item in items:
        by_lesson.setdefault(item.lesson, []).append(item)
    return QuestionBank(tuple(item for each in by_lesson.values() for item in each))
