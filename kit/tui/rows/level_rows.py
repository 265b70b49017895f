"""The map of levels, and what is known of one, as rows of text. Pure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from kit.plain_text import counted
from kit.school.game.drive_records import DriveRecord
from kit.school.game.ghosts import Ghost
from kit.school.game.player_progress import LevelProgress
from kit.school.game.race import DriverKind, RaceFinish
from kit.tui.widgets.text_rows import Row, StyledText, row

CELL: Final = (20, 26)
"""Columns of one level on the map: at least, and at most."""
WIDTH: Final = 80
STAR, NO_STAR, SHUT = "*", ".", "-"
TITLES: Final = ("finished", "touched nothing", "under par")
WHO: Final = {DriverKind.KEYS: "by hand", DriverKind.CONTROLLER: "by program", DriverKind.AGENT: "by agent"}


def stars(progress: LevelProgress) -> str:
    """``**.``, or ``---`` for a level that is not open yet."""
    if not progress.is_open:
        return SHUT * len(progress.stars)
    return "".join(STAR if has else NO_STAR for has in progress.stars)


def grid(standings: Sequence[LevelProgress]) -> list[list[int]]:
    """Which levels stand in which row of the map: by number, from 0."""
    rows = 1 + max((each.level.row for each in standings), default=-1)
    return [[number for number, each in enumerate(standings) if each.level.row == at] for at in range(rows)]


def level_map(standings: Sequence[LevelProgress], chosen: int) -> list[Row]:
    """One row for each depth, an empty one between."""
    made: list[Row] = []
    for numbers in grid(standings):
        width = max(CELL[0], min(CELL[1], WIDTH // max(1, len(numbers))))
        made += [
            row(*(part for number in numbers for part in _cell(standings[number], number == chosen, width))),
            row(),
        ]
    return made[:-1]


def _cell(progress: LevelProgress, is_chosen: bool, width: int) -> tuple[StyledText, ...]:
    title = progress.level.title
    room = width - 6
    title = title if len(title) <= room else title[: room - 1] + "."
    style = "bold" if is_chosen else "" if progress.is_open else "dim"
    return (
        (">" if is_chosen else " ", "bold"),
        (stars(progress), "warn" if progress.star_count else "dim"),
        (f" {title:<{room}} ", style),
    )


def about(progress: LevelProgress, ghosts: Sequence[Ghost], reference: Ghost | None) -> list[Row]:
    """What the chosen level asks for, and how it was driven."""
    level = progress.level
    if not progress.is_open:
        return [row((level.title, "bold"), f"  opens when you have finished {' or '.join(level.opened_by)}.")]
    times = [
        f"{WHO[DriverKind(ghost.name)]} {progress.best_times[DriverKind(ghost.name)]:.1f} s"
        for ghost in ghosts
        if DriverKind(ghost.name) in progress.best_times
    ]
    best = ", ".join(times) or "none yet"
    measure = "" if reference is None else f"; the reference takes {reference.seconds:.1f} s"
    return [
        row((level.title, "bold"), f"  {level.hint}"),
        row(("par ", "dim"), f"{level.par:g} s{measure}"),
        row(("best ", "dim"), best),
    ]


def result(
    level_title: str, par: float, finish: RaceFinish, noted: DriveRecord, reference: Ghost | None
) -> list[Row]:
    """What a drive earned: rows of a page."""
    if finish.foul:
        head = f" It does not count: {finish.foul}."
    elif finish.failure is not None:
        head = f" The program stopped: {finish.failure}"
    elif finish.reached:
        head = f" The target was reached after {finish.seconds:.2f} s, with {counted(finish.collisions, 'bump')}."
    else:
        head = f" The target was not reached in {finish.seconds:.0f} s."
    made = [row(), row((f" {level_title}", "bold")), row(head), row()]
    for title, has in zip(TITLES, noted.stars, strict=True):
        extra = f" ({par:g} s)" if title == TITLES[-1] else ""
        made.append(
            row(
                (f"   {STAR if has else NO_STAR} ", "warn" if has else "dim"),
                (title + extra, "" if has else "dim"),
            )
        )
    made.append(row())
    if noted.is_best:
        made.append(row(" This is your best so far; its ghost drives along next time."))
    if reference is not None:
        made.append(row(f" The reference takes {reference.seconds:.2f} s."))
    return [*made, row()]
