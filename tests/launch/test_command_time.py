"""What a launch starts later is in step, and its commands go by simulated time: on an idle machine and on a busy one."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest

from kit.host.processor_delay import delayed_s
from kit.inspection.sockets import running_worlds, sockets_folder
from kit.launch import command_time
from kit.launch.command_time import CommandTime
from tests.launch.conftest import Launched
from tests.waiting import wait_until

REPOSITORY = str(Path(__file__).parents[2])
WORLD = Path(__file__).parents[1] / "ros" / "outside_programs" / "room" / "world.yaml"

DRIVE = """
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry

class Drive(Node):
    def __init__(self):
        super().__init__("drive")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(Odometry, "/odom", self.on_odometry, 10)
        self.create_timer(0.1, self.tick)
        self.place = None
        self.ticks = 0
        print("START", self.get_clock().now().nanoseconds, flush=True)

    def on_odometry(self, message):
        self.place = message.pose.pose.position.x, message.pose.pose.orientation.z

    def tick(self):
        command = Twist()
        command.linear.x, command.angular.z = 0.2, 0.1
        self.publisher.publish(command)
        self.ticks += 1
        if self.ticks % 10 == 1:
            print("TICK", self.ticks, self.get_clock().now().nanoseconds, self.place, flush=True)

rclpy.init()
rclpy.spin(Drive())
"""

LAUNCH = """
from launch import LaunchDescription
from launch.actions import *
from launch.event_handlers import *
from launch_ros.actions import Node

def generate_launch_description():
    drive = ExecuteProcess(cmd=["python3", {drive!r}], name="drive")
    prepare = ExecuteProcess(cmd=["echo", "prepared"], name="prepare")
    world = Node(package="flatland_server", executable="flatland_server",
                 parameters=[{{"world_path": {world!r}, "step_size": 0.01, "update_rate": 100.0}}])
    return LaunchDescription([world, {started}])
"""
STARTED = {
    "timer": "TimerAction(period=2.0, actions=[drive])",
    "exit": "prepare, RegisterEventHandler(OnProcessExit(target_action=prepare, on_exit=[drive]))",
    "start": "drive",
    "event": "prepare, RegisterEventHandler(OnProcessStart(target_action=prepare, on_start=[TimerAction(period=1.5, actions=[drive])]))",
}
FIRST_NS = {"timer": 2_000_000_000, "exit": 0, "start": 0, "event": 1_500_000_000}


@contextmanager
def load(processes: int = 4) -> Iterator[None]:
    """Keeps every processor busy."""
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(processes)]
    try:
        yield
    finally:
        for each in busy:
            each.kill()
            each.wait()


def write_launch(folder: Path, started: str) -> Path:
    drive = folder / "drive.py"
    drive.write_text(DRIVE)
    file = folder / "late.launch.py"
    file.write_text(LAUNCH.format(drive=str(drive), world=str(WORLD), started=started))
    return file


def printed(launch: Launched, file: Path) -> list[str]:
    """What the programs print, without the numbers of processes."""
    out, _, status = launch(file, "--until", "5")
    assert status == 0
    return [line for line in out.splitlines() if re.match(r"\[\w+-\d+\]", line)]


@pytest.mark.sampled(4)
@pytest.mark.parametrize("started", STARTED)
def test_a_node_that_starts_later_ticks_from_the_instant_at_which_it_was_due(
    tmp_path: Path, launch: Launched, started: str
) -> None:
    lines = [line for line in printed(launch, write_launch(tmp_path, STARTED[started])) if "[drive" in line]
    assert lines[0].endswith(f"START {FIRST_NS[started]}")
    assert f"TICK 1 {FIRST_NS[started] + 100_000_000} " in lines[1]


@pytest.mark.long
def test_the_same_launch_is_the_same_run_idle_and_under_load(tmp_path: Path, launch: Launched) -> None:
    """To the bit: positions are printed with all their digits."""
    file = write_launch(tmp_path, ", ".join((STARTED["exit"].replace("[drive]", f"[{STARTED['timer']}]"),)))
    idle = printed(launch, file)
    with load():
        assert printed(launch, file) == idle
    assert sum("TICK" in line for line in idle) == 3


@pytest.fixture
def room(tmp_path: Path) -> Iterator[dict[str, str]]:
    """A world that runs in real time in another process; the environment of a second terminal."""
    environment = {**os.environ, "KIT_WORKSPACE": str(tmp_path / "home"), "PYTHONPATH": REPOSITORY}
    words = [sys.executable, "-m", "kit", "run", str(WORLD), "--serve", "--steps", "100000000"]
    quiet = subprocess.DEVNULL
    with subprocess.Popen(words, env=environment, stdin=quiet, stdout=quiet, stderr=quiet) as world:
        try:
            wait_until(lambda: bool(running_worlds(sockets_folder(tmp_path / "home"))), limit_s=60)
            yield environment
        finally:
            world.kill()


@pytest.mark.long
@pytest.mark.parametrize("is_busy", [False, True], ids=["idle", "under-load"])
def test_a_node_from_a_second_terminal_ticks_from_the_instant_at_which_it_was_due(
    tmp_path: Path, room: dict[str, str], is_busy: bool
) -> None:
    file = tmp_path / "drive.py"
    file.write_text(
        DRIVE.replace("self.ticks += 1", "self.ticks += 1\n        if self.ticks == 4: raise SystemExit")
    )
    words = [sys.executable, "-m", "kit", "ros", "run", str(file)]
    with load() if is_busy else nullcontext():
        done = subprocess.run(
            words,
            env=room,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
        )
    assert done.returncode == 0, done.stderr
    (start,) = re.findall(r"START (\d+)", done.stdout)
    (first,) = re.findall(r"TICK 1 (\d+)", done.stdout)
    assert int(start) > 0
    assert int(first) == int(start) + 100_000_000


START_ORDER = """
from launch import LaunchDescription
from launch.actions import *
from launch.event_handlers import *

def generate_launch_description():
    said = [ExecuteProcess(cmd=["echo", f"{{name}} speaks"], name=name) for name in ("early", "late", "after", "second")]
    told = [LogInfo(msg=f"{{name}} has started") for name in ("early", "late")]
    return LaunchDescription([
        RegisterEventHandler(OnProcessStart(target_action=said[0], on_start=[told[0], said[3]])),
        RegisterEventHandler(OnProcessStart(target_action=said[1], on_start=[told[1], said[2]])),
        said[0], TimerAction(period=1.0, actions=[said[1]]),
    ])
"""


def test_what_waits_for_a_start_comes_before_what_the_process_says(tmp_path: Path, launch: Launched) -> None:
    """As in ROS 2, where the event is there before the first line; what it starts begins in the same tick, and the two processes
    then speak in any order."""
    file = tmp_path / "order.launch.py"
    file.write_text(START_ORDER.format())
    out, _, status = launch(file, "--until", "5")
    assert status == 0
    lines = [line.split("] ", 1)[1] for line in out.splitlines() if "speaks" in line or "has started" in line]
    for group, name, other in ((lines[:3], "early", "second"), (lines[3:], "late", "after")):
        assert sorted(group) == sorted([f"[launch]: {name} has started", f"{name} speaks", f"{other} speaks"])
        assert group.index(f"[launch]: {name} has started") < group.index(f"{name} speaks")


def test_what_waits_for_a_start_is_started_though_nothing_else_happens(
    tmp_path: Path, launch: Launched
) -> None:
    file = tmp_path / "started.launch.py"
    file.write_text(
        "from launch import LaunchDescription\nfrom launch.actions import *\nfrom launch.event_handlers import *\n"
        "def generate_launch_description():\n"
        "    first = ExecuteProcess(cmd=['sleep', '1000'])\n"
        "    then = ExecuteProcess(cmd=['echo', 'second'], on_exit=[Shutdown()])\n"
        "    return LaunchDescription([\n"
        "        first, RegisterEventHandler(OnProcessStart(target_action=first, on_start=[then]))])\n"
    )
    out, _, _ = launch(file, "--until", "5")
    assert "second" in out


COMMANDS = """
from launch import LaunchDescription
from launch.actions import *
from launch.event_handlers import *
from launch_ros.actions import Node

def generate_launch_description():
    spawn = ExecuteProcess(cmd=["ros2 service call /spawn turtlesim/srv/Spawn '{{x: 2, y: 2}}'"], shell=True, name="spawn")
    publish = ExecuteProcess(cmd=["ros2", "topic", "pub", "-r", "2", "/turtle1/cmd_vel", "geometry_msgs/msg/Twist",
                                  "{{linear: {{x: 0.1}}}}"], name="publish")
    listed = ExecuteProcess(cmd=["ros2", "topic", "list"], name="listed")
    return LaunchDescription([
        Node(package="turtlesim", executable="turtlesim_node"), spawn, publish,
        RegisterEventHandler(OnProcessExit(target_action=spawn, on_exit=[listed])),
    ])
"""


@pytest.mark.long
def test_ros2_commands_of_a_launch_file_go_by_simulated_time(tmp_path: Path, launch: Launched) -> None:
    file = tmp_path / "commands.launch.py"
    file.write_text(COMMANDS.format())
    lines = printed(launch, file)
    assert any("Spawn_Response(name='turtle2')" in line for line in lines)
    assert any("/turtle2/pose" in line for line in lines)
    assert sum("publishing #" in line for line in lines) in (9, 10, 11)


@dataclass(frozen=True)
class _Command:
    pid: int
    is_of_kit: bool
    poll: Callable[[], int | None]


@pytest.mark.skipif(
    not Path("/proc/self/schedstat").exists(), reason="only Linux tells how long a process waited"
)
@pytest.mark.parametrize("is_of_kit", [True, False], ids=["ros2", "other"])
def test_a_command_that_a_busy_machine_keeps_from_computing_is_waited_for(
    monkeypatch: pytest.MonkeyPatch, is_of_kit: bool
) -> None:
    """And one that sleeps is not."""
    monkeypatch.setattr(command_time, "START_S", 0.2)
    monkeypatch.setattr(command_time, "COMMAND_S", 0.2)
    processor = min(os.sched_getaffinity(0))

    def on_one_processor() -> None:
        os.sched_setaffinity(0, {processor})

    def when_idle() -> None:
        on_one_processor()
        os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))

    computes = [sys.executable, "-c", "while True: pass"]
    rival = subprocess.Popen(computes, preexec_fn=on_one_processor)
    commands = {
        "kept": subprocess.Popen(computes, preexec_fn=when_idle),
        "asleep": subprocess.Popen(["sleep", "1000"]),
    }
    try:
        waits = {
            name: CommandTime(
                cast(
                    "Any",
                    SimpleNamespace(
                        commands={_Command(each.pid, is_of_kit, each.poll): 0},
                        graph=SimpleNamespace(now_ns=0),
                    ),
                ),
                dict,
            )
            for name, each in commands.items()
        }
        assert waits["kept"]._must_wait()
        wait_until(lambda: not waits["asleep"]._must_wait())
        wait_until(lambda: delayed_s(commands["kept"].pid) > 0.3)
        assert waits["kept"]._must_wait()
    finally:
        for each in (rival, *commands.values()):
            each.kill()
            each.wait()


TURTLESIM = {
    "node list": ["/turtlesim"],
    "topic list": [
        "/parameter_events",
        "/rosout",
        "/turtle1/cmd_vel",
        "/turtle1/color_sensor",
        "/turtle1/pose",
    ],
    "service list": [
        "/clear",
        "/kill",
        "/reset",
        "/spawn",
        "/turtle1/set_pen",
        "/turtle1/teleport_absolute",
        "/turtle1/teleport_relative",
        *(
            f"/turtlesim/{name}"
            for name in (
                "describe_parameters",
                "get_parameter_types",
                "get_parameters",
                "list_parameters",
                "set_parameters",
                "set_parameters_atomically",
            )
        ),
    ],
    "service type /reset": ["std_srvs/srv/Empty"],
    "action list": ["/turtle1/rotate_absolute"],
}
"""What the official tutorial shows."""


@pytest.mark.long
def test_turtlesim_has_what_turtlesim_has(tmp_path: Path, launch: Launched) -> None:
    commands = "".join(
        f"ExecuteProcess(cmd='ros2 {words}'.split(), name={words.replace(' ', '_').replace('/', '')!r}),"
        for words in TURTLESIM
    )
    file = tmp_path / "turtlesim.launch.py"
    file.write_text(
        "from launch import LaunchDescription\nfrom launch.actions import *\nfrom launch_ros.actions import Node\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([Node(package='turtlesim', executable='turtlesim_node'), "
        f"TimerAction(period=0.1, actions=[{commands}])])"
    )
    lines = printed(launch, file)
    for words, expected in TURTLESIM.items():
        name = words.replace(" ", "_").replace("/", "")
        shown = [line.split("] ", 1)[1] for line in lines if re.match(rf"\[{name}-\d+\]", line)]
        assert shown == expected, words
