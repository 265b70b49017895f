"""Launch files that want what the kit does not have, and launch files in XML with lifecycle nodes: carried out whole."""

from __future__ import annotations

import pytest

from tests.launch.conftest import Launched, Workshop

SPEAKER = """
import rclpy
from rclpy.node import Node

def main():
    rclpy.init()
    print("speaks", Node("speaker").get_name())
"""


@pytest.mark.long
def test_what_is_missing_is_named_and_the_rest_goes_on(workshop: Workshop, launch: Launched) -> None:
    folder = workshop.package(
        "mixed",
        """
        IncludeLaunchDescription(PathJoinSubstitution([FindPackageShare("gazebo_ros"), "launch", "gazebo.launch.py"])),
        Node(package="robot_state_publisher", executable="robot_state_publisher",
             parameters=[{"robot_description": Command(["xacro ", "robot.urdf.xacro"])}]),
        Node(package="ros_gz_sim", executable="create"),
        ExecuteProcess(cmd=["gazebo", "--verbose"]),
        ComposableNodeContainer(name="c", namespace="", package="rclcpp_components", executable="component_container"),
        Node(package="fast", executable="talker"),
        Node(package="mixed", executable="speaker", name="ada"),
        ExecuteProcess(cmd=[ExecutableInPackage("speaker", "mixed"), "--ros-args", "-r", "__node:=bob"]),
        """,
        speaker=SPEAKER,
    )
    fast = workshop.folder / "fast"
    fast.mkdir()
    (fast / "package.xml").write_text(
        "<package><name>fast</name><export><build_type>ament_cmake</build_type></export></package>"
    )
    (fast / "CMakeLists.txt").write_text("add_executable(talker src/talker.cpp)")
    said, complained, code = launch(folder, "--plain")
    everything = said + complained
    assert code == 0, everything
    assert "speaks ada" in said
    assert "speaks bob" in said
    for name in (
        "gazebo_ros",
        "xacro",
        "ros_gz_sim",
        "gazebo ",
        "composable nodes",
        "'fast' has no Python programs",
    ):
        skipped = [line for line in everything.splitlines() if "skipped: " in line and name in line]
        assert skipped, (name, everything)
        assert "mixed.launch.py:" in skipped[0]


def test_python_may_ask_for_a_missing_package_s_share(workshop: Workshop, launch: Launched) -> None:
    folder = workshop.package("asks", "*rest(),", speaker=SPEAKER)
    file = folder / "launch" / "asks.launch.py"
    file.write_text(
        file.read_text().replace(
            "def generate",
            "import os\nfrom ament_index_python.packages import get_package_share_directory\n\n"
            "def rest():\n"
            "    file = os.path.join(get_package_share_directory('gazebo_ros'), 'launch', 'gazebo.launch.py')\n"
            "    return [IncludeLaunchDescription(file), Node(package='asks', executable='speaker')]\n\n\n"
            "def generate",
            1,
        )
    )
    said, complained, code = launch(folder, "--plain")
    assert code == 0, complained
    assert "skipped: gazebo_ros is not in the kit" in said
    assert "speaks speaker" in said


COMPONENTS = """
from rclpy.node import Node
from std_msgs.msg import String

class Speaker(Node):
    def __init__(self):
        super().__init__("speaker")
        self.declare_parameter("word", "none")
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.create_timer(0.1, lambda: self.publisher.publish(String(data=self.get_parameter("word").value)))
        self.create_timer(3.0, self.leave)

    def leave(self):
        raise SystemExit

class Hearer(Node):
    def __init__(self):
        super().__init__("hearer")
        self.create_subscription(String, "chatter", self.hear, 10)

    def hear(self, message):
        print(self.get_fully_qualified_name(), "heard", message.data)
        raise SystemExit
"""


@pytest.mark.long
def test_composable_nodes_in_python_run_and_the_others_are_named(
    workshop: Workshop, launch: Launched
) -> None:
    container = """
        ComposableNodeContainer(name="c", namespace="", package="rclcpp_components", executable="component_container",
            composable_node_descriptions=[
                ComposableNode(package="parts", plugin="parts::Speaker", name="ada", parameters=[{"word": "bye"}],
                               remappings=[("chatter", "/talk")], extra_arguments=[{"use_intra_process_comms": True}]),
                ComposableNode(package="image_proc", plugin="image_proc::RectifyNode"),
            ]),
        LoadComposableNodes(target_container="c", composable_node_descriptions=[
            ComposableNode(package="parts", plugin="parts.nodes::Hearer", namespace="rig",
                           remappings=[("chatter", "/talk")])]),
        """
    folder = workshop.package("parts", container)
    (folder / "parts" / "nodes.py").write_text(COMPONENTS)
    (folder / "setup.py").write_text(
        "setup(name='parts', entry_points={'rclpy_components': ['parts::Speaker = parts.nodes:Speaker']})"
    )
    file = folder / "launch" / "parts.launch.py"
    file.write_text(f"from launch_ros.descriptions import ComposableNode\n{file.read_text()}")
    said, complained, code = launch(folder, "--plain")
    assert code == 0, said + complained
    assert "/rig/hearer heard bye" in said
    assert "skipped" in said
    assert "package 'image_proc' not found" in said


def test_a_launch_file_may_import_what_is_missing(workshop: Workshop, launch: Launched) -> None:
    folder = workshop.package(
        "robots",
        """
        Node(package="robot_state_publisher", executable="robot_state_publisher"),
        Node(package="robots", executable="gone",
             parameters=[{"robot_description": xacro.process_file("robot.xacro", mappings={"a": "b"}).toxml()}]),
        Node(package="robots", executable="gone", parameters=[RewrittenYaml(source_file="a.yaml", param_rewrites={})]),
        Node(package="robots", executable="speaker"),
        """,
        speaker=SPEAKER,
    )
    file = folder / "launch" / "robots.launch.py"
    file.write_text(f"import xacro\nfrom nav2_common.launch import RewrittenYaml\n{file.read_text()}")
    said, complained, code = launch(folder, "--plain")
    assert code == 0, said + complained
    for name in ("robot_state_publisher", "xacro", "nav2_common"):
        assert [
            line
            for line in said.splitlines()
            if f"skipped: {name} is not in the kit" in line or ("skipped" in line and name in line)
        ], (name, said)
    assert "speaks speaker" in said


LIFECYCLE = """
import rclpy
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn

class Camera(LifecycleNode):
    def on_configure(self, state):
        print("configured", self.get_name())
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        print("activated")
        self.is_done = True
        return TransitionCallbackReturn.SUCCESS

def main():
    rclpy.init()
    camera = Camera("camera")
    camera.is_done = False
    while not camera.is_done:
        rclpy.spin_once(camera)
"""


@pytest.mark.long
def test_a_lifecycle_node_of_an_xml_file_is_started(workshop: Workshop, launch: Launched) -> None:
    folder = workshop.package("shots", "", camera=LIFECYCLE)
    (folder / "launch" / "shots.launch.py").unlink()
    (folder / "launch" / "shots.launch.xml").write_text(
        "<launch><lifecycle_node pkg='shots' exec='camera' name='left' namespace='rig' autostart='true'/></launch>"
    )
    said, complained, code = launch(folder, "--plain")
    assert "configured left" in said, said + complained
    assert "activated" in said
    assert code == 0


@pytest.mark.long
def test_a_launch_file_leads_a_node_through_its_states(workshop: Workshop, launch: Launched) -> None:
    """As launch_ros's own example does: configure, and activate once it is inactive."""
    folder = workshop.package("led", "*steps(),", camera=LIFECYCLE)
    file = folder / "launch" / "led.launch.py"
    steps = """from launch.events import matches_action
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from lifecycle_msgs.msg import Transition

def steps():
    node = LifecycleNode(package="led", executable="camera", name="lens", namespace="")
    def change(number):
        return EmitEvent(event=ChangeState(lifecycle_node_matcher=matches_action(node), transition_id=number))
    reaches_inactive = OnStateTransition(
        target_lifecycle_node=node, goal_state="inactive",
        entities=[LogInfo(msg="is inactive"), change(Transition.TRANSITION_ACTIVATE)],
    )
    return [RegisterEventHandler(reaches_inactive), node, change(Transition.TRANSITION_CONFIGURE)]

def generate"""
    file.write_text(file.read_text().replace("def generate", steps, 1))
    said, complained, code = launch(folder, "--plain")
    assert code == 0, said + complained
    for text in ("configured lens", "is inactive", "activated"):
        assert text in said


def test_a_mistake_in_a_launch_file_is_named_with_its_place(workshop: Workshop, launch: Launched) -> None:
    folder = workshop.package("wrong", "")
    (folder / "launch" / "wrong.launch.py").unlink()
    (folder / "launch" / "wrong.launch.xml").write_text("<launch>\n  <node pkg='wrong' exe='a'/>\n</launch>")
    _, complained, code = launch(folder, "--plain")
    assert code == 2
    assert "launch/wrong.launch.xml:2" in complained
    assert "did you mean 'exec'" in complained
