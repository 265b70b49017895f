"""The rows around a lesson's step, the list of lessons, and a student's progress. Pure."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from kit.document.rows import TEXT_WIDTH, Row, row, spread
from kit.plain_text import wrap
from kit.school.game.levels import GameLevel
from kit.school.lessons.catalogue import LessonEntry, LessonProgress
from kit.school.lessons.records import (
    LessonStep,
    StepKind,
)

LONGEST_BAR: Final = 12
LEAST_GOAL: Final = 8

_KINDS: Final = {
    StepKind.PREDICT: "Predict",
    StepKind.RUN: "Run",
    StepKind.EXPLAIN: "Read",
    StepKind.MODIFY: "Change",
    StepKind.MAKE: "Make",
}


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
    left = row((title, "bold"), "  ", (goal, "dim")) if goal else row((title, "bold"))
    return spread(left, row(where, (bar, "bold")), width)


def progress_bar(progress: LessonProgress, here: LessonStep | None = None) -> str:
    """One character a step: full where it is done, half where one stands."""
    return "".join(
        "█"
        if progress.is_step_completed(step)
        else "▒"
        if here is not None and step.number == here.number
        else "░"
        for step in progress.lesson.steps
    )


def title(step: LessonStep, caption: Row, width: int) -> Row:
    """Returns the step's kind and title, and on the right the state of the scene, or what is said to the last key. Where not all
    fit, the kind gives way: the title is whole."""
    kind = f"{_KINDS[step.kind]}: "
    said = sum(len(text) for text, _ in caption)
    if len(kind) + len(step.title) + 1 + said > width:
        kind = ""
    return spread(row((kind, "dim"), (step.title, "bold")), caption, width)


def checking(seconds: float, progress: str = "") -> Row:
    """One line of a check that is running. ``progress``: what it is doing."""
    return row((f"  {seconds:.1f} s: {progress}" if progress else f"  Checking ... {seconds:.1f} s", "bold"))


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


TITLE: Final = 46
STARS: Final = 3


def mark(entry: LessonEntry) -> str:
    """Done, begun, or neither; also where there is no colour."""
    if entry.progress is None:
        return "[!]"
    return "[x]" if entry.is_completed else "[~]" if entry.has_started else "[ ]"


def lines(shelf: Sequence[LessonEntry], chosen: LessonEntry | None) -> list[tuple[LessonEntry | None, Row]]:
    """The list of all lessons: each line with its lesson, or with None where a unit begins."""
    made: list[tuple[LessonEntry | None, Row]] = []
    for each in shelf:
        if each.opened_unit is not None:
            made.append((None, row("  ", (f"{each.opened_unit.letter}  {each.opened_unit.title}", "dim"))))
        made.append((each, line(each, each is chosen)))
    return made


def line(entry: LessonEntry, chosen: bool) -> Row:
    """One lesson of the list: number, title, mark, minutes, steps."""
    style = "chosen" if chosen else ""
    title = entry.title if len(entry.title) <= TITLE else entry.title[: TITLE - 3] + "..."
    head = row(
        (">" if chosen else " ", "bold"),
        (f"{entry.number:>3}  ", style),
        (mark(entry), style),
        (f" {title:<{TITLE}}", style),
    )
    progress = entry.progress
    if progress is None:
        return (*head, (" cannot be read", "bad"))
    return (*head, (f" {progress.lesson.minutes:>3} min  ", style or "dim"), (progress_bar(progress), ""))


def summary(entry: LessonEntry, rows: int) -> list[Row]:
    """What the chosen lesson is about, and what one can do after it; at most so many rows."""
    lesson = entry.lesson
    if lesson is None:
        lines = [each for part in entry.problem.splitlines() for each in wrap(part, TEXT_WIDTH)]
        return [row("  ", (each, "bad")) for each in lines[:rows]]
    made = []
    if entry.opened_unit is not None:
        made += [row("  ", (each, "dim")) for each in wrap(entry.opened_unit.opener, TEXT_WIDTH)]
    made += [row("  ", each) for each in wrap(lesson.summary, TEXT_WIDTH)]
    for outcome in lesson.outcomes:
        made += [row("  ", (each, "dim")) for each in wrap(f"- {outcome}", TEXT_WIDTH, "", "  ")]
    return made[:rows]


def details(entry: LessonEntry, levels: Sequence[GameLevel], width: int) -> list[Row]:
    """All of the chosen lesson, for a screen with room beside the list. ``levels``: those that it opens."""
    lesson, progress = entry.lesson, entry.progress
    if lesson is None or progress is None:
        return [row((f"{entry.number}  {entry.name}", "bold")), row(), *summary(entry, len(entry.problem))]
    room = min(width, TEXT_WIDTH)
    done = f"{progress.completed_count} of {len(lesson.steps)} steps done"
    opener = entry.opened_unit.opener if entry.opened_unit is not None else ""
    made = [
        row((f"{entry.number}  {lesson.title}", "bold")),
        row((f"{lesson.minutes} min, {done}", "dim")),
        row(),
        *(row((each, "dim")) for each in (wrap(opener, room) if opener else ())),
        *(row(each) for each in wrap(lesson.summary, room)),
        row(),
        row(("Afterwards you can:", "bold")),
    ]
    for outcome in lesson.outcomes:
        made += [row(each) for each in wrap(f"- {outcome}", room, "", "  ")]
    made += [row(), row(("Steps", "bold"))]
    for step in lesson.steps:
        is_done = progress.is_step_completed(step)
        has_tried = step.exercise is not None and step.exercise.name in progress.best_shares
        earned = f"  {stars(progress, step.exercise.name)}" if step.exercise and has_tried else ""
        made.append(
            row(
                ("[x] " if is_done else "[ ] ", "good" if is_done else "dim"),
                (f"{_KINDS[step.kind]:<8}", "dim"),
                step.title[: room - 20],
                (earned, "warn"),
            )
        )
    if levels:
        titles = ", ".join(level.title for level in levels)
        made += [row(), *(row((each, "dim")) for each in wrap(f"Opens in the game: {titles}", room))]
    return made


STARS_LEGEND: Final = "an exercise: *** all points, **. half or more, *.. some, ... none yet"
"""What ``stars`` means, on the page of progress."""


def stars(progress: LessonProgress, exercise: str) -> str:
    """``***`` for everything, ``**.`` from half of the points on, ``*..`` for some, ``...`` for none yet; one more for a
    program that was defended."""
    share = progress.best_shares.get(exercise, 0.0)
    count = STARS if exercise in progress.passed_exercises else 2 if share >= 0.5 else 1 if share > 0 else 0
    return "*" * count + "." * (STARS - count) + "*" * (exercise in progress.defended_exercises)


def progress(shelf: Sequence[LessonEntry]) -> list[Row]:
    """All that was done of the lessons and their exercises."""
    readable = [each.progress for each in shelf if each.progress is not None]
    exercises = [(each, one.name) for each in readable for one in each.lesson.exercises]
    passed = sum(name in each.passed_exercises for each, name in exercises)
    made = [
        row(),
        row(
            "  ",
            ("Lessons", "bold"),
            f"  {sum(each.is_completed for each in readable)} of {len(shelf)} done,"
            f" {passed} of {len(exercises)} exercises passed",
        ),
        row("  ", (STARS_LEGEND, "dim")),
        row(),
    ]
    for entry in shelf:
        progress = entry.progress
        if progress is None:
            made.append(row(f" {entry.number:>3}  {mark(entry)} {entry.name}", (" cannot be read", "bad")))
            continue
        made.append(
            row(
                f" {entry.number:>3}  {mark(entry)} ",
                (entry.title[:TITLE], "bold" if entry.has_started else ""),
            )
        )
        if entry.has_started:
            done = ", ".join(f"{one.name} {stars(progress, one.name)}" for one in progress.lesson.exercises)
            made.append(row("          ", progress_bar(progress), (f"  {done}", "dim")))
    return made


def game_and_quiz_progress(game: Sequence[Row], quiz: Iterable[str], workspace: str) -> list[Row]:
    """Summarises progress beside the lessons: the game, the quiz, and how to export everything."""
    made = [row(), row("  ", ("Game", "bold")), row(), *game]
    made += [row(), row("  ", ("Quiz", "bold")), row(), *(row("  " + each) for each in quiz)]
    made += [
        row(),
        row("  ", ("Export your progress", "bold")),
        row(),
        row(
            "  ", ("kit progress export FILE", "code"), " writes everything to one file, for another machine"
        ),
        row("  or for your teacher. ", ("kit progress import FILE", "code"), " imports it there."),
        row(),
        row((f"  Saved in {workspace}", "dim")),
    ]
    return made
