"""The level of the day, the streak of days, and the belts."""

from __future__ import annotations

import datetime
from dataclasses import replace

import pytest

from kit.school.game.daily import daily_level, find_playable_level, streak
from kit.school.game.ghosts import reference_seconds
from kit.school.game.levels import UnknownLevel, all_levels
from kit.school.game.medals import Medal
from kit.school.game.player_progress import BELTS, LevelProgress, belt_of
from kit.school.game.race import DriverKind
from kit.school.progress import EventKind, ProgressEvent

DAY = datetime.date(2026, 9, 1)


def test_a_day_has_one_level_for_everybody_and_days_differ() -> None:
    days = [DAY + datetime.timedelta(days=number) for number in range(30)]
    levels = [daily_level(day) for day in days]
    assert levels == [daily_level(day) for day in days]
    assert len({level.reference for level in levels}) > 8
    assert {level.conditions.fog for level in levels} == {True, False}
    for level in levels:
        assert level.opened_by == ()
        assert reference_seconds(level) is not None
        assert find_playable_level(level.id) == level
    with pytest.raises(UnknownLevel, match="day"):
        find_playable_level("daily-2026-13-01")


def finish(day: datetime.date, level: str, *, reached: bool = True) -> ProgressEvent:
    at = datetime.datetime.combine(day, datetime.time(12)).astimezone()
    content = {"driver": "keys", "reached": reached, "seconds": 9.0, "bumps": 0, "edition": 2, "medal": 1}
    return ProgressEvent(f"{day}{level}{reached}", at.isoformat(), EventKind.FINISH, level, content)


def test_a_streak_counts_days_in_a_row_on_their_day() -> None:
    before = [DAY - datetime.timedelta(days=number) for number in range(5)]
    events = [finish(day, f"daily-{day}") for day in before[1:3]]
    assert streak(events, DAY) == 2  # today may still come
    events.append(finish(DAY, f"daily-{DAY}"))
    assert streak(events, DAY) == 3
    events.append(finish(DAY, f"daily-{before[3]}"))  # a day late
    events.append(finish(before[4], f"daily-{before[4]}", reached=False))
    assert streak(events, DAY) == 3
    assert streak(events, DAY + datetime.timedelta(days=2)) == 0
    assert streak([finish(DAY, "first-drive")], DAY) == 0


def test_belts_rise_with_the_medals_of_a_world() -> None:
    levels = [level for level in all_levels() if level.world == "pair"]
    nothing = [LevelProgress(each, True, {}, frozenset(), (False, False, False), {}, 0) for each in levels]

    def belt(*medals: Medal) -> str:
        found = [
            replace(each, medals={DriverKind.KEYS: medal})
            for each, medal in zip(nothing, medals, strict=False)
        ]
        return belt_of([*found, *nothing[len(found) :]])

    gold, silver, bronze, none = Medal.GOLD, Medal.SILVER, Medal.BRONZE, Medal.NONE
    found = [
        belt(none),
        belt(gold),
        belt(bronze, bronze, bronze, bronze),
        belt(silver, silver, bronze, bronze),
        belt(silver, silver, silver, gold),
        belt(silver, silver, gold, gold),
        belt(gold, gold, gold, gold),
    ]
    assert found == list(BELTS)
