"""The menu of the start screen as rows of text. Pure."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass
from typing import Final

from kit.tui.student_store import StudentOverview
from kit.tui.widgets.text_rows import Row, row

PANEL_WIDTH: Final = 31
TEXT: Final = PANEL_WIDTH - 2


@dataclass(frozen=True, slots=True)
class MenuItem:
    """One line of the menu."""

    name: str
    """Of the screen's method that opens it."""
    title: str
    about: str


MENU: Final = (
    MenuItem("continue", "Continue", ""),
    MenuItem("lessons", "Lessons", "All of them, in order: predict, run, explain, change, make."),
    MenuItem("drive", "Drive", "Any map and any program, your own too."),
    MenuItem("levels", "Levels", "The game: stars, ghosts, races against what you wrote and trained."),
    MenuItem("train", "Train", "Train an agent to drive, and watch it learn."),
    MenuItem("layers", "Layers", "Who collides, who is seen: the fewest layers for it."),
    MenuItem("quiz", "Quiz", "What do you know, and how sure are you?"),
    MenuItem("form", "Form", "What you knew before, what you learned, how the kit served you."),
    MenuItem("progress", "Progress", "What you have done, and how to take it to another machine."),
)


def menu(overview: StudentOverview | None, chosen: int) -> list[Row]:
    """The menu, always as many rows. ``overview``: None while it is being read."""
    rows = [row()]
    for number, item in enumerate(MENU):
        is_chosen = number == chosen
        title = _continue_label(overview) if item.name == "continue" else item.title
        status = _status(item.name, overview)
        rows.append(
            row(
                (">" if is_chosen else " ", "bold"),
                (f" {number + 1}  ", "chosen" if is_chosen else "press"),
                (f"{title:<9}", "chosen" if is_chosen else ""),
                (f"  {status:<{TEXT - 14}}", "chosen" if is_chosen else "dim"),
            )
        )
        if item.name == "continue":
            rows += [row("     ", each) for each in _padded(_next_step_text(overview), 3, TEXT - 5)]
    about = _padded(MENU[chosen].about, 3, TEXT)
    return [*rows, row(), *(row("  ", (each, "dim")) for each in about)]


def _continue_label(overview: StudentOverview | None) -> str:
    return "Begin" if overview is not None and overview.is_new else "Continue"


def _next_step_text(overview: StudentOverview | None) -> str:
    """Where one goes on."""
    if overview is None:
        return ""
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
    if name == "quiz" and overview.due:
        return f"{overview.due} due today"
    return ""


def _padded(text: str, rows: int, width: int) -> list[str]:
    lines = textwrap.wrap(text, width, max_lines=rows, placeholder=" ...")
    return lines + [""] * (rows - len(lines))
