"""Draw a policy: an arrow for each cell of a slippery floor, or one for all cells that look alike to the robot."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final, Self

import numpy as np

from kit.arrays import BoolArray, FloatArray
from kit.document.rows import Row, row
from kit.school.game.board import (
    ARROWS,
    GOAL,
    MOVES,
    START,
    WALL,
    Board,
    Cell,
    History,
    by_value,
    distances_to,
    figure_rows,
    find_cell,
    free_cells,
    grid_rows,
    step,
)
from kit.school.game.challenge import AnswerError, AnswerSubmission, ChallengeTask, judge_return
from kit.school.game.judgement import Judgement
from kit.world.yaml_section import Section

PIT: Final = "X"
SIDES: Final = {"l": "ud", "r": "ud", "u": "lr", "d": "lr"}
"""Where a move may slip to."""
GOAL_PAY, PIT_PAY = 1.0, -1.0
CHUNK: Final = 2048
"""The number of policies that are evaluated together."""
MAX_POLICIES: Final = 100_000
"""The most policies of a floor with cells that look alike that are compared."""


@dataclass(frozen=True, slots=True)
class PolicyTask(ChallengeTask):
    """A floor: ``S`` start, ``G`` target (paid 1), ``X`` pit (paid -1); each ends the episode."""

    kind = "policy"
    answer_file = "policy.txt"

    grid: tuple[str, ...]
    slip: float
    """Chance of each side that a move slips there."""
    step_pay: float
    """Paid for each step, below 0."""
    discount: float
    looks_alike: bool
    """Whether the robot sees only which of the four cells beside it are walls, so that such cells share an arrow."""

    @classmethod
    def read(cls, section: Section, folder: Path) -> Self:
        return cls(
            section.texts("map", at_least=1),
            section.number("slip", minimum=0, maximum=0.49),
            section.number("step", maximum=0),
            section.number("discount", above=0, maximum=1),
            section.flag("looks_alike", False),
        )

    def lines(self) -> list[str]:
        return [*self.grid, self.prices]

    @property
    def prices(self) -> str:
        """What is paid, and how slippery the floor is, in one line."""
        slips = f", a move slips to each side with {self.slip:.0%}" if self.slip else ""
        return f"Reward: G 1, X -1, a step {self.step_pay:g}; discount {self.discount:g}{slips}."

    def naive_answer(self) -> str:
        return format_policy(self, naive_policy(self))

    def read_answer(self, file: Path) -> str:
        """The lines of the drawing; a wall begins a line, so comments end where the first line of the drawing is."""
        try:
            lines = file.read_text().splitlines()
        except (OSError, UnicodeDecodeError) as error:
            raise AnswerError(f"{file} cannot be read: {error}") from None
        return "\n".join(line for line in lines if not line.startswith("# "))

    def board(self, answer: str) -> Board:
        return PolicyBoard(self, answer)

    def judge(self, submission: AnswerSubmission) -> Judgement:
        value = value_of(self, read_policy(self, submission.answer))
        naive, best = value_of(self, naive_policy(self)), value_of(self, best_policy(self))
        if math.isinf(value):
            raise AnswerError(
                "From S an episode may never end, and each of its steps costs: lead every cell to G."
            )
        text = f"Return from S {value:.2f}; the shortest way has {naive:.2f}, and {best:.2f} is possible."
        return judge_return(text, value, naive, best)

    @property
    def cells(self) -> tuple[Cell, ...]:
        """The cells that need an arrow."""
        return tuple(cell for cell in free_cells(self.grid) if self.grid[cell[0]][cell[1]] not in PIT + GOAL)

    def look(self, cell: Cell) -> object:
        """What the robot sees in a cell: cells of one look share an arrow."""
        if not self.looks_alike:
            return cell
        return tuple(step(self.grid, cell, move) == cell for move in MOVES)


Policy = dict[Cell, str]
"""An arrow for each cell."""


def naive_policy(task: PolicyTask) -> Policy:
    """The shortest way from each cell, as if nothing slipped; of cells that look alike the one nearest to the target decides."""
    dry = tuple(line.replace(PIT, WALL) for line in task.grid)
    far = distances_to(dry, find_cell(task.grid, GOAL))
    by_look: dict[object, str] = {}
    policy = {}
    for cell in sorted(task.cells, key=lambda each: far.get(each, 10**6)):
        arrow = min(MOVES, key=lambda move: far.get(step(dry, cell, move), 10**6))
        policy[cell] = by_look.setdefault(task.look(cell), arrow)
    return policy


def format_policy(task: PolicyTask, policy: Policy) -> str:
    """A policy as an answer's file holds it: the drawing with letters for arrows."""
    lines = [
        "".join(policy.get((row, column), sign) for column, sign in enumerate(line))
        for row, line in enumerate(task.grid)
    ]
    return "\n".join(lines) + "\n"


def read_policy(task: PolicyTask, answer: str) -> Policy:
    """Reads the drawing with l, r, u or d in each cell. Raises AnswerError."""
    lines = [line for line in answer.splitlines() if line.strip()]
    if [len(line) for line in lines] != [len(line) for line in task.grid]:
        raise AnswerError("Write the drawing as it is, with l, r, u or d in each free cell.")
    policy: Policy = {}
    of_look: dict[object, str] = {}
    for cell in task.cells:
        sign = lines[cell[0]][cell[1]].lower()
        if sign not in MOVES:
            raise AnswerError(f"Row {cell[0]}, column {cell[1]} (from 0): {sign!r} is none of l, r, u, d.")
        if of_look.setdefault(task.look(cell), sign) != sign:
            raise AnswerError(
                f"Row {cell[0]}, column {cell[1]} (from 0) looks like a cell with another arrow."
            )
        policy[cell] = sign
    return policy


@cache
def _transition_model(task: PolicyTask) -> dict[str, tuple[FloatArray, FloatArray]]:
    """The chances (cells, cells) of where each move leads, and what it is paid on average (cells,), by move."""
    cells = task.cells
    number = {cell: at for at, cell in enumerate(cells)}
    model = {}
    for move in MOVES:
        chances, pays = np.zeros((len(cells), len(cells))), np.full(len(cells), task.step_pay)
        for cell in cells:
            ways = [(move, 1.0 - 2.0 * task.slip), *((side, task.slip) for side in SIDES[move])]
            for way, chance in ways:
                there = step(task.grid, cell, way)
                sign = task.grid[there[0]][there[1]]
                if there in number:
                    chances[number[cell], number[there]] += chance
                else:
                    pays[number[cell]] += chance * (GOAL_PAY if sign == GOAL else PIT_PAY)
        model[move] = chances, pays
    return model


def _leading_to(chances: FloatArray, cells: BoolArray) -> BoolArray:
    """(cells,) those from which one of ``cells`` is ever reached, themselves included."""
    found = cells
    while True:
        further = found | (chances[:, found] > 0).any(axis=1)
        if (further == found).all():
            return found
        found = further


def _values(task: PolicyTask, arrows: Sequence[str]) -> FloatArray:
    """(cells,) the expected return from each cell under these arrows, exactly: a linear system.

    Without a discount it is minus infinity where an episode may never end: its steps cost without limit.
    """
    model = _transition_model(task)
    chances = np.stack([model[arrow][0][at] for at, arrow in enumerate(arrows)])
    pays = np.array([model[arrow][1][at] for at, arrow in enumerate(arrows)])
    ends = np.ones(len(arrows), np.bool_)
    if task.discount == 1:
        may_end = _leading_to(chances, chances.sum(axis=1) < 1 - 1e-9)
        ends = ~_leading_to(chances, ~may_end)
    values = np.full(len(arrows), -np.inf)
    values[ends] = np.linalg.solve(
        np.eye(ends.sum()) - task.discount * chances[np.ix_(ends, ends)], pays[ends]
    )
    return values


def value_of(task: PolicyTask, policy: Policy) -> float:
    """The expected return of a policy from the start; minus infinity if, undiscounted, its episodes may never end."""
    return float(
        _values(task, [policy[cell] for cell in task.cells])[task.cells.index(find_cell(task.grid, START))]
    )


@cache
def _best_policy(task: PolicyTask) -> tuple[str, ...]:
    cells, model = task.cells, _transition_model(task)
    if not task.looks_alike:  # policy iteration
        arrows = [naive_policy(task)[cell] for cell in cells]
        while True:
            values = _values(task, arrows)
            worth = {
                move: pays
                + task.discount * np.multiply(chances, values, where=chances > 0, out=chances * 0).sum(axis=1)
                for move, (chances, pays) in model.items()
            }
            better = []
            for at, own in enumerate(arrows):
                most = max(each[at] for each in worth.values())
                is_best = worth[own][at] >= most - 1e-12
                better.append(own if is_best else next(move for move in MOVES if worth[move][at] == most))
            if better == arrows:
                return tuple(arrows)
            arrows = better
    looks = list(dict.fromkeys(task.look(cell) for cell in cells))
    assert len(MOVES) ** len(looks) <= MAX_POLICIES, "too many looks to compare all policies"
    every = np.array(list(itertools.product(range(len(MOVES)), repeat=len(looks))))
    of_cells = every[:, [looks.index(task.look(cell)) for cell in cells]]  # (policies, cells)
    all_chances = np.stack([model[move][0] for move in MOVES])
    all_pays = np.stack([model[move][1] for move in MOVES])
    number, start = np.arange(len(cells)), cells.index(find_cell(task.grid, START))
    best_value, best = -math.inf, of_cells[0]
    for first in range(0, len(of_cells), CHUNK):
        arrows_of = of_cells[first : first + CHUNK]
        systems = np.eye(len(cells)) - task.discount * all_chances[arrows_of, number]
        values = np.linalg.solve(systems, all_pays[arrows_of, number][..., None])[:, start, 0]
        if values.max() > best_value:
            best_value, best = values.max(), arrows_of[values.argmax()]
    return tuple(tuple(MOVES)[move] for move in best)


def best_policy(task: PolicyTask) -> Policy:
    """A policy than which none is better: by policy iteration, or of cells that look alike by comparing all."""
    return dict(zip(task.cells, _best_policy(task), strict=True))


class PolicyBoard(Board):
    """Arrows move the cursor, and Space turns the arrow under it."""

    keys = "Arrows move the cursor, Space turns the arrow there, u undoes it."
    mark_word = "turn"

    def __init__(self, task: PolicyTask, answer: str) -> None:
        self._task = task
        self._policy = naive_policy(task)
        self._cursor = find_cell(task.grid, START)
        self._history: History[Policy] = History()
        with suppress(AnswerError):
            self._policy = read_policy(task, answer)

    @property
    def answer(self) -> str:
        return format_policy(self._task, self._policy)

    def judgement(self) -> Judgement:
        return self._task.judge(AnswerSubmission(self.answer, Path()))

    def move(self, columns: int, rows: int) -> None:
        there = self._cursor[0] + rows, self._cursor[1] + columns
        if there in free_cells(self._task.grid):
            self._cursor = there

    def mark(self) -> None:
        if self._cursor not in self._policy:
            return
        self._history.note(dict(self._policy))
        names = list(MOVES)
        turned = names[(names.index(self._policy[self._cursor]) + 1) % len(names)]
        look = self._task.look(self._cursor)
        self._policy = {
            cell: turned if self._task.look(cell) == look else arrow for cell, arrow in self._policy.items()
        }

    def undo(self) -> None:
        self._policy = self._history.take(self._policy)

    def rows(self, scale: int = 1) -> list[Row]:
        task, start = self._task, find_cell(self._task.grid, START)
        look = task.look(self._cursor) if self._cursor in self._policy else None
        worth = self._worth()
        signs = {
            cell: (
                ARROWS[arrow],
                ("warn" if task.look(cell) == look else "") if task.looks_alike else worth[cell][1],
            )
            for cell, arrow in self._policy.items()
        }
        signs[find_cell(task.grid, GOAL)] = (GOAL, "good")
        for cell in free_cells(task.grid):
            if task.grid[cell[0]][cell[1]] == PIT:
                signs[cell] = (PIT, "bad")
        signs[self._cursor] = (signs[self._cursor][0], "chosen")
        told = f"  return {value_of(task, self._policy):.2f} from S, at {start[0]},{start[1]}"
        return [
            *grid_rows(task.grid, signs, scale, worth),
            row(),
            row((told, "bold")),
            row((f"  {task.prices}", "dim")),
        ]

    def details(self, width: int) -> list[list[Row]]:
        return [figure_rows("return from each square", self._task.grid, self._worth())]

    def _worth(self) -> dict[Cell, tuple[str, str]]:
        """What each square is worth under these arrows, by value."""
        cells = self._task.cells
        found = _values(self._task, [self._policy[cell] for cell in cells])
        values = dict(zip(cells, map(float, found), strict=True))
        texts = {cell: f"{each:.2f}" if math.isfinite(each) else "never" for cell, each in values.items()}
        return by_value(values, texts)


KIND = PolicyTask
