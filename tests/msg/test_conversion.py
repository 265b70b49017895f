"""Messages as plain data and back, and their numbers by path: nested, listed, cut; every path that is shown leads to its value."""

from __future__ import annotations

import json
import math
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.msg.conversion import (
    MAX_ITEMS,
    MAX_MESSAGES,
    ConversionError,
    field_values,
    from_dict,
    number_at,
    to_dict,
)
from kit.msg.fields import FieldKind, FixedArrayKind, MessageKind, ScalarKind, SequenceKind
from kit.msg.flatland_msgs import Collision, Collisions
from kit.msg.geometry_msgs import PoseArray, Twist
from kit.msg.interfaces import PACKAGES, interfaces
from kit.msg.message import Message
from kit.msg.nav_msgs import Odometry, Path
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import Bool, Byte, ByteMultiArray, Float32MultiArray, String, UInt8MultiArray
from kit.render.message_rows import message_field_rows
from tests.cases import every_case

MESSAGES = [cls for package in PACKAGES for cls in interfaces(package) if issubclass(cls, Message)]


def values_of(kind: FieldKind) -> st.SearchStrategy[Any]:
    """Values that a field of this kind takes."""
    if isinstance(kind, MessageKind):
        return messages_of(kind.cls)
    if isinstance(kind, SequenceKind):
        return st.lists(values_of(kind.item), max_size=min(3, kind.bound or 3))
    if isinstance(kind, FixedArrayKind):
        return st.lists(values_of(kind.item), min_size=kind.length, max_size=kind.length)
    assert isinstance(kind, ScalarKind)
    if kind.python_type is int:
        return st.integers(int(kind.low), int(kind.high))
    if kind.python_type is float:
        return st.floats(width=32 if kind.type_code == "f" else 64, allow_nan=False)
    return {bool: st.booleans(), str: st.text(max_size=5), bytes: st.binary(min_size=1, max_size=1)}[
        kind.python_type
    ]


def messages_of(cls: type[Message]) -> st.SearchStrategy[Message]:
    return st.builds(cls, **{field.name: values_of(field.kind) for field in cls.__ros_fields__})


@pytest.mark.long
@given(st.sampled_from(MESSAGES).flatmap(messages_of))
def test_there_and_back_through_json_gives_the_same_message(message: Message) -> None:
    assert from_dict(type(message), json.loads(json.dumps(to_dict(message)))) == message


def test_plain_data_is_plain() -> None:
    data = to_dict(Odometry())
    assert data["header"] == {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}
    assert data["pose"]["covariance"] == [0.0] * 36
    looked_at = Odometry()
    looked_at.pose.covariance[0] = 1.0
    assert to_dict(looked_at)["pose"]["covariance"][0] == 1.0
    assert to_dict(Byte(data=b"\7")) == {"data": 7}
    assert to_dict(ByteMultiArray(data=[b"\7"]))["data"] == [7]


def test_a_scan_without_hits_survives_json() -> None:
    scan = from_dict(LaserScan, json.loads(json.dumps(to_dict(LaserScan(ranges=[math.nan, math.inf])))))
    assert math.isnan(scan.ranges[0])
    assert scan.ranges[1] == math.inf


def test_whole_numbers_do_for_floats_as_people_write_them_in_yaml() -> None:
    assert from_dict(Twist, {"linear": {"x": 1}}).linear.x == 1.0
    assert from_dict(LaserScan, {"ranges": [1, 2.5]}).ranges.tolist() == [1.0, 2.5]
    assert from_dict(Odometry, {"pose": {"covariance": [1] * 36}}).pose.covariance.dtype == np.float64


def test_what_is_not_given_keeps_its_default() -> None:
    assert from_dict(Path, {}) == Path()
    assert from_dict(Odometry, {"pose": {"pose": {"position": {"x": 1.0}}}}).pose.pose.orientation.w == 1.0


@every_case(
    ("cls", "data", "said"),
    [
        (Twist, {"liner": {}}, "geometry_msgs/msg/Twist has no field 'liner'; did you mean 'linear'?"),
        (Twist, {"linear": {"x": "fast"}}, "linear.x: needs a number, not str 'fast'"),
        (Twist, {"linear": {"x": 10**400}}, "linear.x: a whole number too large for a float"),
        (Twist, {"linear": {"x": True}}, "linear.x: needs a number, not bool True"),
        (Twist, {"linear": None}, "linear: geometry_msgs/msg/Vector3 needs its fields by name, not nothing"),
        (Twist, [1, 2], "needs its fields by name, not list"),
        (Odometry, {"pose": {"pose": {"position": {"q": 1}}}}, "pose.pose.position: geometry_msgs/msg/Point"),
        (Odometry, {"pose": {"covariance": [0.0]}}, "exactly 36 items, not 1"),
        (LaserScan, {"ranges": 5}, "ranges: needs a list, not int 5"),
        (LaserScan, {"ranges": [1.0, "a"]}, "ranges[1]: needs a number, not str 'a'"),
        (LaserScan, {"ranges": [1e39]}, "ranges[0]"),
        (LaserScan, {"header": {"stamp": {"sec": 2**40}}}, "header.stamp.sec"),
        (
            LaserScan,
            {"header": {"stamp": {"sec": 1.5}}},
            "header.stamp.sec: needs a whole number, not float 1.5",
        ),
        (LaserScan, {"header": {"frame_id": 5}}, "header.frame_id: needs a text, not int 5"),
        (UInt8MultiArray, {"data": [1, 256]}, "data[1]"),
        (UInt8MultiArray, {"data": [True]}, "data[0]: needs a whole number, not bool True"),
        (Float32MultiArray, {"data": "abc"}, "data: needs a list, not str 'abc'"),
        (Byte, {"data": 256}, "data: needs a number, 0 to 255, not int 256"),
        (
            Path,
            {"poses": [{"pose": {"position": {"x": []}}}]},
            "poses[0].pose.position.x: needs a number, not list []",
        ),
    ],
)
def test_what_does_not_fit_is_refused_with_its_place(cls: type[Message], data: Any, said: str) -> None:
    with pytest.raises(ConversionError) as problem:
        from_dict(cls, data)
    assert said in str(problem.value)


@given(
    st.sampled_from(MESSAGES),
    st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=3),
        lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner, max_size=3),
        max_leaves=8,
    ),
)
def test_any_data_gives_a_message_or_an_explanation(cls: type[Message], data: Any) -> None:
    fields = [field.name for field in cls.__ros_fields__]
    for candidate in (data, dict.fromkeys(fields, data)):
        with suppress(ConversionError):
            assert isinstance(from_dict(cls, candidate), cls)


def test_nested_fields_have_paths_and_texts_are_left_out() -> None:
    message = Odometry()
    message.pose.pose.position.x = 1.5
    message.twist.covariance[7] = 0.25
    values = field_values(message)
    assert number_at(values, "pose.pose.position.x") == 1.5
    assert number_at(values, "twist.covariance[7]") == 0.25
    assert number_at(values, "twist.covariance[36]") is None
    assert number_at(values, "pose.pose.position.x[0]") is None
    assert number_at(values, "child_frame_id") is None
    assert "header.frame_id" not in values


def test_long_lists_are_cut_and_copied() -> None:
    scan = LaserScan(ranges=[0.0] * 1000)
    values = field_values(scan)
    scan.ranges[0] = 5.0
    assert number_at(values, "ranges[0]") == 0.0
    assert number_at(values, f"ranges[{MAX_ITEMS - 1}]") == 0.0
    assert number_at(values, f"ranges[{MAX_ITEMS}]") is None
    poses = field_values(PoseArray(poses=[Odometry().pose.pose for _ in range(MAX_MESSAGES + 4)]))
    assert number_at(poses, f"poses[{MAX_MESSAGES - 1}].position.z") == 0.0
    assert number_at(poses, f"poses[{MAX_MESSAGES}].position.z") is None


def test_truth_values_and_bytes_are_numbers() -> None:
    assert number_at(field_values(Bool(data=True)), "data") == 1.0
    assert number_at(field_values(Byte(data=b"\x07")), "data") == 7.0
    assert field_values(String(data="word")) == {}


@pytest.mark.parametrize(
    "message", [Odometry(), LaserScan(ranges=[1.0]), PoseArray(poses=[Odometry().pose.pose])]
)
def test_the_rows_of_a_message_name_the_same_fields(message: Odometry | LaserScan | PoseArray) -> None:
    shown = {path for path, _ in message_field_rows(message, 80) if path}
    assert shown >= field_values(message).keys()
    assert {path.rpartition(".")[2] for path in shown - field_values(message).keys()} <= {
        "frame_id",
        "child_frame_id",
    }


def test_messages_in_lists_are_told_apart_by_their_index() -> None:
    message = Collisions(collisions=[Collision(entity_a="robot"), Collision(entity_a="other")])
    paths = {text.strip(" -"): path for path, text in message_field_rows(message, 80) if "entity_a" in text}
    assert paths == {"entity_a: robot": "collisions[0].entity_a", "entity_a: other": "collisions[1].entity_a"}
