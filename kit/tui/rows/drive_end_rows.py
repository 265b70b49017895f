"""What a drive of a level earned, as rows of text: time, medal, sectors, what was won besides."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from kit.document.rows import Row, row
from kit.host.failure import Failure, syntax_error
from kit.plain_text import counted, wrap
from kit.render.curve import Axes, Curve, draw_curves
from kit.render.encode import Encoder
from kit.school.game.daily import DAILY_PREFIX
from kit.school.game.drive_records import DriveRecord
from kit.school.game.ghosts import Ghost, Split
from kit.school.game.levels import GameLevel, all_worlds
from kit.school.game.players_histogram import HistogramBin
from kit.school.game.race import STUCK_TIME, DriverKind, RaceFinish
from kit.school.game.starts import SHIFT_M, SHIFT_RAD
from kit.tui.rows.level_rows import BAR
from kit.tui.rows.medal_rows import medal_row
from kit.tui.rows.medal_signs import STAR
from kit.tui.rows.ruled_title import ruled_title

LEAST_BACKWARDS: Final = 0.02
"""m/s, from which on a drive has driven backwards."""
LEAST_CURVE_ROWS, HIGHEST_CURVE = 4, 22
"""Rows of a curve with its title and its scale."""
SCALE: Final = 7
"""Columns of the scale before a curve."""
RUN_OF_THE_DAY: Final = "this run counts; what follows is practice"
REPLACES: Final = "it replaces a best that this kit drives differently"
FILL: Final = "\u2501"
"""Of bars."""
OTHER_STARTS: Final = (
    f"At the others the robot stands up to {SHIFT_M[1] * 100:.0f} cm aside, is turned by up to {math.degrees(SHIFT_RAD[1]):.0f} "
    "degrees and veers: steer by what it senses."
)
MARK: Final = 5
"""Columns of a star before what it is for."""


def finish_sentence(finish: RaceFinish) -> str:
    """How a drive ended."""
    if finish.foul:
        return f"It does not count: {finish.foul}."
    if finish.failure is not None:
        return f"The program stopped: {finish.failure}"
    if finish.reached:
        apart = ", and the pair was apart for too long" if finish.is_apart else ""
        bumps = counted(finish.collisions, "bump")
        return f"Finished after {finish.seconds:.2f} s, with {bumps}{apart}."
    shortfall = f": {finish.shortfall}" if finish.shortfall else ""
    if finish.is_stuck:
        return f"Stuck after {finish.seconds:.0f} s, touching something for {STUCK_TIME:.0f} s without moving{shortfall}."
    return f"Not finished in {finish.seconds:.0f} s{shortfall}."


def failed_line(failure: Failure | None, program: Path | None) -> list[Row]:
    """The line of a program at which it failed, and below it where in it Python cannot read on; nothing where that is not in
    the program's own file."""
    if failure is None or failure.line is None or program is None or failure.file != program.name:
        return []
    try:
        text = program.read_text(encoding="utf-8", errors="replace")
        line = text.splitlines()[failure.line - 1]
    except (OSError, IndexError):
        return []
    number = f"   {failure.line:>4}  "
    rows = [row((number, "dim"), (line.expandtabs(4), "code"))]
    error = syntax_error(text)
    if error is not None and error.lineno == failure.line and error.offset:
        before = line[: error.offset - 1].expandtabs(4)
        rows.append(row(" " * (len(number) + len(before)), ("^", "bad")))
    return rows


def how_it_ended(finishes: Sequence[RaceFinish], counts: int, *, was_watched: bool = True) -> list[str]:
    """How a drive ended; of a program's drives first the one from the level's own start, which may have been watched, then
    which of them counts and why."""
    said = finish_sentence(finishes[counts])
    if len(finishes) == 1 or all(each.failure is not None for each in finishes):
        return [said]
    first = finish_sentence(finishes[0])
    if said == first:
        return [f"{said} Of {len(finishes)} starts the middle one counts."]
    told = [
        f"{'You watched start 1' if was_watched else 'Start 1'}: {first}",
        f"The middle one counts, start {counts + 1} of {len(finishes)}: {said}",
    ]
    if finishes[0].reached and not finishes[counts].reached:
        told.append(OTHER_STARTS)
    return told


def ending(level: GameLevel, finish: RaceFinish, width: int) -> list[Row]:
    """What came of a drive that has reached its goal, in the level's story."""
    return [row(f" {each}") for each in wrap(level.ending, width) if each and finish.reached]


def earned(level: GameLevel, finish: RaceFinish, record: DriveRecord, width: int) -> list[Row]:
    """The medal and the stars of a drive, in the order in which they appear, in rows of at most ``width`` columns."""
    if record.is_shipped:
        return [row(" " * MARK, "a controller of the kit drove: it shows the way and earns nothing")]
    if record.is_practice:
        return [row(" " * MARK, "practice: the first run of the day has counted")]
    if not level.has_medals:
        return [row(("   your best time so far", "good"))] if record.is_best else []
    if not finish.reached:
        needed = level.skill_sentence if finish.failure is None else ""
        skill = [row(" " * MARK, each) for each in wrap(needed, width - MARK) if each]
        return [row(" " * MARK, ("no medal yet", "dim")), *skill]
    rows = [medal_row(record.medal, is_new=record.medal > record.previous_medal)]
    for rule in record.rules:
        new = " (new)" if rule in record.new_rules else ""
        first, *rest = wrap(rule.description(level) + new, width - MARK)
        rows.append(row((f"   {STAR} ", "warn"), first))
        rows += [row(" " * MARK, each) for each in rest]
    return rows


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
            (FILL * max(1, round(BAR * each.sector / longest)), "good" if each.difference <= 0 else ""),
            "  ",
            _difference(each.difference),
        )
        for number, each in enumerate(splits, 1)
    ]


def lead_rows(leads: Sequence[float], seconds: float, width: int, room: int, encoder: Encoder) -> list[Row]:
    """A curve of how far ahead of the reference a drive of ``seconds`` was, from its beginning to its end, in at most ``room``
    rows; none for fewer than ``LEAST_CURVE_ROWS``."""
    title = "ahead of the reference"
    return _curve_rows(title, "s, below 0: behind", leads, seconds, width, room, Axes("s", goal=0.0), encoder)


def speed_rows(
    speeds: Sequence[float], seconds: float, width: int, room: int, encoder: Encoder, title: str = "speed"
) -> list[Row]:
    """The same of the speed ahead; what is driven backwards is below dashes."""
    backwards = min(speeds, default=0.0) < -LEAST_BACKWARDS
    note, axes = (
        ("m/s, below 0: backwards", Axes("s", goal=0.0)) if backwards else ("m/s", Axes("s", low=0.0))
    )
    return _curve_rows(title, note, speeds, seconds, width, room, axes, encoder)


def _curve_rows(
    title: str,
    note: str,
    values: Sequence[float],
    seconds: float,
    width: int,
    room: int,
    axes: Axes,
    encoder: Encoder,
) -> list[Row]:
    """A curve over the time of a drive below its title."""
    if len(values) < 2 or room < LEAST_CURVE_ROWS:
        return []
    curve = Curve("", np.linspace(0.0, seconds, len(values)), np.array(values))
    axes = replace(axes, end=seconds, margin=SCALE)
    frame = draw_curves([curve], axes, width, min(room, HIGHEST_CURVE), encoder)
    drawn = [row((each[:SCALE], "dim"), (each[SCALE:], "code")) for each in frame.rows()[1:-1]]
    return [ruled_title(title, width, note), *drawn, row((frame.rows()[-1], "dim"))]


def needed_rows(bins: Sequence[HistogramBin], width: int, unit: str = "s", decimals: int = 2) -> list[Row]:
    """A histogram of what all players of this machine needed; empty for one without bins."""
    most = max((each.count for each in bins), default=0)
    if not most:
        return []
    players = sum(each.count for each in bins)
    rows = [row((f"   what {players} players here needed", "title"))]
    for each in bins:
        start = f"   to {each.high:7.{decimals}f} {unit}  {each.count:3} "
        own = " < you" if each.holds_own else ""
        longest = max(1, min(BAR, width - len(start) - len(" < you")))
        bar = FILL * max(1, round(longest * each.count / most)) if each.count else ""
        rows.append(row(start, bar, (own, "bold")))
    return rows


def won_besides(level: GameLevel, record: DriveRecord) -> list[Row]:
    """What a drive has won besides its medal and stars: levels that it opens, a belt, a day of the streak; and whether it is the
    run of the day."""
    rows = []
    if level.id.startswith(DAILY_PREFIX) and not record.is_practice:
        rows.append(row(("   today:  ", "dim"), (RUN_OF_THE_DAY, "good")))
    if record.replaces:
        rows.append(row(("   board:  ", "dim"), REPLACES))
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
