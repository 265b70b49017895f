"""A puzzle beside its text uses the room that there is, and nothing of it is cut."""

from __future__ import annotations

import pytest

from kit.document.rows import row_text
from kit.school.game.challenge import AnswerError, Challenge
from kit.school.game.challenge_kinds.layers import LayersTask
from kit.school.game.challenges import all_challenges
from kit.school.game.judgement import Judgement
from kit.tui.rows.challenge_rows import GAP, LARGEST_SCALE, LEAST_TEXT, largest_drawing, puzzle_beside

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
        rows = [row_text(each) for each in puzzle_beside(challenge, board, judgement, width, height)]
        assert max(map(len, rows)) <= width
        assert len(rows) <= height
        assert not any("…" in each for each in rows), "nothing is cut"
        assert all(word in " ".join(rows) for word in challenge.story.split())
        scales.append(largest_drawing(board, width - LEAST_TEXT - GAP, height - 1)[0])
    assert scales == sorted(scales)
    assert scales[-1] == LARGEST_SCALE or scales[-1] > scales[0], "a larger screen has a larger board"


def test_everything_that_is_still_wrong_with_a_layer_plan_stands_beside_it_where_there_is_room() -> None:
    challenge = next(each for each in PLAYED if isinstance(each.task, LayersTask))
    board = challenge.task.board("")
    assert board is not None
    wrong = [row_text(each).strip() for each in board.details()]
    assert len(wrong) > 20

    def told(height: int) -> list[str]:
        rows = [row_text(each).strip() for each in puzzle_beside(challenge, board, "", 200, height)]
        return [each for each in wrong if any(shown.endswith(each) for shown in rows)]

    assert told(48) == wrong
    assert told(20) == wrong[: len(told(20))] != wrong
