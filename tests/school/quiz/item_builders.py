"""Items and answers for the tests of the quiz."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

from kit.document.layout import Page, rows_of
from kit.document.rows import MARGIN, Row, text_width
from kit.school.progress import EventKind, ProgressEvent
from kit.school.quiz.answers import NOT_SURE, AnswerChoice, AnswerOccasion, event_content
from kit.school.quiz.items import AnswerOption, QuestionBank, QuizItem, QuizTopic, build_bank
from kit.school.quiz.quiz_dialogue import QuizDialogue
from kit.tui.screens.dialogue import WIDEST
from kit.world.records import SourceLocation

MONDAY = datetime(2026, 3, 2, 10, 0, tzinfo=UTC)


def item(
    name: str, topic: QuizTopic = QuizTopic.ROS2, *, lesson: str = "01-one", idea: int | None = None
) -> QuizItem:
    """One whose first option is right."""
    options = tuple(AnswerOption(f"{name} {i}", f"about {i}", i == 0) for i in range(3))
    return QuizItem(
        name, lesson, topic, idea, f"{name}?", (), options, lesson, "", "", SourceLocation(Path("quiz.yaml"))
    )


def bank(**counts: int) -> QuestionBank:
    """So many items of each topic, each topic in a lesson of its own: ``bank(ros2=5)`` has ros2-0 to ros2-4."""
    return build_bank(
        item(f"{topic}-{i}", QuizTopic(topic), lesson=f"0{number}-{topic}")
        for number, (topic, count) in enumerate(counts.items(), 1)
        for i in range(count)
    )


def answered(
    what: QuizItem,
    days: float = 0,
    choice: AnswerChoice | None = None,
    *,
    confidence: int | None = 3,
    occasion: AnswerOccasion = AnswerOccasion.LESSON,
) -> ProgressEvent:
    """An answer so many days after Monday; the right one where none is given."""
    at = MONDAY + timedelta(days=days)
    content = event_content(what, choice or AnswerChoice(what.right_option), confidence, occasion)
    return ProgressEvent(
        f"{what.id}-{days}-{occasion}",
        at.isoformat(timespec="microseconds"),
        EventKind.ANSWER,
        what.id,
        content,
    )


class OneQuestion:
    """Stands in for a session that asks one question and keeps nothing."""

    question_number = question_count = 1

    def __init__(self, item: QuizItem) -> None:
        self.current_item: QuizItem | None = item

    def answer(self, choice: AnswerChoice, confidence: int | None = None) -> None:
        self.current_item = None


def told_rows(item: QuizItem, choice: AnswerChoice, width: int = 80) -> list[Row]:
    """The rows of a question once it is answered."""
    dialogue = asked(item)
    if choice.option is not None:
        dialogue.choose(choice.option + 1)
        dialogue.rate(1)
    elif choice is NOT_SURE:
        dialogue.say_not_sure()
    else:
        dialogue.leave_blank()
    return shown_rows(dialogue, width)


def asked(item: QuizItem) -> QuizDialogue:
    """A dialogue that asks this question."""
    return QuizDialogue(OneQuestion(item))  # type: ignore[arg-type]  # stands in for a QuizSession


def shown_rows(dialogue: QuizDialogue, width: int = 80) -> list[Row]:
    """The rows between a screen's heading and its last two."""
    return rows_of(dialogue.blocks(), Page(text_width(width, WIDEST - 2 * MARGIN), MARGIN))
