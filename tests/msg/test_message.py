"""Message classes behave as those ROS 2 generates."""

from __future__ import annotations

import copy
import subprocess
import sys
from array import array

import numpy as np
import pytest

from kit.msg.builtin_interfaces import Time
from kit.msg.fields import FieldError
from kit.msg.flatland_msgs import Collision, MoveModel
from kit.msg.geometry_msgs import Pose, PoseArray, Quaternion, Twist, Vector3
from kit.msg.message import Message, is_custom_interface, type_name
from kit.msg.nav_msgs import Odometry
from kit.msg.sensor_msgs import LaserScan, NavSatStatus
from kit.msg.std_msgs import Empty, Header, String
from kit.msg.std_srvs import SetBool, Trigger


def test_constructors_take_keywords_only() -> None:
    assert Vector3(x=1.0, z=3.0) == Vector3(x=1.0, y=0.0, z=3.0)
    with pytest.raises(TypeError, match=r"write Vector3\(x=\.\.\.\)\. Its fields are x, y, z"):
        Vector3(1.0)
    with pytest.raises(TypeError, match=r"write Empty\(\)\. Its fields are none"):
        Empty(1.0)


def test_an_unknown_field_is_refused_with_the_nearest_name() -> None:
    with pytest.raises(
        FieldError, match=r"geometry_msgs/msg/Twist has no field 'liner' \(did you mean 'linear'\?\)"
    ):
        Twist(liner=Vector3())


def test_a_typo_in_an_attribute_is_refused_too() -> None:
    with pytest.raises(AttributeError):
        Twist().lineer = Vector3()


def test_every_message_starts_with_values_of_its_own() -> None:
    first, second = Odometry(), Odometry()
    first.pose.pose.position.x = 1.0
    first.pose.covariance[0] = 5.0
    assert second == Odometry()
    assert first != second


def test_defaults_are_those_of_the_definitions() -> None:
    assert Quaternion().w == 1.0
    assert Pose().orientation == Quaternion(w=1.0)
    assert NavSatStatus().status == NavSatStatus.STATUS_UNKNOWN == -2


def test_slots_and_fields_are_told() -> None:
    assert list(Header.__slots__) == ["_stamp", "_frame_id"]
    assert Header.get_fields_and_field_types() == {"stamp": "builtin_interfaces/Time", "frame_id": "string"}
    types = LaserScan().get_fields_and_field_types()
    assert list(types)[:2] == ["header", "angle_min"]
    assert (types["angle_min"], types["ranges"]) == ("float", "sequence<float>")
    assert PoseArray.get_fields_and_field_types()["poses"] == "sequence<geometry_msgs/Pose>"
    assert Odometry().pose.get_fields_and_field_types()["covariance"] == "double[36]"


def test_the_repr_is_nested_and_arrays_look_like_lists() -> None:
    vector = "geometry_msgs.msg.Vector3(x=0.0, y=0.0, z=0.0)"
    assert repr(Twist()) == f"geometry_msgs.msg.Twist(linear={vector}, angular={vector})"
    assert "ranges=[1.5, 2.0], intensities=[])" in repr(LaserScan(ranges=[1.5, 2.0]))
    assert repr(SetBool.Request(data=True)) == "std_srvs.srv.SetBool_Request(data=True)"
    assert "covariance=array([" in repr(Odometry())


def test_equality_looks_at_type_and_values() -> None:
    assert String(data="a") == String(data="a") != String(data="b")
    assert String() != Empty()
    assert LaserScan(ranges=[1.0]) == LaserScan(ranges=array("f", [1.0]))
    looked_at, never = Odometry(), Odometry()
    assert looked_at.pose.covariance.sum() == 0
    assert looked_at == never


def test_messages_cannot_be_hashed_as_in_ros() -> None:
    with pytest.raises(TypeError):
        hash(String())


def test_a_deep_copy_shares_nothing() -> None:
    original = Odometry()
    original.pose.covariance[3] = 1.0
    copied = copy.deepcopy(original)
    assert copied == original
    copied.pose.covariance[3] = 2.0
    copied.twist.twist.linear.x = 1.0
    assert original.pose.covariance[3] == 1.0
    assert original.twist.twist.linear.x == 0.0
    many = PoseArray(poses=[Pose()])
    copy.deepcopy(many).poses[0].position.x = 9.0
    assert many.poses[0].position.x == 0.0
    scan = LaserScan(ranges=[1.0])
    copy.deepcopy(scan).ranges[0] = 2.0
    assert scan.ranges[0] == 1.0


def test_check_fields_is_accepted_and_changes_nothing() -> None:
    assert Vector3(x=1.0, check_fields=True).x == 1.0
    with pytest.raises(FieldError):
        Vector3(x=1, check_fields=False)


def test_a_program_may_derive_its_own_variant() -> None:
    class Labelled(Header):
        def __init__(self, label: str) -> None:
            super().__init__(frame_id="map")
            self.label = label

    message = Labelled("here")
    assert (message.frame_id, message.stamp.sec, message.label) == ("map", 0, "here")
    assert type_name(Labelled) == "std_msgs/msg/Header"
    assert isinstance(copy.deepcopy(message), Labelled)
    assert Header(frame_id="map").frame_id == "map"


def test_services_have_requests_and_responses_and_no_instances() -> None:
    assert type_name(Trigger) == "std_srvs/srv/Trigger"
    assert type_name(MoveModel.Response) == "flatland_msgs/srv/MoveModel_Response"
    assert isinstance(MoveModel.Request(name="a"), Message)
    with pytest.raises(NotImplementedError, match=r"Trigger\.Request\(\)"):
        Trigger()


def test_what_is_ours_is_marked() -> None:
    from kit.msg.geometry_msgs import Pose2D

    assert is_custom_interface(Collision)
    assert is_custom_interface(MoveModel)
    assert is_custom_interface(Pose2D)
    assert not is_custom_interface(Twist)
    assert not is_custom_interface(SetBool)


def test_odd_values_of_fields_named_like_builtins() -> None:
    from kit.msg.rcl_interfaces import ParameterValue

    assert ParameterValue(type=3, double_value=0.5).type == 3


def test_numbers_of_a_fixed_array_read_the_same_before_and_after_a_look() -> None:
    stamped = Odometry()
    stamped.pose.covariance = [float(i) for i in range(36)]
    assert copy.deepcopy(stamped).pose.covariance.tolist() == list(np.arange(36.0))
    assert Time(sec=1, nanosec=2) == Time(sec=1, nanosec=2)


def test_messages_load_neither_numpy_nor_anything_heavy() -> None:
    code = (
        "import sys, kit.msg.interfaces as i; i.interface_names(); from kit.msg.nav_msgs import Odometry; import copy;"
        "m = copy.deepcopy(Odometry()); assert m == Odometry(); from kit.msg.conversion import to_dict; to_dict(m);"
        "print([n for n in ('numpy', 'rosbags', 'yaml') if n in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"
