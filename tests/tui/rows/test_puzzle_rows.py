"""A puzzle beside its text uses the room that there is, and nothing of it is cut."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from kit.document.rows import row_text, row_width
from kit.school.game.board import LIT, by_value, grid_rows
from kit.school.game.challenge import AnswerError, Challenge, judge_return
from kit.school.game.challenge_kinds.devices import DevicesTask
from kit.school.game.challenge_kinds.exploit import ExploitTask
from kit.school.game.challenges import BEGUN, all_challenges
from kit.school.game.judgement import Judgement, judge_count
from kit.school.game.medal import Medal
from kit.school.progress import EventKind, ProgressEvent
from kit.tui.rows.challenge_rows import (
    GAP,
    LARGEST_SCALE,
    LEAST_TEXT,
    PuzzleCheck,
    PuzzleView,
    challenge_standing,
    largest_drawing,
    lesson_below,
    next_medal,
    puzzle_beside,
    puzzle_page,
    tries_rows,
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
        shown = puzzle_beside(PuzzleView(challenge, board, judgement, "braille"), width, height)
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
        rows = puzzle_page(PuzzleView(challenge, board, "", "braille"), 80, height)
        assert len(rows) <= height
        shown = [row_text(each) for each in rows]
        assert all(any(row_text(each).strip() in line for line in shown) for each in board.rows()[-1:])
    if board.drawing(40, 20, "braille"):
        assert any(chr(0x2800) < sign < chr(0x28FF) for line in shown for sign in line), "a picture"


def test_the_picture_of_a_layer_plan_tells_what_collides_and_what_must_not() -> None:
    challenge = next(each for each in PLAYED if each.id == "yard-plan")
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
    challenge = next(each for each in PLAYED if each.id == "yard-plan")
    board = challenge.task.board("")
    assert board is not None
    (part,) = board.details(1000)
    wrong = [row_text(each).strip() for each in part]
    assert len(wrong) > 20

    def told(height: int) -> list[str]:
        shown = [
            row_text(each) for each in puzzle_beside(PuzzleView(challenge, board, "", "braille"), 200, height)
        ]
        first = next(number for number, each in enumerate(shown) if wrong[0] in each)
        column = shown[first].index(wrong[0])
        text = " ".join(" ".join(each[column:] for each in shown[first:]).split())
        return [each for each in wrong if each in text]

    assert told(48) == wrong
    assert told(20) == wrong[: len(told(20))] != wrong


def test_a_small_screen_keeps_the_story_and_leaves_the_keys_to_the_foot() -> None:
    challenge = next(each for each in PLAYED if each.id == "yard-plan")
    board = challenge.task.board("")
    assert board is not None
    board.mark()
    rows = puzzle_page(PuzzleView(challenge, board, board.judgement(), "braille"), 80, 21)
    shown = " ".join(" ".join(map(row_text, rows)).split())
    assert len(rows) <= 21
    assert challenge.story.split(".")[0] in shown
    assert board.signs in shown
    assert board.keys not in shown


@pytest.mark.parametrize("scale", [1, 2, 4])
def test_what_a_laser_sees_is_filled_and_not_dotted(scale: int) -> None:
    task = next(each.task for each in PLAYED if isinstance(each.task, DevicesTask))
    board = task.board("")
    assert board is not None
    board.mark()
    laser, letters = task.floor[0], task.places.values()
    lit = [each for each in task.floor if task.sees(laser, each) and each not in (laser, *letters)]
    filled = sum(row_text(each).count(LIT) for each in board.rows(scale))
    assert filled == 2 * scale * scale * len(lit), "all but the letters and the laser itself"


@pytest.mark.parametrize("challenge", PLAYED, ids=lambda each: each.id)
@pytest.mark.parametrize("width", [80, 120])
def test_a_check_moves_no_row_of_a_puzzle(challenge: Challenge, width: int) -> None:
    board = challenge.task.board(challenge.task.naive_answer())
    assert board is not None
    for _ in range(3):
        board.move(1, 0)
        board.mark()
    try:
        judgement: Judgement | str = board.judgement()
    except AnswerError as error:
        judgement = str(error)
    place = puzzle_page if width == 80 else puzzle_beside
    needed = [(("what 9 players here needed", "dim"),), (("to 9 moves", ""),)]
    before, after, failed = (
        [
            row_text(each)
            for each in place(PuzzleView(challenge, board, judgement, "braille", check, beside), width, 21)
        ]
        for check, beside in (
            (None, ()),
            (PuzzleCheck(following="Another one"), (needed,)),
            (PuzzleCheck(problem="The disk is full."), ()),
        )
    )
    drawn = [row_text(each) for each in board.rows(1)][-1].strip()
    for shown in (after, failed):
        places = [[at for at, each in enumerate(rows) if drawn in each] for rows in (before, shown)]
        assert places[0] == places[1]
        assert [each.find("check  ") for each in shown if "check  " in each] == [
            each.find("now  ") for each in before if "now  " in each
        ]


def test_a_curve_and_figures_tell_what_the_moves_gained_where_there_is_room() -> None:
    challenge = next(each for each in PLAYED if isinstance(each.task, ExploitTask))
    board = challenge.task.board("")
    assert board is not None

    def told() -> str:
        return "\n".join(map(row_text, puzzle_beside(PuzzleView(challenge, board, "", "braille"), 200, 47)))

    title, figures = board.curve()
    assert title not in told()
    assert not figures
    for columns in (1, -1, 1):
        board.move(columns, 0)
    title, figures = board.curve()
    assert len(figures) == 3
    assert figures[0] < figures[2]
    assert title in told()
    paid, visits, moves, each_move = map(list, board.details(60))
    assert row_text(each_move[2]).split()[-1] == f"{figures[-1]:.2f}", "the newest move stands first"
    assert [each.count("2") for each in map(row_text, visits) if "2" in each] == [1], "entered twice"
    assert all(row_text(each[0]) in told() for each in (paid, visits, moves))


def test_the_checks_of_a_puzzle_are_listed_the_newest_first() -> None:
    def checked(number: int, medal: int, text: str) -> ProgressEvent:
        time = f"2026-03-0{number}T10:00:00.000000+00:00"
        return ProgressEvent(
            str(number), time, EventKind.FINISH, "challenge-x", {"medal": medal, "text": text}
        )

    assert tries_rows([], 60) == []
    assert tries_rows([checked(1, 0, BEGUN)], 60) == [], "the first look is no check"
    shown = [row_text(each) for each in tries_rows([checked(1, 0, "none"), checked(2, 3, "best")], 60)]
    assert "2 checks" in shown[0]
    assert [each.split()[-2:] for each in shown[1:]] == [["G", "best"], [".", "none"]]


@pytest.mark.parametrize("challenge", all_challenges(), ids=lambda each: each.id)
def test_the_chosen_one_of_a_list_says_what_its_medals_ask_for_and_what_teaches_it(
    challenge: Challenge,
) -> None:
    told = [row_text(each) for each in challenge_standing(challenge, [], 55)]
    assert max(map(len, told), default=0) <= 55
    for room in range(12):
        lesson = [row_text(each) for each in lesson_below(challenge, 55, room)]
        assert len(lesson) <= room
        assert not lesson or len(lesson) > 3, "no title without what it is about"
        assert any(line.startswith("── lesson") for line in lesson) is (room > 9) or 0 < room < 10
    board = challenge.task.board("")
    if board is not None:
        assert any(line.startswith("keys") for line in told)
    if challenge.id == "five-numbers":
        assert [line.split()[1:] for line in told if line[2:6] in ("gold", "silv", "bron")] == [
            ["gold", "at", "most", "1,300", "steps"],
            ["silver", "at", "most", "1,900", "steps"],
            ["bronze", "at", "most", "4,000", "steps"],
        ]


def test_the_start_is_seen_under_what_stands_on_it_and_figures_have_their_colour() -> None:
    grid = ["####", "#SG#", "####"]
    worth = by_value({(1, 1): 0.0, (1, 2): 1.0}, {(1, 1): "0.00", (1, 2): "1.00"})
    for scale in (1, 2, 3, 5):
        shown = grid_rows(grid, {(1, 1): ("@", "chosen")}, scale, worth)
        text = "\n".join(map(row_text, shown))
        assert "S@" not in text, "no sign of two letters"
        assert ("S" in text) is (scale > 1)
        assert ("1.00" in text) is (scale >= 3)
        assert len({len(row_text(each)) for each in shown}) == 1
        assert ("good" in {style for each in shown for part, style in each if "1.00" in part}) is (scale >= 3)
        left = "\n".join(
            map(row_text, grid_rows(grid, {(1, 1): ("→", "dim"), (1, 2): ("@", "chosen")}, scale))
        )
        assert "S" in left, "once the robot has left it"


def test_the_checks_of_a_puzzle_take_the_columns_that_there_are() -> None:
    challenge = next(each for each in all_challenges() if each.id == "free-lunch")
    board = challenge.task.board("")
    assert board is not None
    told = "Return 139.97, the shortest way only 125.66: the reward is exploited."
    time = "2026-03-01T10:00:00.000000+00:00"
    event = ProgressEvent("1", time, EventKind.FINISH, challenge.id, {"medal": 1, "text": told})
    view = PuzzleView(challenge, board, "", "braille", checks=[event])
    rows = [row_text(each) for each in puzzle_beside(view, 200, 46)]
    assert sum(" 139.97" in each or "exploited" in each for each in rows) <= 2
