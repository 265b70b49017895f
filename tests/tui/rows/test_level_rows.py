"""The map of a world: every level once, each to the right of what opens it, with a line between."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from itertools import product
from pathlib import Path

import pytest

from kit.document.rows import MARGIN, row_width
from kit.host.failure import Failure, FailureKind
from kit.school.game.levels import all_worlds
from kit.school.game.medal import Medal
from kit.school.game.player_progress import GameSummary, LevelProgress, level_progress
from kit.school.game.race import DriverKind, RaceFinish
from kit.tui.rows.drive_end_rows import failed_line, finish_sentence, how_it_ended
from kit.tui.rows.ladder_rows import LADDERS
from kit.tui.rows.level_map_rows import map_places, map_rows
from kit.tui.rows.level_rows import (
    THUMBNAIL,
    WHOLE,
    about,
    before_the_start,
    game_progress,
    opens_after,
    starts_rows,
    world_heading,
    world_levels,
)
from kit.tui.rows.medal_signs import MEDAL_SIGNS
from kit.tui.screens.level_pictures import GHOST_LOOKS
from kit.tui.widgets.text_rows import _ASCII
from tests.kit_content import kit_levels
from tests.tui.lesson_stage import row_text

WIDTH, HEIGHT = 84, 28
"""What a screen of 200x50 leaves below the list."""


def standings_of(world: str) -> list[LevelProgress]:
    return [each for each in level_progress(kit_levels(), ()) if each.level.world == world]


@pytest.mark.parametrize("world", [each.id for each in all_worlds()])
def test_every_level_has_a_place_right_of_those_that_open_it(world: str) -> None:
    standings = standings_of(world)
    places = {place.level: place for place in map_places(standings, WIDTH, HEIGHT)}
    assert set(places) == {each.level.id for each in standings}
    taken = [
        (x, y)
        for place in places.values()
        for x in range(place.x, place.x + place.columns)
        for y in range(place.y, place.y + place.rows + 1)
    ]
    assert len(taken) == len(set(taken))  # no picture on another
    assert max(x for x, _ in taken) < WIDTH
    assert max(y for _, y in taken) < HEIGHT
    for each in standings:
        for name in each.level.opened_by:
            if name in places:
                assert places[name].x < places[each.level.id].x


@pytest.mark.parametrize("world", [each.id for each in all_worlds()])
def test_titles_pictures_and_an_arrow_for_each_level_that_another_opens(world: str) -> None:
    standings = standings_of(world)
    places = map_places(standings, WIDTH, HEIGHT)
    pictures = {place.level: ["#" * place.columns] * place.rows for place in places}
    rows = map_rows(standings, places, pictures, standings[0].level.id)
    text = [row_text(each) for each in rows]
    assert len(text) <= HEIGHT
    assert sum(line.count("#") for line in text) == sum(place.columns * place.rows for place in places)
    assert "".join(text).translate(_ASCII).isascii()
    inside = {place.level for place in places}
    opened = [each for each in standings if inside & set(each.level.opened_by)]
    assert sum(line.count("▶") for line in text) == len(opened)
    assert next(part for each in rows for part, style in each if style == "key").strip()


def test_what_is_said_of_a_level_fits_beside_its_map() -> None:
    columns, rows = THUMBNAIL
    width = WHOLE - columns - MARGIN
    for each, is_open in product(level_progress(kit_levels(), ()), (True, False)):
        times = dict.fromkeys(DriverKind, 123.45)
        told = about(replace(each, is_open=is_open, best_times=times), 110.0, width, rows + 1)
        assert len(told) <= rows + 1
        assert max(map(row_width, told)) <= width
        assert sum("━" in row_text(line) for line in told) == (len(LADDERS) if is_open else 0)


def test_what_is_said_of_a_level_and_its_world_fits_80_columns() -> None:
    for world in all_worlds():
        for medals in ([Medal.NONE], [Medal.BRONZE], [Medal.GOLD]):
            assert all(len(row_text(each)) <= 80 for each in world_heading(world, 1, 8, medals, 80))
        assert "white for a medal" in row_text(world_heading(world, 1, 8, [Medal.NONE], 120)[0])
    for each in level_progress(kit_levels(), ()):
        for is_open in (True, False):
            rows = about(replace(each, is_open=is_open), 99.0, 80, 99)
            told = " ".join(map(row_text, rows))
            assert (f"lesson {each.level.lesson_number}" in told) is (
                bool(each.level.opened_by_lesson) and not is_open
            )
            assert [row_text(row) for row in rows if len(row_text(row)) > 80] == []
        names = [
            "the reference (P) 6.0 s",
            *(f"a classmate's long name {number} (c) 9.9 s" for number in range(3)),
        ]
        for ghosts, task_in_sight in product(([], names), (True, False)):
            rows = before_the_start(each.level, ghosts, 80, task_in_sight=task_in_sight)
            told = [row_text(row) for row in rows]
            assert [line for line in told if len(line) > 80] == []
            assert not ghosts or names[0] in " ".join(told)
            assert (each.level.hint in " ".join(told)) is not task_in_sight


def test_there_is_no_map_where_there_is_no_room() -> None:
    standings = standings_of("hall")
    assert map_places(standings, 30, HEIGHT) == ()
    assert map_places(standings, WIDTH, 3) == ()


@pytest.mark.parametrize("world", [each.id for each in all_worlds()])
@pytest.mark.parametrize("height", range(4, 12))
def test_where_pictures_have_no_room_the_titles_alone_are_a_map(world: str, height: int) -> None:
    standings = standings_of(world)
    places = map_places(standings, WIDTH, height)
    if places and not places[0].rows:
        text = [row_text(each) for each in map_rows(standings, places, {}, "")]
        assert len(text) <= height
        for each in standings:
            assert (each.level.title if each.is_open else f"({each.level.title})") in "".join(text)
    elif not places:
        assert max(Counter(place.x for place in map_places(standings, WIDTH, 40)).values()) > height


def test_a_map_without_places_has_no_rows() -> None:
    standings = standings_of("hall")
    assert map_rows(standings, (), {}, "") == []


def test_a_belt_and_a_count_of_each_world() -> None:
    first, *others = level_progress(kit_levels(), ())
    summary = GameSummary(
        (replace(first, medals={DriverKind.HAND: Medal.GOLD}), *others), challenges=(Medal.BRONZE,)
    )
    counts, _, *worlds = map(row_text, game_progress(summary))
    assert counts.split() == ["gold", "1", "silver", "0", "bronze", "1", "stars", "0"]
    assert len(worlds) == len(all_worlds()) + 1
    assert "1 of 8" in worlds[0]
    assert "white belt" in worlds[0]
    assert "1 of 1" in worlds[-1]
    assert "yellow belt" in worlds[-1]


def test_a_locked_level_says_so() -> None:
    found = [replace(each, is_open=True) for each in level_progress(kit_levels(), ())]
    for each in found:
        _, listed = map(row_text, world_levels([each], "", {}, 80))
        signs = listed.removeprefix("  ").removeprefix(each.level.title).split()[:3]
        assert signs == [".", ".", "."]
        _, shut = map(row_text, world_levels([replace(each, is_open=False)], "", {}, 80))
        assert opens_after(each.level) in shut or not each.level.opened_by
        assert len(shut) <= 80
        _, narrow = map(row_text, world_levels([replace(each, is_open=False)], "", {}, 60))
        assert "locked" in narrow
        assert " - " not in shut


def test_where_a_program_did_not_arrive_is_no_time() -> None:
    reached, lost = RaceFinish(True, 6.0, 0), RaceFinish(False, 72.0, 0)
    (shown,) = map(row_text, starts_rows([reached, lost, lost, lost, reached], 1))
    assert shown.split() == ["5", "starts", "6.00", "s", "[-]", "-", "-", "6.00", "s"]
    assert row_text(starts_rows([lost] * 5, 0)[0]).split()[2:] == ["[-]", "-", "-", "-", "-"]


def test_a_letter_is_either_a_medal_or_a_ghost() -> None:
    ghosts = {letter for letter, _ in GHOST_LOOKS.values()}
    assert not ghosts & {sign for medal, sign in MEDAL_SIGNS.items() if medal is not Medal.NONE}


def test_of_a_program_first_the_drive_that_was_watched_is_told_and_then_the_one_that_counts() -> None:
    arrived, late, lost = RaceFinish(True, 6.0, 0), RaceFinish(True, 9.5, 1), RaceFinish(False, 36.0, 0)
    assert how_it_ended([lost], 0) == [finish_sentence(lost)]
    first, counts, why = how_it_ended([arrived, lost, late, lost, lost], 3)
    assert "degrees" in why, "how the other starts differ"
    assert len(how_it_ended([lost, arrived, arrived, late, lost], 3)) == 2
    assert first.endswith(finish_sentence(arrived))
    assert counts.endswith(finish_sentence(lost))
    assert "tart 4 " in counts
    (both,) = how_it_ended([late, arrived, arrived, lost, lost], 0)
    assert both.startswith(finish_sentence(late))
    failed = replace(lost, failure=Failure(FailureKind.SYNTAX, "Oops", "a.py", 2))
    assert how_it_ended([failed] * 5, 2) == [finish_sentence(failed)]
    (both,) = how_it_ended([lost, arrived, lost, late, lost], 2)
    assert both.startswith(finish_sentence(lost))


def test_a_program_that_cannot_be_read_is_shown_with_the_place_in_its_line(tmp_path: Path) -> None:
    program = tmp_path / "mine.py"
    program.write_text("speed = 1\nif True:\n\tturn = (1 2)\n")
    failure = Failure(FailureKind.SYNTAX, "SyntaxError: invalid syntax", "mine.py", 3)
    line, caret = map(row_text, failed_line(failure, program))
    assert line.split() == ["3", "turn", "=", "(1", "2)"]
    assert line[caret.index("^")] == "1"
    assert len(failed_line(replace(failure, line=1), program)) == 1, "Python can read this one"
    for other in (
        replace(failure, file="other.py"),
        replace(failure, line=9),
        replace(failure, line=None),
        None,
    ):
        assert failed_line(other, program) == []
    program.unlink()
    assert failed_line(failure, program) == []
