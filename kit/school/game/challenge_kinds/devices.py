"""Mount the fewest lasers that see all places of a drawing."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final, Self

from kit.document.blocks import Tone, ToneText
from kit.document.rows import Row, row
from kit.layers.cover import minimum_cover
from kit.plain_text import counted
from kit.school.game.board import (
    LIT,
    LIT_STYLE,
    WALL,
    Board,
    Cell,
    History,
    by_value,
    figure_rows,
    free_cells,
    grid_rows,
    told_rows,
)
from kit.school.game.challenge import AnswerError, AnswerSubmission, ChallengeTask
from kit.school.game.judgement import Judgement, judge_count
from kit.school.game.medal import Medal
from kit.world.yaml_section import Section

STEPS_PER_SQUARE: Final = 10
"""A line of sight is checked at this many points on the length of a square."""
MAX_DEVICES: Final = 100


@dataclass(frozen=True, slots=True)
class DevicesTask(ChallengeTask):
    """A drawing: ``#`` wall, lower-case letters the places to be seen, everything else floor."""

    kind = "devices"
    answer_file = "lasers.txt"

    grid: tuple[str, ...]
    reach: float = math.inf
    """How far a laser sees [squares]."""

    @classmethod
    def read(cls, section: Section, folder: Path) -> Self:
        return cls(section.texts("map", at_least=1), section.number("reach", math.inf, above=0))

    def lines(self) -> list[str]:
        columns = "   " + "".join(str(column % 10) for column in range(len(self.grid[0])))
        return [columns, *(f"{number:>2} {line}" for number, line in enumerate(self.grid))]

    def naive_answer(self) -> str:
        return "".join(f"{row},{column}\n" for row, column in naive_lasers(self))

    def board(self, answer: str) -> Board:
        return DevicesBoard(self, answer)

    def judge(self, submission: AnswerSubmission) -> Judgement:
        """Judges by what is not seen, then by the number of lasers against the fewest and the naive plan's."""
        lasers = read_lasers(self, submission.answer)
        missed = sorted(set(self.places) - self.seen_from(lasers))
        if missed:
            return Judgement(Medal.NONE, f"Nothing sees {', '.join(missed)}.")
        count, fewest, naive = len(lasers), len(fewest_lasers(self)), len(naive_lasers(self))
        text = f"{counted(count, 'laser')}; one at every place takes {naive}, and {fewest} are enough."
        return judge_count("lasers", text, count, fewest, naive)

    @property
    def places(self) -> dict[str, Cell]:
        """The places by their letters."""
        return {sign: square for square, sign in self._squares().items() if sign.islower()}

    @property
    def floor(self) -> tuple[Cell, ...]:
        """The squares where a laser can be mounted."""
        return free_cells(self.grid)

    def sees(self, laser: Cell, square: Cell) -> bool:
        """Whether no wall lies on the straight line between the middles of two squares, and it is no longer than a laser reaches."""
        if math.dist(laser, square) > self.reach:
            return False
        steps = STEPS_PER_SQUARE * max(abs(laser[0] - square[0]), abs(laser[1] - square[1]), 1)
        for step in range(steps + 1):
            row, column = (round(a + (b - a) * step / steps) for a, b in zip(laser, square, strict=True))
            if self.grid[row][column] == WALL:
                return False
        return True

    def seen_from(self, lasers: tuple[Cell, ...]) -> set[str]:
        """The letters of the places that at least one laser sees."""
        visible = _visible_squares(self)
        return {name for laser in lasers for name in visible[laser]}

    def _squares(self) -> dict[Cell, str]:
        return {(row, column): sign for row, line in enumerate(self.grid) for column, sign in enumerate(line)}


class DevicesBoard(Board):
    """A cursor that mounts lasers; what they see is lit, and letters that are seen become capitals."""

    keys = "Arrows move the cursor, Space mounts a laser or takes it away, u undoes it."
    mark_word = "mount"

    def __init__(self, task: DevicesTask, answer: str) -> None:
        self._task = task
        self._lasers: tuple[Cell, ...] = ()
        self._cursor = task.floor[0]
        self._history: History[tuple[Cell, ...]] = History()
        with suppress(AnswerError):
            lasers = read_lasers(task, answer)
            self._lasers = lasers if lasers != naive_lasers(task) else ()

    @property
    def answer(self) -> str:
        return "".join(f"{row},{column}\n" for row, column in self._lasers)

    def judgement(self) -> Judgement:
        return self._task.judge(AnswerSubmission(self.answer, Path()))

    def move(self, columns: int, rows: int) -> None:
        """To the next square of the floor in that direction; walls are passed over."""
        row, column = self._cursor
        grid = self._task.grid
        for distance in range(1, max(len(grid), len(grid[0]))):
            there = row + distance * _sign(rows), column + distance * _sign(columns)
            if there in self._task.floor:
                self._cursor = there
                return

    def mark(self) -> None:
        self._history.note(self._lasers)
        if self._cursor in self._lasers:
            self._lasers = tuple(each for each in self._lasers if each != self._cursor)
        else:
            self._lasers = (*self._lasers, self._cursor)[:MAX_DEVICES]

    def undo(self) -> None:
        self._lasers = self._history.take(self._lasers)

    def rows(self, scale: int = 1) -> list[Row]:
        task, seen = self._task, self._task.seen_from(self._lasers)
        lit = {square for laser in self._lasers for square in _squares_seen_from(task, laser)}
        signs: dict[Cell, tuple[str, str]] = {}
        for square in task.floor:
            signs[square] = (LIT, LIT_STYLE) if square in lit else (" ", "")
        for name, square in task.places.items():
            signs[square] = (name.upper(), "good") if name in seen else (name, "bold")
        signs |= dict.fromkeys(self._lasers, ("*", "warn"))
        under = signs[self._cursor][0]
        signs[self._cursor] = ("+" if under in (" ", LIT) else under, "chosen")
        return [
            *grid_rows(task.grid, signs, scale, lit=lit - set(self._lasers)),
            row(),
            row(
                (f"  lasers {len(self._lasers)}", "bold"),
                f"   {len(seen)} of {len(task.places)} letters seen",
            ),
        ]

    def details(self, width: int) -> list[list[Row]]:
        """What each laser sees, what one would see at the cursor, what nothing sees yet, and how many see each square."""
        task = self._task
        missed = sorted(set(task.places) - task.seen_from(self._lasers))
        places = [("cursor", self._cursor), *((f"{laser[0]},{laser[1]}", laser) for laser in self._lasers)]
        sights = [
            (name, ToneText(" ".join(sorted(_visible_squares(task)[place])) or "none", Tone.BOLD))
            for name, place in places
        ]
        lit = Counter(cell for laser in self._lasers for cell in _squares_seen_from(task, laser))
        return [
            told_rows("letters in sight of", sights, width),
            [row(("letters that nothing sees", "title")), row(f" {' '.join(missed) or 'none'}")],
            figure_rows(
                "lasers that see each square",
                task.grid,
                by_value(lit, {cell: str(lit[cell]) for cell in lit}),
            ),
        ]

    def curve(self) -> tuple[str, Sequence[float]]:
        counts = range(1, len(self._lasers) + 1)
        return "letters seen after each laser", [
            len(self._task.seen_from(self._lasers[:count])) for count in counts
        ]


def _sign(number: int) -> int:
    return (number > 0) - (number < 0)


def naive_lasers(task: DevicesTask) -> tuple[Cell, ...]:
    """A laser at every place: the naive answer."""
    return tuple(task.places.values())


@cache
def _visible_squares(task: DevicesTask) -> dict[Cell, frozenset[str]]:
    """Computes which squares are seen from each square of the floor."""
    places = task.places
    return {
        square: frozenset(name for name, place in places.items() if task.sees(square, place))
        for square in task.floor
    }


@cache
def _squares_seen_from(task: DevicesTask, laser: Cell) -> frozenset[Cell]:
    """Computes which squares of the floor are seen from one of them."""
    return frozenset(square for square in task.floor if task.sees(laser, square))


@cache
def fewest_lasers(task: DevicesTask) -> tuple[Cell, ...]:
    """A plan than which none has fewer lasers."""
    places = list(task.places)
    columns = [
        frozenset(number for number, name in enumerate(places) if name in task.seen_from((square,)))
        for square in task.floor
    ]
    cover = minimum_cover(columns, len(places))
    assert cover.is_proved  # no deadline
    return tuple(task.floor[column] for column in cover.chosen)


def read_lasers(task: DevicesTask, answer: str) -> tuple[Cell, ...]:
    """Reads ``ROW,COLUMN ROW,COLUMN``. Raises AnswerError."""
    words = answer.split()
    if not 0 < len(words) <= MAX_DEVICES:
        raise AnswerError(f"Write the places of 1 to {MAX_DEVICES} lasers, such as 1,4 6,2.")
    found = []
    for word in words:
        parts = word.split(",")
        if len(parts) != 2 or not all(part.isascii() and part.isdigit() and len(part) < 5 for part in parts):
            raise AnswerError(
                f"{word[:20]!r} is not a place: write its row, a comma and its column, counting from 0."
            )
        square = int(parts[0]), int(parts[1])
        if square not in task.floor:
            raise AnswerError(f"{word}: there is a wall, or nothing.")
        found.append(square)
    return tuple(found)


KIND = DevicesTask
