"""Challenges as rows of text: their list, what one asks for, what an answer is worth beside the naive and the best one."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

from kit.dialogue.dialogue import Panel
from kit.document.blocks import CellStyle, Column, Table, Tone, ToneText
from kit.document.rows import (
    MARGIN,
    Row,
    broken,
    row,
    row_text,
    row_width,
    side_by_side,
)
from kit.document.tables import list_rows
from kit.layers.drawing.spans import GlyphStyle
from kit.plain_text import counted, wrap
from kit.school.game.board import Board
from kit.school.game.challenge import AnswerError, Challenge
from kit.school.game.challenges import BEGUN, all_challenges
from kit.school.game.judgement import AnswerComparison, Judgement
from kit.school.game.medal import Medal
from kit.school.game.players_histogram import HistogramBin
from kit.school.lessons.lesson_text import about_lesson
from kit.school.lessons.reading import find_lesson, lesson_number
from kit.school.lessons.shell_lines import shell_path
from kit.school.progress import ProgressEvent
from kit.tui.rows.chart_rows import CHART_ROWS, stretched_chart
from kit.tui.rows.drive_end_rows import needed_rows
from kit.tui.rows.medal_rows import medal_row
from kit.tui.rows.medal_signs import MEDAL_SIGNS, MEDAL_STYLES
from kit.tui.rows.panel_rows import panel_rows
from kit.tui.rows.progress_marks import share_bar
from kit.world.problems import WorldError

LEAST_TEXT: Final = 36
"""Columns of a puzzle's text beside its board, at least."""
WIDEST_TEXT: Final = 76
DRAWING_SHARE: Final = 0.5
"""Of the columns, for a drawing of a board."""
LEAST_BOARD: Final = 60
"""Columns of a board that is no drawing."""
GAP: Final = 2
LARGEST_SCALE: Final = 8
"""More would only be larger: the room tells more instead."""
LONG_LIST, LEAST_LISTED = 16, 4
"""Rows of a part that may be cut, and the fewest of it that are shown."""
TWO_TEXTS: Final = 48
"""Columns of each of two texts beside a board."""
MOST_CURVE_ROWS: Final = 14
"""Of a curve below a board."""
UNSOLVED: Final = "   not solved yet; the answer is kept"
"""After a check that earned no medal, where a figure does not tell what the next one asks for."""
NEW: Final = " (new)"
"""After a medal that is better than those before."""
MOST_TRIES: Final = 4
"""Checks that are listed."""
LEAST_DETAILS: Final = 16
"""Columns from which on something stands beside a board."""
LEAST_TOLD: Final = 34
"""Columns from which on a check is listed with what was said of it."""
NAME_COLUMNS: Final = 14
LIST_COLUMNS: Final = 56
"""Of the list, where a picture stands beside it."""
NARROW_LIST: Final = 45
"""Of the list, where only a small picture may stand beside it."""
ROOM_FOR_PICTURE: Final = LIST_COLUMNS + 50


def first_shown(count: int, chosen: int, room: int) -> int:
    """The number of the first of ``count`` rows that are shown in ``room`` rows, so that the chosen one is among them.

    >>> first_shown(15, 2, 10), first_shown(15, 9, 10), first_shown(15, 14, 10), first_shown(5, 4, 10)
    (0, 4, 5, 0)
    """
    return max(0, min(chosen - room // 2, count - room))


def challenge_list(
    challenges: Sequence[Challenge], medals: Mapping[str, Medal], chosen: str, room: int, width: int
) -> list[Row]:
    """One row for each challenge, of those for which there is room; the first row says which these are.
    ``medals``: the best of each that has one, by its id."""
    number = next(number for number, each in enumerate(challenges) if each.id == chosen)
    best = [medals.get(each.id, Medal.NONE) for each in challenges]
    cells = tuple(
        (
            each.title,
            ToneText(MEDAL_SIGNS[medal], MEDAL_STYLES[medal]),
            ToneText(lesson_number(each.lesson), Tone.DIM),
        )
        for each, medal in zip(challenges, best, strict=True)
    )
    columns = tuple(Column(title, CellStyle.TEXT) for title in ("puzzle", "", "lesson"))
    return list_rows(Table("puzzles", "", columns, cells), width, room + 1, number)


def about_challenge(challenge: Challenge, medal: Medal, width: int) -> list[Row]:
    """What the chosen challenge asks for, and what was earned."""
    return [
        *_wrap_with_lead(challenge.title, f" {challenge.story}", width),
        *_wrap_with_lead("task  ", challenge.task_text, width, "dim"),
        row(
            ("best   ", "dim"),
            medal.title,
            (f"   lesson {lesson_number(challenge.lesson)} teaches it", "dim"),
        ),
    ]


@cache
def most_rows_about(width: int) -> int:
    """As many rows as that of any challenge takes, so that what is above keeps its place."""
    return max(len(about_challenge(each, Medal.NONE, width)) for each in all_challenges())


def challenge_standing(challenge: Challenge, checks: Sequence[ProgressEvent], width: int) -> list[Row]:
    """The keys that solve a challenge on the screen and what each medal asks for, as far as they are known; the checks so far.
    ``checks``: of it, the oldest first."""
    board, rows = challenge.task.board(""), list[Row]()
    if board is not None:
        rows += [row(), *_wrap_with_lead("keys  ", board.keys, width, "dim")]
        with suppress(AnswerError):  # which an empty answer is to some
            rows += _rungs_rows(board.judgement().comparison)
    tries = tries_rows(checks, width)
    return [*rows, *([row(), *tries] if tries else [])]


def lesson_below(challenge: Challenge, width: int, height: int) -> list[Row]:
    """What the lesson that teaches a challenge is about; cut where there is little room, and nothing where it cannot be read, which
    is told where it is opened."""
    about = _about_lesson_of(challenge.lesson)
    return [] if about is None else panel_rows([about], width, height)


@cache
def _about_lesson_of(name: str) -> Panel | None:
    try:
        return about_lesson(find_lesson(name))
    except (WorldError, LookupError, OSError):
        return None


def _rungs_rows(comparison: AnswerComparison | None) -> list[Row]:
    """What each medal asks for, the highest first."""
    if comparison is None:
        return []
    bound = "at least" if comparison.more_is_better else "at most"
    medals = [
        row(
            (f"{MEDAL_SIGNS[medal]} ", MEDAL_STYLES[medal]),
            f"{medal.title:<{NAME_COLUMNS}} ",
            (f"{bound} ", "dim"),
            _rung_text(comparison, figure),
        )
        for medal, figure in reversed(comparison.rungs)
    ]
    return [row(), *medals]


def challenge_picture(challenge: Challenge, width: int, height: int, glyphs: GlyphStyle) -> list[Row]:
    """What a challenge looks like before anybody has begun, as large as fits: its board, or the drawing of one that has none."""
    board = challenge.task.board("")
    if board is None:
        shown = [row((line, "code")) for line in challenge.task.lines()]
    else:
        scale, _ = largest_drawing(board, width, height)
        shown = board.drawing(width, height, glyphs) or board.rows(scale)
    return [part for each in shown for part in _wrap_row(each, width)][:height]


def small_picture(challenge: Challenge, width: int) -> list[Row]:
    """The board of a challenge as it is drawn, below an empty row; nothing where there is none, or it is wider."""
    board = challenge.task.board("")
    drawn = [] if board is None else _table_and_rest(board.rows())[0]
    return [row(), *drawn] if max(map(row_width, drawn), default=width + 1) <= width else []


def challenge_page(challenge: Challenge, file: Path | None, width: int) -> list[Row]:
    """A challenge as a page. ``file``: where the answer is written; None: a training run is handed in."""
    place = (
        "Your answer is a training run of yours: c asks which one."
        if file is None
        else f"Your answer: {shell_path(file)}"
    )
    return [
        *_wrap_with_lead("", challenge.story, width),
        *_wrap_with_lead("task  ", challenge.written_task, width, "dim"),
        *(each for line in challenge.task.lines() for each in broken(row((line, "code")), width)),
        *broken(row((place, "bold")), width),
    ]


@dataclass(frozen=True, slots=True)
class PuzzleCheck:
    """What came of handing in a puzzle's answer."""

    previous: Medal = Medal.NONE
    """The best medal before."""
    following: str | None = None
    """The title of the next challenge; None after the last one."""
    problem: str = ""
    """Why it could not be judged or kept; empty where it was."""


@dataclass(frozen=True, slots=True)
class PuzzleView:
    """What is shown of a puzzle that is being solved."""

    challenge: Challenge
    board: Board
    judgement: Judgement | str
    """Of the answer on the board, or why there is none."""
    glyphs: GlyphStyle
    check: PuzzleCheck | None = None
    beside: Sequence[Sequence[Row]] = ()
    """Parts that stand beside the board, before the first of its details, where they fit."""
    checks: Sequence[ProgressEvent] = ()
    """Those so far, the oldest first, which are listed after it."""

    def details(self, width: int, tries: Sequence[Row]) -> list[Sequence[Row]]:
        """All that may stand beside the board, in this order. ``tries``: the list of the checks."""
        details = self.board.details(width)
        return [*self.beside, *details[:1], tries, *details[1:]]


def puzzle_page(view: PuzzleView, width: int, height: int) -> list[Row]:
    """A puzzle below each other: what it asks for, its board, what the answer is worth. A check changes no row's place. Where there
    are too few rows, the keys give way first, which stand at the foot too, then the empty row above the board, the story, the
    sentence about the worth and the task."""
    board = view.board
    story, task, keys, signs = _about_puzzle(view, width)
    worth, sentence = worth_now(view.judgement, width, view.check)
    around = sum(map(len, (story, task, keys, signs, worth, sentence)))
    room = height - around - 1
    scale, _ = largest_drawing(board, width, room + len(keys))
    middle = _with_drawing(view, board.rows(scale), width, room)
    for left_out in range(6):
        parts = [
            *(story if left_out < 3 else ()),
            *(task if left_out < 5 else ()),
            *(keys if left_out < 1 else ()),
            *(signs if left_out < 5 else ()),
            *([row()] if left_out < 2 else ()),
            *middle,
            *worth,
            *(sentence if left_out < 4 else ()),
        ]
        if len(parts) <= height:
            break
    return parts


def puzzle_beside(view: PuzzleView, width: int, height: int) -> list[Row]:
    """A puzzle with its picture at the left and the curve of its moves below, and beside it what it asks for, what the answer is
    worth and what helps to solve it, in two columns where there is room. The picture is the board, or a drawing of it, which then
    stands among the rest."""
    board, glyphs = view.board, view.glyphs
    lesson: list[Row] = []
    if drawing := board.drawing(int(width * DRAWING_SHARE), height - 1, glyphs):
        column, left = max(map(row_width, drawing)) + GAP, drawing
    else:
        scale, columns = largest_drawing(board, width - LEAST_TEXT - GAP, height - 1)
        column = min(max(LEAST_BOARD, columns + GAP), width - LEAST_TEXT)
        left = [each for shown in board.rows(scale) for each in _wrap_row(shown, column - GAP)]
        empty = height - 1 - len(left)
        curve = _curve_rows(board, column - GAP, empty)
        lesson = [] if curve else lesson_below(view.challenge, column - GAP - MARGIN, empty)
        left += [*curve, *(row(" " * MARGIN, *each) for each in lesson)]
    rest = width - column - 1
    count = 2 if rest >= 2 * TWO_TEXTS else 1
    room = min(rest // count - GAP * (count - 1), WIDEST_TEXT)
    story, task, keys, signs = _about_puzzle(view, room)
    worth, sentence = worth_now(view.judgement, room, view.check)
    text = [row(), *story, row(), *task, row(), *keys, *signs, row(), *worth]
    text += sentence if len(text) + len(sentence) <= height else ()
    details = board.details(room)
    table: list[Row] = []
    if drawing:
        cells, told = _table_and_rest(board.rows())
        table = [*cells, *(each for shown in told for each in _wrap_row(shown, room))]
    tries = tries_rows(view.checks, room)
    judgement = view.judgement
    rungs = [] if isinstance(judgement, str) else _rungs_rows(judgement.comparison)[1:]
    below: list[Sequence[Row]] = [table, rungs, *view.beside, tries]
    if count == 1:
        below = [table, *view.details(room, tries), rungs]
    text += _stacked(below, room, height - len(text))
    if count == 1 and not lesson:
        text += lesson_below(view.challenge, room, height - len(text))
    shown = side_by_side([row(), *left], text, column)
    if count == 1:
        return shown
    third = _stacked(details, room, height)
    if not lesson:
        third += lesson_below(view.challenge, room, height - len(third))
    return side_by_side(shown, third, column + room + GAP)


def _stacked(parts: Iterable[Sequence[Row]], width: int, height: int) -> list[Row]:
    """Those parts below each other that fit, each below an empty row; of a long list as much as there is room for."""
    placed: list[Row] = []
    for part in parts:
        room = height - len(placed) - 1
        shown = part[:room] if len(part) > LONG_LIST and room >= LEAST_LISTED else part
        if shown and len(shown) <= room and max(map(row_width, shown)) <= width:
            placed += [row(), *shown]
    return placed


def _curve_rows(board: Board, width: int, height: int) -> list[Row]:
    """The curve of a figure of a board over its moves; none where there is no room, or no move yet."""
    title, figures = board.curve()
    if not figures or height < CHART_ROWS + 2:
        return []
    return [row(), *stretched_chart(title, "", figures, width, 1.0, min(height - 2, MOST_CURVE_ROWS))]


def tries_rows(events: Sequence[ProgressEvent], width: int) -> list[Row]:
    """The checks of a challenge so far, the newest first. ``events``: of it, the oldest first."""
    checks = [each for each in events if "medal" in each.content and each.content.get("text") != BEGUN]
    if not checks:
        return []
    note = f", the last {MOST_TRIES}" if len(checks) > MOST_TRIES else ""
    rows = [row((f"{counted(len(checks), 'check')} so far{note}", "title"))]
    for each in reversed(checks[-MOST_TRIES:]):
        number = int(each.number("medal") or 0)
        medal = Medal(number) if number in tuple(Medal) else Medal.NONE
        when = f" {each.time.astimezone():%d %b %H:%M}  "
        sign = (f"{MEDAL_SIGNS[medal]} ", MEDAL_STYLES[medal])
        told = str(each.content.get("text", "")) if width >= LEAST_TOLD else medal.title
        rows += broken(row((when, "dim"), sign, told), width)
    return rows


def _with_drawing(view: PuzzleView, rows: Sequence[Row], width: int, height: int) -> list[Row]:
    """A board with the drawing of it, if it has one, else with what fits there, beside its table."""
    table, rest = _table_and_rest(rows)
    column = max(map(row_width, table), default=0) + GAP
    beside = width - column
    if beside < LEAST_DETAILS:
        return [*table, *rest]
    right = view.board.drawing(beside, max(len(table), height - len(rest)), view.glyphs)
    if not right:
        details = view.details(beside, tries_rows(view.checks, LEAST_TOLD - 1))
        right = _stacked(details, beside, len(table) + 1)[1:]
    return [*(side_by_side(table, right, column) if right else table), *rest]


def _table_and_rest(rows: Sequence[Row]) -> tuple[list[Row], list[Row]]:
    """A board's rows up to the first empty one, and from there on."""
    count = next((number for number, each in enumerate(rows) if not each), len(rows))
    return [*rows[:count]], [*rows[count:]]


def largest_drawing(board: Board, width: int, height: int) -> tuple[int, int]:
    """The largest scale of a board's drawing that fits, and how many columns it then has, 0 for one that has no scale."""
    usual = {row_text(each) for each in board.rows()}
    for scale in range(LARGEST_SCALE, 1, -1):
        rows = [row_text(each) for each in board.rows(scale)]
        drawn = max((len(each.rstrip()) for each in rows if each not in usual), default=0)
        if drawn <= width and len(rows) <= height:
            return scale, drawn
    return 1, 0


def _wrap_row(shown: Row, width: int) -> list[Row]:
    """A row that is wider, which is a sentence, goes on below."""
    text = row_text(shown)
    if len(text) <= width:
        return [shown]
    indent = text[: len(text) - len(text.lstrip())]
    return [row((line, shown[-1][1])) for line in wrap(text.strip(), width, indent, indent)]


def _about_puzzle(view: PuzzleView, width: int) -> tuple[list[Row], list[Row], list[Row], list[Row]]:
    """The story, the task, the keys and the signs of a puzzle."""
    signs = view.board.signs
    return (
        _wrap_with_lead("", view.challenge.story, width),
        _wrap_with_lead("task  ", view.challenge.task_text, width, "dim"),
        _wrap_with_lead("keys  ", view.board.keys, width, "dim"),
        _wrap_with_lead("signs ", signs, width, "dim") if signs else [],
    )


def worth_now(
    judgement: Judgement | str, width: int, check: PuzzleCheck | None = None
) -> tuple[list[Row], list[Row]]:
    """What the answer on a board is worth, with a bar from the naive answer to the best one; and a sentence about it. ``check``:
    what came of handing it in, which is told in as many rows."""
    lead = ("now    ", "dim") if check is None else ("check  ", "bold")
    problem = "" if check is None else check.problem
    if isinstance(judgement, str):
        sentence = _wrap_with_lead("      ", judgement, width, "dim") if judgement else []
        return [row(lead, "no answer yet")], sentence
    medal = judgement.medal
    is_new = check is not None and not problem and medal > check.previous
    rows = [
        row(lead, (MEDAL_SIGNS[medal] + " ", MEDAL_STYLES[medal]), (medal.title + NEW * is_new, "bold")),
    ]
    told = UNSOLVED if check is not None and medal is Medal.NONE else ""
    if asked := next_medal(judgement) or told:
        is_beside = row_width(rows[0]) + len(NEW) * (not is_new) + len(asked) <= width
        rows[-1:] = [row(*rows[0], asked)] if is_beside else [*rows, row("    ", asked)]
    comparison = judgement.comparison
    if comparison is not None and comparison.others[0][1] != comparison.others[-1][1]:
        (first, naive), (last, best) = comparison.others[0], comparison.others[-1]
        share = (comparison.answer - naive) / (best - naive)
        parts = (
            (f"{first} {_number_text(naive)} ", "dim"),
            (share_bar(share), "good" if judgement.medal is not Medal.NONE else "dim"),
            (f" {last} {_number_text(best)} {comparison.unit}", "dim"),
        )
        indent = "       "
        if len(indent) + sum(len(text) for text, _ in parts) <= width:
            rows.append(row(indent, *parts))
        else:
            rows += [row(indent, (text.strip(), style)) for text, style in parts]
    sentence = _wrap_with_lead("      ", judgement.text, width, "dim")
    if check is not None and (problem or (check.following is not None and medal is not Medal.NONE)):
        told = problem or f"next   {check.following}"
        told_rows = (
            _wrap_with_lead("      ", told, width, "dim") if problem else [row(("next   ", "dim"), told[7:])]
        )
        sentence = [*told_rows, *[row()] * len(sentence)][: len(sentence)]
    return rows, sentence


def next_medal(judgement: Judgement) -> str:
    """What the next medal asks for; empty where none is left, or a figure does not decide."""
    comparison = judgement.comparison
    if comparison is None or comparison.medal is not judgement.medal or comparison.next_rung is None:
        return ""
    medal, figure = comparison.next_rung
    return f"   next {medal.title} at {_rung_text(comparison, figure)}"


def _rung_text(comparison: AnswerComparison, figure: float) -> str:
    """What a medal asks for, rounded so that it earns the medal."""
    hundredths = math.ceil(figure * 100.0) if comparison.more_is_better else math.floor(figure * 100.0)
    return f"{_number_text(hundredths / 100.0)} {comparison.unit}"


def judged(judgement: Judgement, previous: Medal, following: str | None, beside: Sequence[Row]) -> list[Row]:
    """What an answer earned, how it stands ``beside`` others, and after a medal what comes next.

    ``previous``: the best medal before. ``following``: the title of the next challenge; None after the last one.
    """
    won = medal_row(judgement.medal, is_new=judgement.medal > previous)
    rows = [row(*won, next_medal(judgement)), *beside]
    if following is not None and judgement.medal is not Medal.NONE:
        rows.append(row(("   next ", "dim"), following))
    return rows


def beside_others(judgement: Judgement, width: int) -> list[Row]:
    """A sentence about an answer, and how far it is from others."""
    rows = _wrap_with_lead("  ", judgement.text, width)
    return rows if judgement.comparison is None else rows + _comparison_rows(judgement.comparison)


def answers_needed_rows(bins: Sequence[HistogramBin], comparison: AnswerComparison, width: int) -> list[Row]:
    """A histogram of what all players of this machine needed; empty for one without bins."""
    decimals = 0 if float(comparison.answer).is_integer() else 2
    return needed_rows(bins, width, comparison.unit, decimals)


def _comparison_rows(comparison: AnswerComparison) -> list[Row]:
    """The differences of an answer to others; one that is no worse than the other is told by its style too."""
    rows = []
    for name, figure in comparison.others:
        difference = round(figure - comparison.answer, 2)
        is_good = difference <= 0 if comparison.more_is_better else difference >= 0
        apart = f"{_number_text(abs(difference))} {'more' if difference > 0 else 'less'} than yours"
        rows.append(
            row(
                f"   {name:<{NAME_COLUMNS}} {_number_text(figure):>9} {comparison.unit}   ",
                (apart if difference else "as yours", "good" if is_good else "warn"),
            )
        )
    return rows


def _number_text(value: float) -> str:
    return f"{value:,.0f}" if float(value).is_integer() else f"{value:,.2f}"


def _wrap_with_lead(word: str, text: str, width: int, style: str = "bold") -> list[Row]:
    """A text that begins with a word in a style of its own, in rows of at most ``width`` columns."""
    start = f"{word} " if word else ""
    indent = " " * len(start) if style == "dim" or not word.strip() else ""
    first, *others = wrap(text, max(20, width), start, indent)
    return [row((start, style), first[len(start) :]), *(row(line) for line in others)]
