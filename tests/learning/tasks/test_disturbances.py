"""What differs from the simulation: read from texts and files, drawn for each episode, felt by robots and lidars."""

from __future__ import annotations

import json
import math
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from kit.geometry import Pose
from kit.learning.authoring.new_task import new_task_file
from kit.learning.environment.batch import BatchEnv
from kit.learning.maps.batch_map import UnsupportedWorld
from kit.learning.tasks.actions import Move
from kit.learning.tasks.catalogue import HALLWAY, WHEELCHAIRS
from kit.learning.tasks.disturbances import DISTURBANCE_KINDS, DisturbanceError, Disturbances, UniformRange
from kit.learning.tasks.learning_task import LearningTask, StartVariation
from kit.learning.tasks.task_reader import read_task
from kit.learning.tasks.task_spec import TaskSpec
from kit.msg.geometry_msgs import Twist, Vector3
from kit.run.scenario import find_scenario
from kit.school.game.levels import LevelConditions, apply_conditions
from kit.sim.simulation import STEP_SIZE_S, Simulation, load_world
from kit.world.catalogue import find_map
from tests.cases import every_case
from tests.learning.worlds import actions_of, short

STRAIGHT = replace(short(HALLWAY, "straight"), start=StartVariation(shifted=False), lidar_noise=0.0)
ALL = Disturbances(
    lidar_noise=UniformRange(0.0, 0.05),
    dropped_rays=UniformRange(0.0, 0.3),
    latency=UniformRange(0.0, 0.3),
    command_jitter=UniformRange(0.0, 0.25),
    inertia=UniformRange(0.0, 3.0),
    wheel_radius=UniformRange(-0.1, 0.2),
    drift=UniformRange(-0.3, 0.3),
)


def constant(**values: float) -> Disturbances:
    return Disturbances.from_dict(values)


def disturbed(task: LearningTask, **values: float) -> LearningTask:
    return replace(task, disturbances=constant(**values))


def poses(task: LearningTask, moves: list[Move], n: int = 1) -> np.ndarray:
    """(moves + 1, n, 3): where the first robot of each world is, as it moves so."""
    batch = BatchEnv(task, n, seed=2, autoreset=False)
    batch.reset()
    found = [batch.state.pose[:, 0].copy()]
    for move in moves:
        number = task.actions.moves.index(move)
        found.append(batch.step(np.full(n, number)).transition.pose[:, 0])
    return np.array(found)


# Reading


@pytest.mark.parametrize(
    ("text", "low", "high"), [("0.1", 0.1, 0.1), ("0:0.2", 0, 0.2), ("-1:1e-2", -1, 0.01)]
)
def test_a_number_or_a_range_is_read(text: str, low: float, high: float) -> None:
    assert UniformRange.parse(text) == (low, high)
    assert UniformRange.parse(str(UniformRange(low, high))) == (low, high)


@every_case("text", ["", "a", "1:2:3", "0.2:0.1", "nan", "0:inf", ":", "1:"])
def test_other_texts_are_refused(text: str) -> None:
    with pytest.raises(DisturbanceError):
        UniformRange.parse(text)


def test_the_kinds_are_the_fields_and_sweep_what_is_possible() -> None:
    assert [kind.name for kind in DISTURBANCE_KINDS] == [field.name for field in fields(Disturbances)]
    for kind in DISTURBANCE_KINDS:
        assert 0.0 in kind.sweep
        assert list(kind.sweep) == sorted(set(kind.sweep))
        for value in kind.sweep:
            kind.check(UniformRange(value, value))
        with pytest.raises(DisturbanceError, match=kind.option):
            Disturbances(**{kind.name: UniformRange(0.0, kind.high + 1)})
        with pytest.raises(DisturbanceError, match=kind.option):
            Disturbances(**{kind.name: UniformRange(kind.low - 1, 0.0)})


@every_case(
    "data",
    [{"latncy": 1}, {"latency": True}, {"latency": [1, 2, 3]}, {"latency": []}, {"latency": None}, [1], "x"],
)
def test_wrong_mappings_are_refused(data: object) -> None:
    with pytest.raises(DisturbanceError):
        Disturbances.from_dict(data)


def test_a_task_keeps_its_disturbances_in_a_file() -> None:
    spec = TaskSpec("hallway", disturbances=ALL)
    again = TaskSpec.from_dict(json.loads(json.dumps(spec.as_dict())))
    assert again == spec
    assert again.resolve().disturbances == ALL
    assert TaskSpec.from_dict({"task": "hallway"}).resolve().disturbances == Disturbances()
    assert not Disturbances()
    assert ALL


# What robots feel


def test_wheels_that_are_too_large_drive_and_turn_faster() -> None:
    moves = [Move.FORWARD] * 3 + [Move.LEFT] * 2
    plain, larger = poses(STRAIGHT, moves)[:, 0], poses(disturbed(STRAIGHT, wheel_radius=0.1), moves)[:, 0]
    assert math.dist(larger[3, :2], larger[0, :2]) == pytest.approx(
        1.1 * math.dist(plain[3, :2], plain[0, :2])
    )
    assert larger[5, 2] - larger[0, 2] == pytest.approx(1.1 * (plain[5, 2] - plain[0, 2]))


def test_drift_turns_by_the_way_driven() -> None:
    path = poses(disturbed(STRAIGHT, drift=0.5), [Move.FORWARD] * 4)[:, 0]
    assert path[4, 2] - path[0, 2] == pytest.approx(0.5 * 4 * 0.2 * STRAIGHT.actions.largest[0])
    still = poses(disturbed(STRAIGHT, drift=0.5), [Move.LEFT, Move.STOP])[:, 0]
    assert still[2, 2] - still[0, 2] == pytest.approx(0.2 * STRAIGHT.actions.largest[1])


@pytest.mark.parametrize("late", [1, 2])
def test_a_latency_of_whole_steps_shifts_the_drive(late: int) -> None:
    moves = [Move.FORWARD, Move.LEFT, Move.FORWARD, Move.FORWARD_RIGHT, Move.STOP, Move.BACK]
    plain, delayed = poses(STRAIGHT, moves)[:, 0], poses(disturbed(STRAIGHT, latency=late * 0.2), moves)[:, 0]
    assert delayed[:late] == pytest.approx(np.repeat(plain[:1], late, axis=0))
    assert delayed[late:] == pytest.approx(plain[: len(moves) + 1 - late])


def test_a_latency_within_a_step_drives_on_by_the_command_before() -> None:
    path = poses(disturbed(STRAIGHT, latency=0.15), [Move.FORWARD, Move.STOP, Move.STOP])[:, 0]
    ways = np.hypot(*np.diff(path[:, :2], axis=0).T) / STRAIGHT.actions.largest[0]
    assert ways == pytest.approx([0.05, 0.15, 0.0])


def test_jitter_delays_each_command_by_another_time_in_order() -> None:
    moves = [Move.FORWARD] + [Move.STOP] * 3
    path = poses(disturbed(STRAIGHT, command_jitter=0.4), moves, n=200)
    ways = np.hypot(*np.diff(path[:, :, :2], axis=0).transpose(2, 0, 1)) / STRAIGHT.actions.largest[0]
    assert (ways >= -1e-12).all()
    assert (ways[3] == 0).any()
    began = 0.2 - ways[0]
    assert 0.1 < began[ways[0] > 0].std() * math.sqrt(12) < 0.3  # within the first step: uniform over 0.2 s
    assert (ways.sum(axis=0) <= 0.6 + 1e-9).all()
    assert 0.15 < ways.sum(axis=0).mean() < 0.35  # on the average it lasts a step, as without jitter


def test_late_commands_keep_to_the_motors_limits_as_in_the_single_world(tmp_path: Path) -> None:
    read = read_task(new_task_file("mine", "turtlebot", tmp_path)).task
    task = disturbed(
        replace(read, start=StartVariation(shifted=False), lidar_noise=0.0, max_steps=40),
        latency=0.05,
        command_jitter=0.3,
    )
    batch, card, ticks = BatchEnv(task, 1, seed=4, autoreset=False), find_map("turtlebot"), 50
    batch.reset()
    limit = batch.map_of_case(0)[1].robot.max_speed
    world, (robot,) = load_world(card.world_file, root=card.root), task.robots_on(card)
    topic = next(model.topic("cmd_vel") for model in world.models if model.name == robot)
    length = task.step_time / ticks
    simulation = Simulation(world, step_size=length, has_subscribers=lambda topic: False)
    simulation.move_model(robot, Pose(*batch.state.pose[0, 0].tolist()))
    sent: list[tuple[float, list[float]]] = []
    chance, fastest = np.random.default_rng(1), 0.0
    for number in range(30):
        before = batch.state.pose[0, 0].copy()
        step = batch.step(chance.integers(len(task.actions.names), size=1))
        takes_effect = number * ticks + float(batch.state.disturbed.due[0, 0, 0]) / length
        sent.append((takes_effect, step.transition.twist[0, 0].tolist()))
        for tick in range(ticks):
            due = [twist for when, twist in sent if when <= number * ticks + tick + 0.5]
            forward, turn = due[-1] if due else (0.0, 0.0)
            simulation.accept(topic, Twist(linear=Vector3(x=forward), angular=Vector3(z=turn)))
            simulation.step()
        assert not step.transition.hit.any()
        after = step.transition.pose[0, 0]
        fastest = max(fastest, math.dist(after[:2], before[:2]) / task.step_time)
        # A command begins at a tick there and at any time here: every change of it costs half a tick.
        away = np.abs(np.array(simulation.pose(robot)) - after)
        assert away.max() < (number + 1) * length * max(task.actions.largest)
    assert 0.9 * limit < fastest <= limit + 1e-9


def test_slow_motors_drive_as_in_the_single_world_under_a_levels_ice() -> None:
    task = replace(
        disturbed(STRAIGHT, inertia=2.5), start=StartVariation(shifted=False), max_steps=60, step_time=0.2
    )
    batch, card = BatchEnv(task, 1, seed=4, autoreset=False), find_map("hall_straight")
    batch.reset()
    scenario = find_scenario("hall_straight", None, None)
    icy = apply_conditions(scenario, LevelConditions(acceleration=1 / 2.5), task.actions.largest)
    simulation = Simulation(icy.world, step_size=STEP_SIZE_S, has_subscribers=lambda topic: False)
    simulation.move_model(card.robot, Pose(*batch.state.pose[0, 0].tolist()))
    chance, ways = np.random.default_rng(3), []
    for _ in range(30):
        before = batch.state.pose[0, 0].copy()
        step = batch.step(chance.integers(len(task.actions.names), size=1)).transition
        forward, turn = step.twist[0, 0].tolist()
        simulation.accept(
            icy.driven.topic("cmd_vel"), Twist(linear=Vector3(x=forward), angular=Vector3(z=turn))
        )
        for _ in range(round(task.step_time / STEP_SIZE_S)):
            simulation.step()
        assert not step.hit.any()
        assert np.abs(np.array(simulation.pose(card.robot)) - step.pose[0, 0]).max() < 1e-9
        ways.append(math.dist(step.pose[0, 0, :2], before[:2]) / task.step_time)
    assert max(np.abs(np.diff(ways))) <= 0.2 / 2.5 + 1e-4  # no step changes the speed by more
    assert max(ways) > 0.1


def test_slow_motors_add_to_late_commands() -> None:
    moves = [Move.FORWARD] + [Move.STOP] * 5
    fast, slow = (
        poses(disturbed(STRAIGHT, latency=0.1, inertia=inertia), moves)[:, 0] for inertia in (0.0, 0.5)
    )
    ways = [np.hypot(*np.diff(path[:, :2], axis=0).T) for path in (fast, slow)]
    assert ways[0][2:] == pytest.approx(0.0)
    assert ways[1][0] < ways[0][0]
    assert (ways[1][1:3] > 1e-3).all()
    assert ways[1][-1] == pytest.approx(0.0)


def test_slow_motors_of_a_tricycle_are_refused(tmp_path: Path) -> None:
    task = read_task(new_task_file("mine", "depot", tmp_path)).task
    BatchEnv(task, 1)
    with pytest.raises(UnsupportedWorld, match="no inertia of a tricycle"):
        BatchEnv(disturbed(task, inertia=1.0), 1)


PAIR = replace(
    WHEELCHAIRS, cases=("pair_straight",), start=StartVariation(gap=0.4), lidar_noise=0.0, max_steps=60
)


def test_each_robot_s_commands_are_late_by_themselves() -> None:
    task = disturbed(PAIR, command_jitter=0.2)
    batch = BatchEnv(task, 300, seed=2, autoreset=False)
    batch.reset()
    ahead = np.full((300, 2), task.actions.moves.index(Move.FORWARD))  # type: ignore[union-attr]  # a table
    step = batch.step(ahead).transition
    ways = np.hypot(*(step.pose - step.previous_pose)[:, :, :2].transpose(2, 0, 1)) / 0.3
    late = 0.2 - ways
    assert late.min() >= -1e-9
    for robot in range(2):
        assert late[:, robot].std() == pytest.approx(0.2 / math.sqrt(12), rel=0.1)
    assert abs(np.corrcoef(late.T)[0, 1]) < 0.2


def test_a_robot_that_stops_between_steps_loses_the_time_that_its_command_is_late() -> None:
    moves = [Move.FORWARD, Move.FORWARD, Move.STOP]
    going, stopping = (
        poses(replace(disturbed(STRAIGHT, latency=0.05), stops_between=stops), moves)[:, 0]
        for stops in (False, True)
    )
    for path, expected in ((going, [0.15, 0.2, 0.05]), (stopping, [0.15, 0.15, 0.0])):
        assert np.hypot(*np.diff(path[:, :2], axis=0).T) / 0.3 == pytest.approx(expected)


@pytest.mark.parametrize("stops", [False, True])
def test_two_robots_with_jitter_drive_as_in_the_single_world(*, stops: bool) -> None:
    task = replace(disturbed(PAIR, latency=0.03, command_jitter=0.12), stops_between=stops)
    batch, card, ticks = BatchEnv(task, 1, seed=4, autoreset=False), find_map("pair_straight"), 50
    batch.reset()
    world, names = load_world(card.world_file, root=card.root), task.robots_on(card)
    topics = [model.topic("cmd_vel") for name in names for model in world.models if model.name == name]
    length = task.step_time / ticks
    simulation = Simulation(world, step_size=length, has_subscribers=lambda topic: False)
    for name, pose in zip(names, batch.state.pose[0].tolist(), strict=True):
        simulation.move_model(name, Pose(*pose))
    moves = task.actions.moves  # type: ignore[union-attr]  # a table
    forward, left, right = (moves.index(move) for move in (Move.FORWARD, Move.LEFT, Move.RIGHT))
    sent: list[list[tuple[float, list[float]]]] = [[], []]
    apart = []
    for number in range(16):
        actions = [{0: left, 3: right}.get(number, forward), forward]
        step = batch.step(np.array([actions])).transition
        due = batch.state.disturbed.due[0, 0] / length
        apart.append(abs(due[0] - due[1]))
        for robot in range(2):
            if stops:
                sent[robot].append((number * ticks, [0.0, 0.0]))
            sent[robot].append((number * ticks + float(due[robot]), step.twist[0, robot].tolist()))
        for tick in range(ticks):
            for topic, commands in zip(topics, sent, strict=True):
                twists = [twist for when, twist in commands if when <= number * ticks + tick + 0.5]
                speed, turn = twists[-1] if twists else (0.0, 0.0)
                simulation.accept(topic, Twist(linear=Vector3(x=speed), angular=Vector3(z=turn)))
            simulation.step()
        assert not step.hit.any()
        for name, pose in zip(names, step.pose[0], strict=True):
            away = np.abs(np.array(simulation.pose(name)) - pose)
            assert away.max() < 2 * (number + 1) * length * max(task.actions.largest)
    assert max(apart) > 10  # ticks


def test_lost_rays_read_the_reach_and_others_each_time() -> None:
    task = disturbed(STRAIGHT, dropped_rays=0.25)
    plain, lossy = BatchEnv(STRAIGHT, 200, seed=1), BatchEnv(task, 200, seed=1)
    plain.reset()
    lossy.reset()
    stop = np.zeros(200, dtype=np.int64)
    seen, missed = plain.step(stop).transition.ranges, lossy.step(stop).transition.ranges
    near, clip = seen < task.observation.clip - 1e-6, task.observation.clip
    lost = (missed == np.float32(clip)) & near
    assert (missed[~lost & near] == seen[~lost & near]).all()
    assert lost.sum() / near.sum() == pytest.approx(0.25, abs=0.02)
    later = lossy.step(stop).transition.ranges
    assert ((later == np.float32(clip)) & near != lost).any()


def test_lidar_noise_has_its_deviation_beside_the_lidars_own() -> None:
    own = replace(STRAIGHT, lidar_noise=0.03)
    for task, deviation in (
        (disturbed(STRAIGHT, lidar_noise=0.04), 0.04),
        (disturbed(own, lidar_noise=0.04), 0.05),
    ):
        batch = BatchEnv(task, 500, seed=1)
        batch.reset()
        side = batch.step(np.zeros(500, dtype=np.int64)).transition.ranges[:, 0, 22]
        assert side.std() == pytest.approx(deviation, rel=0.1)


# Drawn for each episode


@pytest.mark.sampled(2)
@pytest.mark.parametrize("task", [STRAIGHT, WHEELCHAIRS], ids=lambda task: task.name)
def test_a_world_draws_its_own_and_is_the_same_alone_or_among_many(task: LearningTask) -> None:
    task = replace(task, disturbances=ALL, max_steps=15)
    together, chance = BatchEnv(task, 4, seed=3), np.random.default_rng(1)
    alone = [BatchEnv(task, 1, seed=3, first=i) for i in range(4)]
    together.reset()
    for each in alone:
        each.reset()
    values = []
    for _ in range(40):
        actions = actions_of(together, chance)
        step = together.step(actions)
        for i, each in enumerate(alone):
            single = each.step(actions[i : i + 1])
            assert single.observations[0].tobytes() == step.observations[i].tobytes()
            assert single.transition.pose[0].tobytes() == step.transition.pose[i].tobytes()
        state = together.state.disturbed
        drawn = [state.shared, state.wheels.reshape(4, -1), state.inertia[:, None]]
        values.append(np.concatenate(drawn, axis=1).copy())
    found = np.unique(np.concatenate(values), axis=0)
    assert len(found) >= 12  # four worlds, three episodes each
    kinds = ["lidar_noise", "dropped_rays", "latency", "command_jitter"] + [
        "wheel_radius",
        "drift",
    ] * task.robots
    for column, kind in zip(found.T, [*kinds, "inertia"], strict=True):
        low, high = ALL.range_of(kind)
        assert (column >= low).all()
        assert (column <= high).all()
        assert len(np.unique(column)) == len(found)
