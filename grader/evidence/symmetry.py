"""The same transitions in the mirrored and in the turned task: a reward for driving to a target should not care."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from grader.assignment import GridTask
from grader.evidence.task_model import HEADINGS, LASTS, LEFT, RIGHT, Integers, Model, build
from grader.evidence.transitions import Steps

Turned: TypeAlias = Steps

SWAPPED = np.arange(LASTS)
SWAPPED[[LEFT, RIGHT]] = RIGHT, LEFT


def mirrored(steps: Steps) -> Turned:
    """Left and right exchanged: x runs the other way."""
    task = steps.model.task
    width = len(task.rows[0])
    return _turned(
        steps,
        replace(task, rows=tuple(row[::-1] for row in task.rows)),
        lambda cells: np.column_stack([width - 1 - cells[:, 0], cells[:, 1]]),
        lambda headings: (HEADINGS // 2 - headings) % HEADINGS,
        SWAPPED,
    )


def rotated(steps: Steps) -> Turned:
    """A quarter turn counter-clockwise."""
    task = steps.model.task
    height = len(task.rows)
    rows = tuple("".join(row[k] for row in task.rows) for k in reversed(range(len(task.rows[0]))))
    return _turned(
        steps,
        replace(task, rows=rows),
        lambda cells: np.column_stack([height - 1 - cells[:, 1], cells[:, 0]]),
        lambda headings: (headings + HEADINGS // 4) % HEADINGS,
        np.arange(LASTS),
    )


def _turned(
    steps: Steps,
    task: GridTask,
    move_cells: Callable[[Integers], Integers],
    turn: Callable[[Integers], Integers],
    moves: Integers,
) -> Steps:
    before, after = steps.model, build(task)
    number = {tuple(cell): index for index, cell in enumerate(after.cells.tolist())}
    place = np.array([number[tuple(cell)] for cell in move_cells(before.cells).tolist()])
    return Steps(after, _states(before, steps.states, place, turn, moves), moves[steps.moves])


def _states(
    model: Model, states: Integers, place: Integers, turn: Callable[[Integers], Integers], moves: Integers
) -> Integers:
    headings = turn(model.heading_of(states))
    made: Integers = (place[model.cell_of(states)] * HEADINGS + headings) * LASTS + moves[states % LASTS]
    return made
