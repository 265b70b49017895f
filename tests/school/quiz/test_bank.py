"""The bank that comes with the kit: enough items, no giveaways, and every screen of it fits 80 by 24."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.school.lessons.reading import lesson_names, lessons_folder
from kit.school.quiz.answers import BLANK, NOT_SURE, AnswerChoice
from kit.school.quiz.items import IDEA_COUNT, OPTION_COUNT, QUIZ_FILE, QuizItem, QuizTopic
from tests.cases import every_case
from tests.kit_content import kit_bank, kit_lesson
from tests.school.quiz.item_builders import asked, shown_rows, told_rows

BANK = kit_bank()
LESSONS = lesson_names()
COMMANDS = sorted({item.command_to_try for item in BANK.items if item.command_to_try})
ROOM = 24 - 3
every_item = every_case("item", BANK.items, ids=lambda item: item.id)


def test_there_are_enough_of_every_lesson_and_idea() -> None:
    folders = {path.name for path in lessons_folder().iterdir() if path.is_dir() and path.name[0].isdigit()}
    assert set(BANK.lessons) == folders
    assert len(BANK.lessons) >= 13
    assert len(BANK.items) >= 65
    assert all(len(BANK.lesson_items(lesson)) >= 5 for lesson in BANK.lessons)
    assert [item.idea for item in BANK.quiz_items] == list(range(1, IDEA_COUNT + 1))
    assert all(len(BANK.topic_items(topic)) >= 4 for topic in QuizTopic)


def test_the_right_option_stands_anywhere() -> None:
    places = Counter(item.right_option for item in BANK.items)
    assert all(0.27 <= places[i] / len(BANK.items) <= 0.40 for i in range(OPTION_COUNT))
    twelve = Counter(item.right_option for item in BANK.quiz_items)
    assert all(2 <= twelve[i] <= 6 for i in range(OPTION_COUNT))
    for lesson in BANK.lessons:
        assert len({item.right_option for item in BANK.lesson_items(lesson)}) >= 2


def test_the_right_option_is_not_given_away_by_its_length() -> None:
    longest = shortest = 0.0
    for item in BANK.items:
        lengths = [len(option.text) for option in item.options]
        right = lengths[item.right_option]
        longest += (right == max(lengths)) / lengths.count(max(lengths))
        shortest += (right == min(lengths)) / lengths.count(min(lengths))
    assert 0.2 <= longest / len(BANK.items) <= 0.45
    assert 0.2 <= shortest / len(BANK.items) <= 0.5


@every_item
def test_a_step_of_this_lesson_or_an_earlier_one_teaches_the_answer(item: QuizItem) -> None:
    lesson, _, number = item.lesson_to_repeat.partition("/")
    assert LESSONS.index(lesson) <= LESSONS.index(item.lesson)
    assert item.taught_by
    step = kit_lesson(lesson).steps[int(number) - 1]
    assert item.taught_by in step.wording


@every_item
def test_options_are_of_like_length(item: QuizItem) -> None:
    lengths = [len(option.text) for option in item.options]
    assert max(lengths) - min(lengths) <= 14 or max(lengths) <= 1.6 * min(lengths)


@every_item
def test_every_choice_is_told_something_of_its_own(item: QuizItem) -> None:
    told = [option.feedback for option in item.options]
    assert len(set(told)) == OPTION_COUNT
    assert all(len(text) >= 20 for text in told)
    assert item.question.endswith(("?", ")")) or "?" in item.question


@every_item
def test_it_fits_the_smallest_full_screen(item: QuizItem) -> None:
    width = 80
    choices = [*(AnswerChoice(i) for i in range(OPTION_COUNT)), NOT_SURE, BLANK]
    chosen = asked(item)
    chosen.choose(1)
    pages = [shown_rows(chosen, width), *(told_rows(item, each, width) for each in choices)]
    for rows in pages:
        assert len(rows) + 1 <= ROOM
        assert all(sum(len(text) for text, _ in row) <= width for row in rows)
        assert all(text.isascii() for row in rows for text, _ in row)


@pytest.mark.parametrize("command", COMMANDS)
def test_what_one_is_told_to_type_works(command: str, tmp_path: Path) -> None:
    words = command.split()[1:]
    result = CliRunner().invoke(main, words, input="", env={"KIT_WORKSPACE": str(tmp_path), "TERM": "dumb"})
    assert result.exit_code == 0, result.output


def test_commands_within_the_words_are_verbs_of_the_kit() -> None:
    texts = [
        text for item in BANK.items for text in (item.question, *(option.feedback for option in item.options))
    ]
    named = {found for text in texts for found in re.findall(r"`kit (\w+)", text)}
    assert named
    for verb in named:
        assert CliRunner().invoke(main, [verb, "--help"]).exit_code == 0, verb


def test_sheets_lie_in_the_lessons_folders() -> None:
    assert {path.parent.name for path in lessons_folder().glob(f"*/{QUIZ_FILE}")} == set(BANK.lessons)


@every_item
def test_the_step_that_teaches_it_names_its_files(item: QuizItem) -> None:
    dialogue = asked(item)
    dialogue.say_not_sure()
    figure = dialogue.figure()
    assert figure is not None
    told = "".join(getattr(block, "text", "") for block in figure.blocks)
    assert not re.search(r"\{(file|folder)\}", told)
