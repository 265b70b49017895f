"""What README.md and lessons/README.md say is so. ``python tests/test_readme.py`` writes the table of lessons anew."""

from __future__ import annotations

import re
from pathlib import Path

from kit.cli import VERBS
from kit.school.lessons.reading import lesson_names, lessons_folder, read_lesson

README = Path(__file__).parent.parent / "README.md"
LESSONS = Path(__file__).parent.parent / "lessons" / "README.md"
FIRST, LAST = "<!-- lessons -->\n", "<!-- end of lessons -->\n"


def table() -> str:
    """The lessons, and what each carries."""
    rows = ["| Lesson | Minutes | Exercises | Carries |", "|---|---|---|---|"]
    for name in lesson_names():
        lesson = read_lesson(lessons_folder() / name)
        exercises = ", ".join(exercise.name for exercise in lesson.exercises)
        rows.append(f"| {name} | {lesson.minutes} | {exercises} | {', '.join(lesson.outcome_ids)} |")
    return "\n".join(rows) + "\n"


def test_the_table_of_lessons_is_true() -> None:
    text = LESSONS.read_text()
    assert text[text.index(FIRST) + len(FIRST) : text.index(LAST)] == table()


def test_every_verb_it_names_exists() -> None:
    named = set(re.findall(r"`kit ([a-z]+)", README.read_text()))
    assert named <= set(VERBS)


if __name__ == "__main__":
    text = LESSONS.read_text()
    head, tail = text.index(FIRST) + len(FIRST), text.index(LAST)
    LESSONS.write_text(text[:head] + table() + text[tail:])
