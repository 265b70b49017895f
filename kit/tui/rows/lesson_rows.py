"""The rows around a lesson's step: its heading, its title, its file, the check."""

from __future__ import annotations

from typing import Final

from kit.document.blocks import Table, Tone, ToneText, labelled_table
from kit.document.rows import Row, at_both_edges, row, row_width
from kit.school.lessons.catalogue import LessonProgress
from kit.school.lessons.records import LessonStep, StepKind
from kit.tui.rows.progress_marks import progress_bar, stars

LONGEST_BAR: Final = 12
LEAST_GOAL: Final = 8

KINDS: Final = {
    StepKind.PREDICT: "Predict",
    StepKind.RUN: "Run",
    StepKind.EXPLAIN: "Read",
    StepKind.MODIFY: "Change",
    StepKind.MAKE: "Make",
}


def steps_table(progress: LessonProgress, here: LessonStep | None = None, first: int = 0) -> Table:
    """The steps of a lesson: which are done, their kinds and titles, and the stars of exercises that were tried. ``here``:
    where one stands. ``first``: the steps before this one, counted from 0, are left out."""
    rows = []
    for step in progress.lesson.steps[first:]:
        is_done, is_here = progress.is_step_completed(step), here is not None and step.number == here.number
        mark = "[x]" if is_done else "[>]" if is_here else "[ ]"
        earned = (
            stars(progress, step.exercise.name)
            if step.exercise is not None and step.exercise.name in progress.best_shares
            else ""
        )
        rows.append(
            (
                ToneText(mark, Tone.GOOD if is_done else Tone.BOLD if is_here else Tone.DIM),
                ToneText(KINDS[step.kind], Tone.DIM),
                ToneText(step.title, Tone.BOLD if is_here else Tone.PLAIN),
                *((ToneText(earned, Tone.WARN),) if progress.best_shares else ()),
            )
        )
    return labelled_table(rows, is_tight=True)


def heading(progress: LessonProgress, step: LessonStep, width: int) -> Row:
    """Lesson, goal, which step of how many, and a bar of what is done. Where not all fit, the bar gives way, then the goal:
    the lesson's title is whole."""
    count = len(progress.lesson.steps)
    bar = progress_bar(progress, step) if count <= LONGEST_BAR else ""
    title = f"{progress.lesson.number} {progress.lesson.title}"
    where, goal = f"step {step.number} of {count} ", step.goal
    room = width - len(title) - len(where) - 4
    if len(goal) > room - len(bar):
        bar = ""
    if len(goal) > room:
        goal = f"{goal[: room - 3].rstrip()}..." if room >= LEAST_GOAL else ""
    left = row((title, "title"), "  ", (goal, "dim")) if goal else row((title, "title"))
    return at_both_edges(left, row(where, (bar, "bold")), width)


def fits_beside_title(step: LessonStep, caption: Row, width: int) -> bool:
    """Whether a step's whole title and a caption fit on one row."""
    return len(step.title) + 1 + row_width(caption) <= width


def title(step: LessonStep, caption: Row, width: int) -> Row:
    """Returns the step's kind and title, and on the right the state of the scene, or what is said to the last key. Where not all
    fit, the kind gives way: the title is whole."""
    kind = f"{KINDS[step.kind]}: "
    if len(kind) + len(step.title) + 1 + row_width(caption) > width:
        kind = ""
    return at_both_edges(row((kind, "dim"), (step.title, "title")), caption, width)


def checking(seconds: float, progress: str, width: int) -> Row:
    """One line of a check that is running. ``progress``: what it is doing; where that does not fit, its last part gives way."""
    if not progress:
        return row((f"  Checking ... {seconds:.1f} s", "bold"))
    head = f"  {seconds:.1f} s: "
    while len(head) + len(progress) > width and ", " in progress:
        progress = progress.rpartition(", ")[0]
    return row((f"{head}{progress}"[:width], "bold"))


PASSED_S: Final = 1.2
"""How long the line of a check that has passed moves [s]."""
PASSED_CELLS: Final = 12
"""Cells that a robot drives along it, and leaves stars in."""


def passing(seconds: float) -> Row:
    """The line of a check that has just passed, so long after: a robot drives along it and leaves a star in each cell."""
    driven = min(PASSED_CELLS, int(PASSED_CELLS * seconds / PASSED_S))
    return row(("  Passed: ", "good"), (f"{'*' * driven}>", "good"))


def file_rows(path: str, by_hand: bool, others: bool, width: int) -> list[Row]:
    """The whole path of what is edited, on as many rows as it needs. ``others``: there is more beside it."""
    head = " Saved in " if by_hand else " Edit "
    tail = ", and the files beside it" if others else ""
    room = max(10, width - len(head))
    parts = _broken_path(path, room)
    made = [
        row((head if number == 0 else " " * len(head), "dim"), (part, "bold"))
        for number, part in enumerate(parts)
    ]
    if tail and len(parts[-1]) + len(tail) <= room:
        made[-1] = (*made[-1], (tail, "dim"))
    elif tail:
        made.append(row((" " * len(head) + tail.removeprefix(", "), "dim")))
    return made


def _broken_path(path: str, room: int) -> list[str]:
    """A path on as many rows as it needs, broken behind a slash where there is one."""
    parts: list[str] = []
    while len(path) > room:
        cut = path.rfind("/", 0, room) + 1 or room
        parts.append(path[:cut])
        path = path[cut:]
    return [*parts, path]
