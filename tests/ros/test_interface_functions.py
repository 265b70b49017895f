"""Interfaces by name, and messages as data, as rosidl_runtime_py has them."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
import yaml

from kit.msg.builtin_interfaces import Time
from kit.msg.geometry_msgs import PoseStamped, Twist
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_srvs import SetBool
from kit.msg.turtlesim import RotateAbsolute
from kit.ros.interface_functions import (
    get_action,
    get_interface,
    get_interface_packages,
    get_interface_path,
    get_message,
    get_message_interfaces,
    get_service,
    is_message,
    message_to_csv,
    message_to_ordereddict,
    message_to_yaml,
    set_message_fields,
)


def test_interfaces_are_found_by_name() -> None:
    assert get_message("geometry_msgs/msg/Twist") is get_message("geometry_msgs/Twist") is Twist
    assert get_service("std_srvs/srv/SetBool") is get_interface("std_srvs/srv/SetBool") is SetBool
    assert get_action("turtlesim/action/RotateAbsolute") is RotateAbsolute
    assert [is_message(each) for each in (Twist, SetBool, Twist())] == [True, False, False]
    with pytest.raises(ValueError, match="geometry_msgs"):
        get_message("geometry_msgs")
    with pytest.raises(ModuleNotFoundError):
        get_message("nobodys_msgs/msg/Thing")
    with pytest.raises(LookupError):
        get_message("geometry_msgs/msg/Twits")


def test_interfaces_are_listed() -> None:
    assert "std_srvs" in get_interface_packages()
    assert "msg/Twist" in get_message_interfaces(["geometry_msgs"])["geometry_msgs"]
    assert get_message_interfaces(["std_srvs"]) == {"std_srvs": []}
    assert "float64" in Path(get_interface_path("geometry_msgs/msg/Point")).read_text("utf-8")


def test_a_message_as_data() -> None:
    scan = LaserScan(ranges=[1.0, math.inf, 3.0], range_max=8.0)
    scan.header.frame_id = "base_scan"
    data = message_to_ordereddict(scan)
    assert list(data) == list(LaserScan.get_fields_and_field_types())
    assert (data["header"]["frame_id"], data["ranges"]) == ("base_scan", [1.0, math.inf, 3.0])
    assert (
        yaml.safe_load(message_to_yaml(scan))
        == yaml.safe_load(message_to_yaml(scan, flow_style=True))
        == data
    )
    assert message_to_csv(Twist()).split(",") == ["0.0"] * 6
    assert message_to_ordereddict(scan, truncate_length=1)["ranges"] == [1.0, "..."]
    assert "length: 3" in message_to_ordereddict(scan, no_arr=True)["ranges"]


def test_fields_are_set_and_others_stay() -> None:
    twist = Twist()
    twist.linear.y = 2.0
    assert set_message_fields(twist, {"linear": {"x": 1}, "angular": {"z": -0.5}}) == []
    assert (twist.linear.x, twist.linear.y, twist.angular.z) == (1.0, 2.0, -0.5)
    pose = PoseStamped()
    stamps = set_message_fields(pose, {"header": "auto"}, expand_header_auto=True)
    for stamp in stamps:
        stamp(Time(sec=7))
    assert pose.header.stamp.sec == 7
    with pytest.raises(AttributeError):
        set_message_fields(twist, {"liner": {}})
    with pytest.raises(TypeError):
        set_message_fields(twist, {"linear": 3})
    with pytest.raises(ValueError, match=r"x"):
        set_message_fields(twist, {"linear": {"x": "fast"}})
