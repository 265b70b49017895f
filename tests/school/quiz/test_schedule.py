"""What comes back when: topics after 1, 3, 7 and 21 days, interleaved, from the journal and the day alone."""

from __future__ import annotations

from datetime import date, timedelta, timezone
from itertools import pairwise

import pytest

from kit.document.layout import lines_of
from kit.school.progress import EventKind, ProgressEvent
from kit.school.quiz.answers import BLANK, NOT_SURE, AnswerChoice, AnswerOccasion
from kit.school.quiz.items import QuestionBank, QuizItem, QuizTopic
from kit.school.quiz.quiz_text import schedule_blocks, today_line
from kit.school.quiz.schedule import GAP_DAYS, PRACTICE_SIZE, PracticeSchedule, build_schedule
from tests.school.quiz.item_builders import MONDAY, answered, bank

BANK = bank(ros2=6, layers=6, rl=2)
FIRST = {item.id: item for item in BANK.items}
SPACED = AnswerOccasion.SPACED
WRONG = AnswerChoice(2)


def at(day: float, events: list[ProgressEvent], of: QuestionBank = BANK, seed: int = 0) -> PracticeSchedule:
    return build_schedule(of, events, MONDAY + timedelta(days=day), seed)


def practise(
    events: list[ProgressEvent], day: float, right: int = PRACTICE_SIZE, limit: int = 99
) -> list[QuizItem]:
    """Answers what is due on that day, so many right and the others wrong."""
    asked: list[QuizItem] = []
    while (queue := at(day, events).queue) and len(asked) < limit:
        choice = None if len(asked) < right else WRONG
        asked.append(queue[0])
        events.append(answered(queue[0], day + len(asked) / 1000, choice, occasion=SPACED))
    return asked


def due(schedule: PracticeSchedule, topic: QuizTopic = QuizTopic.ROS2) -> int:
    (schedule_of_topic,) = [each for each in schedule.topics if each.topic is topic]
    return (schedule_of_topic.due - MONDAY.date()).days


def test_nothing_is_due_before_anything_was_asked() -> None:
    schedule = at(0, [])
    assert schedule.topics == ()
    assert schedule.queue == ()
    assert schedule.next_due is None


def test_a_topic_comes_back_after_1_3_7_and_21_days() -> None:
    events = [answered(FIRST["ros2-0"])]
    day, found = 0, []
    for _ in range(5):
        assert at(due(at(day, events)) - 0.5, events).queue == ()
        gap = due(at(day, events)) - day
        found.append(gap)
        day += gap
        assert len(practise(events, day)) == PRACTICE_SIZE
    assert found == [*GAP_DAYS, GAP_DAYS[-1]]


@pytest.mark.parametrize(("right", "gap"), [(4, 3), (3, 3), (2, 1), (0, 1)])
def test_three_of_four_lengthen_the_gap_and_fewer_make_it_a_day(right: int, gap: int) -> None:
    events = [answered(FIRST["ros2-0"])]
    practise(events, 1, right)
    assert due(at(1, events)) == 1 + gap


@pytest.mark.parametrize("choice", [NOT_SURE, BLANK])
def test_not_sure_and_blank_do_not_lengthen_it(choice: AnswerChoice) -> None:
    events = [answered(FIRST["ros2-0"])]
    events += [answered(item, 1, choice, occasion=SPACED) for item in at(1, events).queue]
    assert due(at(1, events)) == 2


def test_after_a_bad_day_it_begins_again() -> None:
    events = [answered(FIRST["ros2-0"])]
    practise(events, 1)
    practise(events, 4)
    assert due(at(4, events)) == 11
    practise(events, 11, right=1)
    assert due(at(11, events)) == 12


def test_an_overdue_topic_waits_and_counts_from_when_it_is_done() -> None:
    events = [answered(FIRST["ros2-0"])]
    assert len(at(9, events).queue) == PRACTICE_SIZE
    practise(events, 9)
    assert due(at(9, events)) == 12


def test_a_practice_left_in_the_middle_goes_on_where_it_stopped() -> None:
    events = [answered(FIRST["ros2-0"])]
    whole = [item.id for item in at(1, events).queue]
    first = practise(events, 1, limit=2)
    assert [item.id for item in first] == whole[:2]
    assert [item.id for item in at(1, events).queue] == whole[2:]
    assert [item.id for item in at(2, events).queue] == whole[2:]  # the next day too
    practise(events, 2)
    assert due(at(2, events)) == 5


def test_due_topics_take_turns() -> None:
    events = [answered(FIRST["ros2-0"]), answered(FIRST["layers-0"])]
    topics = [item.topic for item in at(1, events).queue]
    assert len(topics) == 2 * PRACTICE_SIZE
    assert all(one is not other for one, other in pairwise(topics))


def test_only_what_was_met_is_asked() -> None:
    by_quiz = [answered(FIRST["ros2-0"], occasion=AnswerOccasion.QUIZ)]
    assert {item.id for item in at(1, by_quiz).queue} == {"ros2-0"}
    lesson = ProgressEvent("s", MONDAY.isoformat(), EventKind.STEP, "01-ros2/1", {})
    assert len(at(1, [lesson, *by_quiz]).queue) == PRACTICE_SIZE
    assert (
        len(at(1, [answered(FIRST["ros2-0"])]).queue) == PRACTICE_SIZE
    )  # a lesson's question: the lesson was met


def test_a_topic_of_few_items_has_a_short_practice() -> None:
    events = [answered(FIRST["rl-0"])]
    assert len(practise(events, 1, right=2)) == 2
    assert due(at(1, events), QuizTopic.RL) == 4


def test_what_was_not_known_comes_first_then_what_was_never_asked() -> None:
    events = [
        answered(FIRST["ros2-0"], 0.1),
        answered(FIRST["ros2-1"], 0.2, WRONG),
        answered(FIRST["ros2-2"], 0.15),
    ]
    order = [item.id for item in at(1, events).queue]
    assert order[0] == "ros2-1"
    assert set(order[1:]) == {"ros2-3", "ros2-4", "ros2-5"}


def test_what_is_asked_too_early_moves_nothing() -> None:
    events = [answered(FIRST["ros2-0"])]
    events += [answered(item, 0.2, occasion=SPACED) for item in BANK.topic_items(QuizTopic.ROS2)[:4]]
    assert due(at(0.3, events)) == 1


def test_a_day_is_the_students_own() -> None:
    """Monday 23:30 UTC is Tuesday where the clocks are two hours ahead."""
    events = [answered(FIRST["ros2-0"], 13.5 / 24)]
    east = MONDAY.astimezone(timezone(timedelta(hours=2)))
    assert build_schedule(BANK, events, MONDAY).topics[0].due == date(2026, 3, 3)
    assert build_schedule(BANK, events, east).topics[0].due == date(2026, 3, 4)


def test_each_day_counts_once() -> None:
    events = [answered(FIRST["ros2-0"]), answered(FIRST["layers-0"])]
    practise(events, 1, right=99)
    practise(events, 4, right=99)
    assert at(4, events).practice_days == (date(2026, 3, 3), date(2026, 3, 6))


def test_the_order_is_the_students_own_and_stays() -> None:
    events = [answered(FIRST["ros2-0"]), answered(FIRST["layers-0"])]
    orders = {tuple(item.id for item in at(1, events, seed=seed).queue) for seed in range(8)}
    assert len(orders) > 1
    again = [tuple(item.id for item in at(1, events, seed=3).queue) for _ in range(2)]
    assert again[0] == again[1]


def test_answers_to_items_that_are_gone_are_passed_over() -> None:
    events = [answered(FIRST["ros2-0"])]
    assert at(1, events, of=bank(layers=2)).topics == ()


def test_the_schedule_in_words() -> None:
    events = [answered(FIRST["ros2-0"]), answered(FIRST["layers-0"], 2)]
    today = at(2, events)
    assert today_line(today) == "Due today: 4 from ROS 2."
    assert lines_of(schedule_blocks(today)) == ["ROS 2   4 due today", "layers  again tomorrow"]
    practise(events, 2)
    after = at(2, events)
    assert today_line(after) == "Nothing is due today. Next: tomorrow."
    assert lines_of(schedule_blocks(after))[:2] == ["layers  again tomorrow", "ROS 2   again in 3 days"]
    assert "1" in lines_of(schedule_blocks(after))[2]
