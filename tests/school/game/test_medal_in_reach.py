"""The medals that a player is told to try for are those that are nearest to what was driven."""

from __future__ import annotations

from kit.school.game.medal import Medal, medal_time
from kit.school.game.medal_in_reach import medals_in_reach
from kit.school.game.player_progress import LevelProgress
from kit.school.game.race import DriverKind
from kit.school.game.references import reference_seconds
from tests.kit_content import kit_levels

FIRST, SECOND = [each for each in kit_levels() if reference_seconds(each) is not None][:2]


def driven(level: object, times: dict[DriverKind, float]) -> LevelProgress:
    return LevelProgress(level, True, {}, frozenset(), times)  # type: ignore[arg-type]


def test_the_smallest_part_of_the_time_decides() -> None:
    first, second = reference_seconds(FIRST) or 0.0, reference_seconds(SECOND) or 0.0
    levels = [
        driven(FIRST, {DriverKind.HAND: 1.9 * first}),
        driven(SECOND, {DriverKind.HAND: 1.31 * second, DriverKind.AGENT: 1.2 * second}),
    ]
    asked = medal_time(Medal.SILVER, second)
    nearest, *others = medals_in_reach(levels)
    assert nearest.describe() == f"silver on {SECOND.title} by hand, {1.31 * second - asked:.2f} s away"
    assert len(others) == 2


def test_nothing_is_named_before_a_drive_and_after_the_record() -> None:
    assert not medals_in_reach([driven(FIRST, {})])
    best = medal_time(Medal.RECORD, reference_seconds(FIRST) or 0.0)
    assert not medals_in_reach([driven(FIRST, {DriverKind.HAND: best})])
