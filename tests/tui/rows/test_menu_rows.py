"""The menu says what is open today, where there is room for it, and is never higher than its panel."""

from __future__ import annotations

from dataclasses import replace

import pytest

from kit.document.rows import row_width
from kit.school.game.levels import all_levels
from kit.tui.rows.menu_rows import FRAME, MENU, PANEL_WIDTH, WIDE_PANEL, WIDE_ROWS, menu
from kit.tui.rows.today_rows import next_level_rows, today_rows, won_rows
from kit.tui.student_store import StudentOverview
from tests.tui.lesson_stage import row_text

FULL = StudentOverview(
    due=3,
    streak=4,
    next_medal="Left turn, by hand: silver at 7.20 s",
    won=(("The training hall", 2, 8), ("A world with a title that is longer than a line has room", 0, 6)),
    running=("turn-ppo-1", "turn-ppo-2", "turn-ppo-3", "turn-ppo-4", "turn-ppo-5"),
)


@pytest.mark.parametrize("room", [18, 19, 24, 32, 46])
def test_what_stands_below_the_menu_is_there_whole_or_not_at_all(room: int) -> None:
    rows = menu(FULL, 0, room)
    assert len(rows) <= room or rows == menu(FULL, 0, 0)
    assert all(row_width(each) <= PANEL_WIDTH - FRAME for each in rows)
    text = " ".join(" ".join(row_text(each).split()) for each in rows)
    assert all(item.title in text for item in MENU)
    assert ("── today" in text) == ("silver" in text)


@pytest.mark.parametrize("room", [24, 46])
def test_a_wide_panel_says_what_every_line_opens_and_shows_the_next_level(room: int) -> None:
    level = next(iter(all_levels()))
    rows = menu(replace(FULL, next_level=level, running=()), 0, room, WIDE_PANEL, ("PICTURE",) * 9)
    assert len(rows) <= room
    assert all(row_width(each) <= WIDE_PANEL - FRAME for each in rows)
    text = " ".join(" ".join(row_text(each).split()) for each in rows)
    is_high = room > 40
    assert all((item.about in text) == is_high for item in MENU[1:])
    assert ("PICTURE" in text) == is_high
    assert (level.title in text) == is_high


def test_the_next_level_tells_its_story_where_there_is_room_for_all_of_it() -> None:
    overview = StudentOverview(next_level=next(iter(all_levels())))
    assert overview.next_level is not None
    heights = set()
    for room in range(10, WIDE_ROWS):
        rows = next_level_rows(overview, ("PICTURE",) * 9, room)
        text = " ".join(" ".join(row_text(each).split()) for each in rows)
        assert overview.next_level.title in text
        assert (overview.next_level.story in text) == (len(rows) > 12)
        heights.add(len(rows))
        assert len(rows) <= max(room, 12)
    assert len(heights) == 2


def test_every_line_of_a_narrow_menu_says_what_it_is_before_it_is_chosen() -> None:
    lines = [row_text(each).split() for each in menu(StudentOverview(is_whole=True), 0, 24)]
    for item in MENU[2:]:
        (line,) = [each for each in lines if item.title in each]
        assert line[line.index(item.title) + 1 :]


def test_today_names_the_maze_the_medal_the_questions_and_the_trainings() -> None:
    text = " ".join(" ".join(row_text(each).split()) for each in today_rows(FULL))
    for told in (
        "not driven yet",
        "4 days in a row",
        "silver at 7.20 s",
        "3 questions due",
        "turn-ppo-3",
        "2 more",
    ):
        assert told in text
    assert "turn-ppo-4" not in text
    over = " ".join(row_text(each) for each in today_rows(StudentOverview(has_run_today=True)))
    assert "driven today" in over
    assert "medal" not in over
    assert "due" not in over


def test_today_names_what_there_is_room_for() -> None:
    rows = today_rows(FULL)
    for room in range(len(rows) + 1):
        fitting = [row_text(each) for each in today_rows(FULL, room=room)]
        assert len(fitting) <= room
        assert any("not driven yet" in each for each in fitting) is (room >= 3), room
        assert len(fitting) != 1, "no title alone"


def test_where_not_all_worlds_have_room_those_with_medals_to_win_are_named() -> None:
    won = tuple((f"World {number}", number % 3, 2) for number in range(9))
    overview = StudentOverview(won=won)
    whole = [row_text(each) for each in won_rows(overview)]
    assert all(any(title in line for line in whole) for title, *_ in won)
    assert any("medals" in line and "9 of 18" in line for line in whole)
    for room in range(len(whole)):
        rows = [row_text(each) for each in won_rows(overview, room=room)]
        named = [title for title, *_ in won if any(title in line for line in rows)]
        open_worlds = [title for title, count, most in won if count < most]
        assert named == open_worlds[: max(0, room - 2)]
        assert len(rows) <= room


def test_a_journal_that_cannot_be_read_tells_of_no_day() -> None:
    assert today_rows(StudentOverview(problem="damaged")) == []
    assert menu(None, 0, 100) == menu(None, 0, 18)
