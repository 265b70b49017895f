"""The ladder of times and medals of a level, as rows of text."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import replace
from itertools import groupby
from typing import Final

from kit.document.rows import Row, row
from kit.school.game.drive_records import DriveRecord
from kit.school.game.levels import GameLevel
from kit.school.game.medal import RUNGS, SHARES, Medal, medal_of, medal_time, next_rung, rung_in_reach
from kit.school.game.ordinary_drives import NONE_MEASURED, ordinary_drives
from kit.school.game.race import DriverKind, RaceFinish
from kit.tui.rows.medal_signs import MEDAL_SIGNS, MEDAL_STYLES

LIST_BAR, ABOUT_BAR, RESULT_BAR = 13, 34, 40
"""Columns of a ladder in the list of levels, below it, and at the end of a drive."""
LADDERS: Final = tuple(
    dict.fromkeys(
        tuple(each for each in DriverKind if SHARES[each] == SHARES[driver]) for driver in DriverKind
    )
)
"""The drivers, those together that have the same ladder."""
HERE: Final = "\u25cf"
"""Where a drive stands on a ladder."""
ORDINARY: Final = "┼"
"""Where an ordinary driver stands."""


def ladder_bar(
    driver: DriverKind,
    reference: float,
    seconds: float | None,
    width: int,
    is_flawed: bool = False,
    ordinary: Mapping[DriverKind, float] = NONE_MEASURED,
) -> Row:
    """All rungs of a driver's ladder, as far apart as the logarithms of their times, and where a time stands among them; that of
    a drive which gets bronze at best, before all others. ``ordinary``: what ordinary drivers took on this level [s].

    >>> from kit.document.rows import row_text
    >>> row_text(ladder_bar(DriverKind.HAND, 10.0, 15.0, 30))
    'B━━━━━━━━━━━●─────S──────G──MR'
    >>> row_text(ladder_bar(DriverKind.HAND, 10.0, 10.21, 30))
    'B━━━━━━━━━━━━━━━━━S━━━━━━G━●MR'
    >>> row_text(ladder_bar(DriverKind.PROGRAM, 10.0, None, 13))
    'B──────S──GMR'
    >>> row_text(ladder_bar(DriverKind.HAND, 10.0, None, 30, ordinary={DriverKind.HAND: 15.0}))
    'B───────────┼─────S──────G──MR'
    """
    shares = SHARES[driver]
    widest = math.log(shares[Medal.BRONZE])

    def column(share: float) -> int:
        return round((width - 1) * (1.0 - min(math.log(max(share, 1.0)) / widest, 1.0)))

    places: dict[Medal, int] = {}
    free = width - 1
    for rung in reversed(RUNGS):  # each has a column of its own
        places[rung] = min(column(shares[rung]), free)
        free = places[rung] - 1

    def place(seconds: float, is_flawed: bool) -> int:
        """The column of a time; -1: it earns nothing."""
        if seconds > medal_time(Medal.BRONZE, reference, driver):
            return -1
        missed = [
            place
            for medal, place in places.items()
            if seconds > medal_time(medal, reference, driver) or (is_flawed and medal > Medal.BRONZE)
        ]
        # before a rung that was missed by a hair
        return min([column(seconds / reference), *(each - 1 for each in missed)])

    here = -1 if seconds is None else place(seconds, is_flawed)
    shown = [("━", "good") if each < here else ("─", "dim") for each in range(width)]
    for each in ordinary.values():
        if (at := place(each, is_flawed=False)) >= 0:
            shown[at] = (ORDINARY, "")
    for medal, at in places.items():
        shown[at] = (MEDAL_SIGNS[medal], MEDAL_STYLES[medal])
    if here >= 0:
        shown[here] = (HERE, "bold")
    return tuple(
        ("".join(sign for sign, _ in run), style) for style, run in groupby(shown, key=lambda each: each[1])
    )


def drivers_by_ladder(timed: Collection[DriverKind]) -> list[tuple[DriverKind, ...]]:
    """The drivers, those together that have the same ladder while none of them has a time on it. ``timed``: those that have one.

    >>> drivers_by_ladder([DriverKind.HAND])[1] == (DriverKind.PROGRAM, DriverKind.AGENT)
    True
    >>> len(drivers_by_ladder([DriverKind.AGENT]))
    3
    """
    return [
        part
        for drivers in LADDERS
        for part in ([(each,) for each in drivers] if set(drivers) & set(timed) else [drivers])
    ]


def ladder_letters() -> Row:
    """What the letters of a ladder mean.

    >>> from kit.document.rows import row_text
    >>> row_text(ladder_letters())
    ' ladder  B bronze  S silver  G gold  M master  R record  ┼ an ordinary driver'
    """
    parts = ((MEDAL_SIGNS[each], MEDAL_STYLES[each], each.title) for each in RUNGS)
    told = (part for sign, style, title in parts for part in ((f"  {sign} ", style), title))
    return row((" ladder", "dim"), *told, f"  {ORDINARY} an ordinary driver")


def ladder_words(driver: DriverKind, reference: float, seconds: float | None) -> str:
    """A time and what the next rung asks for."""
    rung = next_rung(driver, reference, seconds)
    asked = "" if rung is None else f"{rung.title} at {medal_time(rung, reference, driver):.2f} s"
    return f"  {asked}" if seconds is None else f"  {seconds:.2f} s{', ' if asked else ''}{asked}"


def ladder_rows(
    driver: DriverKind,
    reference: float,
    seconds: float | None,
    ordinary: Mapping[DriverKind, float] = NONE_MEASURED,
) -> list[Row]:
    """A ladder with the times of its rungs below it, and how far the next one is."""
    bar = ladder_bar(driver, reference, seconds, RESULT_BAR, ordinary=ordinary)
    times = [f"{medal.title} {medal_time(medal, reference, driver):.2f}" for medal in RUNGS]
    rows = [
        row("   ", *bar, (f"  {driver.phrase}", "dim"), *_named(ordinary)),
        row((f"   {'  '.join(times)} s", "dim")),
    ]
    rung = next_rung(driver, reference, seconds)
    if seconds is not None and rung is not None:
        missing = seconds - medal_time(rung, reference, driver)
        rows.append(row("   next ", (f"{rung.title}, {missing:.2f} s away", "bold")))
    return rows


def _named(ordinary: Mapping[DriverKind, float]) -> Row:
    return row(*((f"  {ORDINARY} ordinary {taken:.2f} s", "dim") for taken in ordinary.values()))


def in_reach_row(driver: DriverKind, reference: float, seconds: float, is_flawed: bool) -> Row:
    """The best medal that a drive still earns, and until when.

    >>> from kit.document.rows import row_text
    >>> row_text(in_reach_row(DriverKind.HAND, 10.0, 11.5, False))
    'silver until 13.00 s'
    """
    medal = rung_in_reach(driver, reference, seconds, is_flawed)
    if medal is None:
        return row(("no medal now", "dim"))
    return row((medal.title, "bold"), f" until {medal_time(medal, reference, driver):.2f} s")


def rung_rows(
    driver: DriverKind,
    reference: float,
    seconds: float | None = None,
    *,
    lost_after: float | None = None,
    is_flawed: bool = False,
    ordinary: Mapping[DriverKind, float] = NONE_MEASURED,
) -> list[Row]:
    """A row for each rung, the highest first, with its time, and where a time stands among them with how far it is from each.
    ``lost_after``: the time of a drive that goes on, for which some rungs are lost already [s]; ``is_flawed``: whether it gets
    bronze at best; ``ordinary``: what ordinary drivers took on this level [s], a row each."""
    timed = []
    for medal in RUNGS:
        limit = medal_time(medal, reference, driver)
        apart = ""
        if seconds is not None:
            apart = (
                f"  {seconds - limit:.2f} s away"
                if seconds > limit
                else f"  {limit - seconds:.2f} s to spare"
            )
        is_earned = seconds is not None and seconds <= limit
        is_lost = lost_after is not None and (lost_after > limit or (is_flawed and medal > Medal.BRONZE))
        shown = row(
            (f"{MEDAL_SIGNS[medal]} ", "dim" if is_lost else MEDAL_STYLES[medal]),
            (f"{medal.title:<8}", "dim" if is_lost else "good" if is_earned else ""),
            (f" {limit:8.2f} s", "dim" if is_lost else ""),
            (apart, "dim"),
        )
        timed.append((limit, 1, shown))
    for each, taken in ordinary.items():
        name = "ordinary" if len(ordinary) == 1 else each.value
        timed.append((taken, 0, row(f"{ORDINARY} {name:<8} {taken:8.2f} s")))
    if seconds is not None:
        timed.append((seconds, 0, _here_row(seconds)))
    return [shown for *_, shown in sorted(timed, key=lambda each: each[:2])]


def _here_row(seconds: float) -> Row:
    return row((f"{HERE} you      {seconds:8.2f} s", "bold"))


def ladder_of_drive(
    level: GameLevel,
    finish: RaceFinish,
    record: DriveRecord,
    driver: DriverKind,
    reference: float | None,
    *,
    is_tall: bool,
) -> list[Row]:
    """The ladder of a drive that has ended; none where it earns nothing. ``is_tall``: with a row for each rung."""
    if reference is None or record.is_shipped:
        return []
    seconds = finish.seconds if finish.reached else None
    ordinary = ordinary_drives(level, [driver])
    if is_tall:
        rungs = [row("   ", *each) for each in rung_rows(driver, reference, seconds)]
        rows = [row((f"   ladder {driver.phrase}", "title"), *_named(ordinary)), *rungs]
    else:
        rows = ladder_rows(driver, reference, seconds, ordinary)
    unharmed = medal_of(replace(finish, collisions=0, is_apart=False), reference, driver)
    if unharmed > record.medal:
        bumps = "without the bump" if finish.collisions == 1 else "without the bumps"
        flaw = bumps if finish.collisions else "side by side"
        told = [row((f"   {flaw} it would have been {unharmed.title}", "dim"))]
        rows = [*rows, *told] if is_tall else [*rows[:2], *told]
    return rows
