"""The game as rows of text: worlds of levels as maps, what is known of a level, what a drive earned, a shared game. Pure."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby, pairwise
from typing import Final

from kit.document.blocks import Block, Cell, CellStyle, Column, Table, Text, Tone, ToneText
from kit.document.layout import Page, rows_of
from kit.document.rows import Row, row, spread
from kit.plain_text import counted, wrap
from kit.school.game.daily import DAILY_PREFIX, daily_level, today
from kit.school.game.drive_records import DriveRecord
from kit.school.game.ghosts import Ghost, Split
from kit.school.game.leaderboard import LeaderboardEntry, PlayerStanding
from kit.school.game.levels import GameLevel, GameWorld, all_levels, all_worlds
from kit.school.game.medal import RUNGS, SHARES, Medal, medal_of, medal_time
from kit.school.game.needed import Bin
from kit.school.game.player_progress import ExtraRule, GameSummary, LevelProgress, belt_of
from kit.school.game.race import DriverKind, RaceFinish
from kit.school.game.starts import SEEDS
from kit.school.game.two_players import COUNTDOWN, TAG_SECONDS, SharedGameState, SharedMode, SharedPhase
from kit.tui.rows.readout_rows import title as ruled

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
    """Who drove, and whether it was on another kind of machine than this one, where a drive is the same but not to the bit."""
    return entry.driver.phrase if entry.is_same_platform else f"{entry.driver.phrase}, another machine"


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


def level_card(level: GameLevel, driver: DriverKind, reference: float | None, width: int) -> list[Row]:
    """What a level is about: story, task, the rungs of its ladder, and the rules that earn stars."""
    rows = [ruled("level", width), *(row(line) for line in wrap(level.story, width))]
    rows += [row((line, "bold")) for line in wrap(level.hint, width)]
    if level.skill:
        rows += [row((line, "dim")) for line in wrap(f"skill: {level.skill}", width)]
    if reference is None:
        return rows
    rows += [
        ruled("ladder", width, driver.phrase),
        row(*ladder_bar(driver, reference, None, min(width, RESULT_BAR))),
    ]
    rows += [
        row(
            (f"{MEDAL_SIGNS[medal]} ", MEDAL_STYLES[medal]),
            f"{medal.title:<8} {medal_time(medal, reference, driver):8.2f} s",
        )
        for medal in reversed(RUNGS)
    ]
    rows.append(ruled("stars", width))
    for rule in ExtraRule:
        rows += [row((line, "")) for line in wrap(f"{STAR} {rule.description(level)}", width, "", "  ")]
    return rows


def next_rung(driver: DriverKind, reference: float, seconds: float | None) -> Medal | None:
    """The lowest rung that a time does not reach; None above the record."""
    missing = [medal for medal in RUNGS if seconds is None or seconds > medal_time(medal, reference, driver)]
    return min(missing, default=None)


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


def finish_sentence(finish: RaceFinish) -> str:
    """How a drive ended."""
    if finish.foul:
        return f"It does not count: {finish.foul}."
    if finish.failure is not None:
        return f"The program stopped: {finish.failure}"
    if finish.reached:
        return (
            f"The goal was reached after {finish.seconds:.2f} s, with {counted(finish.collisions, 'bump')}."
        )
    return f"The goal was not reached in {finish.seconds:.0f} s."


def earned(level: GameLevel, finish: RaceFinish, record: DriveRecord) -> list[Row]:
    """The medal and the stars of a drive, one row each, in the order in which they appear."""
    if record.is_shipped:
        return [
            row(
                (f"   {NO_STAR} ", "dim"), "a controller of the kit drove: it shows the way and earns nothing"
            )
        ]
    if record.is_practice:
        return [row((f"   {NO_STAR} ", "dim"), "practice: the first run of the day has counted")]
    if not level.has_medals:
        return [row(("   your best time so far", "good"))] if record.is_best else []
    if not finish.reached:
        return [row((f"   {NO_STAR} ", "dim"), ("no medal yet", "dim"))]
    rows = [medal_row(record.medal, is_new=record.medal > record.previous_medal)]
    for rule in record.rules:
        new = " (new)" if rule in record.new_rules else ""
        rows.append(row((f"   {STAR} ", "warn"), rule.description(level) + new))
    return rows


def medal_row(medal: Medal, *, is_new: bool) -> Row:
    """A medal that was earned. ``is_new``: whether it is better than those before."""
    better = " (new)" if is_new else ""
    return row((f"   {MEDAL_SIGNS[medal]} ", MEDAL_STYLES[medal]), (f"{medal.title}{better}", "bold"))


MEDAL_PICTURE: Final = (
    r"  \ \   / /",
    r"   \ \ / /",
    r"   .-'-'-.",
    r"  /       \ ",
    r" |    {}    |",
    r"  \       /",
    r"   '-----'",
)
SPARK_SIGNS: Final = "*.+'"


def medal_drawing(medal: Medal, spark: int) -> list[Row]:
    """A medal with its letter. ``spark``: the number of a picture of joy around it, 0 for none."""
    rows = []
    for number, line in enumerate(MEDAL_PICTURE):
        sparks = "".join(
            SPARK_SIGNS[(number + column) % len(SPARK_SIGNS)]
            if (7 * column + 5 * number + 3 * spark) % 11 < 2
            else " "
            for column in range(30 if spark else 0)
        )
        drawn = f"   {line.format(MEDAL_SIGNS[medal]):<14}"
        rows.append(row((drawn, MEDAL_STYLES[medal]), (sparks, "warn")))
    return [*rows, row()]


def compared(
    finish: RaceFinish, record: DriveRecord, reference: float | None, ghosts: Sequence[Ghost]
) -> list[Row]:
    """A drive's time beside the medals, the reference, the driver's best so far and the quickest classmate's."""
    rows: list[Row] = []
    if not finish.reached:
        return rows
    times = [("reference", reference), ("your best before", record.previous_best)]
    classmates = [each for each in ghosts if each.name not in (*DriverKind, "reference")]
    times += [(each.name, each.seconds) for each in classmates[:1]]
    for name, seconds in times:
        if seconds is not None:
            rows.append(row(f"   {name:<18.18} {seconds:7.2f} s  ", _difference(finish.seconds - seconds)))
    return rows


def sector_rows(splits: Sequence[Split]) -> list[Row]:
    """The sectors of a drive, each with a bar as long as its time and the difference to the reference's."""
    longest = max((each.sector for each in splits), default=0.0)
    return [
        row(
            f"   sector {number}  {each.sector:6.2f} s ",
            ("=" * max(1, round(BAR * each.sector / longest)), "good" if each.difference <= 0 else ""),
            "  ",
            _difference(each.difference),
        )
        for number, each in enumerate(splits, 1)
    ]


def needed_rows(bins: Sequence[Bin]) -> list[Row]:
    """A histogram of what all players of this machine needed; empty for one without bins."""
    most = max((each.count for each in bins), default=0)
    if not most:
        return []
    players = sum(each.count for each in bins)
    rows = [row((f"   what {players} players here needed", "dim"))]
    for each in bins:
        bar = "=" * round(BAR * each.count / most) if each.count else ""
        own = " < you" if each.holds_own else ""
        rows.append(row(f"   to {each.high:7.2f} s  {each.count:3} ", bar, (own, "bold")))
    return rows


def won_besides(level: GameLevel, record: DriveRecord) -> list[Row]:
    """What a drive has won besides its medal and stars: levels that it opens, a belt, a day of the streak."""
    rows = []
    if record.unlocked:
        titles = ", ".join(each.title for each in record.unlocked)
        rows.append(row(("   opened: ", "dim"), (titles, "good")))
    if record.belt:
        title = next(each.title for each in all_worlds() if each.id == level.world)
        rows.append(row(("   belt:   ", "dim"), (f"{record.belt} belt of {title}", "good")))
    if record.streak:
        rows.append(row(("   streak: ", "dim"), (f"{counted(record.streak, 'day')} in a row", "good")))
    return rows


def _difference(seconds: float) -> tuple[str, str]:
    return f"{seconds:+.2f}", "good" if seconds <= 0.0 else "warn"


BAR_WIDTH: Final = 20


def share_bar(share: float) -> str:
    """How far something is: ``share`` from 0 to 1, one character for a twentieth."""
    full = round(min(max(share, 0.0), 1.0) * BAR_WIDTH)
    return "█" * full + "░" * (BAR_WIDTH - full)


GAP: Final = 4
"""Columns between two pictures, for the lines."""
MOST_COLUMNS, LEAST_COLUMNS = 24, 12
MOST_ROWS, LEAST_ROWS = 8, 3
"""Most and fewest rows of a picture."""
RIGHT, LEFT, UP, DOWN = 1, 2, 4, 8
"""Directions in which a line leaves a character."""


@dataclass(frozen=True, slots=True)
class LevelPlace:
    """Where a level stands on the map, in characters from the map's left upper corner."""

    level: str
    x: int
    y: int
    """Row of its title; the picture is below."""
    columns: int
    rows: int
    """Rows of the picture."""


def map_places(standings: Sequence[LevelProgress], width: int, height: int) -> tuple[LevelPlace, ...]:
    """Places the levels of a world: each to the right of all that open it. Empty where there is no room for pictures."""
    depths: dict[str, int] = {}
    for each in standings:  # a level comes after those that open it
        before = [depths[name] for name in each.level.opened_by if name in depths]
        depths[each.level.id] = max(before, default=-1) + 1
    count = max(depths.values(), default=0) + 1
    by_depth = [[name for name, depth in depths.items() if depth == number] for number in range(count)]
    most = max((len(names) for names in by_depth), default=1)
    columns = min(MOST_COLUMNS, (width - 1 - GAP * (count - 1)) // count)
    rows = min(MOST_ROWS, (height + 1) // most - 2)
    if columns < LEAST_COLUMNS or rows < LEAST_ROWS:
        return ()
    used = most * (rows + 2) - 1
    places = []
    for depth, names in enumerate(by_depth):
        top = (used - (len(names) * (rows + 2) - 1)) // 2
        places += [
            LevelPlace(name, 1 + depth * (columns + GAP), top + number * (rows + 2), columns, rows)
            for number, name in enumerate(names)
        ]
    return tuple(places)


def level_at(places: Sequence[LevelPlace], x: int, y: int) -> str | None:
    """The level whose title or picture is at this character of the map.

    >>> level_at([LevelPlace("maze", 1, 0, 12, 3)], 12, 3), level_at([LevelPlace("maze", 1, 0, 12, 3)], 13, 3)
    ('maze', None)
    """
    for place in places:
        if 0 <= x - place.x < place.columns and 0 <= y - place.y <= place.rows:
            return place.level
    return None


def map_rows(
    standings: Sequence[LevelProgress],
    places: Sequence[LevelPlace],
    pictures: Mapping[str, Sequence[str]],
    chosen: str,
) -> list[Row]:
    """The map as rows of text. ``pictures``: the rows of each level's picture; one that is missing stays blank."""
    if not places:
        return []
    width = max(place.x + place.columns for place in places) + 1
    height = max(place.y + place.rows for place in places) + 1
    signs = [[(" ", "") for _ in range(width)] for _ in range(height)]
    by_level = {place.level: place for place in places}
    for y, line in enumerate(_lines(standings, by_level, width, height)):
        for x, sign in enumerate(line):
            signs[y][x] = sign, "dim"
    for each in standings:
        place = by_level[each.level.id]
        medal = SHUT if not each.is_open else MEDAL_SIGNS[each.best_medal] if each.best_medal else " "
        style = "key" if each.level.id == chosen else "" if each.is_open else "dim"
        _write(
            signs,
            place.x,
            place.y,
            f"{medal} {each.level.title}"[: place.columns].ljust(place.columns),
            style,
        )
        style = "warn" if each.best_medal >= Medal.GOLD else "" if each.is_open else "dim"
        for number, text in enumerate(pictures.get(each.level.id, ())[: place.rows]):
            _write(signs, place.x, place.y + 1 + number, text[: place.columns].ljust(place.columns), style)
    return [
        tuple(("".join(sign for sign, _ in run), style) for style, run in groupby(line, lambda each: each[1]))
        for line in signs
    ]


def _write(signs: list[list[tuple[str, str]]], x: int, y: int, text: str, style: str) -> None:
    for number, sign in enumerate(text):
        signs[y][x + number] = sign, style


def _lines(
    standings: Sequence[LevelProgress], places: Mapping[str, LevelPlace], width: int, height: int
) -> list[str]:
    """The lines from each level to those in the next column that it opens, ending in an arrow."""
    ways = [[0] * width for _ in range(height)]
    arrows = set()
    for each in standings:
        end = places[each.level.id]
        for name in each.level.opened_by:
            begin = places.get(name)
            if begin is None or begin.x + begin.columns + GAP != end.x:
                continue
            x, middle = begin.x + begin.columns, begin.x + begin.columns + GAP // 2
            first, last = (place.y + (place.rows + 1) // 2 for place in (begin, end))
            _line(ways, [(x, first), (middle, first), (middle, last), (end.x - 1, last)])
            arrows.add((end.x - 1, last))
    return [
        "".join("▶" if (x, y) in arrows else _SIGNS[way] for x, way in enumerate(line))
        for y, line in enumerate(ways)
    ]


def _line(ways: list[list[int]], corners: Sequence[tuple[int, int]]) -> None:
    """Leaves in each character on the way the directions in which the line goes on."""
    for (x, y), (end_x, end_y) in pairwise(corners):
        while (x, y) != (end_x, end_y):
            step_x, step_y = (end_x > x) - (end_x < x), (end_y > y) - (end_y < y)
            there, back = (RIGHT, LEFT) if step_x else (DOWN, UP) if step_y > 0 else (UP, DOWN)
            ways[y][x] |= there
            x, y = x + step_x, y + step_y
            ways[y][x] |= back


_SIGNS: Final = {
    0: " ", RIGHT: "─", LEFT: "─", RIGHT | LEFT: "─", UP: "│", DOWN: "│", UP | DOWN: "│",
    RIGHT | DOWN: "┌", LEFT | DOWN: "┐", RIGHT | UP: "└", LEFT | UP: "┘",
    RIGHT | LEFT | DOWN: "┬", RIGHT | LEFT | UP: "┴", RIGHT | UP | DOWN: "├", LEFT | UP | DOWN: "┤",
    RIGHT | LEFT | UP | DOWN: "┼",
}  # fmt: skip
"""The character for the directions in which lines leave it."""


NOBODY: Final = "nobody yet"
PLAYER_STYLES: Final = ("code", "bold")


def shared_heading(level: str, mode: SharedMode, state: SharedGameState, watching: int, width: int) -> Row:
    """The level and both players on the left, spectators and the clock on the right."""
    left = row(
        (level, "bold"),
        f"  {mode.value}  ",
        (state.names[0], PLAYER_STYLES[0]),
        " against ",
        state.names[1] or NOBODY,
    )
    seconds = state.seconds
    if mode is SharedMode.TAG and state.phase is SharedPhase.RUNNING:
        seconds = max(0.0, TAG_SECONDS - seconds)
    clock = f"{seconds:.1f} s" if state.phase is SharedPhase.RUNNING else state.phase.value
    watched = f"{counted(watching, 'spectator')}  " if watching else ""
    return spread(left, row((watched, "dim"), (clock, "bold")), width)


def shared_message(
    mode: SharedMode, state: SharedGameState, me: int | None, join: str = ""
) -> tuple[Row, ...]:
    """Says what to do now, and the score. ``me``: this player; None watches. ``join``: how another comes in."""
    if state.phase is SharedPhase.WAITING:
        return (
            row((" Waiting for the second player.", "bold")),
            row((f" In another terminal of this machine: {join}" if join else "", "dim")),
        )
    if state.phase is SharedPhase.COUNTDOWN:
        return (
            row(
                (f" {max(1, round(COUNTDOWN - state.seconds + 0.5))}", "warn"),
                f"   {_task(mode, state, me)}",
            ),
        )
    scores = row(
        " ",
        *(
            f"{'you' if number == me else name or NOBODY}: {_score(mode, state, number)}   "
            for number, name in enumerate(state.names)
        ),
    )
    if state.phase is SharedPhase.OVER:
        return row((f" {_end(state, me)}", "good" if state.winner == me is not None else "bold")), scores
    return row((f" {_task(mode, state, me)}", "bold")), scores


def _task(mode: SharedMode, state: SharedGameState, me: int | None) -> str:
    if mode is SharedMode.RACE:
        return "First at the target wins."
    assert state.catcher is not None
    if me is None:
        return f"{state.names[state.catcher]} catches."
    return "You catch: touch the other robot." if state.catcher == me else "Do not get caught."


def _score(mode: SharedMode, state: SharedGameState, number: int) -> str:
    score = state.scores[number]
    return counted(round(score), "target") if mode is SharedMode.RACE else f"catcher for {score:.1f} s"


def _end(state: SharedGameState, me: int | None) -> str:
    if state.winner is None:
        return "Nobody has won."
    if me is not None:
        return "You have won." if state.winner == me else "The other player has won."
    return f"{state.names[state.winner] or NOBODY} has won."
