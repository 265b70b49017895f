"""The analysis of items: figures by hand, warnings, and KR-20."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kit.school.quiz.answers import AnswerOutcome
from kit.school.report.item_analysis import analyse_item, kr20
from kit.school.report.measures import BLANK, AnswerSheet, ItemReply, ReportItem
from tests.cases import every_case

LETTERS = {".": BLANK, "?": ItemReply(AnswerOutcome.NOT_SURE)}


def reply(letter: str) -> ItemReply | None:
    """A to C by option, capital where right; `.` blank, `?` not sure, `-` not there."""
    if letter == "-":
        return None
    if letter in LETTERS:
        return LETTERS[letter]
    right = letter.isupper()
    return ItemReply(AnswerOutcome.RIGHT if right else AnswerOutcome.WRONG, "abc".index(letter.lower()))


def quiz(**rows: str) -> AnswerSheet:
    items = tuple(ReportItem(name, "ros2") for name in rows)
    return AnswerSheet(items, {name: tuple(map(reply, row)) for name, row in rows.items()})


def test_wrong_not_sure_and_blank_are_kept_apart() -> None:
    sheet = quiz(one="AAbc.?-")
    found = analyse_item(sheet, sheet.items[0])
    assert found.n == 6
    assert found.outcomes == {
        AnswerOutcome.RIGHT: 2,
        AnswerOutcome.WRONG: 2,
        AnswerOutcome.BLANK: 1,
        AnswerOutcome.NOT_SURE: 1,
    }
    assert found.choice_counts == {0: 2, 1: 1, 2: 1}
    assert found.difficulty == pytest.approx(2 / 6)
    assert found.interval.low < 2 / 6 < found.interval.high


def test_item_rest_leaves_the_item_itself_out() -> None:
    sheet = quiz(one="AAbb", two="AAbb", three="bAAb")
    first = analyse_item(sheet, sheet.items[0])
    rest = np.array([1, 2, 1, 0]) / 2
    assert first.rest_correlation == pytest.approx(np.corrcoef([1, 1, 0, 0], rest)[0, 1])
    assert math.isnan(analyse_item(quiz(one="AAbb"), ReportItem("one", "ros2")).rest_correlation)


@every_case(
    ("rows", "words"),
    [
        ({"one": "ABcc", "two": "AAbb"}, "2 different options"),
        ({"one": "Abbbcc", "two": "AAbbbb"}, "options 2, 3 drew more"),
        ({"one": "Accccc", "two": "Abbbbb"}, "only 17%"),
        ({"one": "AAAA", "two": "AAbb"}, "nearly everyone"),
        ({"one": "AAbb", "two": "bbAA"}, "r = -1.00"),
    ],
)
def test_what_a_teacher_should_look_at(rows: dict[str, str], words: str) -> None:
    sheet = quiz(**rows)
    assert any(words in each for each in analyse_item(sheet, sheet.items[0]).warnings)


def test_a_good_item_is_left_in_peace() -> None:
    sheet = quiz(one="AAAbcb", two="AAAbbb", three="AAbbbb")
    assert analyse_item(sheet, sheet.items[0]).warnings == ()


def test_kr_20_by_hand() -> None:
    sheet = quiz(one="AAAb", two="AAbb", three="Abbb")
    totals = np.array([3, 2, 1, 0])
    expected = 3 / 2 * (1 - (3 / 16 + 4 / 16 + 3 / 16) / totals.var())
    assert kr20(sheet) == pytest.approx(expected)


def test_kr_20_of_too_little_is_not_told() -> None:
    assert math.isnan(kr20(quiz(one="AAb")))
    assert math.isnan(kr20(quiz(one="AA", two="bb")))
