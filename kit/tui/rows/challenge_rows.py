"""Challenges as rows of text: their list, what one asks for, what an answer is worth beside the naive and the best one. Pure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from kit.document.rows import Row, row
from kit.plain_text import wrap
from kit.school.game.challenge import AnswerComparison, Challenge, Judgement
from kit.school.game.medal import Medal
from kit.school.lessons.reading import lesson_number
from kit.school.lessons.shell_lines import shell_path
from kit.tui.rows.level_rows import MEDAL_SIGNS, MEDAL_STYLES, TITLE_WIDTH, medal_row

TITLE_COLUMNS: Final = TITLE_WIDTH + 8
HEADER: Final = f"  {'challenge':<{TITLE_COLUMNS}} medal  lesson"
NAME_COLUMNS: Final = 14


def challenge_list(challenges: Sequence[Challenge], medals: Mapping[str, Medal], chosen: str) -> list[Row]:
    """One row for each challenge. ``medals``: the best of each that has one, by its id."""
    rows = [row((HEADER, "dim"))]
    for each in challenges:
        medal, is_chosen = medals.get(each.id, Medal.NONE), each.id == chosen
        rows.append(
            row(
                ("> " if is_chosen else "  ", "bold"),
                (f"{each.title:<{TITLE_COLUMNS}} ", "chosen" if is_chosen else ""),
                (f"{MEDAL_SIGNS[medal]:<7}", MEDAL_STYLES[medal]),
                (lesson_number(each.lesson), "dim"),
            )
        )
    return rows


def about_challenge(challenge: Challenge, medal: Medal, width: int) -> list[Row]:
    """What the chosen challenge asks for, and what was earned."""
    return [
        *_wrapped(challenge.title, f" {challenge.story}", width),
        *_wrapped("task  ", challenge.task_text, width, "dim"),
        row(
            ("best   ", "dim"),
            medal.title,
            (f"   lesson {lesson_number(challenge.lesson)} teaches it", "dim"),
        ),
    ]


def challenge_page(challenge: Challenge, file: Path | None, width: int) -> list[Row]:
    """A challenge as a page. ``file``: where the answer is written; None: a training run is handed in."""
    place = (
        "Your answer is a training run of yours: c asks which one."
        if file is None
        else f"Your answer: {shell_path(file)}"
    )
    return [
        *_wrapped("", challenge.story, width),
        *_wrapped("task  ", challenge.task_text, width, "dim"),
        *(row((line, "code")) for line in challenge.task.lines()),
        row((place, "bold")),
    ]


def judged(judgement: Judgement, previous: Medal, following: str | None, width: int) -> list[Row]:
    """What an answer earned, how far it is from others, and after a medal what comes next.

    ``previous``: the best medal before. ``following``: the title of the next challenge; None after the last one.
    """
    rows = [
        medal_row(judgement.medal, is_new=judgement.medal > previous),
        *_wrapped("  ", judgement.text, width),
    ]
    if judgement.comparison is not None:
        rows += _compared(judgement.comparison)
    if following is not None and judgement.medal is not Medal.NONE:
        rows.append(row(("   next ", "dim"), following))
    return rows


def _compared(comparison: AnswerComparison) -> list[Row]:
    """The differences of an answer to others; one that is no worse than the other is told by its style too."""
    rows = []
    for name, figure in comparison.others:
        difference = round(comparison.answer - figure, 2)
        is_good = difference >= 0 if comparison.more_is_better else difference <= 0
        rows.append(
            row(
                f"   {name:<{NAME_COLUMNS}} {_number(figure):>9} {comparison.unit}  ",
                (f"{'+' if difference > 0 else ''}{_number(difference)}", "good" if is_good else "warn"),
            )
        )
    return rows


def _number(value: float) -> str:
    return f"{value:,.0f}" if float(value).is_integer() else f"{value:,.2f}"


def _wrapped(word: str, text: str, width: int, style: str = "bold") -> list[Row]:
    """A text that begins with a word in a style of its own, in rows of at most ``width`` columns."""
    start = f"{word} " if word else ""
    indent = " " * len(start) if style == "dim" or not word.strip() else ""
    first, *others = wrap(text, max(20, width), start, indent)
    return [row((start, style), first[len(start) :]), *(row(line) for line in others)]
