"""Running a program: the world is ours, the clock is ours, and what is measured is what happened."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest

from grader.assignment import Assignment, Shift, Trial
from grader.check import Check
from grader.driving.check_table import CHECKS
from grader.driving.checks.interfaces import TopicRateParams, TopicsParams
from grader.driving.checks.walls import DistanceBandParams
from grader.driving.drive_record import GradedDrive
from grader.driving.episodes import run_episode, shifted_start
from grader.driving.service_calls import NO_ANSWER, ServiceCall
from grader.evidence.contract import EpisodeSpec
from kit.controllers import find_controller
from kit.host.failure import FailureKind
from kit.host.proxy_nodes import ProxyNodes
from kit.host.sandbox.limits import GRADER_LIMITS
from kit.host.sandbox.sandbox_config import Level
from kit.host.wire import Json
from kit.run.recording import rerun
from kit.run.scenario import find_scenario
from tests.grader.conftest import FORWARD, LOCKS

TURN = Trial(
    "turn",
    find_scenario("turn"),
    3.0,
    (1,),
    (),
    Shift(0.05, 0.05, 0.2),
    None,
    True,
    frozenset({"move_model"}),
)


def drive(
    folder: Path, source: str, trial: Trial = TURN, seed: int = 1, level: Level = Level.LIMITED
) -> GradedDrive:
    file = folder / "controller.py"
    file.write_text(source)
    return run_episode(
        EpisodeSpec(trial, seed, "turn, seed 1", False), file, limits=GRADER_LIMITS, level=level
    )


@pytest.fixture(scope="module")
def forward(tmp_path_factory: pytest.TempPathFactory) -> GradedDrive:
    return drive(tmp_path_factory.mktemp("forward"), FORWARD)


def measure(name: str, seen: GradedDrive, params: object | None = None) -> float:
    check: Check = CHECKS[name]
    return check.measure(seen, check.params() if params is None else params)


def test_the_recording_runs_again_to_the_bit(forward: GradedDrive) -> None:
    again = rerun(forward.recording, forward.scenario.world)
    assert np.array_equal(again.poses, forward.recording.poses)


@pytest.mark.long
def test_the_same_seed_is_the_same_drive(tmp_path: Path, forward: GradedDrive) -> None:
    assert drive(tmp_path, FORWARD).fingerprint == forward.fingerprint
    assert drive(tmp_path, FORWARD, seed=2).fingerprint != forward.fingerprint


SLEEPS = FORWARD.replace("import rclpy", "import time\n\nimport rclpy", 1).replace(
    "rclpy.spin(Forward())", "node = Forward()\n    time.sleep(1.6)\n    rclpy.spin(node)"
)
"""Goes on after 1.6 s."""


@pytest.mark.parametrize("within", [1.0, 0.3])
def test_an_answer_that_comes_late_is_none(tmp_path: Path, within: float) -> None:
    """The program's own node is asked, whatever its name."""
    request = {"names": ["use_sim_time"]}
    asked = ServiceCall("asked", 1.0, "get_parameters", "rcl_interfaces/srv/GetParameters", request, within)
    trial = dataclasses.replace(TURN, calls=(asked,))
    assert '"values"' in drive(tmp_path, FORWARD, trial).answers["asked"]
    late = drive(tmp_path, SLEEPS, trial).answers["asked"]
    assert late == NO_ANSWER if within < 0.6 else '"values"' in late


def test_a_seed_shifts_the_start_within_its_bounds() -> None:
    home = TURN.home()
    starts = [shifted_start(TURN, seed) for seed in range(50)]
    assert len({start.x for start in starts}) == 50
    assert all(abs(start.x - home.x) <= 0.05 and abs(start.theta - home.theta) <= 0.2 for start in starts)
    assert shifted_start(dataclasses.replace(TURN, shift=Shift()), 3) == home


def test_what_a_drive_measures(forward: GradedDrive) -> None:
    assert forward.outcome.startswith("not reached")
    assert measure("runs", forward) == 1.0
    assert measure("reached", forward) == 0.0
    assert measure("in_time", forward) == math.inf
    assert measure("moves", forward) == pytest.approx(0.3 * 2.8, abs=0.06)
    assert measure("rate", forward) == pytest.approx(0.0, abs=0.05)
    assert measure("rate", forward, TopicRateParams("/cmd_vel", 20.0)) == pytest.approx(0.5, abs=0.05)
    assert measure("rate", forward, TopicRateParams("/nowhere", 20.0)) == math.inf
    assert measure("smooth", forward) == 0.0
    assert measure("topics", forward) == 1.0
    assert measure("topics", forward, TopicsParams(("/cmd_vel std_msgs/msg/String", "/cmd_vel"))) == 0.5
    assert measure("bumps", forward) == 0.0
    assert measure("top_speed", forward) == pytest.approx(0.3, abs=0.01)
    assert measure("obeys", forward) == 0.0
    assert measure("short_way", forward) == math.inf
    assert 0.1 < measure("approach", forward) < 0.9
    nearest = measure("clearance", forward)
    assert 0.0 < nearest < 0.5
    assert measure("keeps_distance", forward, DistanceBandParams(nearest - 0.01, 10.0)) == 1.0
    assert measure("keeps_distance", forward, DistanceBandParams(5.0, 10.0)) == 0.0


def test_every_check_says_what_to_do_and_no_measure_is_credit_for_nothing(tmp_path: Path) -> None:
    still = drive(
        tmp_path, "import rclpy\nfrom rclpy.node import Node\nrclpy.init()\nrclpy.spin(Node('still'))\n"
    )
    for name, check in CHECKS.items():
        assert len(check.feedback) > 30, name
        said = check.feedback.format(actual="1", full="2", where="here", passed=0, count=1)
        assert "{" not in said
        assert isinstance(measure(name, still), float)
    for name in ("reached", "in_time", "approach", "moves", "smooth", "short_way", "rate", "topics"):
        assert CHECKS[name].anchors.share(measure(name, still)) == 0.0, name


def test_a_shipped_controller_gets_there(tmp_path: Path) -> None:
    trial = dataclasses.replace(TURN, scenario=find_scenario("simple"), time_s=30.0, shift=Shift())
    seen = drive(tmp_path, find_controller("avoid").file.read_text(), trial)
    assert seen.score.reached_s is not None
    assert seen.seconds == pytest.approx(seen.score.reached_s, abs=0.02)
    assert "#" in seen.picture()
    assert measure("reached", seen) == 1.0
    assert measure("approach", seen) == 1.0
    assert measure("short_way", seen) > 1.0


@pytest.mark.long_cases("500.0")
@pytest.mark.parametrize("speed", [5.0, 20.0, 500.0])
def test_no_speed_is_too_high_to_be_measured(tmp_path: Path, speed: float) -> None:
    seen = drive(tmp_path, FORWARD.replace("SPEED = 0.3", f"SPEED = {speed}"))
    assert measure("top_speed", seen) > 4.9
    assert CHECKS["top_speed"].anchors.share(measure("top_speed", seen)) == 0.0


CALLS_HOME = (
    FORWARD
    + """
from flatland_msgs.srv import MoveModel
from geometry_msgs.msg import Pose2D

class Forward(Forward):
    def __init__(self):
        super().__init__()
        home = self.declare_parameter("home", [0.0, 0.0, 0.0]).value
        model = self.declare_parameter("model", "serp").value
        self.client = self.create_client(MoveModel, "/move_model")
        dx = DX
        pose = Pose2D(x=home[0] + dx, y=home[1], theta=home[2])
        self.create_timer(2.0, lambda: self.client.call_async(MoveModel.Request(name=model, pose=pose)))
"""
)


@pytest.mark.long
def test_a_robot_may_be_sent_home_and_nowhere_else(tmp_path: Path) -> None:
    home = drive(tmp_path, CALLS_HOME + "DX = 0.0\n")
    assert home.failure is None
    assert home.refused == ()
    jump = np.abs(np.diff(home.track[:, 1])).max()
    assert jump > 0.3
    assert measure("top_speed", home) == pytest.approx(0.3, abs=0.05), "sent home, not driven"
    away = drive(tmp_path, CALLS_HOME + "DX = 0.001\n")
    assert away.refused == ("move_model",)
    assert np.abs(np.diff(away.track[:, 1])).max() < 0.1
    forbidden = dataclasses.replace(TURN, services=frozenset())
    assert drive(tmp_path, CALLS_HOME + "DX = 0.0\n", forbidden).refused == ("move_model",)


def test_a_program_that_stops_the_clock_does_not_stop_it(tmp_path: Path) -> None:
    source = FORWARD.replace(
        "        self.create_timer",
        "        from std_srvs.srv import Empty\n"
        "        self.create_client(Empty, '/pause').call_async(Empty.Request())\n"
        "        self.create_timer",
    )
    seen = drive(tmp_path, source)
    assert seen.steps == 300
    assert seen.refused == ("pause",)


@pytest.mark.long
def test_noise_is_the_grader_s(tmp_path: Path) -> None:
    source = FORWARD.replace(
        "        self.create_timer",
        "        from sensor_msgs.msg import LaserScan\n"
        "        self.create_subscription(LaserScan, 'static_laser', lambda s: print(s.ranges[45]), 10)\n"
        "        self.create_timer",
    )
    readings = {}
    for noise in (0.0, 0.3):
        trial = dataclasses.replace(TURN, noise=noise, shift=Shift())
        readings[noise] = np.array([float(line) for line in drive(tmp_path, source, trial).printed])
    steady = np.abs(np.diff(readings[0.0], 2))
    assert steady.max() < 0.05
    assert np.abs(np.diff(readings[0.3], 2)).max() > 0.2


@pytest.mark.parametrize(
    ("source", "line"),
    [("import rclpy\n1/0\n", 2), ("def main(:\n", 1), (FORWARD.replace("x=SPEED", "x='a'"), 13)],
)
def test_a_program_that_fails_says_where(tmp_path: Path, source: str, line: int) -> None:
    seen = drive(tmp_path, source)
    assert seen.failure is not None
    assert seen.failure.line == line
    assert seen.picture() == "" or "#" in seen.picture()


def test_an_assignment_knows_its_trials(quick: Assignment) -> None:
    assert quick.trial("turn").name == "turn"


SENDER = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_msgs.msg import Int32

class Sender(Node):
    def __init__(self):
        super().__init__({name!r})
        self.number = self.create_publisher(Int32, "number", 10)
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.send)

    def send(self):
        for _ in range({count}):
            self.{publisher}.publish({message}())

def main():
    rclpy.init()
    rclpy.spin(Sender())
"""


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("flatland_server", ()),
        ("honest", ("-r", "__node:=flatland_server")),
    ],
)
def test_the_name_of_the_worlds_node_is_refused(tmp_path: Path, name: str, options: tuple[str, ...]) -> None:
    source = SENDER.format(name=name, count=100, publisher="number", message="Int32")
    if options:
        source = source.replace("rclpy.init()", f"rclpy.init(args=['--ros-args', *{options!r}])")
    driven = drive(tmp_path, source, dataclasses.replace(TURN, time_s=1.0))
    assert driven.failure is not None
    assert driven.failure.kind is FailureKind.EXCEPTION
    assert "/flatland_server is reserved" in str(driven.failure)
    assert str(driven.failure).startswith("controller.py")
    assert measure("runs", driven) == 0.0


def test_what_is_sent_under_the_worlds_name_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nodes are told apart by what they are: even where the name were not refused, its messages count."""
    add_node = ProxyNodes._add_node

    def add_unreserved(self: ProxyNodes, *event: Json) -> None:
        self._graph.reserved_names.clear()
        add_node(self, *event)

    monkeypatch.setattr(ProxyNodes, "_add_node", add_unreserved)
    source = SENDER.format(name="flatland_server", count=100, publisher="number", message="Int32")
    driven = drive(tmp_path, source, dataclasses.replace(TURN, time_s=1.0))
    assert driven.failure is None
    assert driven.traffic["/number"].count > 800
    assert "/scan" not in driven.traffic
    assert "/static_laser" not in driven.traffic


@pytest.mark.long
def test_a_flood_of_commands_ends_the_episode_as_the_programs_failure(tmp_path: Path) -> None:
    source = SENDER.format(name="sender", count=8000, publisher="drive", message="Twist")
    driven = drive(tmp_path, source)
    assert driven.failure is not None
    assert driven.failure.kind is FailureKind.FLOOD
    assert "more than 500 messages" in str(driven.failure)
    assert driven.recording.ticks < 20


def test_a_program_that_sends_much_but_not_a_flood_drives_on(tmp_path: Path) -> None:
    source = SENDER.format(name="sender", count=400, publisher="drive", message="Twist")
    driven = drive(tmp_path, source, dataclasses.replace(TURN, time_s=0.5))
    assert driven.failure is None


TRUTH_READER = """
import rclpy
from nav_msgs.msg import Odometry
from rclpy.node import Node
from robot_kit_msgs.srv import GetState
from sensor_msgs.msg import LaserScan

class Reader(Node):
    def __init__(self):
        super().__init__("reader")
        self.seen = set()
        self.client = self.create_client(GetState, "/get_state")
        self.client.call_async(GetState.Request()).add_done_callback(lambda done: self.see("state"))
        self.create_subscription(Odometry, "odometry/ground_truth", lambda message: self.see("truth"), 10)
        self.create_subscription(Odometry, "odom", lambda message: self.see("odometry"), 10)
        self.create_subscription(LaserScan, "static_laser", lambda message: self.see("scan"), 10)

    def see(self, what):
        if what not in self.seen:
            self.seen.add(what)
            print("SEEN", what, flush=True)

def main():
    rclpy.init()
    rclpy.spin(Reader())
"""


@pytest.mark.parametrize("level", [Level.LIMITED, pytest.param(Level.FILTERED, marks=LOCKS)], ids=["0", "1"])
def test_the_true_state_of_the_world_is_not_offered(tmp_path: Path, level: Level) -> None:
    driven = drive(tmp_path, TRUTH_READER, dataclasses.replace(TURN, time_s=0.5), level=level)
    assert driven.failure is None
    assert sorted(line for line in driven.printed if "SEEN" in line) == ["SEEN odometry", "SEEN scan"]
    assert any("no node serves '/get_state'" in line for line in driven.printed)
    assert driven.refused == ("get_state",)
    assert measure("obeys", driven) == 1.0  # one request too many


@pytest.mark.parametrize("topic", ["odometry/ground_truth", "/odometry/ground_truth"])
def test_a_truth_that_the_trial_names_is_offered(tmp_path: Path, topic: str) -> None:
    trial = dataclasses.replace(
        TURN, time_s=0.5, services=frozenset({"get_state"}), topics=frozenset({topic})
    )
    driven = drive(tmp_path, TRUTH_READER, trial)
    assert sorted(driven.printed) == ["SEEN odometry", "SEEN scan", "SEEN state", "SEEN truth"]
    assert driven.refused == ()
