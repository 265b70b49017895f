"""A lesson's step as rows of text: heading, words, what can be predicted, and what a check said. Pure.

The list of lessons and a student's progress, as rows of text. Pure.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from kit.document.code_lines import broken_command, is_command
from kit.document.markup import TextStyle, parse_markup, wrap_blocks
from kit.document.rows import MARGIN, TEXT_WIDTH, Row, entry_rows, row, spread, text_width
from kit.school.game.levels import GameLevel, opened_levels_text
from kit.school.lessons.catalogue import LessonEntry, LessonProgress
from kit.school.lessons.checking import CheckReport
from kit.school.lessons.lesson_session import LessonHint
from kit.school.lessons.records import (
    CommandKind,
    Exercise,
    Lesson,
    LessonCommand,
    LessonStep,
    PredictionOption,
    StepKind,
)
from kit.school.result import TextRole, criterion_lines, points_text

LONGEST_BAR: Final = 12
LEAST_TITLE: Final = 8

_STYLES: Final = {TextStyle.PLAIN: "", TextStyle.CODE: "code", TextStyle.BOLD: "bold"}
_ROLE_STYLES: Final = {
    TextRole.PASSED: "good",
    TextRole.LOST: "bad",
    TextRole.NOT_JUDGED: "dim",
    TextRole.PLAIN: "",
    TextRole.HEADING: "bold",
    TextRole.DETAIL: "dim",
    TextRole.HINT: "bold",
}
_KINDS: Final = {
    StepKind.PREDICT: "Predict",
    StepKind.RUN: "Run",
    StepKind.EXPLAIN: "Read",
    StepKind.MODIFY: "Change",
    StepKind.MAKE: "Make",
}
_WHERE: Final = {
    CommandKind.ALONE: "In a second terminal, or here: press o. For how to open one, press a.",
    CommandKind.SCREEN: "To run it here, press o:",
    CommandKind.BESIDE: "In a second terminal (press a for how to open one), while a world runs:",
}


def heading(progress: LessonProgress, step: LessonStep, width: int) -> Row:
    """Lesson, goal, which step of how many, and a bar of what is done. A long lesson's title gives way to the goal."""
    count = len(progress.lesson.steps)
    bar = progress_bar(progress, step) if count <= LONGEST_BAR else ""
    where = f"step {step.number} of {count} "
    title, room = (
        f"{progress.lesson.number} {progress.lesson.title}",
        width - len(where) - len(bar) - len(step.goal) - 4,
    )
    if len(title) > room:
        title = f"{title[: room - 3].rstrip()}..." if room >= LEAST_TITLE else ""
    left = row((title, "bold"), "  ", (step.goal, "dim")) if title else row((step.goal, "dim"))
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
    """Returns the step's kind and title, and on the right the state of the scene."""
    return spread(row((f"{_KINDS[step.kind]}: ", "dim"), (step.title, "bold")), caption, width)


def words(text: str, width: int) -> list[Row]:
    """A lesson's text."""
    room = min(width - 2 * MARGIN, TEXT_WIDTH)
    made: list[Row] = []
    for each in wrap_blocks(parse_markup(text), room):
        if len(each) == 1 and len(each[0].text) > room:
            made += code(each[0].text, room)
        else:
            made.append(
                row(" " * MARGIN, *((piece.text, _STYLES[piece.style]) for piece in each)) if each else row()
            )
    return made


def code(line: str, room: int) -> list[Row]:
    """A line of code; one that is too long on several. What goes on in the middle of a word has no margin."""
    parts = (
        broken_command(line, room)
        if is_command(line)
        else [line[at : at + room] for at in range(0, len(line), room)]
    )
    made = [row(" " * MARGIN, (parts[0], "code"))]
    for before, part in pairwise(parts):
        in_a_word = before.endswith("\\") and not before.endswith(" \\")
        made.append(row("" if in_a_word else " " * MARGIN, (part, "code")))
    return made


def commands(filled: Sequence[tuple[LessonCommand, str]], width: int) -> list[Row]:
    """The commands of a step, those of a kind under one line that says where to type them."""
    made: list[Row] = []
    for how, where in _WHERE.items():
        lines = [line for command, line in filled if command.kind is how]
        if lines:
            made += [row(), row(" " * MARGIN, (where, "dim"))]
            made += [each for line in lines for each in code(" " * MARGIN + line, text_width(width))]
    return made


def question(step: LessonStep, chosen: PredictionOption | None, told: bool, width: int) -> list[Row]:
    """The question and its options, ``>`` before the chosen one; once it is told, ``+`` before the right and ``x``
    before a wrong choice."""
    made = [row(" " * MARGIN, (line, "bold")) for line in _wrapped(step.question, width)]
    for number, option in enumerate(step.options, 1):
        mark, style = (">", "bold") if option is chosen else (" ", "")
        if told and option.is_right:
            mark, style = "+", "good"
        elif told:
            mark, style = ("x", "bad") if option is chosen else (" ", "dim")
        made += entry_rows(mark, str(number), option.text, style, text_width(width))
    return made


def feedback(step: LessonStep, chosen: PredictionOption, width: int) -> list[Row]:
    """Returns the feedback to the prediction, and that of the right option where it was another."""
    right = next(option for option in step.options if option.is_right)
    if chosen.is_right:
        return [row(), *_wrapped_after("Right.", "good", chosen.feedback, width)]
    numbers = {id(option): number for number, option in enumerate(step.options, 1)}
    return [
        row(),
        *_wrapped_after(
            f"Not this time: you predicted {numbers[id(chosen)]}.", "bold", chosen.feedback, width
        ),
        row(),
        *_wrapped_after(f"The answer is {numbers[id(right)]}.", "good", right.feedback, width),
    ]


@dataclass(frozen=True, slots=True)
class VerdictRows:
    """The rows of a check's result, and the one to look at first."""

    rows: Sequence[Row]
    first_lost: int
    """The row of the first criterion that is lost; 0 where none is."""
    last_hint: int
    """The row in which the newest hint begins; 0 where none is open."""


def verdict(report: CheckReport, hints: Sequence[LessonHint], width: int) -> VerdictRows:
    """Shows a check's result, criterion by criterion; the hints opened so far below the criterion they help with."""
    made: list[Row] = [row()]
    first_lost = last_hint = 0
    if report.problem:
        style = "warn" if report.is_broken else "bad"
        made += [row(" " * MARGIN, (line, style)) for line in _wrapped(report.problem, width)]
    for each in report.criteria:
        opened = sum(hint.criterion.id == each.id for hint in hints)
        first_lost = first_lost or (0 if each.is_passed else len(made))
        for line in criterion_lines(each, text_width(width), hints=opened):
            if opened and line[0].role is TextRole.HINT and f"Hint {opened} of" in line[0].text:
                last_hint = len(made)
            made.append(row(" " * MARGIN, *((span.text, _ROLE_STYLES[span.role]) for span in line)))
    return VerdictRows(made, first_lost, last_hint)


def status(report: CheckReport | None, progress: LessonProgress, exercise: Exercise, by_hand: bool) -> Row:
    """One line of where one is with an exercise."""
    begin = (
        "Press d to drive; leaving the drive checks it"
        if by_hand
        else "Save the file to check it, or press c"
    )
    passed = exercise.name in progress.passed_exercises
    if report is None:
        best = progress.best_shares.get(exercise.name)
        if passed:
            return row((" Passed before.", "good"), f" {begin}.")
        return row((f" {begin}.", ""), (f" Best so far: {best:.0%}." if best else "", "dim"))
    if report.is_broken:
        return row((" The check itself failed. Press c to try again.", "warn"))
    level = f", isolation level {report.result.level}" if report.result and report.result.level else ""
    points = (
        f"{points_text(report.points, report.max_points)} points, checked in {report.seconds:.1f} s{level}."
    )
    if report.is_passed:
        return row((" Passed: ", "good"), ("*** ", "warn"), points)
    if not report.criteria:
        return row((" Not checked.", "bad"))
    return row(
        (" Not yet: ", "bad"),
        points,
        " Press h for a hint." if any(each.hints for each in report.lost_criteria) else "",
    )


def checking(seconds: float, progress: str = "") -> Row:
    """One line of a check that is running. ``progress``: what it is doing."""
    return row((f" {seconds:.1f} s: {progress}" if progress else f" Checking ... {seconds:.1f} s", "bold"))


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


def ending(
    progress: LessonProgress, width: int, following: Lesson | None = None, levels: Sequence[GameLevel] = ()
) -> list[Row]:
    """The page after the last step. ``following``: the lesson that Enter opens. ``levels``: those that this one opens."""
    lesson = progress.lesson
    made = [row()]
    if progress.is_completed:
        made.append(row(" " * MARGIN, (f"{lesson.title} is done.", "good")))
        made += [row(), row(" " * MARGIN, "You can now:")]
        made += [
            line
            for outcome in lesson.outcomes
            for line in entry_rows(" ", "-", outcome, "", text_width(width))
        ]
    else:
        open_steps = [step for step in lesson.steps if not progress.is_step_completed(step)]
        made.append(row(" " * MARGIN, ("That was the last step. Not done yet:", "bold")))
        made += [
            line
            for step in open_steps
            for line in entry_rows(" ", str(step.number), step.title, "", text_width(width))
        ]
        made += [
            row(),
            *(
                row(" " * MARGIN, line)
                for line in _wrapped("Press b for the previous step, l for the list of steps.", width)
            ),
        ]
    best = [f"{each.name} {progress.best_shares.get(each.name, 0.0):.0%}" for each in lesson.exercises]
    if best:
        made += [row(), *_indented("Exercises: " + ", ".join(best), "", width, MARGIN)]
    if progress.is_completed and (text := opened_levels_text(tuple(levels))):
        made += [row(), *_indented(text, "", width, MARGIN)]
    if following is not None:
        made += [
            row(),
            *_indented(
                f"Enter opens the next lesson, {following.number} {following.title}.", "bold", width, MARGIN
            ),
        ]
    return made


def _wrapped_after(head: str, style: str, text: str, width: int) -> list[Row]:
    first, *rest = textwrap.wrap(text, text_width(width), initial_indent=" " * (len(head) + 1)) or [""]
    return [
        row(" " * MARGIN, (head, style), " ", first.strip()),
        *(row(" " * MARGIN + line) for line in rest),
    ]


def _indented(text: str, style: str, width: int, indent: int = MARGIN + 5) -> list[Row]:
    lines = [
        line
        for part in text.splitlines()
        for line in textwrap.wrap(part, max(20, text_width(width) - indent + MARGIN))
    ]
    return [row(" " * indent, (line, style)) for line in lines]


def _wrapped(text: str, width: int) -> list[str]:
    return [line for part in text.splitlines() for line in textwrap.wrap(part, text_width(width))]


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
        lines = [each for part in entry.problem.splitlines() for each in textwrap.wrap(part, TEXT_WIDTH)]
        return [row("  ", (each, "bad")) for each in lines[:rows]]
    made = []
    if entry.opened_unit is not None:
        made += [row("  ", (each, "dim")) for each in textwrap.wrap(entry.opened_unit.opener, TEXT_WIDTH)]
    made += [row("  ", each) for each in textwrap.wrap(lesson.summary, TEXT_WIDTH)]
    for outcome in lesson.outcomes:
        made += [
            row("  ", (each, "dim"))
            for each in textwrap.wrap(f"- {outcome}", TEXT_WIDTH, subsequent_indent="  ")
        ]
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
        *(row((each, "dim")) for each in textwrap.wrap(opener, room)),
        *(row(each) for each in textwrap.wrap(lesson.summary, room)),
        row(),
        row(("Afterwards you can:", "bold")),
    ]
    for outcome in lesson.outcomes:
        made += [row(each) for each in textwrap.wrap(f"- {outcome}", room, subsequent_indent="  ")]
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
        made += [row(), *(row((each, "dim")) for each in textwrap.wrap(f"Opens in the game: {titles}", room))]
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
