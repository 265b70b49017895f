"""A drive by hand that is handed in: run again, judged, and no trick of a file's works."""

from __future__ import annotations

import dataclasses
import io
import json
import math
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from grader.assignment import Assignment, Shift, Trial
from grader.driving.check_table import CHECKS
from grader.driving.checks.interfaces import (
    NodeNamesParams,
    PrintedTextParams,
    ProfilesParams,
    TopicRateParams,
    TopicsParams,
)
from grader.driving.checks.ways import CircleParams, HeadingParams
from grader.driving.drive_record import GradedDrive
from grader.driving.episodes import run_episode
from grader.evidence.contract import EpisodeSpec
from grader.grading import GradingOptions, grade
from grader.kinds.drive.kind import MAX_INPUTS_PER_S
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.limits import GRADER_LIMITS
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus, GradingResult, GradingVerdict
from kit.run.recording import Input, Recording, load_recording, save_recording
from kit.run.scenario import find_scenario
from tests.solutions.drives import AGAIN, STILL, ahead, driven, left

ASSIGNMENT_TEXT = """
title: Forward
kind: drive
submit: drive.npz
level: 0
drive: {place: simple, time: 20}
checks:
  - {check: genuine, points: 1}
  - {check: moves, points: 1, after: genuine, share: {none: 0, full: 1}}
  - {check: bumps, points: 1, after: genuine, share: {none: 1, full: 0}}
"""
DESK = GradingOptions(Level.LIMITED, secret=True)
Edit = Callable[[dict[str, Any]], None]


@pytest.fixture(scope="module")
def assignment(tmp_path_factory: pytest.TempPathFactory) -> Assignment:
    folder = tmp_path_factory.mktemp("forward")
    (folder / "assignment.yaml").write_text(ASSIGNMENT_TEXT)
    return read_assignment(folder)


@pytest.fixture(scope="module")
def recording() -> Recording:
    return driven(find_scenario("simple"), [ahead(1.2), STILL])


def handed_in(assignment: Assignment, data: bytes) -> GradingResult:
    return grade(assignment, Submission("ada", "drive.npz", {"drive.npz": data}), DESK)


def as_bytes(recording: Recording, folder: Path) -> bytes:
    save_recording(recording, folder / "made.npz")
    return (folder / "made.npz").read_bytes()


def refused(result: GradingResult) -> str:
    """What is said of a file that cannot be taken."""
    assert result.tests[0].status is CriterionStatus.STUDENT_ERROR
    assert result.points == 0
    said = result.tests[0].rationale
    assert "Traceback" not in said
    assert "/tmp" not in said
    return said


def test_a_true_drive_earns_what_it_drove(
    assignment: Assignment, recording: Recording, tmp_path: Path
) -> None:
    result = handed_in(assignment, as_bytes(recording, tmp_path))
    assert result.verdict is GradingVerdict.PASS
    assert result.points == 3


@pytest.mark.long
def test_the_best_attempt_counts(assignment: Assignment, tmp_path: Path) -> None:
    legs = [ahead(2.9), AGAIN, left(90), ahead(1.1), AGAIN, STILL]
    result = handed_in(assignment, as_bytes(driven(find_scenario("simple"), legs), tmp_path))
    assert result.points == 3
    bumped = handed_in(assignment, as_bytes(driven(find_scenario("simple"), [ahead(3.0)]), tmp_path))
    assert next(test for test in bumped.tests if test.id == "bumps").points == 0


def test_poses_that_were_changed_prove_nothing(
    assignment: Assignment, recording: Recording, tmp_path: Path
) -> None:
    poses = recording.poses + np.linspace(0, 1, recording.ticks)[:, None]
    result = handed_in(assignment, as_bytes(replace(recording, poses=poses), tmp_path))
    assert result.tests[0].status is CriterionStatus.FAIL
    assert result.points == 0


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"place": "maze", "case": "maze"}, "maze"),
        ({"case": "other"}, "other"),
        ({"level": "follow-the-nurse"}, "follow-the-nurse"),
        ({"step_size": 0.02}, "0.02"),
        ({"models": ((0, ("other",)),)}, "models"),
        ({"inputs": (Input(0, "move_model", ("serp", [3.0, 1.9, 0.0])),)}, "keys"),
        ({"inputs": (Input(0, "spawn_model", ("/etc/passwd", "x", "", [0, 0, 0])),)}, "keys"),
        ({"inputs": (Input(0, "delete_model", ("serp",)),)}, "keys"),
        ({"inputs": (Input(0, "accept", ("/odom", "geometry_msgs/msg/Twist", {})),)}, "/odom"),
        ({"inputs": (Input(0, "accept", ("/cmd_vel", "os/system", {})),)}, "accept"),
        ({"inputs": (Input(0, "accept", ("/cmd_vel", "geometry_msgs/msg/Twist", {"linear": 3})),)}, "accept"),
        (
            {
                "inputs": (
                    Input(
                        0, "accept", ("/cmd_vel", "geometry_msgs/msg/Twist", {"linear": {"x": float("nan")}})
                    ),
                )
            },
            "accept",
        ),
        ({"inputs": (Input(0, "accept", ()),)}, ""),
        ({"inputs": (Input(0, "reset", (None,)),) * 100_000}, "more commands"),
    ],
    ids=[
        *("place", "case", "level", "step", "models", "lift", "spawn", "delete"),
        *("topic", "type", "shape", "nan", "nothing", "flood"),
    ],
)
def test_what_no_keys_can_do_is_refused(
    assignment: Assignment, recording: Recording, tmp_path: Path, change: dict[str, Any], word: str
) -> None:
    said = refused(handed_in(assignment, as_bytes(replace(recording, **change), tmp_path)))
    assert word in said


def test_a_long_recording_is_refused(assignment: Assignment, tmp_path: Path) -> None:
    recording = driven(find_scenario("simple"), [STILL])
    ticks = 2100
    long = replace(recording, poses=np.zeros((ticks, 3)), counts=np.ones(ticks, dtype=np.int64), inputs=())
    assert "at most 20 s" in refused(handed_in(assignment, as_bytes(long, tmp_path)))


def test_more_commands_than_anybody_gives_by_hand_are_refused(
    assignment: Assignment, recording: Recording, tmp_path: Path
) -> None:
    many = MAX_INPUTS_PER_S * (2 + recording.ticks // 100)
    flood = replace(recording, inputs=recording.inputs[:1] * many)
    assert "by hand" in refused(handed_in(assignment, as_bytes(flood, tmp_path)))
    long = _archive(header=_header(inputs=[[0, "x" * 1_000_000, []]]), poses=POSES, counts=COUNTS)
    assert "by hand" in refused(handed_in(assignment, long))


def _archive(**parts: bytes) -> bytes:
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            archive.writestr(f"{name}.npy", content)
    return data.getvalue()


def _array(values: Any) -> bytes:
    data = io.BytesIO()
    np.save(data, values, allow_pickle=True)
    return data.getvalue()


def _header(**changes: Any) -> bytes:
    header = {
        "format": 1,
        "place": "simple",
        "case": "simple",
        "seed": 0,
        "step_size": 0.01,
        "models": [[0, ["serp"]]],
        "inputs": [],
    }
    return _array(np.frombuffer(json.dumps(header | changes).encode(), dtype=np.uint8))


class Bad:
    def __reduce__(self) -> tuple[Any, ...]:
        return exec, ("raise SystemExit('ran')",)


CLAIMED = (
    b"\x93NUMPY\x01\x00v\x00"
    + b"{'descr': '<f8', 'fortran_order': False, 'shape': (999999999999, 3), }".ljust(117)
    + b"\n"
)
POSES, COUNTS = _array(np.zeros((5, 3))), _array(np.ones(5, dtype=np.int64))
NASTY: dict[str, Callable[[], bytes]] = {
    "empty": lambda: b"",
    "text": lambda: b"not a zip",
    "cut": lambda: _archive(header=_header(), poses=POSES, counts=COUNTS)[:-30],
    "missing": lambda: _archive(header=_header(), poses=POSES),
    "more": lambda: _archive(header=_header(), poses=POSES, counts=COUNTS, extra=POSES),
    "bomb": lambda: _archive(header=_header(), poses=_array(np.zeros((4_000_000, 3))), counts=COUNTS),
    "claimed": lambda: _archive(header=_header(), poses=CLAIMED, counts=COUNTS),
    "pickle": lambda: _archive(
        header=_header(), poses=_array(np.array([[Bad()]], dtype=object)), counts=COUNTS
    ),
    "dimensions": lambda: _archive(header=_header(), poses=_array(np.zeros((5, 3, 1))), counts=COUNTS),
    "json": lambda: _archive(
        header=_array(np.frombuffer(b"[" * 100_000, dtype=np.uint8)), poses=POSES, counts=COUNTS
    ),
    "seed": lambda: _archive(header=_header(seed=-1), poses=POSES, counts=COUNTS),
    "infinite seed": lambda: _archive(header=_header(seed=1e400), poses=POSES, counts=COUNTS),
    "steps": lambda: _archive(header=_header(step_size=0), poses=POSES, counts=COUNTS),
    "reset": lambda: _archive(header=_header(inputs=[[0, "reset", ["x"]]]), poses=POSES, counts=COUNTS),
    "early": lambda: _archive(header=_header(inputs=[[-5, "reset", [{"a": 1}]]]), poses=POSES, counts=COUNTS),
    "counts": lambda: _archive(header=_header(), poses=POSES, counts=_array(np.array([5, 0, 0, 0, 0]))),
}


@pytest.mark.parametrize("name", NASTY)
def test_a_file_that_is_no_recording_is_refused_and_harms_nobody(assignment: Assignment, name: str) -> None:
    result = handed_in(assignment, NASTY[name]())
    assert result.verdict is GradingVerdict.FAIL
    assert result.points == 0
    assert all(test.status is not CriterionStatus.GRADER_ERROR for test in result.tests)


def test_a_sheet_without_a_place_is_told_so(tmp_path: Path) -> None:
    from kit.world.problems import WorldError

    (tmp_path / "assignment.yaml").write_text(ASSIGNMENT_TEXT.replace("place: simple", "place: simpel"))
    with pytest.raises(WorldError, match="simple"):
        read_assignment(tmp_path)


@pytest.mark.long
def test_the_solutions_are_as_their_script_makes_them(tmp_path: Path) -> None:
    from tests.solutions.drives import FLAG, FOLDER

    place, legs = FLAG["solution"]
    kept = load_recording(FOLDER / "01-drive" / "flag" / "solution.npz")
    assert np.abs(driven(find_scenario(place), legs).poses - kept.poses).max() < 1e-6


SIMPLE = Trial("simple", find_scenario("simple"), 0.5, (1,), (), Shift(), None, False, frozenset())

MISTAKEN = """
import rclpy
from flatland_msgs.srv import MoveModel
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool

class Mistaken(Node):
    def __init__(self):
        super().__init__("Heartbeat")
        self.create_subscription(Odometry, "odometry", self.on_odometry, 10)
        self.create_client(MoveModel, "/movemodel")
        self.drive = self.create_publisher(Twist, "cmdvel", 10)
        self.warn = self.create_publisher(Bool, "wall_ahead", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)
        self.create_timer(0.1, self.beat())

    def beat(self):
        self.warn.publish(Bool(data=True))

    def on_odometry(self, message):
        pass

    def on_scan(self, scan):
        pass

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Mistaken())
"""

CIRCLE = """
import rclpy
from geometry_msgs.msg import Twist, Vector3
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

class Circle(Node):
    def __init__(self):
        super().__init__("circle")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan):
        self.get_logger().info(f"ahead {scan.ranges[45]:.1f}")
        self.drive.publish(Twist(linear=Vector3(x=0.4), angular=Vector3(z=-2.0)))

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Circle())
"""


def drive(folder: Path, source: str, trial: Trial) -> GradedDrive:
    file = folder / "controller.py"
    file.write_text(source)
    return run_episode(
        EpisodeSpec(trial, 1, "simple, seed 1", False), file, limits=GRADER_LIMITS, level=Level.LIMITED
    )


@pytest.fixture(scope="module")
def mistaken(tmp_path_factory: pytest.TempPathFactory) -> GradedDrive:
    return drive(tmp_path_factory.mktemp("mistaken"), MISTAKEN, SIMPLE)


@pytest.fixture(scope="module")
def circle(tmp_path_factory: pytest.TempPathFactory) -> GradedDrive:
    """A circle to the right, by a robot whose laser reaches no wall."""
    trial = dataclasses.replace(SIMPLE, time_s=5.0, laser_range=0.05)
    return drive(tmp_path_factory.mktemp("circle"), CIRCLE, trial)


def test_the_name_of_a_node_is_compared_letter_by_letter(mistaken: GradedDrive) -> None:
    measure = CHECKS["named"].measure
    assert measure(mistaken, NodeNamesParams(("/heartbeat",))) == 0.0
    assert measure(mistaken, NodeNamesParams(("/Heartbeat",))) == 1.0
    assert mistaken.explain("named", NodeNamesParams(("/heartbeat",))) == "There is /Heartbeat."


def test_how_often_something_came_is_told_beside_how_often_it_should(mistaken: GradedDrive) -> None:
    told = mistaken.explain("says", PrintedTextParams("never said", 0.5))
    assert "“never said” 0 times in" in told
    assert f"; {mistaken.seconds / 0.5:.0f} are asked for." in told
    assert "0 messages came on /silent in" in mistaken.explain("rate", TopicRateParams("/silent", 10.0))


def test_only_the_program_s_own_nodes_count(mistaken: GradedDrive) -> None:
    assert mistaken.connections.nodes == ("/Heartbeat",)


def test_connections_without_another_end_are_named_with_what_there_is(mistaken: GradedDrive) -> None:
    listens, publishes, calls = mistaken.connections.mistakes
    for told, wrong, there_is in (
        (listens, "/odometry", "/odom"),
        (publishes, "/cmdvel", "/cmd_vel"),
        (calls, "/movemodel", "/move_model"),
    ):
        assert "/Heartbeat " in told
        assert told.startswith(f"{wrong}, ")
        assert f" {there_is}" in told.partition(";")[2]


def test_a_callback_that_was_called_instead_of_given_is_named(mistaken: GradedDrive) -> None:
    assert mistaken.failure is None
    assert "without parentheses" in mistaken.explain("rate")
    assert "without parentheses" not in mistaken.explain("bumps")


def test_a_topic_that_another_node_publishes_is_named(mistaken: GradedDrive) -> None:
    params = TopicsParams(("/wall_ahead std_msgs/msg/Bool /watcher",))
    assert "/wall_ahead is published by /Heartbeat, not by /watcher." in mistaken.explain("topics", params)
    assert "Nothing came on /silent." in mistaken.explain("topics", TopicsParams(("/silent",)))


def test_the_heading_at_the_end_is_compared_the_short_way_round(circle: GradedDrive) -> None:
    turned = math.degrees(circle.track[-1, 2] - circle.track[0, 2])
    measure = CHECKS["faces"].measure
    assert measure(circle, HeadingParams(turned)) == pytest.approx(0.0, abs=1e-6)
    assert measure(circle, HeadingParams(turned + 350.0)) == pytest.approx(10.0, abs=1e-6)


def test_a_profile_is_compared_word_by_word(mistaken: GradedDrive) -> None:
    measure = CHECKS["profiles"].measure
    asked = ProfilesParams(("/Heartbeat publishes /wall_ahead RELIABLE",))
    other = ProfilesParams(("/Heartbeat publishes /wall_ahead BEST_EFFORT",))
    assert (measure(mistaken, asked), measure(mistaken, other)) == (1.0, 0.0)
    assert "There: /Heartbeat publishes /wall_ahead RELIABLE VOLATILE 10" in mistaken.explain(
        "profiles", other
    )


def test_two_ends_that_do_not_fit_are_named(tmp_path: Path) -> None:
    source = MISTAKEN.replace(
        '"static_laser", self.on_scan, 10)',
        '"static_laser", self.on_scan, QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))',
    ).replace("import rclpy\n", "import rclpy\nfrom rclpy.qos import DurabilityPolicy, QoSProfile\n", 1)
    mistakes = drive(tmp_path, source, SIMPLE).connections.mistakes
    assert any("Nothing passes on /static_laser. DURABILITY" in each for each in mistakes)


def test_nothing_is_said_of_a_secret_episode(mistaken: GradedDrive) -> None:
    secret = dataclasses.replace(mistaken, secret=True)
    assert secret.explain("rate") == secret.explain("named") == ""


@pytest.mark.long
def test_a_circle_to_the_other_side_is_no_circle_of_that_radius(circle: GradedDrive) -> None:
    check = CHECKS["circle"]
    off = {
        side: check.measure(circle, CircleParams(radius=0.2, turning=side)) for side in ("", "left", "right")
    }
    assert off[""] == off["right"] < 0.1
    assert off["left"] == pytest.approx(2.0, abs=0.1)


def test_a_trial_may_shorten_the_laser(circle: GradedDrive) -> None:
    assert any("ahead nan" in line for line in circle.printed)
