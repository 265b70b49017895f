"""Scores: wrong, not sure and blank are three things; how sure against how often right."""

from __future__ import annotations

import re
from collections.abc import Sequence

from kit.document.layout import Page, lines_of
from kit.school.progress import EventKind, ProgressEvent
from kit.school.quiz.answers import (
    BLANK,
    NOT_SURE,
    AnswerChoice,
    AnswerOccasion,
    AnswerOutcome,
    answer_from_event,
    answers_from_events,
)
from kit.school.quiz.items import QuizTopic
from kit.school.quiz.quiz_scores import (
    OutcomeCounts,
    count_by_topic,
    count_outcomes,
    latest_answers,
    measure_calibration,
)
from kit.school.quiz.quiz_text import calibration_blocks, follow_up_blocks, tally_line
from kit.school.quiz.schedule import round_history
from tests.cases import every_case
from tests.kit_content import kit_bank, kit_lesson
from tests.school.quiz.item_builders import MONDAY, answered, bank, told_rows

BANK = bank(ros2=4, layers=2)
ITEMS = BANK.items
WRONG = AnswerChoice(1)


def test_each_outcome_is_counted_by_itself() -> None:
    choices = [AnswerChoice(0), WRONG, NOT_SURE, BLANK]
    answers = answers_from_events(
        answered(item, 0, choice) for item, choice in zip(ITEMS, choices, strict=False)
    )
    counted = count_by_topic(ITEMS, latest_answers(answers))
    assert [answer.outcome for answer in answers] == list(AnswerOutcome)
    assert counted[QuizTopic.ROS2] == OutcomeCounts(1, 1, 1, 1)
    assert count_outcomes(ITEMS, latest_answers(answers)) == OutcomeCounts(1, 1, 1, 1, 2)
    assert counted[QuizTopic.LAYERS].total == 2
    assert (
        tally_line(OutcomeCounts(1, 1, 1, 1, 2))
        == "1 of 6 right, 1 wrong, 1 not sure, 1 blank, 2 not asked yet"
    )


def test_the_latest_answer_counts() -> None:
    answers = answers_from_events([answered(ITEMS[0], 0, WRONG), answered(ITEMS[0], 1)])
    assert count_outcomes(ITEMS[:1], latest_answers(answers)) == OutcomeCounts(right=1)


@every_case(
    "content",
    [
        {},
        {"occasion": "exam", "chosen": 1},
        {"occasion": "quiz", "chosen": 7},
        {"occasion": "quiz", "chosen": "1"},
        {"occasion": 3, "chosen": 1},
        {"occasion": "quiz", "chosen": [1]},
    ],
    ids=str,
)
def test_what_cannot_be_understood_is_passed_over(content: dict[str, object]) -> None:
    assert answer_from_event(ProgressEvent("u", MONDAY.isoformat(), EventKind.ANSWER, "x", content)) is None


def test_who_chose_nothing_is_sure_of_nothing() -> None:
    (answer,) = answers_from_events([answered(ITEMS[0], 0, NOT_SURE, confidence=4)])
    assert answer.confidence is None


def _calibrated(figures: Sequence[tuple[int, int, int]]) -> list[str]:
    """Lines for (confidence, answers, right)."""
    events = [
        answered(ITEMS[0], i, AnswerChoice(0) if i < right else WRONG, confidence=confidence)
        for confidence, count, right in figures
        for i in range(count)
    ]
    return lines_of(calibration_blocks(measure_calibration(answers_from_events(events))))


def test_how_well_one_judges_oneself() -> None:
    assert "too sure" in _calibrated([(4, 10, 5)])[-1]
    assert "judge yourself well" in _calibrated([(4, 10, 10), (1, 3, 1)])[-1]
    assert "more than you think" in _calibrated([(1, 10, 9)])[-1]
    assert "After 8" in _calibrated([(4, 7, 1)])[-1]
    assert _calibrated([]) == ["You have not yet said how sure you were of any answer."]
    assert "5 of 10" in _calibrated([(4, 10, 5)])[3]


def test_rounds_are_counted_one_after_the_other() -> None:
    answers = answers_from_events(answered(item, day) for day in range(2) for item in ITEMS[:4])
    rounds = round_history(ITEMS[:4], answers, AnswerOccasion.LESSON)
    assert len(rounds.finished) == 2
    assert rounds.current == {}
    assert {item.id for item in rounds.remaining(1)} == {item.id for item in ITEMS[:4]}
    assert round_history(ITEMS[:4], answers, AnswerOccasion.QUIZ).finished == ()


def test_within_a_round_the_first_answer_counts() -> None:
    events = [answered(ITEMS[0], 0, WRONG), answered(ITEMS[0], 0.1), answered(ITEMS[1], 0.2)]
    rounds = round_history(ITEMS[:2], answers_from_events(events), AnswerOccasion.LESSON)
    assert rounds.finished[0][ITEMS[0].id].outcome is AnswerOutcome.WRONG
    assert rounds.current == {}


def test_a_lesson_to_repeat_is_named_by_its_number() -> None:
    item = next(each for each in kit_bank().items if each.lesson_to_repeat.startswith("07-"))
    lesson = kit_lesson("07-who-collides-who-sees")
    line = lines_of(follow_up_blocks(item), Page(1000))[0]
    assert line.startswith(f"See lesson {lesson.number}, step ")
    assert f": kit lesson {lesson.number}   " in f"{line}   "


def test_at_80_columns_no_command_of_a_reference_is_broken() -> None:
    for item in kit_bank().items:
        rows = ["".join(text for text, _ in each) for each in told_rows(item, AnswerChoice(0), 80)]
        assert max(map(len, rows)) <= 80
        assert any(re.search(r"^  .*: kit lesson [A-Z]\d+\b", each) for each in rows), rows
        assert not item.command_to_try or any(item.command_to_try in each for each in rows), rows
