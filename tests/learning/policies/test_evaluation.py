from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import kit
from kit.document.layout import lines_of
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.episode_stats import EpisodeOutcome, EpisodeStats, EpisodeStatsRecorder
from kit.learning.policies.episode_paths import record_paths
from kit.learning.policies.evaluation import Evaluator, evaluate_on
from kit.learning.policies.paths_picture import build_paths_scene
from kit.learning.policies.policy import ActionSampling, Policy, PolicyError, action_counts, task_interface
from kit.learning.policies.policy_network import LinearLayer, PolicyNetwork
from kit.learning.policies.policy_node import format_policy_node
from kit.learning.policies.seeds import derive_seed
from kit.learning.policies.sweep import PolicySweep, find_kinds, sweep_csv
from kit.learning.tasks.catalogue import find_task
from kit.learning.tasks.learning_task import StartVariation, UnknownTask
from kit.learning.tasks.student_reward import (
    RewardFileError,
    StudentReward,
    metric_parameters,
    reward_parameters,
)
from kit.learning.tasks.task_case import EpisodePlaces
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.run_text import comparison_tables

STRAIGHT = TaskSpec("hallway", ("straight", "center_door"))
AHEAD_ONLY = replace(STRAIGHT.resolve(), start=StartVariation(shifted=False))


def always(choice: TaskSpec, action: int) -> Policy:
    """One that does the same whatever it sees."""
    task = choice.resolve()
    choices = action_counts(task.actions.space(task.robots))
    bias = np.zeros(sum(choices), dtype=np.float32)
    for first in np.cumsum([0, *choices[:-1]]):
        bias[first + action] = 9.0
    layer = LinearLayer(np.zeros((task.observation.size * task.robots, sum(choices)), np.float32), bias)
    return Policy(
        PolicyNetwork((layer,), "tanh"), choices, ActionSampling("softmax"), choice, 0, task_interface(task)
    )


FORWARD = always(STRAIGHT, 1)
BACK = always(STRAIGHT, 2)
STOP = always(STRAIGHT, 0)


def test_counts_what_happened_case_by_case() -> None:
    evaluator = Evaluator(AHEAD_ONLY)
    ahead, back, stop = (evaluator.test(policy, 30, 1) for policy in (FORWARD, BACK, STOP))
    assert [case.outcomes for case in ahead.cases] == [(30, 0, 0), (30, 0, 0)]
    assert [case.outcomes for case in back.cases] == [(0, 30, 0), (0, 30, 0)]
    assert [case.outcomes for case in stop.cases] == [(0, 0, 30), (0, 0, 30)]
    assert ahead.cases[0].steps == pytest.approx(28, abs=3)  # 2 m less radius and hull, 0.06 m a step
    assert math.isnan(back.cases[0].steps)
    assert ahead.mean == 1.0 > back.reward
    assert ahead.cases[0].interval.low == pytest.approx(0.886, abs=0.01)


def test_the_task_is_given_by_name_too() -> None:
    policy = always(TaskSpec("turn"), 0)
    by_name = kit.evaluate_policy(policy, task="turn", episodes=2)
    assert by_name.as_dict() == kit.evaluate_policy(policy, episodes=2).as_dict()
    assert "turn" in repr(by_name)
    assert len(repr(by_name)) < 100
    table = by_name._repr_html_()
    assert table.startswith("<")
    assert all(case.case in table for case in by_name.cases)
    with pytest.raises(UnknownTask, match='did you mean "turn"'):
        kit.evaluate_policy(policy, task="tern")
    with pytest.raises(ValueError, match="at least one episode"):
        kit.evaluate_policy(policy, episodes=0)


def test_a_group_is_the_mean_of_its_cases() -> None:
    choice = TaskSpec("hallway", ("doors", "straight"))
    task = replace(choice.resolve(), start=StartVariation(shifted=False))
    result = Evaluator(task).test(always(choice, 1), 10, 1)
    assert result.groups() == {"doors": pytest.approx(1 / 3)}
    assert result.worst.case in ("left_door", "right_door")


def test_the_same_seed_tests_the_same_and_another_does_not() -> None:
    evaluator = Evaluator(STRAIGHT.resolve())
    results = [evaluator.test(FORWARD, 60, seed, greedy=False) for seed in (1, 1, 2)]
    assert results[0] == results[1] != results[2]


def test_many_episodes_are_shared_out_evenly() -> None:
    result = Evaluator(AHEAD_ONLY).test(BACK, 1300, 1)
    assert {case.episodes for case in result.cases} == {1300 + (-1300 % 3)}


def test_uses_of_a_seed_are_apart() -> None:
    seeds = {
        derive_seed(seed, use, k) for seed in range(20) for use in ("test", "training") for k in range(20)
    }
    assert len(seeds) == 800
    assert all(0 <= seed < 2**32 for seed in seeds)


def test_two_robots_are_judged_side_by_side() -> None:
    choice = TaskSpec("wheelchairs", ("pair_straight",))
    result = Evaluator(replace(choice.resolve(), start=StartVariation(gap=0.3))).test(
        always(choice, 1), 20, 1
    )
    (case,) = result.cases
    assert case.reached == 20
    assert case.adjacency > 0.8
    assert "by rays" in " ".join(lines_of([result.table()]))  # the measure is named
    json.dumps(result.as_dict())


def test_a_result_is_told_with_its_worst_case() -> None:
    result = Evaluator(AHEAD_ONLY).test(STOP, 10, 1)
    json.dumps(result.as_dict(), allow_nan=False)
    text = "\n".join(lines_of([result.table()]))
    assert "0.000 to 0.278" in text
    assert "worst" in text
    assert "greedy" in text


def test_a_policy_for_something_else_is_refused() -> None:
    with pytest.raises(PolicyError, match="turn gives 9"):
        Evaluator(TaskSpec("turn").resolve()).test(FORWARD, 1, 1)


def test_ways_lead_from_start_to_end() -> None:
    ways = record_paths(FORWARD, AHEAD_ONLY, 3, 5)
    assert [way.case for way in ways] == ["straight"] * 3 + ["center_door"] * 3
    for way in ways:
        assert way.outcome is EpisodeOutcome.REACHED
        steps = np.hypot(*np.diff(way.poses[:, 0, :2], axis=0).T)
        assert steps == pytest.approx(0.06, abs=1e-6)
        assert np.hypot(*(way.poses[-1, 0, :2] - way.target)) < 0.4
    card, case = AHEAD_ONLY.map_cases()[0]
    scene = build_paths_scene(AHEAD_ONLY, card, case, ways)
    assert len(scene.paths) == 3
    assert not len(scene.contacts)
    crashed = build_paths_scene(AHEAD_ONLY, card, case, record_paths(BACK, AHEAD_ONLY, 2, 5))
    assert len(crashed.contacts) == 2
    assert {path.style for path in crashed.paths} == {"dotted"}


def test_two_robots_have_two_lines_and_a_mark_for_every_second() -> None:
    task = find_task("two-through-a-hall")
    ways = record_paths(always(TaskSpec("two-through-a-hall"), 1), task, 2, 5)
    card, case = task.map_cases()[0]
    scene = build_paths_scene(task, card, case, ways)
    ways = tuple(way for way in ways if way.case == case.name)
    seconds = sum(int((len(way.poses) - 1) * task.step_time + 1e-9) for way in ways)
    assert [mark.label for mark in scene.marks].count("•") == seconds
    assert [mark.label for mark in scene.marks].count("o") == seconds
    reached = [way.outcome is EpisodeOutcome.REACHED for way in ways]
    wanted = [style for has in reached for style in (("solid", "dashed") if has else ("dotted", "dotted"))]
    assert [path.style for path in scene.paths if len(path.points) != 5] == wanted


def test_areas_are_drawn_where_starts_and_targets_are_drawn_from_them() -> None:
    card, case = AHEAD_ONLY.map_cases()[0]
    area = (-0.5, 0.25, 0.5, -0.25)
    case = replace(case, starts=(EpisodePlaces(area=area),), targets=EpisodePlaces(area=(3.0, 0.0, 4.0, 1.0)))
    scene = build_paths_scene(AHEAD_ONLY, card, case, record_paths(FORWARD, AHEAD_ONLY, 1, 5))
    corners = [set(map(tuple, path.points.tolist())) for path in scene.paths if path.style == "dashed"]
    assert corners[0] == {(x, y) for x in (-0.5, 0.5) for y in (-0.25, 0.25)}
    assert corners[1] == {(x, y) for x in (3.0, 4.0) for y in (0.0, 1.0)}
    assert {(-0.5, 0.25, "S"), (3.0, 1.0, "T")} <= {mark[:3] for mark in scene.marks}


def test_a_node_knows_what_the_policy_knows() -> None:
    source = format_policy_node(always(TaskSpec("wheelchairs"), 1))
    compile(source, "node.py", "exec")
    assert all(f"/{robot}/static_laser" in source for robot in ("left", "right"))
    assert "import kit" not in source


def test_a_policy_drives_in_the_world_as_a_node(tmp_path: Path) -> None:
    from kit.controllers import find_controller
    from kit.run.headless import run_headless
    from kit.run.scenario import find_scenario

    file = tmp_path / "ahead.py"
    file.write_text(format_policy_node(always(TaskSpec("hallway"), 1)))
    summary = run_headless(
        find_scenario("hall_straight"), find_controller(str(file)), steps=1200, until_reached=True
    )
    assert summary.failure is None
    assert summary.metrics.reached_s is not None
    assert summary.metrics.bumps == 0


REWARDS = {
    "no file": (None, "cannot be read"),
    "no Python": ("def reward(:", r"mine\.py:1: not Python"),
    "no function": ("x = 1", r"no function reward\(\)"),
    "no such fact": ("\n\ndef reward(distence): return 0", r"mine\.py:3.*distence.*distance"),
    "all at once": ("def reward(distence, velocity): return 0", "distence.*velocity.*distance"),
    "no facts": ("def reward(): return 0", "can use: abreast"),
    "positions": ("def reward(step, /): return 0", "leave out"),
}


@pytest.mark.parametrize(("source", "said"), REWARDS.values(), ids=REWARDS)
def test_a_reward_that_cannot_be_called_is_told_before_it_runs(
    tmp_path: Path, source: str | None, said: str
) -> None:
    file = tmp_path / "mine.py"
    if source is not None:
        file.write_text(source)
    with pytest.raises(RewardFileError, match=said):
        reward_parameters(file)


@pytest.mark.parametrize("task", ["turn", "wheelchairs"])
def test_a_reward_is_told_the_facts_of_each_world(tmp_path: Path, task: str) -> None:
    from kit.learning.tasks.transition import TRANSITION_FIELDS

    file = tmp_path / "mine.py"
    file.write_text(
        f"def reward({', '.join(TRANSITION_FIELDS)}):\n"
        "    first = distance[0] if isinstance(distance, list) else distance\n"
        "    rays = ranges[0] if isinstance(ranges[0], list) else ranges\n"
        "    assert len(rays) == 91 and len(target) == 2 and isinstance(collided, bool)\n"
        "    return 1000 * step + first + max_steps\n"
    )
    resolved = TaskSpec(task).resolve()
    batch = BatchEnv(resolved, 6, 1)
    batch.reset()
    step = batch.step(np.zeros((6, 2) if task == "wheelchairs" else 6, dtype=np.int64))
    with StudentReward(file) as reward:
        found = reward(step.transition)
    wanted = 1000 + step.transition.distance[:, 0] + resolved.max_steps
    assert found == pytest.approx(wanted, abs=1e-4)


def test_metrics_of_a_reward_file_are_counted_and_earn_nothing(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(
        "def reward(reached):\n    return 1.0 * reached\n\n"
        "def metric_half_steps(step):\n    return 0.5\n\n"
        "def metric_near(nearest):\n    return float(nearest < 0.3)\n"
    )
    assert metric_parameters(file) == {"half_steps": ("step",), "near": ("nearest",)}
    with StudentReward(file) as reward:
        batch = BatchEnv(find_task("turn"), 4, seed=1, reward=reward)
        batch.reset()
        recorder = EpisodeStatsRecorder(batch)
        ended: list[EpisodeStats] = []
        while len(ended) < 4:
            step = batch.step(np.zeros(4, dtype=np.int64))  # ahead, into the wall
            assert not step.rewards.any()
            near = step.transition.ranges[:, 0].min(axis=1) < 0.3
            assert step.terms["near"].tolist() == near.astype(float).tolist()
            ended += recorder.add(step)
    for episode in ended:
        assert episode.reward == 0.0
        assert episode.terms["half_steps"] == episode.steps / 2
        assert episode.terms["near"] >= 1
    own = replace(find_task("turn"), reward_file=file)
    ahead = always(TaskSpec("turn"), 0)
    result = evaluate_on(own, ahead, episodes=4, seed=1)
    assert result.metrics["half_steps"] > 1
    assert {"half_steps", "near"} <= {column.title for column in result.table().columns}
    (_, half_steps, near) = comparison_tables({"ahead": result})
    assert half_steps.columns[0].title == "half_steps"
    assert near.rows
    sweep = PolicySweep(ahead, own, find_kinds(["latency"]), episodes=2, seed=1)
    points = list(sweep.points())
    assert all(point.metrics["half_steps"] > 1 for point in points)
    assert sweep_csv(points).splitlines()[0].endswith("worst_share,half_steps,near")
    file.write_text("def reward(reached):\n    return 1.0 * reached\n\ndef metric_x(speeed):\n    return 1\n")
    with pytest.raises(RewardFileError, match=r"mine.py:4: metric_x\(\) asks for \"speeed\""):
        reward_parameters(file)
