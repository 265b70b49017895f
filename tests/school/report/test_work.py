"""What is read from a student's events about the lessons."""

from __future__ import annotations

from typing import Any

from kit.school.progress import EventKind
from kit.school.report.students import started_lessons, student_work
from tests.cases import every_case
from tests.school.report.class_builder import Diary


def test_attempts_points_and_what_was_lost() -> None:
    diary = Diary("Ada")
    diary.attempt("01-drive/flag", 2.0, "fail", ["reached", "clear"])
    diary.attempt("01-drive/flag", 1.0, "fail", ["reached"])
    diary.attempt("01-drive/flag", 0.0, "broken")
    diary.attempt("01-drive/flag", 5.0, "pass")
    diary.attempt("01-drive/flag", 3.0, "fail", ["clear"])
    exercise = student_work(diary.events)["01-drive"].exercises["flag"]
    assert (exercise.attempts, exercise.points, exercise.max_points) == (4, 5.0, 5.0)
    assert (exercise.is_passed, exercise.tries_to_pass) == (True, 3)
    assert exercise.lost_criteria == {"reached": 2, "clear": 2}


def test_steps_hints_predictions_and_solutions() -> None:
    diary = Diary("Ada")
    for step in ("1", "2", "1"):
        diary.note(EventKind.STEP, f"01-drive/{step}")
    diary.note(EventKind.PREDICTION, "01-drive/3", {"chosen": 0, "right": True})
    diary.note(EventKind.PREDICTION, "01-drive/4", {"chosen": 0, "right": False})
    diary.note(EventKind.HINT, "01-drive/flag/reached", {"step": 1})
    diary.note(EventKind.SOLUTION, "01-drive/flag")
    lesson = student_work(diary.events)["01-drive"]
    assert len(lesson.steps) == 2
    assert (lesson.predictions, lesson.predicted_right, lesson.hint_count) == (2, 1, 1)
    assert lesson.exercises["flag"].has_seen_solution
    assert (lesson.attempt_count, lesson.passed_count) == (0, 0)


def test_time_stops_in_pauses_and_between_lessons() -> None:
    diary = Diary("Ada")
    for lesson, minutes in (("a", 1), ("a", 3), ("b", 4), ("b", 9), ("b", 60), ("b", 2), ("a", 5)):
        diary.note(EventKind.STEP, f"{lesson}/1", minutes=minutes)
    work = student_work(diary.events)
    assert (work["a"].minutes, work["b"].minutes) == (3, 11)
    assert started_lessons([work, {}]) == ("a", "b")


def test_what_is_not_of_lessons_is_passed_over() -> None:
    diary = Diary("Ada")
    diary.note(EventKind.ABOUT, "name", {"value": "Ada"})
    diary.note(EventKind.FINISH, "level-1", {"reached": True})
    assert student_work(diary.events) == {}


@every_case(
    "content",
    [
        {},
        {"verdict": "pass", "points": "many", "max_points": None, "lost": "reached"},
        {"verdict": "pass", "points": float("nan"), "max_points": float("inf"), "lost": [1, None]},
        {"verdict": "pass", "points": 10**400, "max_points": -5, "lost": {"a": 1}},
        {"verdict": ["pass"], "points": True},
        {"verdict": "pass", "points": 99, "max_points": 5},
    ],
)
def test_damaged_entries_count_as_little_as_they_say(content: dict[str, Any]) -> None:
    diary = Diary("Ada")
    diary.note(EventKind.ATTEMPT, "01-drive/flag", content)
    lesson = student_work(diary.events)["01-drive"]
    assert 0 <= lesson.points <= lesson.max_points <= 5
