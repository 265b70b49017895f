"""What an agent perceives and how it rates its actions: the same numbers that it decides by, where they belong."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.episode_start import EpisodeStart
from kit.learning.policies.agent_view import AgentObserver, AgentView, ExpectedReturns, build_agent_view
from kit.learning.policies.policy import ActionSampling, Policy, PolicyError, action_counts, task_interface
from kit.learning.policies.policy_network import LinearLayer, PolicyNetwork
from kit.learning.tasks.actions import ContinuousActions
from kit.learning.tasks.catalogue import find_task, task_names
from kit.learning.tasks.learning_task import StartVariation
from kit.learning.tasks.task_spec import TaskSpec
from kit.run.scenario import find_scenario
from kit.run.session import Session
from kit.school.game.task_levels import episode_scenario, find_task_level
from tests.cases import every_case


def random_policy(name: str, sampling: ActionSampling | None = None, *, tells_target: bool = False) -> Policy:
    choice = replace(TaskSpec(name), tells_target=tells_target)
    task = choice.resolve()
    choices = action_counts(task.actions.space(task.robots))
    outputs = sum(choices) or 2 * task.robots
    rng = np.random.default_rng(3)
    weights = rng.normal(size=(task.observation.size * task.robots, outputs)).astype(np.float32)
    usual = ActionSampling("softmax") if choices else ActionSampling("normal", 1.0, (0.1,) * outputs)
    network = PolicyNetwork((LinearLayer(weights, np.zeros(outputs, np.float32)),), "tanh")
    return Policy(network, choices, sampling or usual, choice, 0, task_interface(choice.resolve()))


def view_of(policy: Policy) -> tuple[AgentView, BatchEnv, np.ndarray]:
    task = policy.trained_on.resolve()
    batch = BatchEnv(task, 1, 1)
    seen = batch.reset()
    player = policy.make_player(1)
    player.act(seen, np.ones(1, dtype=np.bool_))
    return build_agent_view(policy, task, seen[0], player.scores[0], batch.state.pose[0]), batch, seen[0]


@pytest.mark.long
@every_case("name", task_names())
def test_every_task_of_the_kit_can_be_looked_into(name: str) -> None:
    view, batch, seen = view_of(random_policy(name))
    task = batch.task
    chosen = [action for action in view.actions if action.is_chosen]
    assert all(0 <= action.share <= 1 for action in view.actions)
    if isinstance(task.actions, ContinuousActions):
        assert view.kind == "command"
        assert [action.name for action in chosen] == ["forward m/s", "turn rad/s"]
    else:
        assert len(view.actions) == sum(action_counts(task.actions.space(task.robots)))
        assert len(chosen) == len(action_counts(task.actions.space(task.robots)))
        assert sum(action.rating for action in view.actions) == pytest.approx(len(chosen))
    assert len(view.nearest) == task.robots
    assert len(view.sight) == task.robots * task.observation.scan_size
    assert len(view.readings) == task.observation.frame_size - task.observation.scan_size
    assert np.isfinite(seen).all()


def test_what_is_drawn_lies_where_the_agent_is_told_it_is() -> None:
    """Each arc is as far from the robot as its number says, and the nearest one is the shortest range."""
    policy = random_policy("hallway")
    view, batch, seen = view_of(policy)
    spec, pose = batch.task.observation, batch.state.pose[0, 0]
    distances = [float(np.hypot(*(path.points[-1] - pose[:2]))) for path in view.sight]
    told = seen[-spec.frame_size :][: spec.scan_size] / spec.scale
    assert distances == pytest.approx(told.tolist(), abs=1e-5)
    assert view.nearest[0] == pytest.approx(min(distances), abs=1e-5)
    assert {path.style for path in view.sight} <= {"solid", "dotted"}
    far = [path.style == "dotted" for path in view.sight]
    assert far == [bool(distance >= spec.clip) for distance in told]


def test_values_are_told_as_values() -> None:
    view, _, _ = view_of(random_policy("turn", ActionSampling("epsilon", 0.05)))
    assert view.kind == "value"
    best = max(view.actions, key=lambda action: action.rating)
    assert best.is_chosen
    assert best.share == 1.0
    assert min(action.share for action in view.actions) == 0.0


def test_a_ray_leads_ahead_of_the_robot_whatever_its_heading() -> None:
    task = replace(
        find_task("turn"), observation=replace(find_task("turn").observation, rays=(45,), sectors=())
    )
    policy = random_policy("turn")
    observation = np.full(task.observation.size, 1.5 * task.observation.scale, dtype=np.float32)
    view = build_agent_view(
        policy, task, observation, np.zeros(3, np.float32), np.array([[1.0, 2.0, math.pi / 2]])
    )
    (path,) = view.sight
    assert path.points[-1] == pytest.approx((1.0, 3.5))


def test_what_the_agent_expects_is_noted_step_by_step() -> None:
    network = PolicyNetwork(
        (LinearLayer(np.ones((find_task("turn").observation.size, 1), np.float32), np.zeros(1, np.float32)),),
        "tanh",
    )
    policy = replace(random_policy("turn"), critic=network)
    task, player, expected = policy.trained_on.resolve(), policy.make_player(1), ExpectedReturns(policy)
    batch = BatchEnv(task, 1, 1)
    seen, sums = batch.reset(), []
    for _ in range(4):
        action = player.act(seen)
        expected.add(player, seen, action)
        sums.append(float(seen.sum()))
        seen = batch.step(action).observations
    assert expected.values == pytest.approx(sums, rel=1e-5)
    view = build_agent_view(policy, task, seen[0], player.scores[0], batch.state.pose[0], expected.values)
    assert view.expected_returns == tuple(expected.values)


@pytest.mark.parametrize("tells_target", [False, True])
def test_it_perceives_what_the_batch_engine_gives(tells_target: bool) -> None:
    policy = random_policy("turn", tells_target=tells_target)
    task = replace(policy.trained_on.resolve(), start=StartVariation(shifted=False), lidar_noise=0.0)
    batch = BatchEnv(task, 1, 1)
    names = [case.name for case in batch.cases]
    seen = batch.reset(cases=np.array([names.index("turn_a_to_b")]))
    views: list[AgentView] = []
    scenario = find_scenario("turn", "turn_a_to_b")
    case = scenario.case
    assert case is not None
    with Session(scenario, always_scan=True) as session:
        session.runner.observers.append(AgentObserver(policy, scenario.partners, views.append, case.target))
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
    assert [number for _, number in views[0].readings] == pytest.approx(
        seen[0, spec.scan_size :].tolist(), abs=1e-4
    )
    assert sum(action.rating for action in views[0].actions) == pytest.approx(1.0)
    assert len(views) >= 3  # after the reset it looks again at once


def test_the_target_of_a_route_and_a_leader_are_followed() -> None:
    policy = random_policy("turn", tells_target=True)
    scenario = find_scenario("turn", "turn_a_to_b")
    start = scenario.starts[0]
    here, there = (start.x, start.y), (1.6, 1.6)
    told: dict[str, list[float]] = {}
    for name, extra in (
        ("alone", {}),
        ("route", {"route": (here, there), "radius": 0.2}),
        ("leader", {"leader": "beacon"}),
    ):
        views: list[AgentView] = []
        with Session(scenario, always_scan=True) as session:
            observer = AgentObserver(policy, scenario.partners, views.append, there, **extra)  # type: ignore[arg-type]
            session.runner.observers.append(observer)
            for _ in range(round(policy.trained_on.resolve().step_time / session.runner.step_size) + 1):
                session.runner.tick()
        assert len(views) == 2
        told[name] = [number for _, number in views[-1].readings]
    assert told["route"] == told["alone"], "the first target is where it stands: it goes on to the second"
    assert told["leader"] == pytest.approx(told["alone"], abs=1e-3)


@pytest.mark.long
@every_case(
    "name",
    [
        name
        for name in task_names()
        if {"achieved", "target_heading", "arrived"}
        & {part.name for part in find_task(name).observation.parts}
    ],
)
def test_it_is_told_of_the_goal_what_training_tells(name: str) -> None:
    policy, seed = random_policy(name), 7
    task = policy.trained_on.resolve()
    level = find_task_level(name)
    assert level is not None
    scenario = episode_scenario(level, EpisodeStart.drawn(task, seed))
    case = scenario.case
    assert case is not None
    seen = BatchEnv(task, 1, seed).reset(seed=seed, cases=np.zeros(1, dtype=np.int64))
    views: list[AgentView] = []
    with Session(scenario, always_scan=True) as session:
        observer = AgentObserver(
            policy,
            scenario.partners,
            views.append,
            case.target,
            route=scenario.targets,
            radius=case.target_radius,
            leader=scenario.leader,
            heading=scenario.target_heading or 0.0,
        )
        session.runner.observers.append(observer)
        session.runner.tick()
    spec = task.observation
    told = seen[0, -spec.frame_size * task.robots :][spec.scan_size : spec.frame_size]
    assert [number for _, number in views[0].readings] == pytest.approx(told.tolist(), abs=1e-2)


def path_start(batch: BatchEnv) -> np.ndarray:
    start: np.ndarray = batch.state.pose[0, 0, :2]
    return start


def test_a_policy_that_is_told_more_than_a_node_knows_is_refused() -> None:
    told = random_policy("turn", tells_target=True)
    with pytest.raises(PolicyError):
        AgentObserver(told, ("serp",), print)
    with pytest.raises(PolicyError, match="drives 2 robots"):
        AgentObserver(random_policy("wheelchairs"), ("left",), print)
