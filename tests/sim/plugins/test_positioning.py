"""Gps and Imu: where on earth, and how it feels."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from kit.geometry import Pose
from kit.msg import sensor_msgs
from kit.msg.geometry_msgs import Twist, Vector3
from kit.sim.plugins.gps import geodetic_position
from kit.sim.simulation import Simulation
from tests.sim.workshop import Workshop


def carrying(workshop: Workshop, **plugin: Any) -> Simulation:
    drive = {"type": "DiffDrive", "name": "drive", "body": "base", "enable_odom_tf_pub": False}
    plugins = [drive, {"name": "device", "body": "base", **plugin}]
    return Simulation(workshop.world({"robot": workshop.model(workshop.circle(0.1), plugins=plugins)}))


def test_the_reference_is_the_origin() -> None:
    assert geodetic_position(0, 0, 41.178, -8.598) == pytest.approx((41.178, -8.598), abs=1e-12)


@pytest.mark.parametrize("latitude", [0.0, 45.0, -80.0])
def test_a_kilometre_north_and_east(latitude: float) -> None:
    """By the ellipsoid's radii of curvature, which is another way to the same thing."""
    e2, sin = 0.00669437999014, math.sin(math.radians(latitude))
    meridian = 6378137.0 * (1 - e2) / (1 - e2 * sin**2) ** 1.5
    parallel = 6378137.0 / math.sqrt(1 - e2 * sin**2) * math.cos(math.radians(latitude))
    north, _ = geodetic_position(0, 1000, latitude, 10)
    _, east = geodetic_position(1000, 0, latitude, 10)
    assert math.radians(north - latitude) * meridian == pytest.approx(1000, abs=0.1)
    assert math.radians(east - 10) * parallel == pytest.approx(1000, abs=0.1)


def test_fixes(workshop: Workshop) -> None:
    simulation = carrying(workshop, type="Gps", ref_lat=41, ref_lon=-8, origin=[1, 0, 0])
    simulation.move_model("robot", Pose(0, 0, math.pi / 2))
    sent = simulation.step(100)
    fixes = [out.message for out in sent if isinstance(out.message, sensor_msgs.NavSatFix)]
    assert len(fixes) == 10
    expected = geodetic_position(0, 1, 41, -8)  # the antenna is a metre ahead: north
    assert (fixes[-1].latitude, fixes[-1].longitude) == pytest.approx(expected, abs=1e-12)
    assert (fixes[-1].altitude, fixes[-1].header.frame_id) == (0, "device")
    [frame] = {out.message.transforms[0].child_frame_id for out in sent if out.topic == "/tf"}
    assert frame == "device"


def imu_messages(
    simulation: Simulation, steps: int, topic: str = "/imu/ground_truth"
) -> list[sensor_msgs.Imu]:
    return [out.message for out in simulation.step(steps) if out.topic == topic]


def test_acceleration_and_turn(workshop: Workshop) -> None:
    simulation = carrying(workshop, type="Imu")
    simulation.accept("/cmd_vel", Twist(linear=Vector3(x=0.5), angular=Vector3(z=2.0)))
    first, *_, last = imu_messages(simulation, 100)
    assert first.linear_acceleration.x == pytest.approx(50, rel=0.01)  # 0.5 m/s in a hundredth of a second
    assert last.angular_velocity.z == pytest.approx(2)
    assert last.linear_acceleration.x == pytest.approx(0, abs=0.05)
    assert last.linear_acceleration.y == pytest.approx(0.5 * 2, rel=0.01)  # to the left, v * w
    assert 2 * math.atan2(last.orientation.z, last.orientation.w) == pytest.approx(2)


def test_a_robot_at_rest_feels_nothing_at_any_rate(workshop: Workshop) -> None:
    """In Flatland the default rate makes it nan."""
    for rate in (math.inf, 10):
        keys = {} if math.isinf(rate) else {"pub_rate": rate}
        messages = imu_messages(carrying(workshop, type="Imu", **keys), 50)
        assert len(messages) == (50 if math.isinf(rate) else 5)
        assert {m.linear_acceleration.x for m in messages} == {0.0}


def test_imu_noise(workshop: Workshop) -> None:
    noise = {"linear_acceleration_noise": [0.04, 0, 0.01], "orientation_noise": [0, 0, 0.09]}
    messages = imu_messages(carrying(workshop, type="Imu", **noise), 2000, "/imu/filtered")
    felt = [(m.linear_acceleration.x, m.linear_acceleration.y, m.linear_acceleration.z) for m in messages]
    assert np.std(felt, axis=0) == pytest.approx([0.2, 0, 0.1], rel=0.1, abs=1e-12)
    yaw = [2 * math.atan2(m.orientation.z, m.orientation.w) for m in messages]
    assert np.std(yaw) == pytest.approx(0.3, rel=0.1)
    assert list(messages[0].linear_acceleration_covariance) == [0.04, 0, 0, 0, 0, 0, 0, 0, 0.01]
