"""The level of the day: the same for everybody, proved drivable, its first run counts, and days in a row are a streak."""

from __future__ import annotations

import datetime
import math
from dataclasses import replace
from pathlib import Path

import pytest

from kit.school.game.daily import (
    CELL,
    LEAST_BENDS,
    LEAST_CELLS,
    daily_level,
    daily_map,
    find_playable_level,
    streak,
    wall_segments,
)
from kit.school.game.drive_records import begin_run, join_leaderboard, record_drive
from kit.school.game.leaderboard import FOLDER_VARIABLE, leaderboard_folder, publish_drives, read_entries
from kit.school.game.levels import UnknownLevel, find_level
from kit.school.game.medal import Medal, medal_of
from kit.school.game.race import DriverKind, judge_recording
from kit.school.game.references import drive_reference, reference_seconds
from kit.school.game.starts import OWN_SEED
from kit.school.progress import EventKind, ProgressEvent, ProgressJournal
from kit.workspace import open_workspace
from tests.school.game.measured_drivers import drive, judged, keys_drive, tape_drives
from tests.school.game.ordinary import targets_of
from tests.school.game.tidy import TidyDriver

DAY = datetime.date(2026, 9, 1)
DAYS = [DAY + datetime.timedelta(days=number) for number in range(60)]


def test_a_day_has_one_map_for_everybody_and_days_differ() -> None:
    maps = [daily_map(day) for day in DAYS]
    daily_map.cache_clear()
    assert [daily_map(day) for day in DAYS] == maps
    assert len({(each.openings, each.way) for each in maps}) == len(DAYS)
    for each in maps:
        assert len(each.way) >= LEAST_CELLS
        assert len(set(each.way)) == len(each.way)
    fogs = {daily_level(day).conditions.fog for day in DAYS}
    assert fogs == {True, False}
    for day in DAYS[:3]:
        level = daily_level(day)
        assert level.opened_by == ()
        assert find_playable_level(level.id) == level
    with pytest.raises(UnknownLevel, match="day"):
        find_playable_level("daily-2026-13-01")


def test_walls_stand_where_cells_do_not_open_and_nowhere_else() -> None:
    drawn = daily_map(DAY)
    walls = wall_segments(drawn)

    def is_crossed(a: tuple[int, int], b: tuple[int, int]) -> bool:
        """Whether a wall lies across the middle between two neighbours."""
        x, y = (0.5 * (a[0] + b[0]) + 0.5) * CELL, (0.5 * (a[1] + b[1]) + 0.5) * CELL
        inside = (walls[:, [0, 2]].min(axis=1) <= x) & (x <= walls[:, [0, 2]].max(axis=1))
        level = (walls[:, [1, 3]].min(axis=1) <= y) & (y <= walls[:, [1, 3]].max(axis=1))
        near_x = abs(walls[:, [0, 2]].mean(axis=1) - x) <= 0.06
        near_y = abs(walls[:, [1, 3]].mean(axis=1) - y) <= 0.06
        return bool((inside & near_y).any() or (level & near_x).any())

    for column in range(drawn.columns):
        for row in range(drawn.rows):
            for other in ((column + 1, row), (column, row + 1)):
                if other[0] < drawn.columns and other[1] < drawn.rows:
                    is_open = ((column, row), other) in drawn.openings
                    assert is_crossed((column, row), other) is not is_open


@pytest.mark.sampled(5)
@pytest.mark.parametrize("day", DAYS, ids=str)
def test_every_day_is_drivable(day: datetime.date) -> None:
    level = daily_level(day)
    finish, recording = drive_reference(level)
    assert finish.reached
    assert finish.collisions == 0
    assert finish.seconds == pytest.approx(reference_seconds(level), abs=0.1)
    assert judge_recording(level, recording).seconds == finish.seconds
    assert medal_of(finish, reference_seconds(level)) >= Medal.GOLD
    way = daily_map(day).way
    bends = sum(
        (b[0] - a[0], b[1] - a[1]) != (c[0] - b[0], c[1] - b[1])
        for a, b, c in zip(way, way[1:], way[2:], strict=False)
    )
    assert bends >= LEAST_BENDS


@pytest.mark.sampled(2)
@pytest.mark.parametrize("day", DAYS[:8], ids=str)
def test_an_ordinary_hand_is_slower_than_the_reference_of_a_day(day: datetime.date) -> None:
    level = daily_level(day)
    finish, _ = keys_drive(level)
    assert finish.seconds > 1.01 * (reference_seconds(level) or math.inf)


def test_a_tape_earns_nothing_on_a_day_either() -> None:
    _, medal = judged(daily_level(DAY), DriverKind.PROGRAM, tape_drives(daily_level(DAY)))
    assert medal <= Medal.BRONZE


def test_the_first_run_of_a_day_counts_and_others_are_practice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path / "board"))
    level = daily_level(DAY)
    workspace = open_workspace(tmp_path / "desk")
    first, better = keys_drive(level), drive_reference(level)
    with ProgressJournal(workspace.folder) as journal:
        join_leaderboard(journal, workspace, "Ada")
        is_practice = begin_run(journal, level)
        record = record_drive(journal, workspace, level, DriverKind.HAND, [first], is_practice=is_practice)
        is_practice = begin_run(journal, level)
        again = record_drive(journal, workspace, level, DriverKind.HAND, [better], is_practice=is_practice)
        events = journal.events(EventKind.FINISH, level.id)
    assert (record.is_practice, again.is_practice) == (False, True)
    assert record.medal > Medal.NONE
    assert (again.medal, again.is_best, again.rules) == (Medal.NONE, False, ())
    assert len(events) == 1
    (entry,) = read_entries(leaderboard_folder(), [level])
    assert entry.seconds == first[0].seconds


def test_a_run_in_another_workspace_does_not_take_the_place_of_the_first_one(tmp_path: Path) -> None:
    level = daily_level(DAY)
    targets = targets_of(level)
    first, better = (
        keys_drive(level),
        drive(
            level, OWN_SEED, lambda session: session.runner.participants.append(TidyDriver(session, targets))
        ),
    )
    assert better[0].seconds < first[0].seconds
    for _, recording in (first, better):
        publish_drives(tmp_path, "Ada", {(level.id, DriverKind.HAND): [recording]})
    (entry,) = read_entries(tmp_path, [level])
    assert entry.seconds == first[0].seconds


def test_a_first_run_that_is_left_is_used_up_and_that_of_another_day_is_not(tmp_path: Path) -> None:
    level = daily_level(DAY)
    with ProgressJournal(tmp_path) as journal:
        assert not begin_run(journal, level)
        assert begin_run(journal, level)
        assert not begin_run(journal, daily_level(DAY + datetime.timedelta(days=1)))
        assert streak(journal.events(), DAY) == 0
        assert not begin_run(journal, find_level("first-drive"))
        assert not begin_run(journal, find_level("first-drive"))


def finish(day: datetime.date, level: str, *, reached: bool = True) -> ProgressEvent:
    at = datetime.datetime.combine(day, datetime.time(12)).astimezone()
    content = {"driver": "hand", "reached": reached, "seconds": 9.0, "bumps": 0, "medal": 1}
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


def test_a_run_over_midnight_belongs_to_the_day_on_which_it_began() -> None:
    late = datetime.datetime.combine(DAY, datetime.time(23, 59)).astimezone()
    begun = ProgressEvent("begun", late.isoformat(), EventKind.START, f"daily-{DAY}", {})
    ended = replace(finish(DAY + datetime.timedelta(days=1), f"daily-{DAY}"))
    assert streak([ended], DAY) == 0
    assert streak([begun, ended], DAY) == 1
