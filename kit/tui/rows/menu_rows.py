"""The menu of the start screen as rows of text: its lines, and below them what there is to do today."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from kit.document.rows import Row, row, side_by_side
from kit.plain_text import wrap

if TYPE_CHECKING:
    from kit.tui.student_store import StudentOverview

PANEL_WIDTH, WIDE_PANEL = 31, 60
"""Columns of the panel, and of the one that a wide screen has beside its robot, which is as high there as it can be."""
FRAME: Final = 2
"""Columns of the panel that are not drawn."""
MARGIN: Final = 2
"""Columns before a text."""
WIDE_ROWS: Final = 44
"""Rows from which on a wide panel says of every line what it opens."""
PICTURE: Final = 28
"""Columns of the next level's picture."""
PICTURE_ROWS: Final = 9
TITLE: Final = 11
"""Columns of a line's title."""


@dataclass(frozen=True, slots=True)
class MenuItem:
    """One line of the menu."""

    name: str
    """Name of the screen's method that opens it."""
    title: str
    note: str
    """What it is about in at most 12 columns, where there is nothing newer to tell of it."""
    about: str
    words: str = ""
    """Other words by which the palette finds it."""


MENU: Final = (
    MenuItem("next_lesson", "Next lesson", "", "The first step that is not done yet.", "continue learn"),
    MenuItem("lessons", "Lessons", "", "In order: predict, run, explain, change, make.", "course exercises"),
    MenuItem(
        "drive", "Drive", "any map", "Any map and any program, your own too.", "play simulate controller"
    ),
    MenuItem(
        "levels",
        "Game",
        "levels",
        "A hospital tries out its robot wheelchair: drive it.",
        "levels puzzles medals race story",
    ),
    MenuItem(
        "train",
        "Train",
        "agents learn",
        "Train an agent to drive, and watch it learn.",
        "trainings learning runs sweeps",
    ),
    MenuItem(
        "layers",
        "Layers",
        "collisions",
        "The fewest layers for what must collide and be seen.",
        "collisions planner",
    ),
    MenuItem(
        "quiz", "Quiz", "questions", "What do you know, and how sure are you?", "questions scores practice"
    ),
    MenuItem(
        "form", "Form", "survey", "What you knew before, and what you have learned.", "evaluation survey"
    ),
    MenuItem(
        "progress",
        "Progress",
        "what is done",
        "What you have done, and how to export it.",
        "medals streak results",
    ),
    MenuItem(
        "league",
        "League",
        "rated races",
        "Programs and agents race, play tag and are rated.",
        "tournament ratings",
    ),
)
MENU_KEYS: Final = "123456789l"
"""The keys of its lines."""


def menu(
    overview: StudentOverview | None,
    chosen: int,
    room: int,
    columns: int = PANEL_WIDTH,
    picture: Sequence[str] = (),
) -> list[Row]:
    """The menu, and as much below it as there are rows for. ``overview``: None while it is being read. ``columns``: of the
    panel; a wide and high one says of every line what it opens. ``picture``: of the next level, which such a one shows."""
    width = columns - FRAME
    is_wide = columns >= WIDE_PANEL and room >= WIDE_ROWS
    rows = [row()]
    for number, item in enumerate(MENU):
        rows.append(_item_row(number, item, _status(item.name, overview), number == chosen, width, is_wide))
        if item.name == "next_lesson":
            text, most = _next_step_text(overview), 2 if is_wide else 3
            rows += [row("     ", each) for each in _padded(text, most, width - 5)]
        elif is_wide:
            rows += [row("     ", (each, "dim")) for each in wrap(item.about, width - 5)]
    if not is_wide:
        about = _padded(MENU[chosen].about, 3, width - MARGIN)
        rows += [row(), *(row("  ", (each, "dim")) for each in about)]
    elif overview is not None:
        rows += [row()]
    if overview is None or not overview.is_whole:
        return rows
    from kit.tui.rows.today_rows import next_level_rows, today_rows, won_rows  # of no use to the first frame

    rows += today_rows(overview, width, room - len(rows))
    left = room - len(rows)
    if is_wide:
        level = next_level_rows(overview, picture, left)
        won = side_by_side(level, won_rows(overview, width - PICTURE - MARGIN), PICTURE + MARGIN)
        return [*rows, *won] if len(won) <= left else rows
    return [*rows, *won_rows(overview, width, left)]


def _item_row(number: int, item: MenuItem, status: str, is_chosen: bool, width: int, is_wide: bool) -> Row:
    """``is_wide``: whether what it opens stands below it, so that its note is of no use."""
    room, style = width - TITLE - 6, "chosen" if is_chosen else ""
    note = status or ("" if is_wide else item.note)
    return row(
        (">" if is_chosen else " ", "bold"),
        (f" {MENU_KEYS[number]}  ", "chosen" if is_chosen else "press"),
        (f"{item.title:<{TITLE}}", style),
        (f" {note:<{room}}", style or "dim"),
    )


def _next_step_text(overview: StudentOverview | None) -> str:
    """Names the step at which the student goes on."""
    if overview is None:
        return "Reading your progress ..."
    entry = overview.going_on
    if overview.problem:
        return "Progress cannot be read."
    if entry is None or entry.progress is None:
        return "Every lesson is done." if overview.shelf else "No lessons were installed."
    step = entry.progress.next_step
    where = f", step {step.number} of {len(entry.progress.lesson.steps)}" if entry.has_started else ""
    return f"Lesson {entry.number}, {entry.title}{where}"


def _status(name: str, overview: StudentOverview | None) -> str:
    if overview is None or overview.problem:
        return ""
    if name == "lessons":
        return f"{overview.done} of {len(overview.shelf)} done"
    if not overview.is_whole:
        return ""
    if name == "levels":
        if not overview.has_run_today:
            return f"maze: day {overview.streak + 1}" if overview.streak else "today's maze"
        return f"streak {overview.streak}" if overview.streak else ""
    if name == "quiz" and overview.due:
        return f"{overview.due} due today"
    if name == "train" and overview.running:
        return f"{len(overview.running)} running"
    return ""


def _padded(text: str, rows: int, width: int) -> list[str]:
    lines = wrap(text, width, most=rows)
    return lines + [""] * (rows - len(lines))
