"""Whoever asks a robot for more than it can is told once, with both numbers; nobody else is."""

from __future__ import annotations

import math
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from kit.host.graph_bridge import ChildBridge, ParentBridge
from kit.msg.ackermann_msgs import AckermannDriveStamped
from kit.msg.flatland_msgs import DeleteModel
from kit.msg.geometry_msgs import Twist, TwistStamped
from kit.ros.graph.connections import ConnectionsReader
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.run.command_limits import describe_limits
from kit.run.connection_watch import LOOK_INTERVAL_NS, ConnectionWatch
from kit.run.runner import Runner
from kit.run.scenario import scenario_on_map
from kit.sim.simulation import Simulation
from kit.world.catalogue import find_map
from tests.run.test_connection_watch import LAUNCH, said_by_kit

FAST = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

class Fast(Node):
    def __init__(self):
        super().__init__("fast")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_timer(0.1, self.drive)

    def drive(self):
        command = Twist()
        command.linear.x = 0.6
        self.publisher.publish(command)

def main():
    rclpy.init()
    rclpy.spin(Fast())

if __name__ == "__main__":
    main()
"""


def twist(forward: float, turn: float) -> Twist:
    command = Twist()
    command.linear.x, command.angular.z = forward, turn
    return command


def stamped(forward: float, turn: float) -> TwistStamped:
    return TwistStamped(twist=twist(forward, turn))


def ackermann(speed: float, angle: float) -> AckermannDriveStamped:
    command = AckermannDriveStamped()
    command.drive.speed, command.drive.steering_angle = speed, angle
    return command


LIMITED = [
    ("turtlebot", "/cmd_vel", twist, (0.22, 2.84)),
    ("turtlebot", "/cmd_vel", stamped, (0.22, 2.84)),
    ("f1tenth", "/drive", ackermann, (7.0, 0.4189)),
]


def runner_on(name: str) -> Runner:
    return Runner(Simulation(scenario_on_map(find_map(name)).world, seed=0), Graph())


def told_of(name: str, topic: str, commands: list[Any]) -> list[str]:
    """What is told of a node that sends these commands, beside one that asks for nothing."""
    runner = runner_on(name)
    told: list[str] = []
    node, other = (create_graph_node(runner.graph, each) for each in ("fast", "modest"))
    names = frozenset({"/fast", "/modest"})
    watch = ConnectionWatch(runner.graph, frozenset, told.append, commanders=lambda: names)
    reader = ConnectionsReader(runner.graph)
    runner.observers.append(watch)
    out, quiet = (each.create_publisher(type(commands[0]), topic, 10) for each in (node, other))
    for _ in range(2):
        for command in commands:
            out.publish(command)
            quiet.publish(type(command)())
            for _ in range(2 * LOOK_INTERVAL_NS // round(1e9 * runner.step_size)):
                runner.tick()
    watch.tell_all()
    assert reader.read().mistakes == ()  # these nodes were there before the reader
    return told


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(("name", "topic", "make", "limits"), LIMITED)
def test_more_than_the_robot_can_is_told_once_with_both_numbers(
    name: str, topic: str, make: Callable[[float, float], Any], limits: tuple[float, float], sign: int
) -> None:
    first, second = limits
    told = told_of(name, topic, [make(sign * 2 * first, 0.0), make(0.0, sign * 3 * second)])
    assert len(told) == 2
    for text, limit, factor in zip(told, limits, (2, 3), strict=True):
        assert text.index("/fast") < text.index(f"{factor * limit:g} ") < text.index(f"{limit:g} ")
        assert "/modest" not in text


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0, math.nan, math.inf])
@pytest.mark.parametrize(("name", "topic", "make", "limits"), LIMITED)
def test_what_the_robot_can_is_not_told(
    name: str, topic: str, make: Callable[[float, float], Any], limits: tuple[float, float], share: float
) -> None:
    assert told_of(name, topic, [make(share * limits[0], share * limits[1])]) == []


def test_a_robot_without_a_limit_does_what_is_asked_for() -> None:
    assert told_of("maze", "/cmd_vel", [twist(50.0, 50.0)]) == []


def test_a_grader_tells_it_of_the_programs_nodes() -> None:
    runner = runner_on("turtlebot")
    reader = ConnectionsReader(runner.graph)
    node = create_graph_node(runner.graph, "fast")
    node.create_publisher(Twist, "/cmd_vel", 10).publish(twist(0.6, 0.0))
    (text,) = reader.read().mistakes
    assert text.index("/fast") < text.index("0.6 m/s") < text.index("0.22 m/s")


@pytest.mark.parametrize(("name", "words"), [("turtlebot", ["0.22 m/s", "2.84 rad/s"]), ("maze", ["no top"])])
def test_a_map_tells_the_top_speed_of_its_robot(name: str, words: list[str]) -> None:
    scenario = scenario_on_map(find_map(name))
    (line,) = describe_limits(Simulation(scenario.world, seed=0), scenario.partners)
    for word in words:
        assert word in line


def test_a_program_in_another_process_is_told_what_the_world_has_noted() -> None:
    """``kit ros run`` beside a world: its end of the graph hears of it, once, and does not send it back."""
    runner = runner_on("turtlebot")
    parent = ParentBridge(runner.graph)
    node = create_graph_node(runner.graph, "fast")
    node.create_publisher(Twist, "/cmd_vel", 10).publish(twist(0.6, 0.0))
    child = ChildBridge(_NoCommands(), 0)
    child.apply_events(parent.take_pending())
    assert child.graph.directory.excesses == runner.graph.directory.excesses != {}
    assert child.take_changes() == []
    runner.tick()
    assert not any(event[0] == "excess" for event in parent.take_pending())


def test_another_process_sees_what_a_robot_does_at_most_and_when_it_has_left() -> None:
    runner = runner_on("turtlebot")
    parent, child = ParentBridge(runner.graph), ChildBridge(_NoCommands(), 0)
    child.apply_events(parent.take_pending())
    seen = child.graph.directory
    assert seen.command_limits == {"/cmd_vel": ("linear.x 0.22 m/s", "angular.z 2.84 rad/s")}
    client = create_graph_node(runner.graph, "teacher").create_client(DeleteModel, "/delete_model")
    client.call_async(DeleteModel.Request(name="burger"))
    runner.tick()
    child.apply_events(parent.take_pending())
    assert seen.command_limits == {}


class _NoCommands:
    def answer(self, kind: str, *content: Any) -> None:
        raise AssertionError(kind)

    def next_command(self) -> list[Any]:
        raise AssertionError


@pytest.mark.long
@pytest.mark.parametrize("verb", ["run", "launch"])
def test_every_verb_tells_it(verb: str, tmp_path: Path) -> None:
    maps = find_map("turtlebot").world_file.parents[1]
    for name in ("turtlebot", "robots"):
        shutil.copytree(maps / name, tmp_path / name)
    (tmp_path / "package.xml").write_text("<package><name>arena</name></package>")
    world = tmp_path / "turtlebot" / "world.yaml"
    program, launch = tmp_path / "fast.py", tmp_path / "fast.launch.py"
    program.write_text(FAST)
    launch.write_text(LAUNCH.format(world=str(world), program=str(program)))
    words = {
        "run": ("run", "turtlebot", "--controller", str(program), "--steps", "300"),
        "launch": ("launch", str(launch), "--until", "3"),
    }[verb]
    (line,) = [line for line in said_by_kit(words, tmp_path) if "0.22 m/s" in line]
    assert line.index("/fast") < line.index("0.6 m/s") < line.index("0.22 m/s")
