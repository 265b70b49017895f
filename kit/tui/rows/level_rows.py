"""The levels of a world, what is known of one, and what a drive earned, as rows of text. Pure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from kit.plain_text import counted
from kit.school.game.drive_records import DriveRecord
from kit.school.game.ghosts import Ghost, Split
from kit.school.game.levels import GameLevel, GameWorld
from kit.school.game.player_progress import GOLD_SHARE, SILVER_SHARE, ExtraRule, LevelProgress, Medal
from kit.school.game.race import DriverKind, RaceFinish
from kit.tui.widgets.text_rows import Row, row

TITLE_WIDTH: Final = 24
STAR, NO_STAR, SHUT = "*", ".", "-"
MEDAL_SIGNS: Final = {Medal.NONE: NO_STAR, Medal.BRONZE: "B", Medal.SILVER: "S", Medal.GOLD: "G"}
MEDAL_STYLES: Final = {Medal.NONE: "dim", Medal.BRONZE: "", Medal.SILVER: "bold", Medal.GOLD: "warn"}
WHO: Final = {DriverKind.KEYS: "by hand", DriverKind.CONTROLLER: "by program", DriverKind.AGENT: "by agent"}
HEADER: Final = "  level" + " " * (TITLE_WIDTH - 4) + "hand  program  agent   stars    best   gold at"
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


def world_levels(
    standings: Sequence[LevelProgress], chosen: str, references: dict[str, float | None]
) -> list[Row]:
    """One row for each level of a world. ``references``: the reference drive's time of each level [s]."""
    rows = [row((HEADER, "dim"))]
    for each in standings:
        level, is_chosen = each.level, each.level.id == chosen
        style = "chosen" if is_chosen else "" if each.is_open else "dim"
        medals: list[str | tuple[str, str]] = []
        for driver, width in zip(DriverKind, (6, 9, 8), strict=True):
            medal = each.medals.get(driver, Medal.NONE)
            sign = MEDAL_SIGNS[medal] if each.is_open else SHUT
            medals.append((f"{sign:<{width}}", MEDAL_STYLES[medal]))
        best = min(each.best_times.values(), default=None)
        reference = references.get(level.id)
        gold = f"{GOLD_SHARE * reference:7.2f} s" if reference is not None else ""
        rows.append(
            row(
                ("> " if is_chosen else "  ", "bold"),
                (f"{level.title:<{TITLE_WIDTH}.{TITLE_WIDTH}} ", style),
                *medals,
                (f"{STAR * each.star_count:{NO_STAR}<{len(ExtraRule)}}", "warn" if each.rules else "dim"),
                f"{best:7.2f} s" if best is not None else " " * 9,
                (gold, "dim"),
            )
        )
    return rows


def about(progress: LevelProgress, ghosts: Sequence[Ghost], reference: float | None) -> list[Row]:
    """What the chosen level asks for, and how it was driven."""
    level = progress.level
    first = (
        "" if not any(progress.first_edition) else f"   first edition {STAR * sum(progress.first_edition)}"
    )
    rows = [
        row((level.title, "bold"), f"  {level.story}", (first, "dim")),
        row(("task   ", "dim"), level.hint),
        row(
            ("needs  ", "dim"),
            level.skill,
            (f"   lesson {level.lesson_number}" if level.opened_by_lesson else "", "dim"),
        ),
    ]
    if not progress.is_open:
        return [*rows, row(("shut   ", "dim"), opens_after(level))]
    if reference is not None:
        rows.append(
            row(
                ("medals ", "dim"),
                f"gold {GOLD_SHARE * reference:.2f} s, silver {SILVER_SHARE * reference:.2f} s, bronze at the goal",
            )
        )
    times = [f"{WHO[driver]} {time:.2f} s" for driver, time in progress.best_times.items()]
    class_best = next((each for each in ghosts if each.name not in tuple(DriverKind)), None)
    classmate = "" if class_best is None else f"; {class_best.name} {class_best.seconds:.2f} s"
    rows.append(row(("best   ", "dim"), (", ".join(times) or "none yet") + classmate))
    return rows


def opens_after(level: GameLevel) -> str:
    """Says what opens a level."""
    lesson = f", or after lesson {level.lesson_number}" if level.opened_by_lesson else ""
    return f"opens after {' or '.join(level.opened_by)}{lesson}"


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
    if not finish.reached:
        return [row((f"   {NO_STAR} ", "dim"), ("no medal yet", "dim"))]
    better = " (new)" if record.medal > record.previous_medal else ""
    rows = [
        row(
            (f"   {MEDAL_SIGNS[record.medal]} ", MEDAL_STYLES[record.medal]),
            (f"{record.medal.title}{better}", "bold"),
        )
    ]
    for rule in record.rules:
        new = " (new)" if rule in record.new_rules else ""
        rows.append(row((f"   {STAR} ", "warn"), rule.description(level) + new))
    return rows


def compared(
    finish: RaceFinish, record: DriveRecord, reference: float | None, ghosts: Sequence[Ghost]
) -> list[Row]:
    """A drive's time beside the medals, the reference, the best so far and the class's best."""
    rows: list[Row] = []
    if not finish.reached:
        return rows
    times = [("reference", reference), ("your best before", record.previous_best)]
    times += [(each.name, each.seconds) for each in ghosts if each.name not in (*DriverKind, "reference")]
    for name, seconds in times:
        if seconds is not None:
            rows.append(row(f"   {name:<18} {seconds:7.2f} s  ", _difference(finish.seconds - seconds)))
    if reference is not None and record.medal is not Medal.GOLD and not record.is_shipped:
        share = SILVER_SHARE if record.medal < Medal.SILVER else GOLD_SHARE
        name = "silver" if record.medal < Medal.SILVER else "gold"
        missing = finish.seconds - share * reference
        text = f"{missing:.2f} s are missing for {name}" if missing > 0 else f"a bump keeps it from {name}"
        rows.append(row((f"   {text}.", "dim")))
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


def _difference(seconds: float) -> tuple[str, str]:
    return f"{seconds:+.2f}", "good" if seconds <= 0.0 else "warn"


BAR_WIDTH: Final = 20


def share_bar(share: float) -> str:
    """How far something is: ``share`` from 0 to 1, one character for a twentieth."""
    full = round(min(max(share, 0.0), 1.0) * BAR_WIDTH)
    return "█" * full + "░" * (BAR_WIDTH - full)
