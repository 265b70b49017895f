"""A level's card: whole parts, the most worthy first, within the room there is."""

from __future__ import annotations

import pytest

from kit.document.rows import Row, row_width
from kit.school.game.ghosts import Ghost
from kit.school.game.levels import GameLevel
from kit.school.game.medal import RUNGS, Medal, medal_of
from kit.school.game.ordinary_drives import ordinary_drives
from kit.school.game.player_progress import ExtraRule
from kit.school.game.race import DriverKind, RaceFinish
from kit.school.game.references import find_drive, reference_recording, reference_seconds
from kit.tui.rows.ladder_rows import (
    ABOUT_BAR,
    HERE,
    LADDERS,
    LIST_BAR,
    ORDINARY,
    RESULT_BAR,
    ladder_bar,
    rung_rows,
)
from kit.tui.rows.level_card_rows import (
    BY_WORTH,
    COLUMN,
    PARTS,
    WIDE,
    Company,
    Rival,
    Standing,
    best_splits,
    level_card,
    star_line,
    stars_and_sectors,
)
from kit.tui.rows.medal_signs import MEDAL_SIGNS
from tests.kit_content import kit_levels
from tests.school.game.measured_drivers import measured
from tests.tui.lesson_stage import row_text

LEVELS = [each for each in kit_levels() if find_drive(each) is not None]


def flat(card: dict[str, list[Row]]) -> list[Row]:
    return [each for part in card.values() for each in part]


@pytest.mark.parametrize("level", LEVELS, ids=lambda each: each.id)
@pytest.mark.parametrize("width", [21, 40, 58])
def test_a_card_keeps_to_its_width_and_its_room(level: GameLevel, width: int) -> None:
    reference = reference_seconds(level)
    company = Company((Rival("P", "the reference", reference or 0.0), Rival("m", "mo", 12.5)))
    whole = flat(level_card(level, DriverKind.HAND, reference, (), width, 1000, company))
    assert all(row_width(each) <= width for each in whole)
    text = " ".join(row_text(each) for each in whole)
    assert all(medal.title in text for medal in RUNGS)
    assert ("mo" in text.split() and "12.50 s" in text) is (width >= WIDE)
    for room in range(len(whole)):
        card = flat(level_card(level, DriverKind.HAND, reference, (), width, room, company))
        assert len(card) <= room
        assert all(each in whole for each in card)
    assert sorted(BY_WORTH) == sorted(PARTS)


@pytest.mark.parametrize("driver", DriverKind)
@pytest.mark.parametrize("width", [LIST_BAR, ABOUT_BAR, RESULT_BAR])
def test_a_ladder_has_a_letter_for_each_rung(driver: DriverKind, width: int) -> None:
    bar = row_text(ladder_bar(driver, 10.0, None, width))
    assert [sign for sign in bar if sign.isalpha()] == [MEDAL_SIGNS[each] for each in RUNGS]


def test_a_drive_that_gets_bronze_at_best_stands_before_silver() -> None:
    clean, flawed = (Standing(10.1, is_flawed) for is_flawed in (False, True))
    for standing, higher in ((clean, "R"), (flawed, "S")):
        card = level_card(LEVELS[0], DriverKind.HAND, 10.0, (), 50, 100, Company(()), standing)
        bar = next(text for each in flat(card) if HERE in (text := row_text(each)))
        assert bar[bar.index(HERE) + 1 :].lstrip("─")[0] == higher


def test_rules_that_were_kept_have_their_star() -> None:
    level = LEVELS[0]
    kept = {ExtraRule.CLEAN}
    rows = [row_text(each) for each in stars_and_sectors(level, kept, None, COLUMN + 1)]
    assert [ExtraRule.CLEAN.description(level) in each for each in rows if each.startswith(" *")] == [True]
    assert sum(each.startswith(" .") for each in rows) == len(ExtraRule) - 1


def test_the_sectors_of_the_quickest_own_drive_stand_beside_the_stars() -> None:
    level = LEVELS[0]
    recording = reference_recording(level)
    assert recording is not None
    seconds = reference_seconds(level) or 0.0
    track = recording.track(level.find_scenario().partners[0])
    ghosts = [
        Ghost(name, took, (track,), recording.step_size)
        for name, took in (("reference", seconds), ("hand", seconds + 2.0), ("agent", seconds + 1.0))
    ]
    best = best_splits(ghosts)
    assert best is not None
    assert best[0] is DriverKind.AGENT
    assert best_splits(ghosts[:1]) is best_splits(ghosts[1:]) is None
    wide = [row_text(each) for each in stars_and_sectors(level, (), best, 2 * COLUMN)]
    assert sum("sector " in each for each in wide) == len(best[1])
    assert not any("sector " in row_text(each) for each in stars_and_sectors(level, (), best, COLUMN + 5))


def test_the_stars_of_every_level_fit_on_one_row_of_80_columns() -> None:
    assert [each.id for each in kit_levels() if row_width(star_line(each, ())) > 80] == []


def test_a_ladder_shows_where_ordinary_drivers_stand_on_its_own_level() -> None:
    bars = set()
    for level in LEVELS:
        for drivers in LADDERS:
            reference = reference_seconds(level)
            assert reference is not None
            ordinary = ordinary_drives(level, drivers)
            for width in (LIST_BAR, RESULT_BAR):
                bar = row_text(ladder_bar(drivers[0], reference, None, width, ordinary=ordinary))
                bars.add(bar)
                assert [sign for sign in bar if sign.isalpha()] == [MEDAL_SIGNS[each] for each in RUNGS]
            for driver, seconds in ordinary.items():
                medal = medal_of(RaceFinish(True, seconds, 0), reference, driver)
                if medal in (Medal.BRONZE, Medal.SILVER):
                    lower, higher = (bar.index(MEDAL_SIGNS[each]) for each in (medal, Medal(medal + 1)))
                    assert ORDINARY in bar[lower:higher], (level.id, driver)
            rows = [row_text(each) for each in rung_rows(drivers[0], reference, ordinary=ordinary)]
            assert sum(each.startswith(ORDINARY) for each in rows) == len(ordinary)
            times = [float(each.split()[-2]) for each in rows]
            assert times == sorted(times)
    assert len(bars) > len(LEVELS), "no shape that all levels share"


def test_a_drive_with_a_bump_is_no_ordinary_one() -> None:
    bumped = {name for (name, driver), each in measured().items() if driver == "keys" and each.collisions}
    assert bumped
    assert not any(ordinary_drives(level, [DriverKind.HAND]) for level in LEVELS if level.id in bumped)
