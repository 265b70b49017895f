"""The game's levels as rows of text: medals, what is known of a level, its starts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from kit.document.rows import Row, row, row_width
from kit.plain_text import wrap
from kit.school.game.daily import DAILY_PREFIX
from kit.school.game.levels import GameLevel, GameWorld, all_levels
from kit.school.game.medal import RUNGS, Medal
from kit.school.game.ordinary_drives import ordinary_drives
from kit.school.game.player_progress import ExtraRule, GameSummary, LevelProgress, belt_of, next_belt
from kit.school.game.race import STUCK_TIME, DriverKind, RaceFinish
from kit.school.game.starts import SHIFT_M, SHIFT_RAD, STARTS
from kit.tui.rows.ladder_rows import ABOUT_BAR, LADDERS, LIST_BAR, ladder_bar, ladder_words
from kit.tui.rows.medal_signs import MEDAL_SIGNS, MEDAL_STYLES, NO_STAR, STAR

TITLE_WIDTH: Final = 24
NARROW_TITLE: Final = 17
COLUMNS: Final = "hand  program  agent  stars    best"
MEDAL_WIDTHS: Final = (6, 9, 7)
"""Columns of the medals by hand, by program and by agent."""
WHOLE: Final = 79
"""Columns of the list with its ladders."""
ABOUT_LABEL, LADDER_LABEL = 7, 15
"""Columns of what stands before a text and before a ladder below the list."""
LADDER_WORDS: Final = LADDER_LABEL + 29
"""Columns around a ladder there: whose it is, one's time and what the next rung asks for."""
THUMBNAIL: Final = 20, 7
"""Columns and rows of the chosen level's map where it stands beside what is said of the level."""
BAR: Final = 12
"""Columns of the longest sector's bar."""


def world_heading(world: GameWorld, number: int, count: int, best: Sequence[Medal], width: int) -> list[Row]:
    """A world's name, the belt earned in it by the ``best`` medal of each level, what the next belt asks for where there is
    room, and its story."""
    following = next_belt(best)
    asked = "" if following is None else f", {following.name} for {following.task}"
    title, others = (
        row((f" World {number} of {count}: {world.title}", "bold")),
        ("   left, right: other worlds", "dim"),
    )
    whole = row(*title, f"   {belt_of(best)} belt", (asked, "dim"), others)
    first = whole if row_width(whole) <= width else row(*title, f"   {belt_of(best)} belt", others)
    return [first, row((f" {world.story}", "dim"))]


def medal_counts(summary: GameSummary) -> str:
    """All medals and stars, on one line."""
    counts = [
        f"{each.title} {summary.count(each)}"
        for each in reversed(RUNGS)
        if each <= Medal.GOLD or summary.count(each)
    ]
    return "  ".join([*counts, f"stars {summary.stars}"])


def game_progress(summary: GameSummary) -> list[Row]:
    """One row for all that was won, and one for each world: the best medal of each of its levels, how many have one, and its
    belt."""
    worlds = summary.best_by_world
    titles, signs = max(map(len, worlds)), max(map(len, worlds.values()))
    rows = []
    for title, entries in worlds.items():
        won = sum(medal is not Medal.NONE for medal in entries)
        medals = ((MEDAL_SIGNS[medal], MEDAL_STYLES[medal]) for medal in entries)
        blanks = " " * (signs - len(entries))
        figures = f"{won:>2} of {len(entries):<3} {belt_of(entries)} belt"
        rows.append(
            row(f"  {title:<{titles}}  ", *medals, f"{blanks}  ", (figures, "bold" if won else "dim"))
        )
    return [row(f"  {medal_counts(summary)}"), row(), *rows]


def world_levels(
    standings: Sequence[LevelProgress], chosen: str, references: dict[str, float | None], width: int
) -> list[Row]:
    """One row for each level of a world. ``references``: the reference drive's time of each level [s]. The ladders are left out
    where they do not fit ``width``."""
    is_whole = width >= WHOLE
    title_width = TITLE_WIDTH if is_whole else NARROW_TITLE
    rows = [row((f"  {'level':<{title_width}} {COLUMNS}" + "   ladder" * is_whole, "dim"))]
    for each in standings:
        level, is_chosen = each.level, each.level.id == chosen
        style = "chosen" if is_chosen else "" if each.is_open else "dim"
        title = (
            ("> " if is_chosen else "  ", "bold"),
            (f"{level.title:<{title_width}.{title_width}} ", style),
        )
        if not each.is_open:
            rows.append(row(*title, (opens_after(level) if is_whole else "locked", "dim")))
            continue
        medals: list[str | tuple[str, str]] = []
        for driver, width in zip(DriverKind, MEDAL_WIDTHS, strict=True):
            medal = each.medals.get(driver, Medal.NONE)
            medals.append((f"{MEDAL_SIGNS[medal]:<{width}}", MEDAL_STYLES[medal]))
        best = min(each.best_times.values(), default=None)
        reference = references.get(level.id)
        driver = each.best_driver
        bar = (
            ()
            if reference is None or not is_whole
            else ladder_bar(
                driver,
                reference,
                each.best_times.get(driver),
                LIST_BAR,
                ordinary=ordinary_drives(level, [driver]),
            )
        )
        rows.append(
            row(
                *title,
                *medals,
                (f"{STAR * each.star_count:{NO_STAR}<{len(ExtraRule)}}", "warn" if each.rules else "dim"),
                f"{best:8.2f} s  " if best is not None else " " * 12,
                *bar,
            )
        )
    return rows


def about(progress: LevelProgress, reference: float | None, width: int, room: int) -> list[Row]:
    """What the chosen level asks for, and how it was driven, in at most ``width`` columns. In fewer than ``room`` rows there is
    also the skill that it takes."""
    level = progress.level
    lead = f"{level.title}  "
    first, *rest = wrap(level.story, width, first=" " * len(lead))
    rows = [row((lead, "bold"), first.lstrip()), *map(row, rest), *_labelled("task", level.hint, width)]
    skill, best = _labelled("skill", level.skill, width), progress.best_times
    if not progress.is_open:
        standing = _labelled("locked", opens_after(level), width)
    elif reference is None:
        times = [f"{driver.phrase} {time:.2f} s" for driver, time in best.items()]
        standing = _labelled("best", ", ".join(times) or "none yet", width)
    else:
        bar = max(LIST_BAR, min(ABOUT_BAR, width - LADDER_WORDS))
        standing = []
        for drivers in LADDERS:
            driver = min(drivers, key=lambda each: best.get(each, math.inf))
            ordinary = ordinary_drives(level, [driver] if driver in best else drivers)
            standing.append(
                row(
                    (f"{', '.join(each.value for each in drivers):<{LADDER_LABEL}}", "dim"),
                    *ladder_bar(driver, reference, best.get(driver), bar, ordinary=ordinary),
                    ladder_words(driver, reference, best.get(driver)),
                )
            )
    return [*rows, *(skill if len(rows) + len(skill) + len(standing) < room else []), *standing]


def _labelled(label: str, text: str, width: int) -> list[Row]:
    """A text behind its label."""
    first, *rest = wrap(text, width - ABOUT_LABEL)
    return [
        row((f"{label:<{ABOUT_LABEL}}", "dim"), first),
        *(row(" " * ABOUT_LABEL, each) for each in rest),
    ]


def way_to_agent(level: GameLevel) -> str:
    """How to come to an agent for a level."""
    command = f"`kit task new mine --level {level.id}`"
    return f"{command} makes a task for it, and says how to train an agent and race it here."


def other_start(number: int, seconds: float) -> Row:
    """What is said while a program drives from its other starts."""
    return row(
        (f" From {STARTS} starts, of which the middle drive counts: ", "dim"),
        f"start {number}, {seconds:.0f} s",
    )


def starts_rows(finishes: Sequence[RaceFinish], counts: int) -> list[Row]:
    """The times of a program's drives from all starts, ``-`` where it did not arrive, the one that counts in brackets; none for
    a single drive and for a program that never ran."""
    if len(finishes) < 2 or all(each.failure is not None for each in finishes):
        return []
    times = [f"{each.seconds:.2f} s" if each.reached else "-" for each in finishes]
    times = [f"[{time}]" if number == counts else time for number, time in enumerate(times)]
    return [row((f"   {len(times)} starts  ", "dim"), "  ".join(times))]


def opens_after(level: GameLevel) -> str:
    """Says what opens a level: any of these."""
    titles = {each.id: each.title for each in all_levels()}
    lesson = [f"lesson {level.lesson_number}"] if level.opened_by_lesson else []
    return f"opens after {' or '.join([*(titles[each] for each in level.opened_by), *lesson])}"


def before_it_goes_on(seconds: float) -> list[Row]:
    """What stands below the picture of a drive that was cut short, until it goes on. ``seconds``: of it [s]."""
    text = f" This drive was cut short after {seconds:.1f} s."
    return [row((text, "bold")), row(" It goes on with your first key; r starts anew.")]


PROGRAM_NOTES: Final = (
    (
        "program, agent",
        (
            "drives on after a bump, without the star; the drive ends when it is stuck: "
            f"{STUCK_TIME:.0f} s in touch with something, without moving"
        ),
    ),
    (
        "starts",
        (
            f"it drives from {STARTS}: the level's own, then others shifted by up to {100 * SHIFT_M[1]:.0f} cm and turned by up to "
            f"{math.degrees(SHIFT_RAD[1]):.0f} degrees; the middle result counts"
        ),
    ),
)
"""What is said of drives by programs and agents where keys are explained."""
NOT_BEGUN: Final = {
    False: "The drive has not begun.",
    True: "Today's run has not begun: d still drives it.",
}
"""What is said once Esc has stopped the preparation of a drive: of a level, of the maze of the day."""
GIVES_UP: Final = row(
    (" This run counts for today.", "bold"), " Once more: Esc gives it up, r starts a practice run."
)
"""What is said before the run of the day is left."""


def before_the_start(
    level: GameLevel,
    ghosts: Sequence[str],
    width: int,
    *,
    task_in_sight: bool,
    is_practice: bool = False,
) -> list[Row]:
    """What stands below the picture until somebody drives: the task, unless it is in sight beside the picture, and who is
    raced. ``ghosts``: letter, driver and time of each; those are shown for which there is room. ``is_practice``: of the day's
    level, whose first run has counted."""
    start = " The clock starts with your first key."
    if level.id.startswith(DAILY_PREFIX):
        start += (
            " Practice: today's run has counted."
            if is_practice
            else " This run counts, also if you leave it."
        )
    if task_in_sight:
        return [row((start, "bold")), row((_listed(ghosts, " You race: ", width), "dim"))]
    hint = f" {level.hint}"
    raced = _listed(ghosts, "  You race: ", width - len(start))
    below = "" if raced else _listed(ghosts, "  You race: ", width - len(hint))
    return [row((start, "bold"), (raced, "dim")), row(hint, (below, "dim"))]


def _listed(items: Sequence[str], lead: str, width: int) -> str:
    """As many items after the lead as there is room for; nothing without any."""
    shown = ""
    for each in items:
        longer = f"{shown}, {each}" if shown else lead + each
        if len(longer) > width:
            break
        shown = longer
    return shown
