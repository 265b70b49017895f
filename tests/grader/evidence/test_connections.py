"""Names and connections of a graded program: wrong ones are found and named, and no secret episode says anything."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import pytest

from grader.assignment import Shift, Trial
from grader.checks.drives import (
    CHECKS,
    CircleParams,
    HeadingParams,
    NodeNamesParams,
    ProfilesParams,
    TopicsParams,
)
from grader.evidence.collector import EpisodeSpec
from grader.evidence.drive_record import GradedDrive
from grader.evidence.episodes import run_episode
from kit.host.sandbox.confinement import Level
from kit.host.sandbox.limits import GRADER_LIMITS
from kit.run.scenario import find_scenario

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


def test_only_the_program_s_own_nodes_count(mistaken: GradedDrive) -> None:
    assert mistaken.connections.nodes == ("/Heartbeat",)


def test_connections_without_another_end_are_named_with_what_there_is(mistaken: GradedDrive) -> None:
    listens, publishes, calls = mistaken.connections.mistakes
    assert "/Heartbeat listens on /odometry, where nobody publishes" in listens
    assert "nav_msgs/msg/Odometry there is /odom" in listens
    assert "/Heartbeat publishes on /cmdvel, where nobody listens" in publishes
    assert "/cmd_vel" in publishes
    assert "/Heartbeat calls /movemodel, which nobody offers" in calls
    assert "/move_model" in calls


def test_a_callback_that_was_called_instead_of_given_is_named(mistaken: GradedDrive) -> None:
    assert mistaken.failure is None
    assert "without parentheses" in mistaken.explain("rate")
    assert "without parentheses" not in mistaken.explain("bumps")


def test_a_topic_that_another_node_publishes_is_named(mistaken: GradedDrive) -> None:
    params = TopicsParams(("/wall_ahead std_msgs/msg/Bool /watcher",))
    assert "/wall_ahead is published by /Heartbeat, not by /watcher." in mistaken.explain("topics", params)


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
