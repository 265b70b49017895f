"""Packages in the shape of Flatland's time, as they are."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

from kit.launch.launch_file_process import find_launch_file
from kit.launch.launch_run import Launch, LaunchOutputLine
from kit.launch.plain_launch import LaunchSession
from kit.ros.graph.graph import Graph
from tests.launch.conftest import TWO_ROBOTS, Launched, Workshop

ARGUMENTS = """\
Arguments (pass arguments as '<name>:=<value>'):

    'world_path':
        no description given
        (default: PathJoin(FindPackageShare(pkg='two_robots'), 'world/world.yaml'))
"""


@pytest.mark.long
def test_two_robots_of_one_model_file_are_driven_apart() -> None:
    """With a service called in a callback, lambdas with arguments of their own, and a module below the package."""
    said: list[LaunchOutputLine] = []
    launch = Launch(
        find_launch_file(str(TWO_ROBOTS), None, ()),
        Graph(),
        arguments={"speed": "0.25"},
        on_output=said.append,
    )
    try:
        launch.load()
        assert launch.world is not None
        assert (launch.world.factor, launch.wants_view) == (1.0, True)
        session = LaunchSession(launch)
        launch.start_processes()
        for _ in range(400):
            session.runner.tick()
        left, right = (session.runner.simulation.pose(name) for name in ("left", "right"))
        assert math.isclose(left.y, 0.25 * 4, abs_tol=0.05)
        assert math.isclose(right.y, -0.25 * 4, abs_tol=0.05)
        names = {handle.full_name for handle in launch.graph.directory.nodes}
        assert {"/pair", "/tf", "/flatland_server"} <= names
        topics = {name for name, _ in launch.graph.directory.topic_names_and_types()}
        assert {
            "/left/cmd_vel",
            "/right/cmd_vel",
            "/left/static_laser",
            "/right/static_laser",
            "/tf_static",
        } <= topics
        for _ in range(400):
            session.runner.tick()
        assert abs(session.runner.simulation.pose("left").y) < 1.0, "it was sent home at the wall"
    finally:
        launch.close()
    assert launch.failures == []
    texts = [line.text for line in said if line.program == "pair-2"]
    assert any("ready to drive" in text for text in texts)
    assert any("left goes home, time 1" in text for text in texts)


@pytest.mark.long
def test_a_thread_trains_with_the_old_gym_while_another_spins(launch: Launched) -> None:
    out, err, code = launch(TWO_ROBOTS, "learn:=true", "--until", "20")
    said = out + err
    assert "Training - Episode 1 end state: timeout" in said
    assert "Training Finished." in said
    assert "gym is not installed" in said
    assert "[left.learner]" in said
    assert code == 0


@pytest.mark.long
def test_the_same_steps_give_the_same_run(launch: Launched) -> None:
    first, second = (launch(TWO_ROBOTS, "--steps", "600") for _ in range(2))
    without_pids = [re.sub(r"pid \[\d+]", "", out + err) for out, err, _ in (first, second)]
    assert without_pids[0] == without_pids[1]
    assert "left goes home, time 1" in without_pids[0]


def test_arguments_are_shown(launch: Launched) -> None:
    out, _, code = launch(TWO_ROBOTS, "--show-args")
    assert out.startswith(ARGUMENTS)
    assert "\n    'speed':\n        of both robots\n        (default: '0.4')\n" in out
    assert "\n    'learn': valid choices are: ['true', 'false']\n" in out
    assert code == 0


def test_nodes_talk_without_a_world(launch: Launched, workshop: Workshop) -> None:
    """Each in a process of its own; the launch ends when both have ended."""
    folder = workshop.package(
        "chat",
        """
        Node(package='chat', executable='talker', parameters=[{'words': 'hello'}], remappings=[('chatter', 'talk')]),
        Node(package='chat', executable='listener', namespace='/', remappings=[('chatter', 'talk')]),
        """,
        talker="""
        self.declare_parameter('words', '')
        self.out = self.create_publisher(String, 'chatter', 10)
        self.create_timer(0.1, self.speak)

    def speak(self):
        self.out.publish(String(data=self.get_parameter('words').value))
        if self.count_subscribers('talk') == 0:
            raise SystemExit
        """,
        listener="""
        self.heard = 0
        self.create_subscription(String, 'chatter', self.hear, 10)

    def hear(self, message):
        self.heard += 1
        self.get_logger().info(f'heard {message.data} {self.heard}')
        """,
    )
    out, err, code = launch(folder, "--until", "1")
    assert "heard hello 5" in out + err
    assert code == 0


@pytest.mark.long
def test_a_launch_without_a_world_ends_with_its_programs(launch: Launched, workshop: Workshop) -> None:
    folder = workshop.package(
        "brief",
        "Node(package='brief', executable='once'), TimerAction(period=0.2, actions=[LogInfo(msg='and later')]),",
        once="import rclpy\ndef main():\n    rclpy.init()\n    rclpy.create_node('once').get_logger().info('done')\n",
    )
    out, err, code = launch(folder, "--plain")
    assert "[once]: done" in out + err
    assert "[INFO] [once-1]: process has finished cleanly" in out
    assert "[INFO] [launch]: and later" in out
    assert code == 0


def test_what_follows_from_what(launch: Launched, workshop: Workshop) -> None:
    """A command, what it prints, its end, and the end of everything; ``ros2`` is the kit's."""
    folder = workshop.package(
        "chain",
        """
        SetEnvironmentVariable('GREETING', 'good day'),
        first := ExecuteProcess(cmd=['sh', '-c', 'echo "$GREETING"; echo oh >&2; exit 3'], name='first'),
        RegisterEventHandler(OnProcessExit(target_action=first, on_exit=lambda event, context: [
            LogInfo(msg=f'{event.process_name} ended with {event.returncode}'),
            ExecuteProcess(cmd=[FindExecutable(name='ros2'), 'interface', 'show', 'std_srvs/srv/Empty'], on_exit=Shutdown(reason='done')),
        ])),
        RegisterEventHandler(OnShutdown(on_shutdown=[LogInfo(msg='good bye')])),
        RegisterEventHandler(OnProcessIO(target_action=first, on_stderr=lambda event, context:
            LogInfo(msg=f'it said {event.text.decode().strip()}'))),
        ExecuteProcess(cmd=['sleep', '60']),
        """,
    )
    out, err, code = launch(folder, "--plain")
    assert "[first-1] good day" in out
    assert "[first-1] oh" in err
    assert "it said oh" in out
    assert "first-1 ended with 3" in out
    assert "[ros2-3] ---" in out
    assert out.index("good bye") < out.index("everything is stopped: done")
    assert code == 1, "one process has failed"


def test_the_last_process_may_be_ended_by_an_event_and_something_follow(
    launch: Launched, workshop: Workshop
) -> None:
    folder = workshop.package(
        "ended",
        """
        last := ExecuteProcess(cmd=['sh', '-c', 'trap "echo last words; exit" INT; echo ready; while :; do sleep 0.01; done']),
        RegisterEventHandler(OnProcessIO(target_action=last, on_stdout=lambda event, context:
            EmitEvent(event=SignalProcess(signal_number='SIGINT', process_matcher=matches_action(last)))
            if b'ready' in event.text else None)),
        RegisterEventHandler(OnProcessExit(target_action=last, on_exit=[LogInfo(msg='what follows')])),
        """,
    )
    out, err, _ = launch(folder, "--plain")
    assert out.index("last words") < out.index("what follows"), out + err


@pytest.mark.long
def test_a_line_for_the_shell_may_call_ros2(launch: Launched, workshop: Workshop) -> None:
    """As ROS 2's own tutorials do, with what the nodes of the same launch offer, whatever its name."""
    folder = workshop.package(
        "a_package_with_a_very_long_name",
        """
        server := Node(package='a_package_with_a_very_long_name', executable='server'),
        RegisterEventHandler(OnProcessStart(target_action=server, on_start=[
            client := ExecuteProcess(cmd=[['ros2 service call /switch ', 'std_srvs/srv/Trigger && exit 4']], shell=True)
        ])),
        RegisterEventHandler(OnProcessExit(on_exit=[
            LogInfo(msg=['ended with ', LocalSubstitution('event.returncode')]), Shutdown(reason='done'),
        ])),
        """,
        server="""
        from std_srvs.srv import Trigger
        self.create_service(Trigger, "switch", lambda request, response: response)
        """,
    )
    (found,) = (folder / "launch").glob("*.launch.py")
    named = found.rename(found.with_name("an_example_of_a_very_long_name.launch.py"))
    out, err, _ = launch(named, "--plain")
    assert "std_srvs.srv.Trigger_Response(success=False, message='')" in out, out + err
    assert "ended with 4" in out


def test_a_world_may_come_later(launch: Launched, workshop: Workshop, tmp_path: Path) -> None:
    world = tmp_path / "later.yaml"
    world.write_text("properties: {}\nlayers: []\n")
    folder = workshop.package(
        "later",
        f"""
        TimerAction(period=0.3, actions=[
            Node(package='flatland_server', executable='flatland_server', parameters=[{{'world_path': {str(world)!r}}}]),
        ]),
        Node(package='later', executable='waiter'),
        """,
        waiter="""
        from flatland_msgs.srv import MoveModel
        self.create_client(MoveModel, '/move_model').wait_for_service()
        self.get_logger().info('the world is there')
        """,
    )
    out, err, code = launch(folder, "--until", "0.5")
    assert "the world is there" in out + err
    assert code == 0


def test_packages_beside_it_are_found(launch: Launched, workshop: Workshop) -> None:
    workshop.package("library", "", tool="GREETING = 'from the library'\ndef main(): pass\n")
    folder = workshop.package(
        "user",
        "Node(package='user', executable='user'), LogInfo(msg=FindPackageShare('library')),",
        user="""
        from library.tool import GREETING
        from ament_index_python.packages import get_package_share_directory
        self.get_logger().info(GREETING + ' in ' + get_package_share_directory('library'))
        """,
    )
    out, err, code = launch(folder, "--until", "0.1")
    assert f"from the library in {workshop.folder / 'library'}" in out + err
    assert f"[launch]: {workshop.folder / 'library'}" in out
    assert code == 0


def test_flatland_s_own_launch_file_is_included(launch: Launched, workshop: Workshop, tmp_path: Path) -> None:
    """As packages of that time do it, with arguments of their own."""
    world = tmp_path / "world.yaml"
    world.write_text("properties: {}\nlayers: []\n")
    folder = workshop.package(
        "outer",
        f"""
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource([FindPackageShare('flatland_server'), '/launch/server.launch.py']),
            launch_arguments={{'world_path': {str(world)!r}, 'update_rate': '50.0'}}.items(),
        ),
        """,
    )
    file = folder / "launch" / "outer.launch.py"
    file.write_text(
        "from launch.launch_description_sources import PythonLaunchDescriptionSource\n" + file.read_text()
    )
    out, err, code = launch(folder, "--steps", "3")
    assert f"replaces flatland_server: {world}" in out
    assert code == 0, err
    assert launch("flatland_server", f"world_path:={world}", "--steps", "3")[2] == 0
