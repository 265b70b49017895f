"""An agent followed in a world: it perceives there what it would perceive in the batch engine at the same place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.task_spec import TaskSpec
from kit.learning.environment.tasks import StartVariation
from kit.learning.policies.agent_view import AgentObserver, AgentView
from kit.learning.policies.policies import PolicyError
from kit.run.scenario import find_scenario
from kit.run.session import Session
from tests.learning.policies.test_agent_view import random_policy


def test_it_perceives_what_the_batch_engine_gives() -> None:
    policy = random_policy("turn")
    task = replace(policy.trained_on.resolve(), start=StartVariation(shifted=False), lidar_noise=0.0)
    batch = BatchEnv(task, 1, 1)
    names = [case.name for case in batch.cases]
    seen = batch.reset(cases=np.array([names.index("turn_a_to_b")]))
    views: list[AgentView] = []
    scenario = find_scenario("turn", "turn_a_to_b")
    with Session(scenario, always_scan=True) as session:
        session.runner.observers.append(AgentObserver(policy, scenario.partners, views.append))
        for _ in range(round(2 * task.step_time / session.runner.step_size) + 1):
            session.runner.tick()
        assert 2 <= len(views) <= 3
        session.reset()
        session.runner.tick()
    spec = task.observation
    told = [float(np.hypot(*(path.points[-1] - path_start(batch)))) for path in views[0].sight]
    assert told == pytest.approx(
        (seen[0, : spec.scan_size] / spec.scale).tolist(), abs=0.06
    )  # the world's lidar is noisy
    assert sum(action.rating for action in views[0].actions) == pytest.approx(1.0)
    assert len(views) >= 3  # after the reset it looks again at once


def path_start(batch: BatchEnv) -> np.ndarray:
    start: np.ndarray = batch.state.pose[0, 0, :2]
    return start


def test_a_policy_that_is_told_more_than_a_node_knows_is_refused() -> None:
    told = random_policy("turn")
    told = replace(told, trained_on=replace(TaskSpec("turn"), tells_target=True))
    with pytest.raises(PolicyError):
        AgentObserver(told, ("serp",), print)
    with pytest.raises(PolicyError, match="drives 2 robots"):
        AgentObserver(random_policy("wheelchairs"), ("left",), print)
