"""DiffDrive and TricycleDrive: how they move a body, and what they say about it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from kit.geometry import Pose
from kit.msg.nav_msgs import Odometry
from kit.sim.simulation import Simulation
from kit.world.problems import WorldError
from tests.sim.workshop import Workshop, command


def yaw(message: Odometry) -> float:
    orientation = message.pose.pose.orientation
    return 2 * math.atan2(orientation.z, orientation.w)


def pose_of(message: Odometry) -> Pose:
    position = message.pose.pose.position
    return Pose(position.x, position.y, yaw(message))


def twist_of(message: Odometry) -> tuple[float, float, float]:
    twist = message.twist.twist
    return twist.linear.x, twist.linear.y, twist.angular.z


def robot(workshop: Workshop, **keys: Any) -> Simulation:
    plugin = {"type": "DiffDrive", "name": "drive", "body": "base", **keys}
    model = workshop.model(workshop.rectangle(-0.117, 0.048, -0.055, 0.055), plugins=[plugin])
    return Simulation(workshop.world({"robot": model}, {"walls": [[2, -5, 2, 5]]}), seed=1)


def reports(simulation: Simulation, steps: int, topic: str) -> list[Any]:
    return [out.message for out in simulation.step(steps) if out.topic == topic]


class TestDiffDrive:
    def test_ten_control_steps(self, workshop: Workshop) -> None:
        simulation = robot(workshop)
        simulation.accept("/cmd_vel", command(0.5))
        simulation.step(100)
        assert simulation.pose("robot") == pytest.approx((0.5, 0, 0), abs=1e-9)

    def test_the_last_command_holds_and_sideways_is_ignored(self, workshop: Workshop) -> None:
        simulation = robot(workshop)
        simulation.accept("/cmd_vel", command(0.2, sideways=3))
        simulation.step(500)
        assert simulation.pose("robot") == pytest.approx((1, 0, 0), abs=1e-9)
        simulation.accept("/cmd_vel", command(0))
        simulation.step(100)
        assert simulation.pose("robot") == pytest.approx((1, 0, 0), abs=1e-9)

    def test_one_that_veers_drives_a_circle_forth_and_back(self, workshop: Workshop) -> None:
        simulation = robot(workshop, veer=0.5)
        simulation.accept("/cmd_vel", command(0.5))
        simulation.step(200)
        angle = 0.5 * 1.0
        assert simulation.pose("robot") == pytest.approx(
            (2 * math.sin(angle), 2 * (1 - math.cos(angle)), angle), abs=1e-3
        )
        simulation.accept("/cmd_vel", command(-0.5))
        simulation.step(200)
        assert simulation.pose("robot") == pytest.approx((0, 0, 0), abs=1e-3)

    @pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
    def test_a_command_that_is_no_number_stops_it(self, workshop: Workshop, bad: float) -> None:
        simulation = robot(workshop)
        simulation.accept("/cmd_vel", command(0.5))
        simulation.step(10)
        simulation.accept("/cmd_vel", command(bad, 0.1))
        simulation.step(10)
        assert simulation.pose("robot") == pytest.approx((0.05, 0, 0))
        simulation.accept("/cmd_vel", command(0.5))
        simulation.step(10)
        assert simulation.pose("robot").x == pytest.approx(0.1)

    def test_limits(self, workshop: Workshop) -> None:
        limits = {"acceleration_limit": 1, "deceleration_limit": 2, "velocity_limit": 0.3}
        simulation = robot(workshop, linear_dynamics=limits, angular_dynamics={"acceleration_limit": 0.5})
        simulation.accept("/cmd_vel", command(1, 1))
        speeds = [twist_of(m) for m in reports(simulation, 60, "/odometry/ground_truth")]
        assert [speed for speed, _, _ in speeds[:3]] == pytest.approx([0.01, 0.02, 0.03])
        assert speeds[-1][0] == pytest.approx(0.3)
        assert [turn for _, _, turn in speeds[:3]] == pytest.approx([0.005, 0.01, 0.015])
        simulation.accept("/cmd_vel", command(0, 1))
        [last] = reports(simulation, 1, "/odometry/ground_truth")
        assert twist_of(last)[0] == pytest.approx(0.28)

    def test_reports_the_pose_before_the_step_and_the_command(self, workshop: Workshop) -> None:
        simulation = robot(workshop, odom_frame_id="origin")
        simulation.accept("/cmd_vel", command(0.5, 0.3))
        first, second = reports(simulation, 2, "/odometry/filtered")
        assert pose_of(first) == (0, 0, 0)
        assert (first.header.stamp.nanosec, second.header.stamp.nanosec) == (0, 10_000_000)
        assert pose_of(second)[0] == pytest.approx(0.005, rel=1e-3)
        assert (first.header.frame_id, first.child_frame_id) == ("origin", "base")

    def test_twists_are_in_the_bodys_own_frame(self, workshop: Workshop) -> None:
        """In Flatland's ROS 2 port a robot that drives north reports a speed to the left."""
        simulation = robot(workshop)
        simulation.move_model("robot", Pose(0, 0, math.pi / 2))
        simulation.accept("/cmd_vel", command(0.5, 0.1))
        for topic in ("/odometry/filtered", "/odometry/ground_truth"):
            [message] = reports(simulation, 1, topic)
            assert twist_of(message) == (0.5, 0, 0.1)
        [stamped] = reports(simulation, 1, "/twist")
        assert (stamped.twist.linear.x, stamped.twist.linear.y, stamped.header.frame_id) == (0.5, 0, "base")

    def test_transform(self, workshop: Workshop) -> None:
        simulation = robot(workshop)
        simulation.move_model("robot", Pose(1, 2, math.pi))
        [message] = reports(simulation, 1, "/tf")
        [found] = message.transforms
        assert (found.header.frame_id, found.child_frame_id) == ("odom", "base")
        assert (found.transform.translation.x, found.transform.translation.y) == (1, 2)
        assert found.transform.rotation.z == pytest.approx(1)

    def test_rate_and_switches(self, workshop: Workshop) -> None:
        assert len(reports(robot(workshop, pub_rate=10), 100, "/odometry/filtered")) == 10
        switches = {"enable_odom_pub": False, "enable_twist_pub": False, "enable_odom_tf_pub": False}
        simulation = robot(workshop, **switches)
        assert [endpoint.topic for endpoint in simulation.endpoints] == ["/cmd_vel"]
        assert simulation.step(10) == []

    @pytest.mark.long
    def test_noise_has_the_variances_and_leaves_the_truth_alone(self, workshop: Workshop) -> None:
        simulation = robot(workshop, odom_pose_noise=[0.04, 0.01, 0], odom_twist_noise=[0, 0, 0.25])
        sent = simulation.step(2000)
        noisy = [out.message for out in sent if out.topic == "/odometry/filtered"]
        exact = [out.message for out in sent if out.topic == "/odometry/ground_truth"]
        assert np.std([pose_of(m) for m in noisy], axis=0) == pytest.approx([0.2, 0.1, 0], rel=0.1, abs=1e-9)
        assert np.std([twist_of(m) for m in noisy], axis=0) == pytest.approx([0, 0, 0.5], rel=0.1, abs=1e-9)
        assert {pose_of(m) for m in exact} == {Pose()}
        assert list(noisy[0].pose.covariance[[0, 7, 35]]) == [0.04, 0.01, 0]
        assert list(noisy[0].twist.covariance[[0, 7, 35]]) == [0, 0, 0.25]
        assert not exact[0].pose.covariance.any()

    def test_given_covariance(self, workshop: Workshop) -> None:
        [message] = reports(robot(workshop, odom_pose_covariance=list(range(36))), 1, "/odometry/filtered")
        assert list(message.pose.covariance) == list(range(36))

    def test_encoders_without_errors_are_ideal(self, workshop: Workshop) -> None:
        simulation = robot(workshop, odometry="encoders", wheel_error=0, wheel_slip=0)
        simulation.accept("/cmd_vel", command(0.2, 0.7))
        sent = simulation.step(300)
        for out in sent:
            if out.topic == "/odometry/ground_truth":
                truth = pose_of(out.message)
            elif out.topic == "/odometry/filtered":
                counted = pose_of(out.message)
        assert counted == pytest.approx(truth, abs=1e-9)

    @pytest.mark.long
    def test_encoders_drift(self, workshop: Workshop) -> None:
        """More and more, by the seed, as much at any step size, and not while it stands."""
        wander = {"odometry": "encoders", "odom_pub": "odom", "ground_truth_pub": "truth"}
        errors = []
        for seed in range(12):
            simulation = robot(workshop, **wander)
            simulation.reset(seed)
            simulation.accept("/cmd_vel", command(0.15))
            sent = simulation.step(1000)
            counted = [pose_of(out.message) for out in sent if out.topic == "/odom"]
            truth = [pose_of(out.message) for out in sent if out.topic == "/truth"]
            errors.append([math.dist(counted[i][:2], truth[i][:2]) for i in (100, 999)])
            simulation.accept("/cmd_vel", command(0))
            still = {pose_of(m) for m in reports(simulation, 50, "/odom")}
            assert len(still) == 1
        early, late = np.mean(errors, axis=0)
        assert 0.0001 < early < 0.02
        assert 0.01 < late < 0.2
        assert early < late

    def test_encoders_count_on_where_a_wall_stops_the_robot(self, workshop: Workshop) -> None:
        simulation = robot(workshop, odometry="encoders")
        simulation.accept("/cmd_vel", command(0.5))
        counted = reports(simulation, 1000, "/odometry/filtered")[-1]
        assert simulation.pose("robot").x < 2
        assert pose_of(counted).x == pytest.approx(5, abs=0.2)

    @pytest.mark.parametrize(
        ("keys", "words"),
        [
            ({"odometry": "perfect"}, "perfect"),
            ({"linear_dynamics": {"acceleration": 1}}, "acceleration_limit"),
            ({"odom_pose_noise": [-1, 0, 0]}, "variances"),
            ({"odom_pose_covariance": [1]}, "36"),
            ({"pub_rate": -1}, "pub_rate"),
        ],
    )
    def test_mistakes(self, workshop: Workshop, keys: dict[str, Any], words: str) -> None:
        with pytest.raises(WorldError, match=words):
            robot(workshop, **keys)


def tricycle(workshop: Workshop, start: float = 12.0, **keys: Any) -> Simulation:
    """Wheelbase 0.9 m: rear wheels at x = -0.9."""
    wheels = {"front": (0, 0), "left": (-0.9, 0.4), "right": (-0.9, -0.4)}
    tyre = workshop.rectangle(-0.1, 0.1, -0.03, 0.03, layers=[])
    model = {
        "bodies": [{"name": "frame", "footprints": [workshop.rectangle(-1, 0.1, -0.4, 0.4)]}]
        + [{"name": name, "pose": [*at, 0], "footprints": [tyre]} for name, at in wheels.items()],
        "joints": [
            {
                "name": f"{name}_joint",
                "type": "revolute" if name == "front" else "weld",
                "bodies": [{"name": "frame", "anchor": at}, {"name": name, "anchor": [0, 0]}],
            }
            for name, at in wheels.items()
        ],
        "plugins": [
            {
                "type": "TricycleDrive",
                "name": "drive",
                "body": "frame",
                "front_wheel_joint": "front_joint",
                "rear_left_wheel_joint": "left_joint",
                "rear_right_wheel_joint": "right_joint",
                **keys,
            }
        ],
    }
    return Simulation(workshop.world({"robot": model}, poses={"robot": (start, 0, 0)}))


class TestTricycleDrive:
    """The numbers of Flatland's own test, to 0.01."""

    def test_forward_and_stop(self, workshop: Workshop) -> None:
        simulation = tricycle(workshop)
        simulation.step(100)
        assert simulation.pose("robot") == (12, 0, 0)
        simulation.accept("/cmd_vel", command(0.5))
        message = reports(simulation, 100, "/odometry/ground_truth")[-1]
        assert twist_of(message)[0] == pytest.approx(0.5, abs=0.01)
        assert simulation.pose("robot").x == pytest.approx(12.5, abs=1e-6)
        simulation.accept("/cmd_vel", command(0))
        message = reports(simulation, 100, "/odometry/ground_truth")[-1]
        assert twist_of(message)[0] == 0
        assert simulation.pose("robot").x == pytest.approx(12.5, abs=1e-6)

    def test_the_rear_axle_of_one_that_veers_drives_a_circle(self, workshop: Workshop) -> None:
        simulation = tricycle(workshop, veer=0.5)
        simulation.accept("/cmd_vel", command(0.5))
        simulation.step(200)
        x, y, theta = simulation.pose("robot")
        axle = x - 0.9 * math.cos(theta), y - 0.9 * math.sin(theta), theta
        assert axle == pytest.approx((12 - 0.9 + 2 * math.sin(0.5), 2 * (1 - math.cos(0.5)), 0.5), abs=1e-2)

    def test_speed_limit(self, workshop: Workshop) -> None:
        simulation = tricycle(workshop, linear_dynamics={"velocity_limit": 0.2})
        simulation.accept("/cmd_vel", command(0.5))
        message = reports(simulation, 100, "/odometry/ground_truth")[-1]
        assert twist_of(message)[0] == pytest.approx(0.2, abs=0.01)
        simulation.accept("/cmd_vel", command(0))
        simulation.step(100)
        assert simulation.pose("robot").x == pytest.approx(12.2, abs=0.01)

    @pytest.mark.parametrize(
        "key", [{"angular_dynamics": {"velocity_limit": 0.2}}, {"max_angular_velocity": 0.2}]
    )
    def test_steering(self, workshop: Workshop, key: dict[str, Any]) -> None:
        simulation = tricycle(workshop, **key)
        simulation.accept("/cmd_vel", command(0, 0.5))
        simulation.step(100)
        states = {body.body: body for body in simulation.state().bodies}
        assert states["frame"].pose == pytest.approx((12, 0, 0), abs=1e-6)
        assert states["front"].pose.theta == pytest.approx(0.2, abs=0.01)
        simulation.accept("/cmd_vel", command(0.5, 0))
        simulation.step(10)
        states = {body.body: body for body in simulation.state().bodies}
        assert states["frame"].velocity[0] == pytest.approx(0.5, abs=0.01)
        assert states["frame"].velocity[2] == pytest.approx(0.11, abs=0.01)
        assert states["frame"].pose.x == pytest.approx(12 + math.cos(0.2) * 0.05, abs=0.01)
        assert states["frame"].pose.y == pytest.approx(math.sin(0.2) * 0.05, abs=0.01)

    def test_a_full_circle(self, workshop: Workshop) -> None:
        """The rear axle circles about the point where its line meets the front wheel's."""
        simulation = tricycle(workshop, start=0.0, max_steer_angle=0.6)
        simulation.accept("/cmd_vel", command(0.5, 2.0))
        period = 2 * math.pi * (0.9 / math.sin(0.6)) / 0.5
        simulation.step(round(period / 0.01))
        x, y, theta = simulation.pose("robot")
        assert (x, y) == pytest.approx((0, 0), abs=0.01)
        assert theta == pytest.approx(2 * math.pi, abs=0.01)
        states = {body.body: body for body in simulation.state().bodies}
        assert states["front"].pose.theta - theta == pytest.approx(0.6, abs=0.01)
        assert states["front"].pose[:2] == pytest.approx((x, y), abs=0.001)

    def test_encoders_without_errors_are_ideal(self, workshop: Workshop) -> None:
        simulation = tricycle(workshop, odometry="encoders", wheel_error=0, wheel_slip=0)
        simulation.accept("/cmd_vel", command(0.4, 0.5))
        sent = simulation.step(300)
        last = {out.topic: out.message for out in sent}
        truth, counted = (pose_of(last[f"/odometry/{name}"]) for name in ("ground_truth", "filtered"))
        assert counted == pytest.approx(truth, abs=1e-3)

    @pytest.mark.parametrize(
        ("keys", "words"),
        [
            ({"front_wheel_joint": "left_joint"}, "revolute"),
            ({"rear_left_wheel_joint": "front_joint"}, "weld"),
            ({"rear_left_wheel_joint": "right_joint"}, "same place"),
            ({"body": "left"}, "does not hold"),
            ({"max_steer_angle": -1}, "max_steer_angle"),
        ],
    )
    def test_mistakes(self, workshop: Workshop, keys: dict[str, Any], words: str) -> None:
        with pytest.raises(WorldError, match=words):
            tricycle(workshop, **keys)
