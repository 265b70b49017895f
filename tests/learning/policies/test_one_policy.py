"""One policy drives the same episode in the batch engine, in a race, as a node and as a package: for every goal."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.learning.policies.policy import Policy
from kit.learning.tasks.catalogue import find_task
from kit.learning.tasks.goals.registry import goal_kinds
from kit.learning.tasks.task_spec import TaskSpec
from tests.benchmarks.one_policy import TASKS, WAYS, Agreement, compare
from tests.learning.policies.test_agent_view import random_policy
from tests.learning.policies.test_evaluation import always


def test_the_tasks_have_every_goal() -> None:
    goals = [find_task(name).goal for name in TASKS]
    assert {goal.kind for goal in goals} == set(goal_kinds())
    assert any(goal.heading_tolerance is not None for goal in goals)


@pytest.mark.long
@pytest.mark.daily(4)
@pytest.mark.parametrize("name", TASKS, ids=lambda name: Path(name).stem)
def test_all_ways_begin_alike_and_do_what_the_policy_chooses(name: str) -> None:
    for way, agreement in compared(name, random_policy(name)).items():
        assert agreement.same_commands == 1.0, way
        if "cart" not in name:  # one that begins on its way is there only from the first tick on
            assert agreement.first_difference < 1e-3, way


@pytest.mark.long
@pytest.mark.daily(4)
@pytest.mark.parametrize("name", TASKS, ids=lambda name: Path(name).stem)
def test_all_ways_end_alike(name: str) -> None:
    """By a policy for which a millimetre changes nothing: it always does the same."""
    for way, agreement in compared(name, always(TaskSpec(name).frozen(), 0)).items():
        assert agreement.same_outcomes == agreement.episodes, way


def compared(name: str, policy: Policy) -> dict[str, Agreement]:
    """How all ways agree with the batch engine on one episode of a task."""
    task = find_task(name)
    assert task.file is not None
    _, found = compare(policy, task.file, (5,))
    assert set(found) == set(WAYS)
    return found
