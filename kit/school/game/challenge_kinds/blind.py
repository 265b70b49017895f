"""Bring a robot to its place that knows neither where it is nor what is around it: walls are all it has (conformant planning)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import accumulate
from typing import TypeAlias

from kit.breadth_first import reached_from
from kit.document.rows import Row, row
from kit.plain_text import counted
from kit.school.game.board import (
    MOVES,
    Board,
    Cell,
    by_value,
    cells_of_moves,
    figure_rows,
    find_cell,
    free_cells,
    grid_rows,
    shortest_way,
    step,
)
from kit.school.game.challenge import AnswerSubmission
from kit.school.game.judgement import Judgement, judge_count
from kit.school.game.medal import Medal
from kit.school.game.moves_challenge import MovesBoard, MovesTask, read_moves

MAX_MOVES = 200
Belief: TypeAlias = frozenset[Cell]
"""Where the robot may be."""


@dataclass(frozen=True, slots=True)
class BlindTask(MovesTask):
    """A floor on which the robot may be anywhere; after the moves it has to be at ``G``, wherever it was."""

    kind = "blind"

    def naive_answer(self) -> str:
        return f"{naive_moves(self)}\n"

    def board(self, answer: str) -> Board:
        return BlindBoard(self, answer)

    def judge(self, submission: AnswerSubmission) -> Judgement:
        moves = read_moves(submission.answer, MAX_MOVES)
        belief = possible_cells(self, moves)
        goal = find_cell(self.grid, "G")
        if belief != {goal}:
            where = "1 place" if len(belief) == 1 else f"{len(belief)} places"
            return Judgement(Medal.NONE, f"The robot may be in {where} then, and has to be at G for certain.")
        count, fewest, naive = len(moves), len(fewest_moves(self)), len(naive_moves(self))
        text = f"{counted(count, 'move')}; two places after another takes {naive}, and {fewest} are enough."
        return judge_count("moves", text, count, fewest, naive)


def possible_cells(task: BlindTask, moves: str) -> Belief:
    """Where a robot may be after moves that may have begun anywhere."""
    belief: Belief = frozenset(free_cells(task.grid))
    for name in moves:
        belief = _move_belief(task, belief, name)
    return belief


def _move_belief(task: BlindTask, belief: Belief, move: str) -> Belief:
    return frozenset(step(task.grid, cell, move) for cell in belief)


def _shortest_moves(task: BlindTask, belief: Belief, is_goal: Belief | None) -> str:
    """The fewest moves that lead a belief to ``is_goal``, or to fewer places where that is None."""
    reached = reached_from(
        belief, lambda present: ((name, _move_belief(task, present, name)) for name in MOVES)
    )
    for present, moves in reached:
        if present == is_goal or (is_goal is None and len(present) < len(belief)):
            return "".join(moves)
    raise ValueError("No moves bring the robot to one place from everywhere.")


@cache
def fewest_moves(task: BlindTask) -> str:
    """A plan than which none is shorter."""
    return _shortest_moves(task, frozenset(free_cells(task.grid)), frozenset({find_cell(task.grid, "G")}))


@cache
def naive_moves(task: BlindTask) -> str:
    """A plan that brings two of the places together, then the next two, and the last one to the target."""
    belief, moves = frozenset(free_cells(task.grid)), ""
    while len(belief) > 1:
        two = frozenset(sorted(belief)[-2:])
        more = _shortest_moves(task, two, None)
        moves += more
        for name in more:
            belief = _move_belief(task, belief, name)
    (cell,) = belief
    return moves + shortest_way(task.grid, cell, find_cell(task.grid, "G"))


class BlindBoard(MovesBoard):
    """Arrows move the robot wherever it may be; each place shows where it may be now."""

    def __init__(self, task: BlindTask, answer: str) -> None:
        super().__init__(task, answer, MAX_MOVES)
        self._blind = task

    def rows(self, scale: int = 1) -> list[Row]:
        task = self._blind
        belief = possible_cells(task, self.moves)
        counts = Counter(belief)
        signs = {cell: (("o", "warn") if counts[cell] else ("·", "dim")) for cell in free_cells(task.grid)}
        goal = find_cell(task.grid, "G")
        signs[goal] = ("@", "good") if goal in belief else ("G", "bold")
        return [
            *grid_rows(task.grid, signs, scale),
            row(),
            row((f"  moves {len(self.moves)}", "bold"), f"   the robot may be in {len(belief)} places"),
        ]

    def details(self, width: int) -> list[list[Row]]:
        """How many of the squares where it may have begun lead to each square."""
        grid = self._blind.grid
        ends = Counter([cell, *cells_of_moves(grid, cell, self.moves)][-1] for cell in free_cells(grid))
        counts = by_value(ends, {cell: str(count) for cell, count in ends.items()})
        ends_here = figure_rows("beginnings that lead to each square", grid, counts)
        return [ends_here, self.moves_made(width)]

    def curve(self) -> tuple[str, Sequence[float]]:
        anywhere: Belief = frozenset(free_cells(self._blind.grid))
        beliefs = accumulate(
            self.moves, lambda belief, move: _move_belief(self._blind, belief, move), initial=anywhere
        )
        sizes = [len(belief) for belief in beliefs][1:]
        return "places where it may be after each move", sizes


KIND = BlindTask
