"""The end of a level's drive: which rows it has on a screen of a size, and where they and the map stand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Final

from kit.document.rows import MARGIN, Row, broken, fitted, row, row_width, side_by_side
from kit.render.encode import Encoder
from kit.school.game.drive_records import DriveRecord
from kit.school.game.levels import GameLevel
from kit.school.game.race import DriverKind, RaceFinish
from kit.tui.rows import drive_end_rows
from kit.tui.rows.level_card_rows import Company, level_card
from kit.tui.rows.medal_rows import CORNER, drawn_columns, medal_drawing, medal_size
from kit.tui.rows.ruled_title import ruled_title

WIDTH: Final = 74
"""Columns of the text where the map stands beside it."""
FIXED_ROWS: Final = 2
"""Of a result: who drove, and the empty row below how it ended."""
ROWS_AROUND: Final = 2
"""Of the result: a note and the keys."""
NARROW: Final = 80
"""Columns from which on a small map stands beside medal, times and sectors."""
WIDE: Final = 110
"""Columns from which on the map stands beside the result."""
VAST: Final = 180
"""Columns from which on the charts have a column of their own, beside the map."""
CHARTS: Final = 54
"""Columns of the charts there."""
LEFT: Final = 46
"""Columns of medal, times and sectors where a small map stands beside these alone."""
LEAST_BESIDE_ROWS, MOST_BESIDE_ROWS = 9, 12
"""Of that map."""
LEAST_MAP_ROWS: Final = 7
"""Of the map below the result; where there are fewer it is left out. It comes there if it is larger than beside the result."""
LADDER_COLUMNS: Final = 46
"""Columns of the ladder beside the next level."""
NEXT_ROWS: Final = 7
"""Of the next level's picture."""
LEAST_CARD_ROWS: Final = 5
"""Of what the next level is about."""


class MapPlace(Enum):
    """Where the map stands."""

    BESIDE = "-wide"
    """Beside all of the text."""
    BETWEEN = "-vast"
    """Beside the text, with the charts on its other side."""
    BESIDE_TIMES = "-beside"
    """A small one, beside medal, times and sectors alone."""
    BELOW = "-high"
    NOWHERE = "-none"


@dataclass(slots=True, eq=False)
class DriveEnd:
    """All that is told of a drive that has ended, as rows; some of it is known later."""

    level: GameLevel
    driver: DriverKind
    finish: RaceFinish
    record: DriveRecord
    ladder: Sequence[Row]
    rungs: Sequence[Row]
    """The ladder with a row for each rung."""
    sentences: Sequence[str]
    """How it ended."""
    failed_line: Sequence[Row]
    """Of a program, at which it failed."""
    starts: Sequence[Row]
    times: Sequence[Row]
    """Beside others, and by sectors."""
    photo_finish: Sequence[Row]
    won: Sequence[Row]
    """What was won besides the medal."""
    speeds: Sequence[float]
    """[m/s], from the beginning to the end."""
    leads: Sequence[float] = ()
    """How far ahead of the reference it was on its way [s]."""
    needed: Sequence[Row] = ()
    """What all players needed."""
    next_picture: Sequence[str] = ()
    """The next level."""
    next_reference: float | None = None
    """The time of its reference drive [s]."""


@dataclass(frozen=True, slots=True)
class DriveEndPage:
    """The rows of a screen of one size."""

    place: MapPlace
    fixed: Sequence[Row]
    """Above those that appear: who drove, how it ended, and what came of it, where there is room for that."""
    revealed: Sequence[Row]
    """Those that appear one after the other."""
    medal_rows: int = 0
    """Of a drawn medal that stands between them; elsewhere those that appear stand beside it."""
    beside: Sequence[Row] = ()
    """Those of ``revealed`` that a small map stands beside, the first ones."""
    charts: Sequence[Row] = ()
    """What has a column of its own."""
    is_medal_in_corner: bool = False
    """Whether ``fixed`` leaves room on its right for a small drawn medal."""

    @property
    def room_above(self) -> int:
        """Rows above those that appear."""
        return len(self.fixed) + self.medal_rows


def drive_end_page(told: DriveEnd, width: int, height: int, encoder: Encoder) -> DriveEndPage:
    """The page for a screen of this many columns and rows."""
    if width >= VAST:
        return _with_charts_beside(told, width, height, encoder)
    if width >= WIDE:
        return _with_map_beside(told, width, height, encoder)
    page = _without_map(told, width, height)
    least = LEAST_MAP_ROWS if width < NARROW else MOST_BESIDE_ROWS + 1
    if height >= page.room_above + len(page.revealed) + ROWS_AROUND + least:
        return page
    if width >= NARROW:
        return _with_small_map(told, width, height, encoder)
    return DriveEndPage(MapPlace.NOWHERE, page.fixed, page.revealed)


def _with_charts_beside(told: DriveEnd, width: int, height: int, encoder: Encoder) -> DriveEndPage:
    """The text, the map, and the charts; the next level is told of where the text leaves room."""
    fixed, before = _fixed(told, width, height), _before_finish(told, height)
    room = height - len(fixed) - ROWS_AROUND
    rows = _fitting(before, told.photo_finish, told.won, told.needed, room)
    rows += _next_card(told, room - len(rows))
    high = height - ROWS_AROUND
    charts = _charts(told, CHARTS - MARGIN, high // 2, high, encoder)
    return DriveEndPage(MapPlace.BETWEEN, fixed, rows, charts=charts)


def _with_map_beside(told: DriveEnd, width: int, height: int, encoder: Encoder) -> DriveEndPage:
    """The text with charts where it leaves room, and the map."""
    fixed, before = _fixed(told, width, height), _before_finish(told, height)
    room = height - len(fixed) - ROWS_AROUND
    rows = _fitting(before, told.photo_finish, told.won, told.needed, room)
    left = room - len(rows)
    is_whole = len(rows) >= len(before) + len(told.photo_finish) + len(told.won) + len(told.needed)
    charts = [row(), *_charts(told, WIDTH - MARGIN, left // 2, left - 1, encoder)] if is_whole else []
    return DriveEndPage(MapPlace.BESIDE, fixed, [*rows, *(charts if len(charts) <= left else [])])


def _without_map(told: DriveEnd, width: int, height: int) -> DriveEndPage:
    """The text, above a map."""
    fixed, before = _fixed(told, width, height), _before_finish(told, height)
    room = height - len(fixed) - ROWS_AROUND
    rows = _fitting(before, told.photo_finish, told.won, told.needed, room)
    return DriveEndPage(MapPlace.BELOW, fixed, rows)


def _with_small_map(told: DriveEnd, width: int, height: int, encoder: Encoder) -> DriveEndPage:
    """A drawn medal above medal, times and sectors, or where there is no room for that in the upper right corner; the map beside
    these, and below both what else has room."""
    size = medal_size(height)
    medal = len(medal_drawing(told.record.medal, size))
    earned = _earned(told, LEFT)
    fixed = _fixed(told, width, height, medal_rows=medal, earned=earned)
    in_corner = [] if size else medal_drawing(told.record.medal, CORNER)
    narrower = _fixed(told, width - drawn_columns(CORNER) - MARGIN, height, earned=earned)
    least = max(LEAST_BESIDE_ROWS, len(earned) + len(told.times))
    least += sum(map(len, (narrower, told.ladder, told.starts, told.won)))
    is_in_corner = 0 < len(in_corner) <= len(narrower) and least + ROWS_AROUND <= height
    fixed = narrower if is_in_corner else fixed
    room = height - len(fixed) - medal - ROWS_AROUND
    rows = [*earned, *told.times]
    is_won_beside = _fit(rows, told.won)
    rows += told.won if is_won_beside else []
    are_rungs_beside = _fit(rows, told.rungs)
    rows += told.rungs if are_rungs_beside else []
    after = [] if is_won_beside else told.won
    below = [] if are_rungs_beside else told.ladder
    if len(below) + len(told.starts) + len(after) + max(LEAST_BESIDE_ROWS, len(rows)) <= room:
        below = [*below, *told.starts]
    left = room - len(below) - len(after)
    if left - len(told.photo_finish) >= max(LEAST_BESIDE_ROWS, len(rows)):
        left -= len(told.photo_finish)
    blank = min(max(LEAST_BESIDE_ROWS, left), MOST_BESIDE_ROWS) - len(rows)
    curve = drive_end_rows.speed_rows(told.speeds, told.finish.seconds, LEFT - MARGIN, blank, encoder)
    speed = [row(" ", *each) for each in curve]
    beside = [*rows, *speed, *[row()] * (blank - len(speed))]
    shown = _fitting([*beside, *below], told.photo_finish, after, told.needed, room)
    if (left := room - len(shown)) > 0 and len(shown) > len(beside) + len(below) + len(after):
        charts = _charts(told, WIDTH - MARGIN, 0 if speed else left // 2, left, encoder)
        shown += charts if len(charts) <= left else []
    return DriveEndPage(MapPlace.BESIDE_TIMES, fixed, shown, medal, beside, is_medal_in_corner=is_in_corner)


def _fixed(
    told: DriveEnd,
    width: int,
    height: int,
    *,
    medal_rows: int = 0,
    earned: Sequence[Row] | None = None,
) -> list[Row]:
    """Who drove and how it ended; with what came of it, where it pushes nothing off the screen."""
    width = min(WIDTH, width)
    sentence = [line for each in told.sentences for line in broken(row(f" {each}"), width)]
    sentence += [fitted(each, width) for each in told.failed_line]
    ending = drive_end_rows.ending(told.level, told.finish, width - MARGIN)
    earned = _earned(told, _width_beside_medal(told, height)) if earned is None else earned
    parts = (sentence, earned, told.times, told.ladder, told.won, ending)
    has_room = sum(map(len, parts)) + medal_rows + FIXED_ROWS + ROWS_AROUND <= height
    head = row((f" {told.level.title}, {told.driver.phrase}", "bold"))
    return [head, *sentence, *(ending if has_room else []), row()]


def _before_finish(told: DriveEnd, height: int) -> list[Row]:
    """Medal, times and ladder; a drawn medal stands on the left of the first two, and the next level beside the ladder."""
    earned = _earned(told, _width_beside_medal(told, height))
    if not medal_size(height):
        return [*earned, *told.ladder, *told.starts, *told.times]
    medal = len(medal_drawing(told.record.medal, medal_size(height)))
    rows = [*earned, *told.times]
    rungs = side_by_side(told.rungs, _next_rows(told), LADDER_COLUMNS)
    return [*rows, *[row()] * (medal - len(rows)), row(), *rungs, *told.starts]


def _next_rows(told: DriveEnd) -> list[Row]:
    """The next level as a picture below its title; none after the last one, and where this one was not finished."""
    following = told.record.following
    if following is None or not told.finish.reached:
        return []
    picture = told.next_picture or [""] * NEXT_ROWS
    return [row(("next level  ", "dim"), (following.title, "bold")), *map(row, picture)]


def _next_card(told: DriveEnd, room: int) -> list[Row]:
    """What the next level is about, below an empty row, as far as there is room."""
    following, columns = told.record.following, WIDTH - 2 * MARGIN
    if following is None or not told.finish.reached or room < LEAST_CARD_ROWS:
        return []
    card = level_card(following, told.driver, told.next_reference, (), columns, room - 1, Company())
    rows = [each for part in card.values() for each in part]
    title = ruled_title(f"next: {following.title}", columns)
    return [row(), *(row(" ", *each) for each in (title, *rows[1:]))] if rows else []


def _fitting(
    before: Sequence[Row], finish: Sequence[Row], after: Sequence[Row], needed: Sequence[Row], room: int
) -> list[Row]:
    """Without the photo finish, and then what others needed, where they would push others off the screen."""
    for rows in ([*before, *finish, *after, *needed], [*before, *after, *needed]):
        if len(rows) <= room:
            return rows
    return [*before, *after]


def _charts(told: DriveEnd, width: int, speed_room: int, room: int, encoder: Encoder) -> list[Row]:
    """The speed and the lead, each as high as there is room for; in ``room`` rows together."""
    seconds, width = told.finish.seconds, width - MARGIN
    speed = drive_end_rows.speed_rows(told.speeds, seconds, width, speed_room, encoder)
    lead = drive_end_rows.lead_rows(told.leads, seconds, width, room - len(speed), encoder)
    return [row(" ", *each) for each in (*speed, *lead)]


def _earned(told: DriveEnd, width: int) -> list[Row]:
    return drive_end_rows.earned(told.level, told.finish, told.record, width)


def _width_beside_medal(told: DriveEnd, height: int) -> int:
    size = medal_size(height)
    return WIDTH - MARGIN - (drawn_columns(size) if medal_drawing(told.record.medal, size) else 0)


def _fit(rows: Sequence[Row], more: Sequence[Row]) -> bool:
    """Whether more rows have room beside a small map."""
    return len(rows) + len(more) <= MOST_BESIDE_ROWS and all(row_width(each) <= LEFT for each in more)
