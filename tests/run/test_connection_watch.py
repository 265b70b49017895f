"""What has no other end is told once, after a while, and not if it is found meanwhile."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from kit.controllers import ControllerFile, find_controller
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import String
from kit.msg.std_srvs import Trigger
from kit.msg.tf2_msgs import TFMessage
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node, create_graph_node
from kit.run.connection_watch import LOOK_INTERVAL_NS, MAX_TOLD, STANDS_NS, ConnectionWatch
from kit.run.episode import run_until
from kit.run.scenario import find_scenario
from kit.run.session import Session

SOON_NS, LATER_NS = STANDS_NS // 2, STANDS_NS + 2 * LOOK_INTERVAL_NS
SILENT = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

class Silent(Node):
    def __init__(self):
        super().__init__("silent")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.drive)

    def drive(self):
        command = Twist()
        command.linear.x = 0.2

rclpy.init()
rclpy.spin(Silent())
"""
DEAF = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

class Deaf(Node):
    def __init__(self):
        super().__init__("deaf")
        self.publisher = self.create_publisher(Twist, "/cmd_velx", 10)
        self.create_subscription(LaserScan, "/scan2", lambda scan: self.publisher.publish(Twist()), 10)

def main():
    rclpy.init()
    rclpy.spin(Deaf())

if __name__ == "__main__":
    main()
"""
"""A controller that hears nothing, and that nothing hears."""
SAID = ("/scan2", "/scan"), ("/cmd_velx", "/cmd_vel")
"""Of each mistake: what the program says, and what there is."""
LAUNCH = """
from launch import LaunchDescription
from launch_ros.actions import Node
from launch.actions import ExecuteProcess

def generate_launch_description():
    return LaunchDescription([
        Node(package="flatland_server", executable="flatland_server", parameters=[{{"world_path": {world!r}}}]),
        ExecuteProcess(cmd=["python3", {program!r}], name="deaf"),
    ])
"""
REPEATS = """
from launch.actions import OpaqueFunction, TimerAction

def again(context):
    return [TimerAction(period=0.3, actions=[OpaqueFunction(function=again)])]

def generate_launch_description_of(described=generate_launch_description):
    description = described()
    description.add_action(OpaqueFunction(function=again))
    return description

generate_launch_description = generate_launch_description_of
"""
"""Sets a timer that sets itself again without end, in addition."""
WORLD = Path(__file__).parents[1] / "ros" / "outside_programs" / "room" / "world.yaml"


def said_by_kit(words: Sequence[str], folder: Path) -> list[str]:
    """The lines that a command of the kit prints with ``folder`` as its home."""
    done = subprocess.run(
        [sys.executable, "-m", "kit", *words],
        capture_output=True,
        text=True,
        env={"PATH": "/usr/bin:/bin", "HOME": str(folder), "KIT_WORKSPACE": str(folder / "workspace")},
        cwd=Path(__file__).parents[2],
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return (done.stdout + done.stderr).splitlines()


def tells_of_both(screen: str) -> bool:
    """Whether a screen shows, of each mistake, what the program says and what there is."""
    return all(re.search(f"{named}, .*; {there_is}", screen) for named, there_is in SAID)


@pytest.fixture
def graph() -> Graph:
    graph = Graph()
    create_graph_node(graph, "world").create_publisher(LaserScan, "/scan", 10)
    return graph


def watched(graph: Graph, *nodes: Node) -> tuple[ConnectionWatch, list[str]]:
    told: list[str] = []
    names = frozenset(node.get_fully_qualified_name() for node in nodes)
    return ConnectionWatch(graph, lambda: names, told.append), told


def pass_time(graph: Graph, watch: ConnectionWatch, nanoseconds: int) -> None:
    end = graph.now_ns + nanoseconds
    while graph.now_ns < end:
        graph.advance(graph.now_ns + 10_000_000)
        watch.look()


def test_a_subscription_that_hears_nothing_is_told_once_with_what_there_is(graph: Graph) -> None:
    node = create_graph_node(graph, "mine")
    node.create_subscription(LaserScan, "/scan2", print, 10)
    watch, told = watched(graph, node)
    pass_time(graph, watch, SOON_NS)
    assert told == []
    pass_time(graph, watch, LATER_NS)
    pass_time(graph, watch, LATER_NS)
    watch.tell_all()
    (text,) = told
    assert text.index("/scan2") < text.index("/mine") < text.index("/scan ")


def test_what_is_found_in_time_is_not_told_and_others_nodes_are_not_looked_at(graph: Graph) -> None:
    node = create_graph_node(graph, "mine")
    node.create_subscription(String, "/words", print, 10)
    create_graph_node(graph, "another").create_client(Trigger, "/nowhere")
    watch, told = watched(graph, node)
    pass_time(graph, watch, SOON_NS)
    create_graph_node(graph, "talker").create_publisher(String, "/words", 10)
    pass_time(graph, watch, 2 * LATER_NS)
    watch.tell_all()
    assert told == []


def test_what_is_lost_later_is_told_and_the_end_tells_the_rest(graph: Graph) -> None:
    node, talker = create_graph_node(graph, "mine"), create_graph_node(graph, "talker")
    node.create_subscription(String, "/words", print, 10)
    talker.create_publisher(String, "/words", 10)
    watch, told = watched(graph, node)
    pass_time(graph, watch, LATER_NS)
    talker.destroy_node()
    pass_time(graph, watch, LATER_NS)
    assert len(told) == 1
    node.create_client(Trigger, "/nowhere")
    watch.tell_all()
    assert len(told) == 2
    assert "/nowhere" in told[1]


def test_a_program_of_very_many_mistakes_does_not_fill_the_screen(graph: Graph) -> None:
    node = create_graph_node(graph, "mine")
    for number in range(MAX_TOLD + 5):
        node.create_subscription(String, f"/words{number}", print, 10)
    watch, told = watched(graph, node)
    watch.tell_all()
    assert len(told) == MAX_TOLD


@pytest.mark.parametrize("namespace", ["", "/robot"])
@pytest.mark.parametrize(
    ("offered", "told_of"), [("tf", []), ("tf_static", []), ("poses", ["tf", "tf_static"])]
)
def test_transforms_need_one_of_their_two_topics(
    graph: Graph, namespace: str, offered: str, told_of: list[str]
) -> None:
    """A listener subscribes to both; most robots publish only one of them, or change none."""
    node = create_graph_node(graph, "mine")
    create_graph_node(graph, "robot").create_publisher(TFMessage, f"{namespace}/{offered}", 10)
    for word in ("tf", "tf_static"):
        node.create_subscription(TFMessage, f"{namespace}/{word}", print, 10)
    watch, told = watched(graph, node)
    pass_time(graph, watch, LATER_NS)
    assert [text.partition(",")[0] for text in told] == [f"{namespace}/{word}" for word in told_of]


@pytest.mark.long
@pytest.mark.parametrize("seconds", ["0.5", "5"])
@pytest.mark.parametrize("verb", ["run", "launch", "launch with a timer that sets itself again"])
def test_a_silent_controller_is_told_of_by_every_verb(verb: str, seconds: str, tmp_path: Path) -> None:
    program = tmp_path / "deaf.py"
    program.write_text(DEAF)
    launch = tmp_path / "deaf.launch.py"
    repeats = REPEATS if verb.endswith("again") else ""
    launch.write_text(LAUNCH.format(world=str(WORLD), program=str(program)) + repeats)
    steps = str(round(float(seconds) * 100))
    words = {
        "run": ("run", str(WORLD), "--controller", str(program), "--steps", steps),
        "launch": ("launch", str(launch), "--until", seconds),
    }[verb.partition(" ")[0]]
    lines = [line for line in said_by_kit(words, tmp_path) if "/deaf" in line]
    assert len(lines) == len(SAID)
    for line, (named, there_is) in zip(lines, SAID, strict=True):
        assert line.index(named) < line.index("/deaf") < line.rindex(there_is)


def test_a_program_that_sends_no_speed_is_told_so_and_again_after_a_change_that_sends_none(
    tmp_path: Path,
) -> None:
    program = tmp_path / "mine.py"
    sends = SILENT.replace("x = 0.2", "x = 0.2; self.publisher.publish(command)")
    for text, is_told in ((SILENT, True), (sends, False)):
        program.write_text(text)
        with Session(find_scenario("simple")) as session:
            watch = session.watch_connections("^E opens it.")
            session.drive_with(ControllerFile("mine", program, ""))
            session.wait_until_driven()
            run_until(session.runner, ticks=400)
            told = [each.text for each in session.messages if "sends no speed" in each.text]
            assert len(told) == is_told
            assert all("cmd_vel" in each and "^E" in each for each in told)
            watch.begin_again()
            run_until(session.runner, ticks=400)
            told = [each.text for each in session.messages if "sends no speed" in each.text]
            assert len(told) == 2 * is_told
    with Session(find_scenario("simple")) as session:  # nobody has pressed a key
        session.watch_connections()
        session.drive_with(find_controller("teleop"))
        session.wait_until_driven()
        run_until(session.runner, ticks=400)
        assert not [each for each in session.messages if "sends no speed" in each.text]
