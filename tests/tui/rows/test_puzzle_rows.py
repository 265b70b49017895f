"""A puzzle beside its text uses the room that there is, and nothing of it is cut."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from kit.document.rows import row_text, row_width
from kit.school.game.challenge import AnswerError, Challenge, judge_return
from kit.school.game.challenge_kinds.layers import LayersTask
from kit.school.game.challenges import all_challenges
from kit.school.game.judgement import Judgement, judge_count
from kit.school.game.medal import Medal
from kit.tui.rows.challenge_rows import (
    GAP,
    LARGEST_SCALE,
    LEAST_TEXT,
    largest_drawing,
    next_medal,
    puzzle_beside,
    puzzle_page,
    worth_now,
)

PLAYED = [each for each in all_challenges() if each.task.board("") is not None]


@pytest.mark.parametrize("challenge", PLAYED, ids=lambda each: each.id)
def test_it_fits_and_is_as_large_as_there_is_room_for(challenge: Challenge) -> None:
    board = challenge.task.board("")
    assert board is not None
    judgement: Judgement | str
    try:
        judgement = board.judgement()
    except AnswerError as error:
        judgement = str(error)
    scales = []
    for width, height in ((118, 33), (130, 40), (200, 48), (260, 70)):
        shown = puzzle_beside(challenge, board, judgement, width, height, "braille")
        rows = [row_text(each) for each in shown]
        assert max(map(len, rows)) <= width
        assert len(rows) <= height
        assert not any("…" in each for each in rows), "nothing is cut"
        assert all(word in " ".join(rows) for word in challenge.story.split())
        drawing = board.drawing(width // 2, height - 1, "braille")
        scales.append(len(drawing) or largest_drawing(board, width - LEAST_TEXT - GAP, height - 1)[0])
    assert scales == sorted(scales)
    assert scales[-1] == LARGEST_SCALE or scales[-1] > scales[0], "a larger screen has a larger board"


@pytest.mark.parametrize("more_is_better", [False, True])
@pytest.mark.parametrize("width", [36, 76])
def test_what_the_next_medal_asks_for_stands_there_and_earns_it(width: int, more_is_better: bool) -> None:
    judgement = (
        judge_return("", 0.0, 10.0, 20.001) if more_is_better else judge_count("moves", "", 90, 20, 80)
    )
    for medal in (Medal.BRONZE, Medal.SILVER, Medal.GOLD):
        assert judgement.comparison is not None
        rows, _ = worth_now(judgement, width)
        assert max(map(row_width, rows)) <= width
        shown = " ".join(map(row_text, rows))
        (figure,) = re.findall(rf"next {medal.title} at ([\d.]+)", shown)
        comparison = replace(judgement.comparison, answer=float(figure))
        assert comparison.medal is medal
        judgement = replace(judgement, comparison=comparison, medal=medal)
    assert "next" not in " ".join(map(row_text, worth_now(judgement, width)[0]))


def test_a_figure_that_does_not_decide_has_no_next_medal() -> None:
    few = judge_count("steps", "", 10, 20, 80)
    assert "next" not in next_medal(replace(few, medal=Medal.NONE))


@pytest.mark.parametrize("challenge", PLAYED, ids=lambda each: each.id)
def test_a_board_takes_the_rows_that_are_left_below_its_text(challenge: Challenge) -> None:
    board = challenge.task.board("")
    assert board is not None
    for height in (22, 33):
        rows = puzzle_page(challenge, board, "", 80, height, "braille")
        assert len(rows) <= height
        shown = [row_text(each) for each in rows]
        assert all(any(row_text(each).strip() in line for line in shown) for each in board.rows()[-1:])
    if board.drawing(40, 20, "braille"):
        assert any(chr(0x2800) < sign < chr(0x28FF) for line in shown for sign in line), "a picture"


def test_the_picture_of_a_layer_plan_tells_what_collides_and_what_must_not() -> None:
    challenge = next(each for each in PLAYED if isinstance(each.task, LayersTask))
    board = challenge.task.board("")
    assert board is not None

    def tones() -> set[str]:
        return {tone for each in board.drawing(90, 40, "braille") for text, tone in each if text.strip()}

    assert "good" not in tones()
    for rows in (0, 2):  # the hall, then the mast of the lift: they must collide
        board.move(0, rows)
        board.mark()
    assert {"good", "key"} <= tones()
    assert "bad" not in tones()
    board.move(0, 5)  # the cart, which must not meet either of them
    board.mark()
    assert "bad" in tones()


def test_everything_that_is_still_wrong_with_a_layer_plan_stands_beside_it_where_there_is_room() -> None:
    challenge = next(each for each in PLAYED if isinstance(each.task, LayersTask))
    board = challenge.task.board("")
    assert board is not None
    wrong = [row_text(each).strip() for each in board.details()]
    assert len(wrong) > 20

    def told(height: int) -> list[str]:
        shown = puzzle_beside(challenge, board, "", 200, height, "braille")
        rows = [row_text(each).strip() for each in shown]
        return [each for each in wrong if any(shown.endswith(each) for shown in rows)]

    assert told(48) == wrong
    assert told(20) == wrong[: len(told(20))] != wrong
