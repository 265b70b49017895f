"""A level's card as rows of text: its story and task, the rungs of its ladder, its stars, and the sectors of one's best drive."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Final, NamedTuple

from kit.document.blocks import labelled_table
from kit.document.layout import Page, rows_of
from kit.document.rows import Row, row, row_width, side_by_side
from kit.plain_text import wrap
from kit.school.game.ghosts import Ghost, Split, compare_tracks
from kit.school.game.levels import GameLevel
from kit.school.game.ordinary_drives import ordinary_drives
from kit.school.game.player_progress import ExtraRule, offered_rules
from kit.school.game.race import DriverKind
from kit.tui.rows.drive_end_rows import sector_rows
from kit.tui.rows.ladder_rows import RESULT_BAR, in_reach_row, ladder_bar, rung_rows
from kit.tui.rows.medal_signs import NO_STAR, STAR
from kit.tui.rows.ruled_title import ruled_title

COLUMN: Final = 54
"""Columns of the stars where the sectors stand beside them."""
GAP: Final = 2
PARTS: Final = ("story", "task", "skill", "ladder", "rungs", "stars", "rivals", "sectors")
"""Parts of a card, from top to bottom."""
BY_WORTH: Final = ("story", "ladder", "rungs", "task", "stars", "skill", "rivals", "sectors")
"""The part that is left out last before the others."""
NARROW_BY_WORTH: Final = ("task", "ladder", "rungs", "stars", "skill", "story", "rivals", "sectors")
"""The same in a narrow panel, where a story takes the rows of all else: it stood beside the list of levels."""
TWO_RUNGS: Final = 43
"""Columns of the card of a drive from which on two rungs stand beside each other."""
LEAST_WIDTH: Final = 16
"""Columns of a card."""
WIDE: Final = 46
"""Columns of a card from which on it tells of other drives."""


class Rival(NamedTuple):
    """Whom one races: the letter on the map, who it is, and the time of the drive [s]."""

    letter: str
    who: str
    seconds: float


class Standing(NamedTuple):
    """How a drive stands that is not over."""

    seconds: float
    """Its time so far [s]."""
    is_flawed: bool
    """Whether it gets bronze at best."""


class Company(NamedTuple):
    """What a level's earlier drives add to its card: who races there, and the best of one's own by sectors."""

    rivals: Sequence[Rival] = ()
    best: tuple[DriverKind, Sequence[Split]] | None = None


def level_card(
    level: GameLevel,
    driver: DriverKind,
    reference: float | None,
    kept: Collection[ExtraRule],
    width: int,
    room: int,
    company: Company,
    standing: Standing | None = None,
) -> dict[str, list[Row]]:
    """What a level is about, by part: story, task, the rungs of its ladder, the rules that earn stars, and what is known of
    others' and one's own drives. Parts for which there is no room are left out whole. ``kept``: the rules that a drive has
    kept already. ``standing``: of a drive that goes on or is to begin, whose place on the ladder is shown."""
    if width < LEAST_WIDTH:  # the screen has no size yet
        return {}
    ladder, rungs = ([], []) if reference is None else _ladder_rows(level, driver, reference, width, standing)
    stars = [] if reference is None else star_rows(level, kept, width)
    rows = (
        [ruled_title("level", width), *(row(line) for line in wrap(level.story, width))],
        [ruled_title("task", width), *(row((line, "bold")) for line in wrap(level.hint, width))],
        [row((line, "dim")) for line in wrap(level.skill_sentence, width)],
        ladder,
        rungs,
        stars,
        *(([], []) if width < WIDE else _company_rows(company, width)),
    )
    parts = {name: part for name, part in zip(PARTS, rows, strict=True) if part}
    shown: set[str] = set()
    worth = BY_WORTH if width >= WIDE else NARROW_BY_WORTH
    for name in filter(parts.__contains__, worth):
        if sum(len(parts[each]) for each in (*shown, name)) <= room:
            shown.add(name)
    return {name: part for name, part in parts.items() if name in shown}


def _ladder_rows(
    level: GameLevel, driver: DriverKind, reference: float, width: int, standing: Standing | None
) -> tuple[list[Row], list[Row]]:
    """The ladder, on it a drive that goes on with the best medal that it can still earn; and its rungs with their times."""
    ordinary = ordinary_drives(level, [driver])
    ladder = [ruled_title("ladder", width, driver.phrase)]
    rungs = rung_rows(driver, reference, ordinary=ordinary)
    seconds = None if standing is None else standing.seconds or None
    is_flawed = standing is not None and standing.is_flawed
    ladder.append(row(*ladder_bar(driver, reference, seconds, min(width, RESULT_BAR), is_flawed, ordinary)))
    if standing is not None:
        ladder.append(in_reach_row(driver, reference, *standing))
        rungs = rung_rows(
            driver, reference, lost_after=standing.seconds, is_flawed=is_flawed, ordinary=ordinary
        )
    if standing is not None and width >= TWO_RUNGS:
        half = (len(rungs) + 1) // 2
        rungs = side_by_side(rungs[:half], rungs[half:], width // 2)
    return ladder, rungs


def _company_rows(company: Company, width: int) -> tuple[list[Row], list[Row]]:
    """Whom one races, each with the letter on the map, and the sectors of one's best drive."""
    table = labelled_table(
        [(each.letter, each.who, f"{each.seconds:.2f} s") for each in company.rivals], is_tight=True
    )
    rivals = [ruled_title("on the map", width), *rows_of([table], Page(width=width))]
    sectors = [] if company.best is None else _sector_rows(*company.best, width)
    return rivals if company.rivals else [], sectors


def _sector_rows(driver: DriverKind, splits: Sequence[Split], width: int) -> list[Row]:
    """The sectors of one's best drive."""
    return [ruled_title("sectors", width, f"best {driver.phrase}"), *sector_rows(splits)]


def star_rows(level: GameLevel, kept: Collection[ExtraRule], width: int) -> list[Row]:
    """The rules that earn stars, those that a drive has kept with theirs."""
    rows = [ruled_title("stars", width)]
    for rule in offered_rules(level):
        sign, style, text = NO_STAR, "", rule.description(level)
        if rule in kept:
            sign, style = STAR, "warn"
        first, *rest = wrap(text, width - 2)
        rows += [row((f"{sign} ", style), first), *(row("  ", each) for each in rest)]
    return rows


def star_line(level: GameLevel, kept: Collection[ExtraRule]) -> Row:
    """The same on one row, in few words."""
    rules = (
        (STAR if rule in kept else NO_STAR, "warn" if rule in kept else "", rule)
        for rule in offered_rules(level)
    )
    parts = [part for sign, style, rule in rules for part in ((f"  {sign} ", style), rule.short_name(level))]
    return row((" stars", "dim"), *parts)


def best_splits(ghosts: Sequence[Ghost]) -> tuple[DriverKind, tuple[Split, ...]] | None:
    """The sectors of one's quickest drive of a level, and who drove it; None without one, or without a reference."""
    reference = next((each for each in ghosts if each.name == "reference"), None)
    own = [
        (each, driver)
        for each in ghosts
        for driver in DriverKind
        if each.name == driver.value and each.tracks
    ]
    if reference is None or not own:
        return None
    ghost, driver = min(own, key=lambda each: each[0].seconds)
    return driver, compare_tracks(ghost.tracks[0], ghost.step_size, reference, ghost.seconds)


def stars_and_sectors(
    level: GameLevel, kept: Collection[ExtraRule], best: tuple[DriverKind, Sequence[Split]] | None, width: int
) -> list[Row]:
    """The stars of a level, and where there is room beside them, the sectors of one's best drive. ``width``: of all, more
    than ``COLUMN``."""
    stars = star_rows(level, kept, COLUMN - GAP)
    sectors = [] if best is None else _sector_rows(*best, width - COLUMN)
    if not sectors or COLUMN + max(map(row_width, sectors)) > width:
        return [row(" ", *each) for each in stars]
    return [row(" ", *each) for each in side_by_side(stars, sectors, COLUMN)]
