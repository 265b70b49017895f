"""The numbers of messages by path: nested, listed, cut; and every path that a message shows leads to its value."""

from __future__ import annotations

import pytest

from kit.msg.field_values import MAX_ITEMS, MAX_MESSAGES, field_values, number_at
from kit.msg.flatland_msgs import Collision, Collisions
from kit.msg.geometry_msgs import PoseArray
from kit.msg.nav_msgs import Odometry
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import Bool, Byte, String
from kit.render.graph_layout import message_field_rows


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
