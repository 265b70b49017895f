"""The goal to patrol: its targets in their order, and again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from kit.learning.environment.episode_stats import EpisodeOutcome
from kit.learning.policies.node_goals.goal_count import GoalProgress
from kit.learning.policies.policy_node import node_count, node_refusals
from kit.school.game.objective import Objective
from kit.school.game.task_levels import task_level
from kit.sim.simulation import STEP_SIZE_S, Simulation
from tests.learning.tasks.tasks_for_tests import AHEAD, HALL, PLAIN, STILL, achieved, drive, one_world


def test_a_patrol_reaches_its_targets_in_their_order() -> None:
    batch = one_world(
        HALL + "targets: [[0.625, 1.0], [0.625, 1.6], [0.625, 2.2]]}\n"
        "goal: {kind: patrol}\ntarget: {radius: 0.1, measured_to: axle}"
    )
    steps = drive(batch, AHEAD)
    shares = [achieved(step) for step in steps]
    assert sorted(set(shares)) == pytest.approx([0.0, 1 / 3, 2 / 3, 1.0])
    assert [step.transition.reached[0] for step in steps] == [False] * (len(steps) - 1) + [True]
    assert EpisodeOutcome.of(steps[-1].transition, 0) is EpisodeOutcome.REACHED
    aims = [tuple(step.transition.target[0].tolist()) for step in steps]
    assert list(dict.fromkeys(aims)) == [(0.625, 1.0), (0.625, 1.6), (0.625, 2.2)]
    progress = sum(float((step.transition.previous_to_go - step.transition.to_go)[0, 0]) for step in steps)
    assert progress == pytest.approx(2.2 - 0.5 - 0.1, abs=0.12)  # nothing is lost where the target changes
    assert sum(float(step.terms["achieving"][0]) for step in steps) == pytest.approx(1.0)


def test_a_patrol_of_two_rounds_comes_back_to_its_first_target() -> None:
    batch = one_world(
        HALL
        + "targets: [[0.625, 0.8], [0.625, 1.4]]}\ngoal: {kind: patrol, rounds: 2}\ntarget: {radius: 0.2}"
    )
    there = drive(batch, AHEAD, 16)
    back = drive(batch, [-1.0, 0.0], 16)
    again = drive(batch, AHEAD, 30)
    assert [achieved(steps[-1]) for steps in (there, back, again)] == pytest.approx([0.5, 0.75, 1.0])


STAYS = (
    HALL + "targets: [[0.625, 0.8], [0.625, 1.4]]}\ngoal: {kind: patrol, stay: 0.6}\ntarget: {radius: 0.2}"
)


def test_a_target_counts_once_the_robot_has_stood_in_it_and_a_node_knows() -> None:
    batch = one_world(STAYS)
    task = batch.task
    assert node_refusals(task) == ()
    node = GoalProgress(
        type(node_count(task))({**task.goal.node_facts(batch._case_arrays.goal_cases[0]), "step_time": 0.2}),
        lambda robot, pose, place: bool(
            batch._loops.find_arrivals(pose[None, None], np.array([place]))[0, 0]
        ),
        [[0.625, 0.8], [0.625, 1.4]],
        1,
    )
    node.step(batch.state.pose[0], np.zeros((1, 2)))
    shares = []
    for action in (*[AHEAD] * 3, STILL, STILL, AHEAD, STILL, STILL, STILL, STILL, AHEAD, STILL, AHEAD, AHEAD):
        shares.append(achieved(drive(batch, action, 1)[0]))
        node.step(batch.state.pose[0], np.zeros((1, 2)))
        assert node.achieved / node.needed == pytest.approx(shares[-1])
        assert node.target == batch.state.target[0].tolist()
    # who leaves too early begins again; in the next target nothing is lost of the one before
    assert shares[:10] == pytest.approx([0, 0, 0, 1 / 6, 2 / 6, 0, 1 / 6, 2 / 6, 3 / 6, 3 / 6])
    assert node.target == [0.625, 1.4]


def test_a_race_waits_as_long(tmp_path: Path) -> None:
    file = tmp_path / "task.yaml"
    file.write_text(f"{STAYS.replace('0.8]', '0.5]')}\n{PLAIN}")
    level = task_level(file)
    scenario = level.find_scenario()
    objective, simulation = Objective(level, scenario, STEP_SIZE_S), Simulation(scenario.world)
    for _ in range(100):
        simulation.step()
        objective.on_step(simulation)
    assert objective.splits == pytest.approx([0.6], abs=0.025)
