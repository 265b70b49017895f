"""Let two robots pass each other where there is room for one: waiting is a move too (multi-agent path finding)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, partial
from itertools import product, zip_longest
from pathlib import Path
from typing import Final

from kit.breadth_first import reached_from
from kit.document.rows import Row, row
from kit.plain_text import quoted
from kit.school.game.board import (
    MOVES,
    Board,
    Cell,
    cells_of_moves,
    distances_to,
    find_cell,
    grid_rows,
    letters_of,
    shortest_way,
    step,
    told_rows,
    visit_rows,
)
from kit.school.game.challenge import AnswerError, AnswerSubmission
from kit.school.game.judgement import Judgement, judge_count
from kit.school.game.medal import Medal
from kit.school.game.moves_challenge import MovesTask

WAIT: Final = "."
MAX_TICKS: Final = 100


@dataclass(frozen=True, slots=True)
class PassByTask(MovesTask):
    """A floor with two robots, ``A`` and ``B``, that want to be where ``a`` and ``b`` are."""

    kind = "pass_by"

    def naive_answer(self) -> str:
        """Each robot goes its own shortest way."""
        ways = (
            shortest_way(self.grid, start, goal) for start, goal in zip(self.starts, self.goals, strict=True)
        )
        return "\n".join(ways) + "\n"

    def board(self, answer: str) -> Board:
        return PassByBoard(self, answer)

    def judge(self, submission: AnswerSubmission) -> Judgement:
        moves = read_two(submission.answer)
        ticks = max(map(len, moves))
        if meeting := first_meeting(self, moves):
            return Judgement(Medal.NONE, f"The robots meet at tick {meeting}.")
        if places(self, moves, ticks) != self.goals:
            return Judgement(Medal.NONE, "Not both robots are where they want to be.")
        fewest = len(fewest_ticks(self)[0])
        naive = sum(len(way) for way in self.naive_answer().split()) * 2
        text = f"{ticks} ticks; {fewest} are enough."
        return judge_count("ticks", text, ticks, fewest, naive)

    @property
    def starts(self) -> tuple[Cell, Cell]:
        return find_cell(self.grid, "A"), find_cell(self.grid, "B")

    @property
    def goals(self) -> tuple[Cell, Cell]:
        return find_cell(self.grid, "a"), find_cell(self.grid, "b")


def read_two(answer: str) -> tuple[str, str]:
    """The moves of both robots, a word each: l, r, u, d and ``.`` to wait. Raises AnswerError."""
    words = answer.lower().split()
    if len(words) != 2:
        raise AnswerError("Write two words: the moves of robot A, and those of robot B.")
    if strange := sorted(set("".join(words)) - {*MOVES, WAIT}):
        raise AnswerError(f"{quoted(strange[0])} is not a move: write l, r, u, d, and . to wait.")
    if max(map(len, words)) > MAX_TICKS:
        raise AnswerError(f"More than {MAX_TICKS} ticks are too many.")
    return words[0], words[1]


def places(task: PassByTask, moves: tuple[str, str], tick: int) -> tuple[Cell, Cell]:
    """Where both robots are after this many ticks; one whose moves have ended stays."""
    found = []
    for start, own in zip(task.starts, moves, strict=True):
        cell = start
        for name in own[:tick]:
            cell = cell if name == WAIT else step(task.grid, cell, name)
        found.append(cell)
    return found[0], found[1]


def first_meeting(task: PassByTask, moves: tuple[str, str]) -> int:
    """The first tick at which both are in one cell or change places; 0 if there is none."""
    before = task.starts
    for tick, _ in enumerate(zip_longest(*moves), 1):
        after = places(task, moves, tick)
        if after[0] == after[1] or after == (before[1], before[0]):
            return tick
        before = after
    return 0


@cache
def fewest_ticks(task: PassByTask) -> tuple[str, str]:
    """Plans than which none are over earlier."""
    for present, moves in reached_from(task.starts, partial(_moves_of_both, task)):
        if present == task.goals:
            return "".join(first for first, _ in moves), "".join(second for _, second in moves)
    raise ValueError("The robots cannot pass each other.")


def _moves_of_both(
    task: PassByTask, present: tuple[Cell, Cell]
) -> Iterator[tuple[tuple[str, str], tuple[Cell, Cell]]]:
    """The moves of both robots in which they do not meet, with the cells that they lead to."""
    for first, second in product((*MOVES, WAIT), repeat=2):
        following = (
            present[0] if first == WAIT else step(task.grid, present[0], first),
            present[1] if second == WAIT else step(task.grid, present[1], second),
        )
        if following[0] != following[1] and following != (present[1], present[0]):
            yield (first, second), following


class PassByBoard(Board):
    """Arrows plan one robot's way, the other one moves along by its own plan; Space lets it wait."""

    keys = "Arrows move a robot, Space lets it wait, Tab changes to the other one, u undoes the last move."
    mark_word = "wait"

    def __init__(self, task: PassByTask, answer: str) -> None:
        self._task = task
        self._moves = ["", ""]
        self._active = 0
        with suppress(AnswerError):
            if answer.split() != task.naive_answer().split():
                self._moves = list(read_two(answer))

    @property
    def _both_moves(self) -> tuple[str, str]:
        return self._moves[0], self._moves[1]

    @property
    def answer(self) -> str:
        return "\n".join(own or WAIT for own in self._moves) + "\n"

    def judgement(self) -> Judgement:
        return self._task.judge(AnswerSubmission(self.answer, Path()))

    def move(self, columns: int, rows: int) -> None:
        self._add_move(letters_of(columns, rows))

    def mark(self) -> None:
        self._add_move(WAIT)

    def switch(self) -> None:
        self._active = 1 - self._active

    def _add_move(self, name: str) -> None:
        if len(self._moves[self._active]) < MAX_TICKS:
            self._moves[self._active] += name

    def undo(self) -> None:
        self._moves[self._active] = self._moves[self._active][:-1]

    def rows(self, scale: int = 1) -> list[Row]:
        task, tick = self._task, len(self._moves[self._active])
        signs = {goal: (name, "good") for name, goal in zip("ab", task.goals, strict=True)}
        signs |= dict.fromkeys(task.starts, (" ", ""))
        here = places(task, self._both_moves, tick)
        for number, cell in enumerate(here):
            signs[cell] = ("AB"[number], "chosen" if number == self._active else "bold")
        meeting = first_meeting(task, self._both_moves)
        if here[0] == here[1]:
            signs[here[0]] = ("X", "bad")
        plans = [
            row((f"  {'>' if number == self._active else ' '} {name} ", "bold"), own)
            for number, (name, own) in enumerate(zip("AB", self._moves, strict=True))
        ]
        state = f"they meet at tick {meeting}" if meeting else "they do not meet"
        ticks = max(map(len, self._moves))
        return [
            *grid_rows(task.grid, signs, scale),
            row(),
            *plans,
            row((f"  ticks {ticks}", "bold"), f"   shown: after tick {tick}   {state}"),
        ]

    def details(self, width: int) -> list[list[Row]]:
        """How far each robot is from where it wants to be, and how often each square was entered."""
        task, now = self._task, places(self._task, self._both_moves, MAX_TICKS)
        left = [distances_to(task.grid, goal)[cell] for goal, cell in zip(task.goals, now, strict=True)]
        togo = told_rows("moves still to go at the end", zip("AB", left, strict=True), width)
        entered = [
            cell
            for start, moves in zip(task.starts, self._moves, strict=True)
            for cell in cells_of_moves(task.grid, start, moves.replace(WAIT, ""))
        ]
        return [togo, visit_rows(task.grid, entered)]

    def curve(self) -> tuple[str, Sequence[float]]:
        far = [distances_to(self._task.grid, goal) for goal in self._task.goals]
        ticks = range(1, max(map(len, self._moves)) + 1)
        both = (places(self._task, self._both_moves, tick) for tick in ticks)
        return "moves still to go for both after each tick", [far[0][a] + far[1][b] for a, b in both]


KIND = PassByTask
