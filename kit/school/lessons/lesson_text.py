"""What a lesson tells: its commands, a prediction's question and feedback, a check's verdict, and its end, as blocks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Final

from kit.dialogue.dialogue import Panel
from kit.document.blocks import Block, Choice, Choices, Code, Text, Tone
from kit.plain_text import join_names
from kit.results.grading_result import CriterionStatus
from kit.results.result_blocks import criterion_blocks, points_text
from kit.school.game.levels import GameLevel, opened_levels_text
from kit.school.lessons.catalogue import LessonProgress
from kit.school.lessons.checking import CheckReport
from kit.school.lessons.lesson_session import LessonHint
from kit.school.lessons.records import (
    CommandKind,
    Exercise,
    Lesson,
    LessonCommand,
    LessonStep,
    PredictionOption,
)

_WHERE: Final[Mapping[CommandKind, str]] = MappingProxyType(
    {
        CommandKind.ALONE: "In a second terminal, or here: press o. For how to open one, press a.",
        CommandKind.SCREEN: "To run it here, press o:",
        CommandKind.BESIDE: "In a second terminal (press a for how to open one), while a world runs:",
    }
)


def about_lesson(lesson: Lesson) -> Panel:
    """What a lesson is about and what one can do after it."""
    outcomes = (Text(each, lead="-", hang=2, is_tight=True) for each in lesson.outcomes)
    title = f"lesson {lesson.number}, {lesson.title}"
    return Panel(title, (Text(lesson.summary), *outcomes), is_below=True)


def command_blocks(filled: Sequence[tuple[LessonCommand, str]]) -> list[Block]:
    """The commands of a step, those of a kind under one line that says where to type them."""
    blocks: list[Block] = []
    for kind, where in _WHERE.items():
        lines = tuple(line for command, line in filled if command.kind is kind)
        if lines:
            blocks += [Text(where, Tone.DIM), Code(lines, indent=2, is_tight=True)]
    return blocks


def question_blocks(step: LessonStep, chosen: PredictionOption | None, *, is_told: bool) -> list[Block]:
    """The question and its options, ``>`` before the chosen one; once it is told, ``+`` before the right and ``x``
    before a wrong choice."""
    entries = []
    for number, option in enumerate(step.options, 1):
        mark, tone = (">", Tone.BOLD) if option is chosen else (" ", Tone.PLAIN)
        if is_told and option.is_right:
            mark, tone = "+", Tone.GOOD
        elif is_told:
            mark, tone = ("x", Tone.BAD) if option is chosen else (" ", Tone.DIM)
        entries.append(Choice(str(number), option.text, tone, mark))
    return [Text(step.question, Tone.BOLD), Choices(tuple(entries), is_tight=True)]


def feedback_blocks(step: LessonStep, chosen: PredictionOption) -> list[Block]:
    """The feedback to a prediction, and that of the right option where it was another."""
    if chosen.is_right:
        return [Text(chosen.feedback, lead="Right.", lead_tone=Tone.GOOD)]
    number = next(number for number, option in enumerate(step.options, 1) if option is chosen)
    answer, right = next((number, option) for number, option in enumerate(step.options, 1) if option.is_right)
    return [
        Text(chosen.feedback, lead=f"Not this time: you predicted {number}."),
        Text(right.feedback, lead=f"The answer is {answer}.", lead_tone=Tone.GOOD),
    ]


def verdict_blocks(report: CheckReport, hints: Sequence[LessonHint]) -> list[Block]:
    """A check's result, criterion by criterion; the hints opened so far below the criterion they help with."""
    blocks: list[Block] = []
    if report.problem:
        blocks.append(Text(report.problem, Tone.WARN if report.is_broken else Tone.BAD))
    skipped = {each.id for each in report.criteria if each.status is CriterionStatus.SKIPPED}
    for number, each in enumerate(report.criteria, 1):
        following = report.criteria[number] if number < len(report.criteria) else None
        is_said_below = following is not None and following.rationale == each.rationale
        if is_said_below or (each.id in skipped and each.depends_on in skipped):  # said of what comes first
            each = replace(each, rationale="")
        first, *others = criterion_blocks(each, hints=sum(hint.criterion.id == each.id for hint in hints))
        blocks += [first if blocks else replace(first, is_tight=False), *others]
    return blocks


def status_text(
    report: CheckReport | None,
    progress: LessonProgress,
    exercise: Exercise,
    *,
    has_hint: bool = False,
    is_writing: bool = False,
) -> Text:
    """Where one is with an exercise, in a sentence or two. ``has_hint``: whether there is one that is not open yet.
    ``is_writing``: whether keys are letters of the program, so that ``c`` and ``h`` come after Esc."""
    begin = "Save the file to check it, or press c."
    if exercise.is_driven:
        begin = "Press d to drive; leaving the drive checks it."
    elif is_writing:
        begin = "^S saves and checks."
    if report is None:
        if exercise.name in progress.passed_exercises:
            return Text(begin, lead="Passed before.", lead_tone=Tone.GOOD)
        best = progress.best_shares.get(exercise.name)
        return Text(begin, tail=f" Best so far: {100 * best:.0f} %." if best else "")
    if report.is_broken:
        again = "^S tries again." if is_writing else "Press c to try again."
        return Text(f"The check itself failed. {again}", Tone.WARN)
    level = f", isolation level {report.result.level}" if report.result and report.result.level else ""
    points = (
        f"{points_text(report.points, report.max_points)} points, checked in {report.seconds:.1f} s{level}."
    )
    if report.is_passed:
        return Text(points, lead="Passed: ***", lead_tone=Tone.GOOD)
    if not report.criteria:
        return Text("Not checked.", Tone.BAD)
    more = (" Esc, then h: a hint." if is_writing else " Press h for a hint.") if has_hint else ""
    return Text(f"{points}{more}", lead="Not yet:", lead_tone=Tone.BAD)


def ending_blocks(
    progress: LessonProgress, following: Lesson | None = None, levels: Sequence[GameLevel] = ()
) -> list[Block]:
    """The page after the last step. ``following``: the lesson that Enter opens. ``levels``: those that this one opens."""
    lesson = progress.lesson
    blocks: list[Block] = []
    if progress.is_completed:
        blocks += [Text(f"{lesson.title} is done.", Tone.GOOD), Text("You can now:")]
        blocks += [Text(f"- {outcome}", hang=2, is_tight=True) for outcome in lesson.outcomes]
    else:
        left = [step for step in lesson.steps if not progress.is_step_completed(step)]
        blocks.append(Text("That was the last step. Not done yet:", Tone.BOLD))
        blocks.append(Choices(tuple(Choice(str(step.number), step.title) for step in left), is_tight=True))
        blocks.append(Text("Press b for the previous step, l for the list of steps."))
    best = [
        f"{each.name} {100 * progress.best_shares.get(each.name, 0.0):.0f} %" for each in lesson.exercises
    ]
    if best:
        blocks.append(Text(f"Exercises: {join_names(best, len(best))}"))
    if progress.is_completed and (text := opened_levels_text(tuple(levels))):
        blocks.append(Text(text))
    if following is not None:
        blocks.append(Text(f"Enter opens the next lesson, {following.number} {following.title}.", Tone.BOLD))
    return blocks
