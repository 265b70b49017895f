"""Transforms transitions into the mirrored and the rotated task; a reward for driving to a target should stay the same."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from grader.assignment import GridTask
from grader.evidence.task_model import HEADINGS, LAST_MOVES, LEFT, RIGHT, GridModel, Integers, build_model
from grader.evidence.transitions import TransitionBatch

MIRRORED_MOVES = np.arange(LAST_MOVES)
MIRRORED_MOVES[[LEFT, RIGHT]] = RIGHT, LEFT


def mirrored(steps: TransitionBatch) -> TransitionBatch:
    """Mirrors the task: left and right exchanged, x reversed."""
    task = steps.model.task
    width = len(task.rows[0])
    return _transformed(
        steps,
        replace(task, rows=tuple(row[::-1] for row in task.rows)),
        lambda cells: np.column_stack([width - 1 - cells[:, 0], cells[:, 1]]),
        lambda headings: (HEADINGS // 2 - headings) % HEADINGS,
        MIRRORED_MOVES,
    )


def rotated(steps: TransitionBatch) -> TransitionBatch:
    """Rotates the task a quarter turn counter-clockwise."""
    task = steps.model.task
    height = len(task.rows)
    rows = tuple("".join(row[k] for row in task.rows) for k in reversed(range(len(task.rows[0]))))
    return _transformed(
        steps,
        replace(task, rows=rows),
        lambda cells: np.column_stack([height - 1 - cells[:, 1], cells[:, 0]]),
        lambda headings: (headings + HEADINGS // 4) % HEADINGS,
        np.arange(LAST_MOVES),
    )


def _transformed(
    steps: TransitionBatch,
    task: GridTask,
    move_cells: Callable[[Integers], Integers],
    turn_headings: Callable[[Integers], Integers],
    moves: Integers,
) -> TransitionBatch:
    before, after = steps.model, build_model(task)
    number = {tuple(cell): index for index, cell in enumerate(after.cells.tolist())}
    cell_map = np.array([number[tuple(cell)] for cell in move_cells(before.cells).tolist()])
    return TransitionBatch(
        after, _states(before, steps.states, cell_map, turn_headings, moves), moves[steps.moves]
    )


def _states(
    model: GridModel,
    states: Integers,
    cell_map: Integers,
    turn_headings: Callable[[Integers], Integers],
    moves: Integers,
) -> Integers:
    headings = turn_headings(model.heading_of(states))
    transformed: Integers = (cell_map[model.cell_of(states)] * HEADINGS + headings) * LAST_MOVES + moves[
        states % LAST_MOVES
    ]
    return transformed
