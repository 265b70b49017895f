"""Leaderboards as rows of text: standings of players, times on a level."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from kit.document.blocks import Block, Cell, CellStyle, Column, Table, Text, Tone, ToneText
from kit.plain_text import counted
from kit.school.game.daily import DAILY_PREFIX, daily_id, today, yesterday
from kit.school.game.leaderboard import LeaderboardEntry, PlayerStanding
from kit.school.game.levels import all_levels
from kit.school.game.medal import RUNGS, Medal, medal_time
from kit.school.game.player_progress import LevelProgress
from kit.school.game.race import DriverKind
from kit.school.game.references import reference_seconds

BEST, BEST_TODAY = 3, 10
"""Rows of the leaderboard per level, and for that of the day."""


def leaderboard_standings(standings: Sequence[PlayerStanding], offer: str = "") -> list[Block]:
    """A table of all who have joined. ``offer``: what can be done about it."""
    offered = [Text(offer, Tone.DIM)] if offer else []
    if not standings:
        return [Text("Nobody is on the leaderboard of this machine yet."), *offered]
    columns = (
        Column(""),
        Column("", CellStyle.TEXT),
        *(Column(each.title) for each in reversed(RUNGS)),
        Column("stars"),
        Column("quickest on", CellStyle.TEXT),
    )
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (
            f"{place}.",
            _player_cell(each.name, each.is_mine),
            *(each.medals[medal] for medal in reversed(RUNGS)),
            each.stars,
            counted(each.fastest, "level"),
        )
        for place, each in enumerate(standings, 1)
    )
    return [Table("standings", "", columns, rows, is_ruled=False), *offered]


def _player_cell(name: str, is_mine: bool) -> ToneText:
    return ToneText(name, Tone.BOLD if is_mine else Tone.PLAIN)


def _driver_text(entry: LeaderboardEntry) -> str:
    """Who drove, whether it was on another kind of machine than this one, where a drive is the same but not to the bit, and who
    had the same drive before."""
    remarks = [
        *([] if entry.is_same_platform else ["another machine"]),
        *([f"as {entry.copy_of} before"] if entry.copy_of else []),
    ]
    return ", ".join([entry.driver.phrase, *remarks])


def leaderboard_times(entries: Sequence[LeaderboardEntry]) -> Table:
    """The quickest drives of today's level, of yesterday's and of each other. ``entries``: in the order of ``read_entries``."""
    days = {daily_id(today()): "Today's maze", daily_id(yesterday()): "Yesterday's maze"}
    titles = days | {each.id: each.title for each in all_levels()}
    rows = tuple(
        (title, *cells)
        for level, title in titles.items()
        for cells in _times_on(entries, level, BEST_TODAY if level.startswith(DAILY_PREFIX) else BEST)
    )
    return Table("times", "", (Column("", CellStyle.TEXT), *_TIMES), rows, grouped=True, is_ruled=False)


def todays_times(entries: Sequence[LeaderboardEntry]) -> Table:
    """The quickest drives of today's level alone."""
    rows = tuple(_times_on(entries, daily_id(today()), BEST_TODAY))
    return Table("today", "", _TIMES, rows, is_ruled=False)


_TIMES: Final = (Column("", CellStyle.TEXT), Column(""), Column("", CellStyle.TEXT))


def _times_on(entries: Sequence[LeaderboardEntry], level: str, most: int) -> list[tuple[Cell, Cell, Cell]]:
    """Player, time and driver of the quickest drives on a level."""
    return [
        (_player_cell(each.name, each.is_mine), f"{each.seconds:.2f} s", _driver_text(each))
        for each in [each for each in entries if each.level == level][:most]
    ]


def times_to_beat(found: Sequence[LevelProgress], medals: Sequence[Medal]) -> Table:
    """The times of each level that earn these medals by hand, the reference drive's, and the player's best ones by every driver
    that has arrived somewhere, for a board on which nobody stands yet."""
    drivers = [driver for driver in DriverKind if any(driver in each.best_times for each in found)]
    rows = tuple(
        (
            each.level.title,
            *(f"{medal_time(medal, reference):.2f} s" for medal in medals),
            f"{reference:.2f} s",
            *(
                f"{each.best_times[driver]:.2f} s" if driver in each.best_times else ToneText("-", Tone.DIM)
                for driver in drivers
            ),
        )
        for each in found
        if (reference := reference_seconds(each.level)) is not None
    )
    yours = (Column(f"you {driver.phrase}") for driver in drivers)
    asked = (Column(medal.title) for medal in medals)
    return Table(
        "to-beat",
        "",
        (Column("level", CellStyle.TEXT), *asked, Column("reference"), *yours),
        rows,
        is_ruled=False,
    )
