"""The tick: who is called when, services, pauses, and that equal inputs make equal runs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from kit.msg.flatland_msgs import ChangeRate, DeleteModel, MoveModel, SpawnModel
from kit.msg.geometry_msgs import Pose2D, Twist, TwistStamped, Vector3
from kit.msg.robot_kit_msgs import GetState, Reset, Step
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import String
from kit.msg.std_srvs import Empty
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.run.recording import Recorder, Recording, RecordingError, load_recording, rerun, save_recording
from kit.run.runner import Runner
from kit.run.scenario import scenario_on_map
from kit.sim.simulation import Simulation
from kit.world.catalogue import find_map
from kit.world.records import World


@pytest.fixture(scope="module")
def maze() -> World:
    return scenario_on_map(find_map("maze")).world


def build(world: World, seed: int = 0) -> Runner:
    graph = Graph()
    return Runner(Simulation(world, seed=seed), graph)


def forward(speed: float = 0.5, turn: float = 0.0) -> Twist:
    return Twist(linear=Vector3(x=speed), angular=Vector3(z=turn))


def call(runner: Runner, kind: Any, name: str, request: Any) -> Any:
    """Asks, ticks until answered, and returns the response."""
    node = create_graph_node(runner.graph, "asker")
    future = node.create_client(kind, name).call_async(request)
    for _ in range(50):
        if future.done():
            break
        runner.tick()
    node.destroy_node()
    assert future.done()
    return future.result()


def test_a_key_reaches_the_wheels_within_the_tick(maze: World) -> None:
    runner = build(maze)
    node = create_graph_node(runner.graph, "teleop")
    drive = node.create_publisher(Twist, "/cmd_vel", 10)
    node.create_subscription(String, "/teleopkeys", lambda message: drive.publish(forward()), 10)
    keyboard = create_graph_node(runner.graph, "keyboard").create_publisher(String, "/teleopkeys", 10)
    before = runner.simulation.pose("serp")
    keyboard.publish(String(data="p_up"))
    runner.tick()
    after = runner.simulation.pose("serp")
    assert np.hypot(after.x - before.x, after.y - before.y) == pytest.approx(0.005, rel=1e-6)


def test_a_command_with_a_stamp_drives_too(maze: World) -> None:
    """The topic has the second type only where somebody publishes it."""
    runner = build(maze)
    directory = runner.graph.directory
    assert directory.topics["/cmd_vel"].type_names == ["geometry_msgs/msg/Twist"]
    node = create_graph_node(runner.graph, "driver")
    publisher = node.create_publisher(TwistStamped, "/cmd_vel", 10)
    publisher.publish(TwistStamped(twist=forward()))
    before = runner.simulation.pose("serp")
    runner.tick()
    after = runner.simulation.pose("serp")
    assert np.hypot(after.x - before.x, after.y - before.y) == pytest.approx(0.005, rel=1e-6)
    assert len(directory.topics["/cmd_vel"].type_names) == 2


def test_a_scan_is_heard_in_the_next_tick(maze: World) -> None:
    runner = build(maze)
    heard: list[LaserScan] = []
    create_graph_node(runner.graph, "listener").create_subscription(
        LaserScan, "/static_laser", heard.append, 10
    )
    runner.tick()
    runner.tick()
    assert len(heard) == 1
    assert len(heard[0].ranges) == 91
    for _ in range(100):
        runner.tick()
    assert len(heard) == 11


def test_the_clock_stands_still_while_paused_and_services_answer(maze: World) -> None:
    runner = build(maze)
    runner.tick()
    call(runner, Empty, "/pause", Empty.Request())
    time_ns = runner.simulation.time_ns
    for _ in range(5):
        runner.tick()
    assert runner.simulation.time_ns == runner.graph.now_ns == time_ns
    stepped = call(runner, Step, "/step", Step.Request(ticks=3))
    assert stepped.success
    assert runner.simulation.time_ns == time_ns + 30_000_000
    assert call(runner, GetState, "/get_state", GetState.Request()).paused
    call(runner, Empty, "/toggle_pause", Empty.Request())
    runner.tick()
    assert runner.simulation.time_ns > time_ns + 30_000_000
    refused = call(runner, Step, "/step", Step.Request(ticks=3))
    assert not refused.success
    assert "pause" in refused.message


def test_models_come_go_and_move(maze: World) -> None:
    runner = build(maze)
    file = str(find_map("maze").root / "robots" / "serp.model.yaml")
    pose = Pose2D(x=0.8, y=-0.1, theta=0.0)
    spawned = call(
        runner,
        SpawnModel,
        "/spawn_model",
        SpawnModel.Request(yaml_path=file, name="two", ns="two", pose=pose),
    )
    assert spawned.success, spawned.message
    heard: list[LaserScan] = []
    create_graph_node(runner.graph, "listener").create_subscription(
        LaserScan, "/two/static_laser", heard.append, 10
    )
    for _ in range(15):
        runner.tick()
    assert heard
    again = call(
        runner,
        SpawnModel,
        "/spawn_model",
        SpawnModel.Request(yaml_path=file, name="two", ns="two", pose=pose),
    )
    assert not again.success
    assert call(
        runner, MoveModel, "/move_model", MoveModel.Request(name="serp", pose=Pose2D(x=0.1, y=-0.2))
    ).success
    assert runner.simulation.pose("serp")[:2] == pytest.approx((0.1, -0.2), abs=1e-3)
    assert call(runner, DeleteModel, "/delete_model", DeleteModel.Request(name="two")).success
    assert "/two/static_laser" not in [endpoint.topic for endpoint in runner.simulation.endpoints]
    unknown = call(runner, MoveModel, "/move_model", MoveModel.Request(name="two", pose=pose))
    assert not unknown.success
    assert "two" in unknown.message


def test_a_rate_needs_somebody_who_paces(maze: World) -> None:
    runner = build(maze)
    assert not call(runner, ChangeRate, "/change_rate", ChangeRate.Request(rate=200.0)).success
    rates: list[float] = []
    runner.on_rate = rates.append
    assert call(runner, ChangeRate, "/change_rate", ChangeRate.Request(rate=200.0)).success
    assert not call(runner, ChangeRate, "/change_rate", ChangeRate.Request(rate=-1.0)).success
    assert rates == [200.0]


def wander(runner: Runner, ticks: int) -> Recording:
    """Drives about by what the noisy laser says, with a reset on the way, and records it."""
    recorder = Recorder("maze", None, runner.simulation)
    runner.observers.append(recorder)
    node = create_graph_node(runner.graph, "wanderer")
    drive = node.create_publisher(Twist, "/cmd_vel", 10)

    def on_scan(scan: LaserScan) -> None:
        drive.publish(forward(0.5 if scan.ranges[45] > 0.3 else 0.0, scan.ranges[30] - 0.3))

    node.create_subscription(LaserScan, "/static_laser", on_scan, 10)
    for tick in range(ticks):
        if tick == ticks // 2:
            runner.call_service("move_model", "serp", (0.0, 0.0, 0.0))
        runner.tick()
    return recorder.recording()


def test_the_same_inputs_make_the_same_run_to_the_bit(maze: World) -> None:
    first, second, other = (wander(build(maze, seed), 1500) for seed in (7, 7, 8))
    assert np.array_equal(first.poses, second.poses)
    assert not np.array_equal(first.poses, other.poses)


def test_a_recording_runs_again_to_the_bit(maze: World, tmp_path: Any) -> None:
    recording = wander(build(maze, 3), 1200)
    save_recording(recording, tmp_path / "run.npz")
    loaded = load_recording(tmp_path / "run.npz")
    again = rerun(loaded, maze)
    assert np.array_equal(again.poses, recording.poses)
    assert again.ticks == recording.ticks == 1200
    assert recording.track("serp").shape == (1200, 3)


def test_a_reset_is_atomic(maze: World) -> None:
    runner = build(maze, 5)
    fresh = wander(build(maze, 5), 300)
    runner.call_service("move_model", "serp", (1.0, -1.0, 0.0))
    for _ in range(100):
        runner.tick()
    assert call(runner, Reset, "/reset", Reset.Request()).success
    assert np.array_equal(wander_after_reset(runner, 300).poses, fresh.poses)


def wander_after_reset(runner: Runner, ticks: int) -> Recording:
    runner.call_service("reset", None)
    return wander(runner, ticks)


@pytest.mark.parametrize("content", [b"", b"not a recording", b"PK\x03\x04 cut off"])
def test_a_damaged_recording_is_refused(tmp_path: Any, content: bytes) -> None:
    file = tmp_path / "run.npz"
    file.write_bytes(content)
    with pytest.raises(RecordingError, match=r"run\.npz"):
        load_recording(file)
