"""A policy as a node and as a package: it chooses what the policy chooses, with any lidar, and stops without one."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.learning.environment.batch import BatchEnv
from kit.learning.policies.policy import ActionSampling, Policy, PolicyError, task_interface
from kit.learning.policies.policy_file import save_policy
from kit.learning.policies.policy_network import PolicyNetwork
from kit.learning.policies.policy_node import format_policy_node
from kit.learning.policies.policy_package import create_policy_package
from kit.learning.tasks.catalogue import find_task
from kit.learning.tasks.task_spec import TaskSpec
from kit.ros.packages import PackageError
from tests.launch.test_package_creation import install_with_setuptools
from tests.learning.policies.test_evaluation import always
from tests.learning.policies.test_policy import SEEN, continuous, layer, made, noisy, squashed, table

CONTINUOUS_TASK = """
maps: [turn]
actions: {linear: [-0.2, 0.5], angular: [-2, 1]}
observation: {sectors: 9}
reward: {name: progress}
step: {time: 0.1}
"""
REMEMBERER = """
import json, sys
import numpy as np
import kit.ros
kit.ros.install_import_names()
import rclpy
import node
rclpy.init()
policy = node.PolicyNode()
shown = []
for frame in json.loads(sys.argv[1]):
    policy.scans[0] = np.array(frame[:9])
    policy.motion["speeds"][0] = frame[9:11]
    policy.motion["last_action"] = policy.model.twists(policy.observe())
    shown.append(policy.motion["last_action"][0])
print(json.dumps(shown))
"""
PLACED = """
import json, math, sys
import kit.ros
kit.ros.install_import_names()
import rclpy
import node
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
rclpy.init()
policy = node.PolicyNode()
knew, told = [policy.knows_places()], []
for (x, y, heading), target in zip(*json.loads(sys.argv[1])):
    goal = PoseStamped()
    goal.pose.position.x, goal.pose.position.y = target
    policy.on_goal(goal)
    knew.append(policy.knows_places())
    odom = Odometry()
    odom.pose.pose.position.x, odom.pose.pose.position.y = x, y
    odom.pose.pose.orientation.z, odom.pose.pose.orientation.w = math.sin(heading / 2), math.cos(heading / 2)
    policy.on_odometry(0, odom)
    told.append([*policy.part_numbers("own_pose", 0), *policy.part_numbers("target", 0)])
knew.append(policy.knows_places())
print(json.dumps([told, [*knew[:2], knew[-1]]]))
"""
CHOOSER = """
import json, sys
import numpy as np
import kit.ros
kit.ros.install_import_names()
import node
seen, layouts = json.loads(sys.argv[1])
model = node.ExportedPolicy()
choices = [model.twists(np.array(x, dtype=np.float32)) for x in seen]
from sensor_msgs.msg import LaserScan
found = []
for low, step, count, yaw in layouts:
    scan = LaserScan(angle_min=low, angle_increment=step, ranges=[1.0] * count)
    found.append(node.find_rays(scan, yaw).tolist())
print(json.dumps([choices, found]))
"""


def in_a_process(
    policy: Policy, folder: Path, layouts: list[tuple[float, ...]]
) -> tuple[list[Any], list[list[int]]]:
    """What the node of a policy chooses, and which rays of lidars it takes; only rclpy's names and numpy are there."""
    (folder / "node.py").write_text(format_policy_node(policy))
    given = json.dumps([SEEN.tolist(), layouts])
    done = subprocess.run(
        [sys.executable, "-c", CHOOSER, given],
        env={"PYTHONPATH": str(folder)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    choices, found = json.loads(done.stdout)
    return choices, found


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    "policy", [made(), made(recurrent=True), table()], ids=["network", "memory", "table"]
)
def test_a_node_chooses_what_the_policy_chooses(policy: Policy, tmp_path: Path) -> None:
    player, twists = policy.make_player(1), find_task("turn").actions.commands
    wanted = [twists(player.act(seen[None]), 1).twists[0].tolist() for seen in SEEN]
    assert in_a_process(policy, tmp_path, [])[0] == wanted


@pytest.mark.sampled(3)
@pytest.mark.parametrize("policy", [squashed(), noisy(), continuous()], ids=["squashed", "noisy", "normal"])
def test_a_node_drives_as_a_continuous_policy(policy: Policy, tmp_path: Path) -> None:
    (tmp_path / "task.yaml").write_text(CONTINUOUS_TASK)
    spec = TaskSpec(str(tmp_path / "task.yaml")).frozen()
    policy = replace(policy, trained_on=spec, interface=task_interface(spec.resolve()))
    commands = policy.trained_on.resolve().actions.commands
    wanted = commands(policy.make_player(len(SEEN)).act(SEEN), 1).twists[:, 0]
    found = np.array(in_a_process(policy, tmp_path, [])[0])[:, 0]
    assert np.abs(found - wanted).max() < 1e-5
    assert len(np.unique(found[:, 1])) > 10


def test_a_node_remembers_frames_and_what_it_did(tmp_path: Path) -> None:
    text = CONTINUOUS_TASK.replace("sectors: 9", "sectors: 9, speeds: true, last_action: true, frames: 3")
    (tmp_path / "task.yaml").write_text(text)
    choice = TaskSpec(str(tmp_path / "task.yaml")).frozen()
    rng = np.random.default_rng(0)
    model = PolicyNetwork((layer(rng, 39, 2),), "tanh")
    policy = Policy(
        model, (), ActionSampling("normal", 1.0, (0.1, 0.1)), choice, 1, task_interface(choice.resolve())
    )
    task = replace(choice.resolve(), lidar_noise=0.0)
    batch, player = BatchEnv(task, 1, 3, autoreset=False), policy.make_player(1)
    seen, shown = [batch.reset()[0]], []
    for _ in range(6):
        action = player.act(seen[-1][None])
        shown.append(task.actions.commands(action, 1).twists[0, 0].tolist())
        seen.append(batch.step(action).observations[0])
    (tmp_path / "node.py").write_text(format_policy_node(policy))
    frames = [x[26:].tolist() for x in seen[:-1]]  # the newest one of three
    done = subprocess.run(
        [sys.executable, "-c", REMEMBERER, json.dumps(frames)],
        env={"PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert np.abs(np.array(json.loads(done.stdout)) - np.array(shown)).max() < 1e-5


@pytest.mark.long
def test_a_continuous_policy_is_packaged_with_its_odometry(tmp_path: Path) -> None:
    policy = replace(
        squashed(),
        trained_on=TaskSpec("smooth-turn"),
        interface=task_interface(TaskSpec("smooth-turn").resolve()),
    )
    policy = replace(policy, model=PolicyNetwork((layer(np.random.default_rng(0), 15, 4),), "relu"))
    folder = create_policy_package(policy, "my_agent", tmp_path)
    output = launched(tmp_path, folder, "simulation.launch.py", "--until", "3")
    assert "Trained on" in output
    assert "no scan" not in output
    assert "odom_topic" in (folder / "launch" / "my_agent.launch.py").read_text()


def test_the_nearest_ray_of_any_lidar_is_taken(tmp_path: Path) -> None:
    degree = np.pi / 180
    layouts = [
        (-np.pi, 4 * degree, 91, 0.0),
        (0.0, degree, 360, 0.0),
        (np.pi, -degree, 360, 0.0),
        (-135 * degree, 0.25 * degree, 1081, 0.0),
        (-np.pi, 4 * degree, 91, np.pi / 2),
    ]
    own, round_, backwards, front, turned = in_a_process(made(), tmp_path, layouts)[1]
    assert own == [*range(90), own[90]]
    assert own[90] in (0, 90)  # straight back, twice
    assert [round_[ray] for ray in (0, 45, 46, 44)] == [180, 0, 4, 356]
    assert [backwards[ray] for ray in (0, 45, 46, 44)] == [0, 180, 176, 184]
    assert front[45] == 540
    assert front[0] == front[90] == -1
    assert sum(ray < 0 for ray in front) == sum(abs(4 * k - 180) > 135 for k in range(91))
    assert turned[45] == 45 - 22.5 or turned[45] in (22, 23)


TOLD_WHERE_THINGS_ARE = """
maps: [crossing]
cases: [{name: road, start: [0.6, 2.0, 0]}]
actions: {twists: {forward: [0.4, 0], left: [0, 1.2]}}
observation: {sectors: 13, achieved: true}
reward: {terms: {achieving: 1.0}}
goal: {kind: avoid}
"""


def test_what_a_node_cannot_know_is_no_node_and_the_check_says_so(tmp_path: Path) -> None:
    file = tmp_path / "clear.yaml"
    file.write_text(TOLD_WHERE_THINGS_ARE)
    with pytest.raises(PolicyError, match="goal avoid"):
        format_policy_node(always(TaskSpec(str(file)).frozen(), 0))
    told = CliRunner().invoke(main, ["task", "check", str(file)])
    assert told.exit_code == 0
    assert "neither raced nor exported" in " ".join(told.output.split())
    file.write_text(TOLD_WHERE_THINGS_ARE.replace(", achieved: true", ""))
    compile(format_policy_node(always(TaskSpec(str(file)).frozen(), 0)), "node.py", "exec")
    assert "exported" not in CliRunner().invoke(main, ["task", "check", str(file)]).output


def test_a_node_knows_its_place_and_the_target_from_odometry(tmp_path: Path) -> None:
    text = CONTINUOUS_TASK.replace("sectors: 9", "sectors: 9, own_pose: true, target: true, scale: 0.5")
    (tmp_path / "task.yaml").write_text(text)
    choice = TaskSpec(str(tmp_path / "task.yaml")).frozen()
    model = PolicyNetwork((layer(np.random.default_rng(0), 15, 2),), "tanh")
    policy = Policy(
        model, (), ActionSampling("normal", 1.0, (0.1, 0.1)), choice, 1, task_interface(choice.resolve())
    )
    batch = BatchEnv(replace(choice.resolve(), lidar_noise=0.0), 3, 3)
    seen = batch.reset()
    shown = [batch.step(np.tile(np.float32([0.2, 0.9]), (3, 1))) for _ in range(4)][-1]
    poses, targets = shown.transition.pose[:, 0].tolist(), shown.transition.target.tolist()
    (tmp_path / "node.py").write_text(format_policy_node(policy))
    done = subprocess.run(
        [sys.executable, "-c", PLACED, json.dumps([poses, targets])],
        env={"PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    told, waits = json.loads(done.stdout)
    assert np.abs(np.array(told) - shown.observations[:, 9:]).max() < 1e-5
    assert waits == [False, False, True]  # without a target, without odometry, with both
    assert seen.shape == (3, 15)


def launched(tmp_path: Path, *words: str | Path) -> str:
    runner = CliRunner(env={"KIT_WORKSPACE": str(tmp_path / "workspace")})
    result = runner.invoke(main, ["launch", *map(str, words)])
    assert result.exit_code == 0, result.output
    return result.output


@pytest.mark.long
@pytest.mark.parametrize("task", ["hallway", "wheelchairs"])
def test_a_package_is_launched_as_it_lies_and_is_what_colcon_builds(task: str, tmp_path: Path) -> None:
    folder = create_policy_package(always(TaskSpec(task), 1), "my_agent", tmp_path / "src")
    output = launched(tmp_path, folder, "simulation.launch.py", "--until", "3")
    assert "Trained on" in output
    assert "no scan" not in output
    program = (folder / "my_agent" / "policy.py").read_text()
    assert "import kit" not in program
    assert "torch" not in program
    share = install_with_setuptools(folder, tmp_path / "install")
    for file in (
        "launch/my_agent.launch.py",
        "launch/simulation.launch.py",
        "config/my_agent.yaml",
        "world/world.yaml",
    ):
        assert (share / "my_agent" / file).is_file()
    assert "policy = my_agent.policy:main" in (folder / "my_agent.egg-info/entry_points.txt").read_text()


COLCON = shutil.which("colcon", path=f"{Path(sys.executable).parent}:{os.environ.get('PATH', '')}")


@pytest.mark.long
@pytest.mark.skipif(COLCON is None, reason="needs colcon: pip install colcon-core colcon-ros")
def test_colcon_builds_a_package(tmp_path: Path) -> None:
    assert COLCON is not None
    create_policy_package(always(TaskSpec("turn"), 0), "my_agent", tmp_path / "src")
    done = subprocess.run(
        [COLCON, "build", "--packages-select", "my_agent"],
        cwd=tmp_path,
        env={**os.environ, "PATH": f"{Path(COLCON).parent}:{os.environ.get('PATH', '')}"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    installed = tmp_path / "install" / "my_agent"
    assert (installed / "lib/my_agent/policy").is_file()
    assert (installed / "share/my_agent/launch/simulation.launch.py").is_file()
    assert (installed / "share/my_agent/config/my_agent.yaml").is_file()


SILENT = """
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        Node(package='flatland_server', executable='flatland_server', parameters=[{'world_path': 'FOLDER/world/world.yaml'}]),
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource('FOLDER/launch/my_agent.launch.py'),
            launch_arguments={'scan_topic': '/front/scan', 'use_sim_time': 'true'}.items(),
        ),
    ])
"""


@pytest.mark.long
def test_an_agent_without_scans_says_so_and_which_there_are(tmp_path: Path) -> None:
    folder = create_policy_package(always(TaskSpec("hallway"), 1), "my_agent", tmp_path)
    file = tmp_path / "silent.launch.py"
    file.write_text(SILENT.replace("FOLDER", str(folder)))
    output = launched(tmp_path, file, "--until", "4")
    assert output.count("no scan on /front/scan for 2 s; this world has ") == 1
    assert "/static_laser" in output.partition("this world has ")[2]


SCANS_UNTIL = """
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from geometry_msgs.msg import Twist

class Lidar(Node):
    def __init__(self):
        super().__init__('lidar')
        self.scans = self.create_publisher(LaserScan, '/front/scan', 10)
        self.create_subscription(Twist, '/told', self.on_command, 10)
        self.create_timer(0.1, self.publish)
        self.last = None

    def publish(self):
        now = self.get_clock().now()
        if now.nanoseconds < 2e9:
            scan = LaserScan(angle_min=-3.14, angle_increment=0.0175, range_max=8.0, ranges=[2.0] * 360)
            scan.header.stamp = now.to_msg()
            self.scans.publish(scan)

    def on_command(self, command):
        if command.linear.x != self.last:
            self.last = command.linear.x
            print(f'told {command.linear.x:.2f} at {self.get_clock().now().nanoseconds / 1e9:.2f}', flush=True)

rclpy.init()
rclpy.spin(Lidar())
"""


@pytest.mark.long
def test_a_robot_whose_scans_stay_away_is_told_to_stand(tmp_path: Path) -> None:
    folder = create_policy_package(always(TaskSpec("hallway"), 1), "my_agent", tmp_path)
    (tmp_path / "lidar.py").write_text(SCANS_UNTIL)
    file = tmp_path / "stops.launch.py"
    file.write_text(
        SILENT.replace("FOLDER", str(folder))
        .replace("'use_sim_time': 'true'", "'use_sim_time': 'true', 'cmd_vel_topic': '/told'")
        .replace(
            "        IncludeLaunch",
            f"        ExecuteProcess(cmd=['python3', '{tmp_path}/lidar.py'], output='screen'),\n        IncludeLaunch",
            1,
        )
        .replace("import IncludeLaunchDescription", "import ExecuteProcess, IncludeLaunchDescription")
    )
    output = launched(tmp_path, file, "--until", "4")
    told = [
        line.split("told ")[1].split(" at ")
        for line in output.splitlines()
        if "]: told" in line or ("told " in line and " at " in line)
    ]
    moments = {float(speed): float(moment) for speed, moment in told}
    assert set(moments) == {0.3, 0.0}
    assert (
        2.0 < moments[0.0] <= 2.0 + 0.6 + 0.1
    )  # three steps of 0.2 s without a scan, looked at every 0.05 s
    assert "no scan on /front/scan" in output


def test_the_verb_makes_a_package_and_refuses_names_that_cannot_be(tmp_path: Path) -> None:
    save_policy(always(TaskSpec("turn"), 0), tmp_path / "best.npz")

    def run(*words: str) -> tuple[str, int]:
        runner = CliRunner(env={"KIT_WORKSPACE": str(tmp_path / "workspace")})
        result = runner.invoke(main, ["evaluate", str(tmp_path / "best.npz"), *words])
        return result.output, result.exit_code

    output, code = run("--package", "my_agent", "--dest", str(tmp_path))
    assert code == 0, output
    assert "colcon build" in output
    assert (tmp_path / "my_agent" / "package.xml").is_file()
    assert run("--package", "my_agent", "--dest", str(tmp_path))[1] == 2, "it is there already"
    assert run("--package", "My Agent")[1] == 2
    with pytest.raises(PackageError):
        create_policy_package(always(TaskSpec("turn"), 0), "std_msgs", tmp_path)
