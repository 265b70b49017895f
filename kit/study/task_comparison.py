"""Says in what two tasks test agents differently: numbers of such tasks must not stand beside each other.

What an agent sees and earns, and how its start varies, belong to how it learned; what must be reached, from where, by which
moves and in which time is the test.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from kit.learning.tasks.actions import DiscreteActions
from kit.learning.tasks.learning_task import LearningTask


def test_differences(one: LearningTask, other: LearningTask) -> list[str]:
    """What differs, each with both values; empty where agents of both are tested alike.

    >>> from kit.learning.tasks.catalogue import find_task
    >>> test_differences(find_task("hallway"), find_task("hallway-seed"))
    []
    >>> test_differences(find_task("wheelchairs"), find_task("wheelchairs-seed-49"))[-1]
    'gap between two robots: 0.4 and 0.3'
    """
    parts, others = dict(_compared_parts(one)), dict(_compared_parts(other))
    return [f"{name}: {value} and {others[name]}" for name, value in parts.items() if value != others[name]]


def _compared_parts(task: LearningTask) -> Iterator[tuple[str, Any]]:
    yield "cases", ", ".join(case.name for _, case in task.map_cases())
    yield "goal", task.goal.description
    yield "actions", _actions_text(task)
    yield "seconds of a step", task.step_time
    yield "steps of an episode", task.max_steps
    yield "target radius", task.target_radius
    yield "target measured to", task.measured_to
    yield "gap between two robots", _start_gap(task)


def _actions_text(task: LearningTask) -> str:
    if not isinstance(task.actions, DiscreteActions):
        return f"continuous, {task.actions.linear} and {task.actions.angular}"
    return ", ".join(
        f"{forward:g} m/s {turn:.3g} rad/s" for forward, turn in sorted(task.actions.twist_table)
    )


def _start_gap(task: LearningTask) -> float | None:
    """Between the first two robots at their starts [m]; None for one."""
    if task.robots == 1:
        return None
    if task.start.gap is not None:
        return task.start.gap
    one, other = (places.nominal for places in task.map_cases()[0][1].starts[:2])
    return round(math.dist((one.x, one.y), (other.x, other.y)), 6)
