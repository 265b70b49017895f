"""Robots that courses use: their topics, sizes and ranges, and code in the shape of those courses' own."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kit.msg.ackermann_msgs import AckermannDrive, AckermannDriveStamped
from kit.msg.geometry_msgs import Twist, Vector3
from kit.run.headless import run_episode
from kit.run.scenario import find_scenario
from kit.sim.simulation import Simulation
from tests.sim.workshop import last_messages

AVOIDS = """
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan


class Turtlebot3ObstacleDetection(Node):
    def __init__(self):
        super().__init__("turtlebot3_obstacle_detection")
        self.linear_velocity = 0.0
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.scan_callback, qos_profile_sensor_data)
        self.create_subscription(Odometry, "odom", self.odom_callback, 10)
        self.create_timer(0.1, self.update)
        self.scan_ranges = []

    def odom_callback(self, msg):
        self.linear_velocity = msg.twist.twist.linear.x

    def scan_callback(self, msg):
        assert len(msg.ranges) == 360
        front = msg.ranges[0]
        left, right, last = msg.ranges[90], msg.ranges[270], msg.ranges[359]
        assert abs(last - front) < 1.0
        self.scan_ranges = msg.ranges[0:30] + msg.ranges[330:360]

    def update(self):
        if not self.scan_ranges:
            return
        twist = Twist()
        if min(self.scan_ranges) > 0.45:
            twist.linear.x = 0.5
        else:
            twist.angular.z = 0.8
        self.publisher.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(Turtlebot3ObstacleDetection())
"""

RACES = """
import numpy as np
import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class MiddleOfTheTrack(Node):
    def __init__(self):
        super().__init__("wall_follow_node")
        self.create_subscription(LaserScan, "/scan", self.lidar_callback, 10)
        self.drive_publisher = self.create_publisher(AckermannDriveStamped, "/drive", 10)

    def lidar_callback(self, data):
        ranges = np.array(data.ranges)
        assert ranges.size == 1080
        angles = data.angle_min + data.angle_increment * np.arange(ranges.size)
        left, right = (
            np.clip(ranges[(side * angles > 0.4) & (side * angles < 1.3)], 0, 3).mean() for side in (1, -1)
        )
        steering = float(np.clip(1.2 * (left - right) / (left + right), -0.41, 0.41))
        message = AckermannDriveStamped()
        message.drive.steering_angle = steering
        message.drive.speed = 2.0 if abs(steering) < 0.2 else 1.2
        self.drive_publisher.publish(message)


def main():
    rclpy.init()
    rclpy.spin(MiddleOfTheTrack())
"""


@pytest.mark.long
@pytest.mark.parametrize(
    ("place", "program", "seconds", "least_m", "fastest"),
    [("turtlebot", AVOIDS, 60.0, 4.0, 0.22), ("f1tenth", RACES, 20.0, 15.0, 2.01)],
)
def test_the_code_of_courses_drives_them(
    place: str, program: str, seconds: float, least_m: float, fastest: float, tmp_path: Path
) -> None:
    file = tmp_path / "student.py"
    file.write_text(program)
    summary = run_episode(place, str(file), seconds=seconds, until_reached=False)
    assert summary.failure is None
    assert summary.metrics.bumps == 0
    assert least_m < summary.metrics.distance_m <= fastest * seconds * 1.01


def test_the_burger_says_what_a_turtlebot_says() -> None:
    simulation = Simulation(find_scenario("turtlebot").world)
    topics = {endpoint.topic for endpoint in simulation.endpoints}
    assert {"/scan", "/odom", "/cmd_vel", "/imu", "/joint_states", "/tf"} <= topics
    scan = last_messages(simulation, 30)["/scan"]
    assert (len(scan.ranges), scan.angle_min, scan.header.frame_id) == (360, 0.0, "base_scan")
    assert scan.angle_increment == pytest.approx(math.radians(1))
    assert (scan.range_min, scan.range_max) == pytest.approx((0.12, 3.5))
    walls = np.array(scan.ranges)
    assert walls[90] == pytest.approx(1.3 - 0.15, abs=0.05), "a pillar stands to the left"
    assert walls[270] == pytest.approx(1.3 - 0.15, abs=0.05), "and one to the right"
    assert walls[0] == pytest.approx(2.6 + 0.032, abs=0.05), "ahead is a corner"


def test_ranges_beyond_the_laser_s_reach_are_infinite() -> None:
    simulation = Simulation(find_scenario("turtlebot").world)
    simulation.move_model("burger", simulation.pose("burger").compose(_pose(-2.2)))
    scan = last_messages(simulation, 30)["/scan"]
    assert math.isinf(scan.ranges[0])
    assert min(scan.ranges) < 0.5


def _pose(x: float) -> Any:
    from kit.geometry import Pose

    return Pose(x, 0.0, 0.0)


def test_the_burger_s_wheels_turn_as_it_drives() -> None:
    simulation = Simulation(find_scenario("turtlebot").world)
    simulation.accept("/cmd_vel", Twist(linear=Vector3(x=9.0), angular=Vector3(z=0.0)))
    messages = last_messages(simulation, 200)
    joints, odom = messages["/joint_states"], messages["/odom"]
    assert odom.twist.twist.linear.x == pytest.approx(0.22)
    assert list(joints.name) == ["wheel_left_joint", "wheel_right_joint"]
    assert list(joints.velocity) == pytest.approx([0.22 / 0.033] * 2)
    assert list(joints.position) == pytest.approx([0.44 / 0.033] * 2, rel=0.02)
    simulation.accept("/cmd_vel", Twist(angular=Vector3(z=1.0)))
    joints = last_messages(simulation, 50)["/joint_states"]
    assert list(joints.velocity) == pytest.approx([-0.08 / 0.033, 0.08 / 0.033], rel=0.01)
    assert messages["/imu"].header.frame_id == "imu_link"


def test_the_car_turns_as_its_wheels_say() -> None:
    simulation = Simulation(find_scenario("f1tenth").world)
    assert len(last_messages(simulation, 10)["/scan"].ranges) == 1080
    start = simulation.pose("car")
    command = AckermannDriveStamped(drive=AckermannDrive(speed=1.0, steering_angle=0.3))
    simulation.accept("/drive", command)
    simulation.step(100)
    twist = last_messages(simulation, 10)["/odom"].twist.twist
    assert twist.linear.x == pytest.approx(1.0), "the speed of the rear axle"
    assert twist.angular.z == pytest.approx(1.0 * math.tan(0.3) / 0.33, rel=1e-3)
    simulation.accept("/drive", AckermannDriveStamped(drive=AckermannDrive(speed=1.0, steering_angle=9.0)))
    simulation.step(40)
    twist = last_messages(simulation, 10)["/odom"].twist.twist
    assert twist.angular.z == pytest.approx(math.tan(0.4189) / 0.33, rel=1e-3), "at most 0.4189 rad"
    assert simulation.pose("car") != start
