"""tf2_geometry_msgs, and Buffer.transform."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from kit.msg.builtin_interfaces import Time as Stamp
from kit.msg.geometry_msgs import (
    Point,
    PointStamped,
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
    Quaternion,
    Transform,
    TransformStamped,
    Twist,
    Vector3,
    Vector3Stamped,
)
from kit.msg.std_msgs import Header
from kit.ros.geometry_transforms import (
    do_transform_point,
    do_transform_pose,
    do_transform_pose_stamped,
    do_transform_pose_with_covariance_stamped,
    do_transform_vector3,
)
from kit.ros.node.time import Time
from kit.ros.rotations import euler_from_quaternion, quaternion_from_euler, quaternion_matrix
from kit.ros.tf import Buffer, ExtrapolationException, LookupException
from kit.ros.tf_conversion import (
    ConvertRegistration,
    TransformRegistration,
    TypeException,
    convert,
)


def quaternion(roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0) -> Quaternion:
    x, y, z, w = (float(value) for value in quaternion_from_euler(roll, pitch, yaw))
    return Quaternion(x=x, y=y, z=z, w=w)


def transform(
    child: str = "base", parent: str = "map", x: float = 1.0, yaw: float = math.pi / 2, sec: int = 3
) -> TransformStamped:
    """``child`` stands in ``parent`` at (x, 2, 0) and has turned by ``yaw``."""
    return TransformStamped(
        header=Header(stamp=Stamp(sec=sec), frame_id=parent),
        child_frame_id=child,
        transform=Transform(translation=Vector3(x=x, y=2.0), rotation=quaternion(yaw=yaw)),
    )


IN_BASE = Header(stamp=Stamp(sec=3), frame_id="base")


def test_a_point_is_turned_and_moved() -> None:
    point = PointStamped(header=IN_BASE, point=Point(x=1.0, z=5.0))
    result = do_transform_point(point, transform())
    assert (result.point.x, result.point.y, result.point.z) == pytest.approx((1.0, 3.0, 5.0))
    assert result.header == transform().header
    assert point.point == Point(x=1.0, z=5.0)


def test_a_vector_is_only_turned() -> None:
    vector = do_transform_vector3(Vector3Stamped(header=IN_BASE, vector=Vector3(x=1.0)), transform()).vector
    assert (vector.x, vector.y, vector.z) == pytest.approx((0.0, 1.0, 0.0))


def test_a_pose_is_turned_and_moved() -> None:
    pose = Pose(position=Point(x=1.0), orientation=quaternion(yaw=0.25))
    found = do_transform_pose(pose, transform())
    turn = found.orientation
    assert euler_from_quaternion([turn.x, turn.y, turn.z, turn.w])[2] == pytest.approx(math.pi / 2 + 0.25)
    assert (found.position.x, found.position.y) == pytest.approx((1.0, 3.0))
    stamped = do_transform_pose_stamped(PoseStamped(header=IN_BASE, pose=pose), transform())
    assert (stamped.pose, stamped.header.frame_id) == (found, "map")
    with pytest.raises(TypeError, match="do_transform_pose_stamped"):
        do_transform_pose(PoseStamped(), transform())  # type: ignore[arg-type]  # the mistake


def test_a_covariance_is_turned_in_both_its_parts() -> None:
    numbers = np.random.default_rng(1).normal(size=(6, 6))
    covariance = numbers @ numbers.T
    pose = PoseWithCovarianceStamped(header=IN_BASE)
    pose.pose.covariance = covariance.ravel()
    about = transform()
    about.transform.rotation = quaternion(0.3, -0.7, 1.9)
    result = do_transform_pose_with_covariance_stamped(pose, about).pose.covariance
    turn = about.transform.rotation
    block = np.array(quaternion_matrix([turn.x, turn.y, turn.z, turn.w]))[:3, :3]
    both = np.block([[block, np.zeros((3, 3))], [np.zeros((3, 3)), block]])
    np.testing.assert_allclose(np.reshape(result, (6, 6)), both @ covariance @ both.T)


@pytest.fixture
def buffer() -> Buffer:
    made = Buffer()
    made.set_transform(transform(x=1.0, sec=3), "test")
    made.set_transform(transform(x=5.0, sec=5), "test")
    return made


class TestBuffer:
    def test_it_transforms_registered_types_at_their_own_time(self, buffer: Buffer) -> None:
        point = PointStamped(header=Header(stamp=Stamp(sec=4), frame_id="base"))
        result = buffer.transform(point, "map")
        assert (result.point.x, result.point.y, result.header.frame_id) == (3.0, 2.0, "map")
        point.header.stamp.sec = 6
        with pytest.raises(ExtrapolationException):
            buffer.transform(point, "map")
        with pytest.raises(TypeException, match="Twist is not loaded"):
            buffer.transform(Twist(), "map")

    def test_it_transforms_into_another_time(self, buffer: Buffer) -> None:
        """The robot has driven 4 m along the map's x axis while it looked along its y axis."""
        point = PointStamped(header=IN_BASE)
        result = buffer.transform_full(point, "base", Time(seconds=5), "map")
        assert (result.point.x, result.point.y) == pytest.approx((0.0, 4.0))
        assert result.header == Header(stamp=Stamp(sec=5), frame_id="base")
        five, six = Time(seconds=5), Time(seconds=6)
        assert buffer.can_transform_full("base", five, "base", five, "map") is True
        is_possible, reason = buffer.can_transform_full(  # type: ignore[misc]  # a tuple, as asked for
            "base", six, "base", five, "map", return_debug_tuple=True
        )
        assert not is_possible
        assert "extrapolation" in reason

    def test_a_transform_can_be_awaited(self, buffer: Buffer) -> None:
        asked = buffer.lookup_transform_async("map", "camera", Time(seconds=3))
        future = asked.send(None)
        assert not future.done()
        buffer.set_transform(transform("laser", "base"), "test")
        assert not future.done()
        buffer.set_transform_static(transform("camera", "base", x=0.0, yaw=0.0), "test")
        assert future.done()
        with pytest.raises(StopIteration) as end:
            asked.send(None)
        assert end.value.value.child_frame_id == "camera"

    def test_frames_as_text(self, buffer: Buffer) -> None:
        assert buffer.all_frames_as_string() == "Frame base exists with parent map.\n"
        with pytest.raises(LookupException):
            buffer.lookup_transform("map", "nothing")


class TestRegistrations:
    @pytest.fixture(autouse=True)
    def tables(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(TransformRegistration, "_by_type", {})
        for name in ("_to_msg", "_from_msg", "_convert"):
            monkeypatch.setattr(ConvertRegistration, name, {})

    def test_a_program_registers_its_own_type(self, buffer: Buffer) -> None:
        TransformRegistration().add(PointStamped, lambda point, found: (point, found.child_frame_id))
        point = PointStamped(header=IN_BASE)
        assert buffer.transform(point, "map") == (point, "base")

    def test_conversions_go_directly_or_through_a_message(self) -> None:
        registration = ConvertRegistration()
        unknown: Any = set
        registration.add_to_msg(str, int)
        registration.add_from_msg(float, float)
        assert convert("7", float) == 7.0
        registration.add_convert((str, float), lambda _: -1.0)
        assert convert("7", float) == -1.0
        assert convert(3.5, float) == 3.5
        with pytest.raises(TypeException, match="set"):
            convert("7", unknown)
