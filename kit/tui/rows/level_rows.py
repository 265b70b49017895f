"""The game's levels as rows of text: medals, the ladder, what is known of a level, leaderboards. Pure."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from kit.document.blocks import Block, Cell, CellStyle, Column, Table, Text, Tone, ToneText
from kit.document.layout import Page, rows_of
from kit.document.rows import Row, row
from kit.plain_text import counted
from kit.school.game.daily import DAILY_PREFIX, daily_level, today
from kit.school.game.drive_records import DriveRecord
from kit.school.game.ghosts import Ghost
from kit.school.game.leaderboard import LeaderboardEntry, PlayerStanding
from kit.school.game.levels import GameLevel, GameWorld, all_levels
from kit.school.game.medal import RUNGS, SHARES, Medal, medal_of, medal_time, next_rung, rung_in_reach
from kit.school.game.player_progress import ExtraRule, GameSummary, LevelProgress, belt_of
from kit.school.game.race import DriverKind, RaceFinish
from kit.school.game.references import reference_seconds
from kit.school.game.starts import SEEDS

TITLE_WIDTH: Final = 24
STAR, NO_STAR, SHUT = "*", ".", "-"
MEDAL_SIGNS: Final = {
    Medal.NONE: NO_STAR,
    Medal.BRONZE: "B",
    Medal.SILVER: "S",
    Medal.GOLD: "G",
    Medal.MASTER: "M",
    Medal.RECORD: "R",
}
MEDAL_STYLES: Final = {
    Medal.NONE: "dim",
    Medal.BRONZE: "",
    Medal.SILVER: "bold",
    Medal.GOLD: "warn",
    Medal.MASTER: "good",
    Medal.RECORD: "good",
}
HEADER: Final = "  level" + " " * (TITLE_WIDTH - 4) + "hand  program  agent  stars    best   ladder"
BAR: Final = 12
"""Columns of the longest sector's bar."""


def world_heading(world: GameWorld, number: int, count: int, belt: str) -> list[Row]:
    """A world's name, the belt earned in it, and its story."""
    return [
        row(
            (f" World {number} of {count}: {world.title}", "bold"),
            f"   {belt} belt",
            ("   left, right: other worlds", "dim"),
        ),
        row((f" {world.story}", "dim")),
    ]


def medal_counts(summary: GameSummary) -> str:
    """All medals and stars, on one line."""
    counts = [
        f"{each.title} {summary.count(each)}"
        for each in reversed(RUNGS)
        if each <= Medal.GOLD or summary.count(each)
    ]
    return "  ".join([*counts, f"stars {summary.stars}"])


def game_progress(summary: GameSummary) -> list[Row]:
    """One row for all that was won, and one for each world: how many of its levels have a medal, and its belt."""
    rows: list[tuple[Cell, ...]] = []
    for title, entries in summary.best_by_world.items():
        won = sum(medal is not Medal.NONE for medal in entries)
        tone = Tone.BOLD if won else Tone.DIM
        figures = (f"{won} of {len(entries)}", f"{belt_of(entries)} belt")
        rows.append((title, *(ToneText(text, tone) for text in figures)))
    columns = (Column("", CellStyle.TEXT), Column(""), Column("", CellStyle.TEXT))
    table = Table("worlds", "", columns, tuple(rows))
    return [row(f"  {medal_counts(summary)}"), row(), *rows_of([table], Page(margin=2))]


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
            _player(each.name, each.is_mine),
            *(each.medals[medal] for medal in reversed(RUNGS)),
            each.stars,
            counted(each.fastest, "level"),
        )
        for place, each in enumerate(standings, 1)
    )
    return [Table("standings", "", columns, rows, is_ruled=False), *offered]


def _player(name: str, is_mine: bool) -> ToneText:
    return ToneText(name, Tone.BOLD if is_mine else Tone.PLAIN)


def _driven(entry: LeaderboardEntry) -> str:
    """Who drove, whether it was on another kind of machine than this one, where a drive is the same but not to the bit, and who
    had the same drive before."""
    remarks = [
        *([] if entry.is_same_platform else ["another machine"]),
        *([f"as {entry.copy_of} before"] if entry.copy_of else []),
    ]
    return ", ".join([entry.driver.phrase, *remarks])


def leaderboard_times(entries: Sequence[LeaderboardEntry]) -> Table:
    """The quickest drives of today's level and of each other. ``entries``: in the order of ``read_entries``."""
    titles = {daily_level(today()).id: "Today's level", **{each.id: each.title for each in all_levels()}}
    rows = tuple(
        (title, _player(each.name, each.is_mine), f"{each.seconds:.2f} s", _driven(each))
        for level, title in titles.items()
        for each in [each for each in entries if each.level == level][
            : BEST_TODAY if level.startswith(DAILY_PREFIX) else BEST
        ]
    )
    columns = (Column("", CellStyle.TEXT), Column("", CellStyle.TEXT), Column(""), Column("", CellStyle.TEXT))
    return Table("times", "", columns, rows, grouped=True)


def still_in_reach(driver: DriverKind, reference: float, seconds: float, collisions: int) -> str:
    """The medal that is still in reach while one drives, and until when."""
    medal = rung_in_reach(driver, reference, seconds, collisions)
    if medal is None:
        return "no medal any more"
    return f"{medal.title} until {medal_time(medal, reference, driver):.2f} s"


def times_to_beat(found: Sequence[LevelProgress]) -> Table:
    """The reference drive's time of each level and the player's best ones, for a board on which nobody stands yet."""
    rows = tuple(
        (
            each.level.title,
            f"{reference:.2f} s",
            *(
                f"{each.best_times[driver]:.2f} s" if driver in each.best_times else ToneText("-", Tone.DIM)
                for driver in DriverKind
            ),
        )
        for each in found
        if (reference := reference_seconds(each.level)) is not None
    )
    drivers = (Column(f"you {driver.phrase}") for driver in DriverKind)
    return Table("to-beat", "", (Column("", CellStyle.TEXT), Column("the kit"), *drivers), rows)


def world_levels(
    standings: Sequence[LevelProgress], chosen: str, references: dict[str, float | None]
) -> list[Row]:
    """One row for each level of a world. ``references``: the reference drive's time of each level [s]."""
    rows = [row((HEADER, "dim"))]
    for each in standings:
        level, is_chosen = each.level, each.level.id == chosen
        style = "chosen" if is_chosen else "" if each.is_open else "dim"
        medals: list[str | tuple[str, str]] = []
        for driver, width in zip(DriverKind, (6, 9, 7), strict=True):
            medal = each.medals.get(driver, Medal.NONE)
            sign = MEDAL_SIGNS[medal] if each.is_open else SHUT
            medals.append((f"{sign:<{width}}", MEDAL_STYLES[medal]))
        best = min(each.best_times.values(), default=None)
        reference = references.get(level.id)
        driver = max(DriverKind, key=lambda kind: (each.medals.get(kind, -1), kind in each.best_times))
        bar = (
            () if reference is None else ladder_bar(driver, reference, each.best_times.get(driver), LIST_BAR)
        )
        rows.append(
            row(
                ("> " if is_chosen else "  ", "bold"),
                (f"{level.title:<{TITLE_WIDTH}.{TITLE_WIDTH}} ", style),
                *medals,
                (f"{STAR * each.star_count:{NO_STAR}<{len(ExtraRule)}}", "warn" if each.rules else "dim"),
                f"{best:8.2f} s  " if best is not None else " " * 12,
                *(bar if each.is_open else ()),
            )
        )
    return rows


def about(progress: LevelProgress, ghosts: Sequence[Ghost], reference: float | None) -> list[Row]:
    """What the chosen level asks for, and how it was driven."""
    level = progress.level
    rows = [
        row((level.title, "bold"), f"  {level.story}"),
        row(("task   ", "dim"), level.hint),
        row(
            ("skill  ", "dim"),
            level.skill,
            (f"   lesson {level.lesson_number} opens it too" if level.opened_by_lesson else "", "dim"),
        ),
    ]
    if not progress.is_open:
        return [*rows, row(("locked ", "dim"), opens_after(level))]
    if reference is None:
        times = [f"{driver.phrase} {time:.2f} s" for driver, time in progress.best_times.items()]
        return [*rows, row(("best   ", "dim"), ", ".join(times) or "none yet")]
    for driver in DriverKind:
        best = progress.best_times.get(driver)
        rows.append(
            row(
                (f"{driver.phrase:<11}", "dim"),
                *ladder_bar(driver, reference, best, ABOUT_BAR),
                ladder_words(driver, reference, best),
            )
        )
    return rows


LIST_BAR, ABOUT_BAR, RESULT_BAR = 13, 34, 40
"""Columns of a ladder in the list of levels, below it, and at the end of a drive."""
HERE: Final = "\u25cf"
"""Where a drive stands on a ladder."""


def ladder_bar(driver: DriverKind, reference: float, seconds: float | None, width: int) -> Row:
    """All rungs of a driver's ladder, as far apart as the logarithms of their times, and where a time stands among them.

    >>> from kit.document.rows import row_text
    >>> row_text(ladder_bar(DriverKind.KEYS, 10.0, 15.0, 30))
    'B━━━━━━━━━━━●─────S──────G──MR'
    """
    shares = SHARES[driver]
    widest = math.log(shares[Medal.BRONZE])

    def column(share: float) -> int:
        return round((width - 1) * (1.0 - min(math.log(max(share, 1.0)) / widest, 1.0)))

    signs = ["─"] * width
    for medal in RUNGS:
        below_record = 0 if medal is Medal.RECORD else 1
        signs[min(column(shares[medal]), width - 1 - below_record)] = MEDAL_SIGNS[medal]
    if seconds is None or seconds > medal_time(Medal.BRONZE, reference, driver):
        return row(("".join(signs), "dim"))
    here = column(seconds / reference)
    passed = "".join("━" if sign == "─" else sign for sign in signs[:here])
    return row((passed, "good"), (HERE, "bold"), ("".join(signs[here + 1 :]), "dim"))


def ladder_words(driver: DriverKind, reference: float, seconds: float | None) -> str:
    """A time and what the next rung asks for."""
    rung = next_rung(driver, reference, seconds)
    asked = "" if rung is None else f"{rung.title} at {medal_time(rung, reference, driver):.2f} s"
    return f"  {asked}" if seconds is None else f"  {seconds:.2f} s{', ' if asked else ''}{asked}"


def ladder_rows(driver: DriverKind, reference: float, seconds: float | None) -> list[Row]:
    """A ladder with the times of its rungs below it, and how far the next one is."""
    times = [f"{medal.title} {medal_time(medal, reference, driver):.2f}" for medal in RUNGS]
    rows = [
        row("   ", *ladder_bar(driver, reference, seconds, RESULT_BAR), (f"  {driver.phrase}", "dim")),
        row((f"   {'  '.join(times)} s", "dim")),
    ]
    rung = next_rung(driver, reference, seconds)
    if seconds is not None and rung is not None:
        missing = seconds - medal_time(rung, reference, driver)
        rows.append(row("   next ", (f"{rung.title}, {missing:.2f} s away", "bold")))
    return rows


def other_start(number: int, seconds: float) -> Row:
    """What is said while a program drives from its other starts."""
    return row(
        (f" From {len(SEEDS)} starts, of which the middle drive counts: ", "dim"),
        f"start {number}, {seconds:.0f} s",
    )


def starts_rows(finishes: Sequence[RaceFinish], counts: int) -> list[Row]:
    """The times of a program's drives from all starts, the one that counts in brackets; none for a single drive."""
    if len(finishes) < 2:
        return []
    times = [f"{each.seconds:.2f}" if each.reached else "not there" for each in finishes]
    times = [f"[{time}]" if number == counts else time for number, time in enumerate(times)]
    return [row((f"   {len(times)} starts  ", "dim"), "  ".join(times), (" s", "dim"))]


def ladder_of_drive(
    finish: RaceFinish, record: DriveRecord, driver: DriverKind, reference: float | None
) -> list[Row]:
    """The ladder of a drive that has ended; none where it earns nothing."""
    if reference is None or record.is_shipped or not finish.reached:
        return []
    rows = ladder_rows(driver, reference, finish.seconds)
    unharmed = medal_of(replace(finish, collisions=0), reference, driver)
    if unharmed > record.medal:
        bumps = "the bump" if finish.collisions == 1 else "the bumps"
        rows[2:] = [row((f"   without {bumps} it would have been {unharmed.title}", "dim"))]
    return rows


def opens_after(level: GameLevel) -> str:
    """Says what opens a level."""
    lesson = f", or after lesson {level.lesson_number}" if level.opened_by_lesson else ""
    titles = {each.id: each.title for each in all_levels()}
    return f"opens after {' or '.join(titles[each] for each in level.opened_by)}{lesson}"


def before_the_start(level: GameLevel, ghosts: Sequence[str], width: int) -> list[Row]:
    """What stands below the picture until somebody drives. ``ghosts``: the name and time of each; those are shown for which
    there is room."""
    start, shown = " The clock starts with your first key.", ""
    for each in ghosts:
        longer = f"{shown}, {each}" if shown else f"  Ghosts: {each}"
        if len(start) + len(longer) > width:
            break
        shown = longer
    return [row((start, "bold"), (shown, "dim")), row(f" {level.hint}")]


MOST_COLUMNS, LEAST_COLUMNS = 24, 12
MOST_ROWS, LEAST_ROWS = 8, 3
"""Most and fewest rows of a picture."""
RIGHT, LEFT, UP, DOWN = 1, 2, 4, 8
"""Directions in which a line leaves a character."""
