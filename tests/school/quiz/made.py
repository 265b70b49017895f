"""Items and answers for the tests of the quiz."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

from kit.school.progress import EventKind, ProgressEvent
from kit.school.quiz.answers import Choice, Occasion, content_of
from kit.school.quiz.items import Bank, Item, Option, Topic, bank_of
from kit.world.records import SourceLocation

MONDAY = datetime(2026, 3, 2, 10, 0, tzinfo=UTC)


def item(name: str, topic: Topic = Topic.ROS2, *, lesson: str = "01-one", idea: int | None = None) -> Item:
    """One whose first option is right."""
    options = tuple(Option(f"{name} {i}", f"about {i}", i == 0) for i in range(3))
    return Item(
        name, lesson, topic, idea, f"{name}?", (), options, lesson, "", "", SourceLocation(Path("quiz.yaml"))
    )


def bank(**counts: int) -> Bank:
    """So many items of each topic, each topic in a lesson of its own: ``bank(ros2=5)`` has ros2-0 to ros2-4."""
    return bank_of(
        item(f"{topic}-{i}", Topic(topic), lesson=f"0{number}-{topic}")
        for number, (topic, count) in enumerate(counts.items(), 1)
        for i in range(count)
    )


def answered(
    what: Item,
    days: float = 0,
    choice: Choice | None = None,
    *,
    confidence: int | None = 3,
    occasion: Occasion = Occasion.LESSON,
) -> ProgressEvent:
    """An answer so many days after Monday; the right one where none is given."""
    at = MONDAY + timedelta(days=days)
    content = content_of(what, choice or Choice(what.right), confidence, occasion)
    return ProgressEvent(
        f"{what.id}-{days}-{occasion}",
        at.isoformat(timespec="microseconds"),
        EventKind.ANSWER,
        what.id,
        content,
    )
