"""The histogram of what players needed: counted, never invented, and empty where there are few."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from kit.school.game import leaderboard
from kit.school.game.leaderboard import publish_drives
from kit.school.game.players_histogram import BINS, LEAST_PLAYERS, histogram, seconds_needed
from kit.school.game.race import DriverKind
from kit.tui.rows.drive_end_rows import needed_rows
from tests.kit_content import kit_levels
from tests.school.game.measured_drivers import keys_drive


def test_every_player_is_counted_once_and_one_bin_holds_ones_own() -> None:
    chance = random.Random(44)
    for count in range(LEAST_PLAYERS, 40):
        figures = [chance.uniform(5.0, 30.0) for _ in range(count)]
        bins = histogram(figures, chance.uniform(3.0, 40.0))
        assert sum(each.count for each in bins) == count
        assert [each.holds_own for each in bins].count(True) == 1
        assert len(needed_rows(bins, 74)) == BINS + 1


@pytest.mark.parametrize("count", range(LEAST_PLAYERS))
def test_few_players_make_no_histogram(count: int) -> None:
    assert histogram([9.0] * count, 9.0) == ()
    assert needed_rows((), 74) == []


def test_players_who_all_needed_the_same_stand_in_one_bin() -> None:
    bins = histogram([9.0] * LEAST_PLAYERS, 9.0)
    assert [each.count for each in bins] == [LEAST_PLAYERS] + [0] * (BINS - 1)
    assert bins[0].holds_own


def test_only_drives_on_the_board_by_that_driver_are_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    level = kit_levels()[0]
    monkeypatch.setenv(leaderboard.FOLDER_VARIABLE, str(tmp_path / "board"))
    assert seconds_needed(level, DriverKind.HAND) == []
    finish, recording = keys_drive(level)
    publish_drives(tmp_path / "board", "Ada", {(level.id, DriverKind.HAND): [recording]})
    assert seconds_needed(level, DriverKind.HAND) == [finish.seconds]
    assert seconds_needed(level, DriverKind.PROGRAM) == []
