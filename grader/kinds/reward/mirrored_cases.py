"""The transitions of a task, and the same ones mirrored and rotated."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from grader.assignment import GridTask
from grader.kinds.reward.task_model import HEADINGS, LAST_MOVES, GridModel, build_model
from grader.kinds.reward.transitions import TransitionBatch
from kit.arrays import IntArray

MIRRORED_MOVES = np.arange(LAST_MOVES)


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
    move_cells: Callable[[IntArray], IntArray],
    turn_headings: Callable[[IntArray], IntArray],
    moves: IntArray,
) -> TransitionBatch:
    before, after = steps.model, build_model(task)
    number = {tuple(cell): index for index, cell in enumerate(after.cells.tolist())}
    cell_map = np.array([number[tuple(cell)] for cell in move_cells(before.cells).tolist()])
    return TransitionBatch(
        after, _states(before, steps.states, cell_map, turn_headings, moves), moves[steps.moves]
    )


def _states(
    model: GridModel,
    states: IntArray,
    cell_map: IntArray,
    turn_headings: Callable[[IntArray], IntArray],
    moves: IntArray,
) -> IntArray:
    headings = turn_headings(model.heading_of(states))
    transformed: IntArray = (cell_map[model.cell_of(states)] * HEADINGS + headings) * LAST_MOVES + moves[
        states % LAST_MOVES
    ]
    return transformed
