"""Tune Q-learning on a grid: numbers that let it find the way, from every seed, before the budget of steps is spent."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final, Self

import numpy as np

from kit.document.rows import Row, row
from kit.school.game.board import (
    MOVES,
    Board,
    History,
    distances_to,
    find_cell,
    free_cells,
    grid_rows,
    step,
)
from kit.school.game.challenge import AnswerError, AnswerSubmission, ChallengeTask
from kit.school.game.judgement import AnswerComparison, Judgement
from kit.school.game.medal import Medal
from kit.world.yaml_section import Section

CHOICES: Final[dict[str, tuple[float, ...]]] = {
    "rate": (0.01, 0.03, 0.1, 0.3, 0.6, 1.0),
    "exploration": (0.0, 0.02, 0.1, 0.3, 0.6, 1.0),
    "discount": (0.5, 0.8, 0.9, 0.95, 0.99, 1.0),
    "first_value": (-1.0, 0.0, 0.25, 0.5, 1.0, 2.0),
    "episodes": (5, 10, 20, 40, 80, 160),
}
"""What each number may be: learning rate, share of random moves, discount, every value at the beginning, and how long."""
NAIVE: Final = {"rate": 0.1, "exploration": 0.1, "discount": 0.9, "first_value": 0.0, "episodes": 40}
SEEDS: Final = range(5)
MAX_STEPS: Final = 200
"""Of one episode."""


@dataclass(frozen=True, slots=True)
class TuningTask(ChallengeTask):
    """A grid for Q-learning: 1 is paid for arriving, nothing else."""

    kind = "tuning"
    answer_file = "numbers.txt"

    grid: tuple[str, ...]
    """``#`` wall, ``S`` start, ``G`` target."""
    max_steps: int
    """Steps on average over the seeds that earn bronze."""
    silver_steps: int
    gold_steps: int

    @classmethod
    def read(cls, section: Section, folder: Path) -> Self:
        return cls(
            section.texts("map", at_least=1),
            section.integer("max_steps", minimum=1),
            section.integer("silver_steps", minimum=1),
            section.integer("gold_steps", minimum=1),
        )

    def lines(self) -> list[str]:
        return [
            *self.grid,
            *(f"{name}: {', '.join(f'{each:g}' for each in values)}" for name, values in CHOICES.items()),
        ]

    def naive_answer(self) -> str:
        return format_numbers(NAIVE)

    def board(self, answer: str) -> Board:
        return TuningBoard(self, answer)

    def judge(self, submission: AnswerSubmission) -> Judgement:
        learned = learn(self, tuple(read_numbers(submission.answer).values()))
        text = f"{learned.arrived} of {len(SEEDS)} seeds find a shortest way, after {learned.steps:,.0f} steps each."
        others = (("budget", self.max_steps), ("silver at", self.silver_steps), ("gold at", self.gold_steps))
        steps = (self.max_steps, self.silver_steps, self.gold_steps)
        rungs = tuple(zip((Medal.BRONZE, Medal.SILVER, Medal.GOLD), steps, strict=True))
        comparison = AnswerComparison("steps", learned.steps, others, rungs)
        if learned.arrived < len(SEEDS) or learned.steps > self.max_steps:
            return Judgement(
                Medal.NONE, f"{text} All in at most {self.max_steps:,} are asked for.", comparison
            )
        return Judgement(comparison.medal, text, comparison)


def format_numbers(numbers: dict[str, float]) -> str:
    """The numbers as an answer's file holds them."""
    return "".join(f"{name}={value:g}\n" for name, value in numbers.items())


def read_numbers(answer: str) -> dict[str, float]:
    """Reads ``name=value`` for each number. Raises AnswerError."""
    numbers: dict[str, float] = {}
    for word in answer.split():
        name, _, value = word.partition("=")
        if name not in CHOICES:
            raise AnswerError(f"{name[:20]!r} is no number of this puzzle: write {', '.join(CHOICES)}.")
        found = next((each for each in CHOICES[name] if f"{each:g}" == value), None)
        if found is None:
            allowed = ", ".join(f"{each:g}" for each in CHOICES[name])
            raise AnswerError(f"{name} is one of {allowed}, not {value[:20]!r}.")
        numbers[name] = found
    if missing := sorted(set(CHOICES) - set(numbers)):
        raise AnswerError(f"{missing[0]} is missing.")
    return {name: numbers[name] for name in CHOICES}


@dataclass(frozen=True, slots=True)
class Learned:
    """What Q-learning makes of some numbers."""

    arrived: int
    """Seeds whose greedy policy takes a shortest way."""
    steps: float
    """Steps of training on average over the seeds."""
    curve: tuple[float, ...]
    """Steps of each episode, on average over the seeds."""


@cache
def learn(task: TuningTask, numbers: tuple[float, ...]) -> Learned:
    """Trains from every seed; the same numbers, the same result. ``numbers``: in the order of ``CHOICES``."""
    runs = [_train_once(task, numbers, seed) for seed in SEEDS]
    curves = np.array([lengths for _, lengths in runs], dtype=np.float64)
    return Learned(
        sum(has_arrived for has_arrived, _ in runs),
        float(curves.sum(axis=1).mean()),
        tuple(curves.mean(axis=0).tolist()),
    )


def _train_once(task: TuningTask, numbers: tuple[float, ...], seed: int) -> tuple[bool, list[int]]:
    """One training: whether its greedy policy takes a shortest way, and the steps of each episode."""
    rate, exploration, discount, first_value, episodes = numbers
    cells = free_cells(task.grid)
    number = {cell: at for at, cell in enumerate(cells)}
    leads_to = [[number[step(task.grid, cell, move)] for move in MOVES] for cell in cells]
    start, goal = number[find_cell(task.grid, "S")], number[find_cell(task.grid, "G")]
    random = np.random.default_rng(seed)
    values = [
        [first_value + 1e-6 * noise for noise in row] for row in random.random((len(cells), 4)).tolist()
    ]
    values[goal] = [0.0] * 4
    lengths = []
    for _ in range(int(episodes)):
        cell, steps = start, 0
        dice, moves = random.random(MAX_STEPS).tolist(), random.integers(4, size=MAX_STEPS).tolist()
        while cell != goal and steps < MAX_STEPS:
            own = values[cell]
            move = moves[steps] if dice[steps] < exploration else own.index(max(own))
            following = leads_to[cell][move]
            pay = 1.0 if following == goal else 0.0
            own[move] += rate * (pay + discount * max(values[following]) - own[move])
            cell, steps = following, steps + 1
        lengths.append(steps)
    cell, steps = start, 0
    shortest = distances_to(task.grid, cells[goal])[cells[start]]
    while cell != goal and steps < shortest:
        cell, steps = leads_to[cell][values[cell].index(max(values[cell]))], steps + 1
    return cell == goal, lengths


class TuningBoard(Board):
    """Sliders, and what Q-learning makes of them."""

    keys = "Up and down choose a number, left and right change it, u undoes it."
    _BARS = " ▁▂▃▄▅▆▇█"

    def __init__(self, task: TuningTask, answer: str) -> None:
        self._task = task
        try:
            self._numbers = read_numbers(answer)
        except AnswerError:
            self._numbers = dict(NAIVE)
        self._chosen = 0
        self._history: History[dict[str, float]] = History()

    @property
    def answer(self) -> str:
        return format_numbers(self._numbers)

    def judgement(self) -> Judgement:
        return self._task.judge(AnswerSubmission(self.answer, Path()))

    def move(self, columns: int, rows: int) -> None:
        self._chosen = max(0, min(self._chosen + rows, len(CHOICES) - 1))
        if columns:
            self._history.note(dict(self._numbers))
            name = list(CHOICES)[self._chosen]
            values = CHOICES[name]
            at = max(0, min(values.index(self._numbers[name]) + columns, len(values) - 1))
            self._numbers[name] = values[at]

    def undo(self) -> None:
        self._numbers = self._history.take(self._numbers)

    def details(self, width: int) -> list[list[Row]]:
        """The grid that it learns on."""
        return [[row(("the grid", "title")), *grid_rows(self._task.grid, {})]]

    def rows(self, scale: int = 1) -> list[Row]:
        learned = learn(self._task, tuple(self._numbers.values()))
        rows = []
        stretch = 3 * scale
        for number, (name, values) in enumerate(CHOICES.items()):
            at, is_chosen = values.index(self._numbers[name]), number == self._chosen
            slider = "─" * (stretch * at) + "●" + "─" * (stretch * (len(values) - 1 - at))
            rows.append(
                row(
                    (
                        f"  {'>' if is_chosen else ' '} {name.replace('_', ' '):<12} ",
                        "bold" if is_chosen else "",
                    ),
                    (slider, "chosen" if is_chosen else "dim"),
                    f"  {self._numbers[name]:g}",
                )
            )
        return [
            *rows,
            row(),
            *self._curve_rows(learned.curve, 20 + 20 * scale, scale),
            row(
                (f"  steps {learned.steps:,.0f}", "bold"),
                f" of {self._task.max_steps:,}   {learned.arrived} of {len(SEEDS)} seeds find a shortest way",
            ),
        ]

    def _curve_rows(self, curve: Sequence[float], columns: int, rows: int) -> list[Row]:
        """The steps of each episode as bars of so many rows, in at most so many columns."""
        stride = -(-len(curve) // columns)
        shown, wide = curve[::stride], max(1, columns // len(curve))
        eighths = [max(1, round(8 * rows * each / max(curve))) for each in shown]
        drawn = [
            "".join(self._BARS[min(8, max(0, each - 8 * below))] * wide for each in eighths)
            for below in reversed(range(rows))
        ]
        label, end = "  steps of each episode  ", "  first to last"
        return [
            row(
                label if number == 0 else " " * len(label),
                (line, "good"),
                (end if number == rows - 1 else "", "dim"),
            )
            for number, line in enumerate(drawn)
        ]


KIND = TuningTask
