"""Messages as text: YAML that YAML readers read, short enough for a screen."""

from __future__ import annotations

import math

import pytest
import yaml

from kit.msg.conversion import to_dict
from kit.msg.flatland_msgs import Collision, Collisions
from kit.msg.geometry_msgs import Twist
from kit.msg.message import Message
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import Float32, String
from kit.msg.std_srvs import Empty, SetBool
from kit.render.graph_data import MAX_NUMBER_ROWS, message_rows
from tests.cases import every_case


def twist() -> Twist:
    message = Twist()
    message.linear.x, message.angular.z = 0.5, -1.25
    return message


def test_a_twist_as_ros_echoes_it() -> None:
    assert message_rows(twist(), 80) == [
        "linear:",
        "  x: 0.5",
        "  y: 0.0",
        "  z: 0.0",
        "angular:",
        "  x: 0.0",
        "  y: 0.0",
        "  z: -1.25",
    ]


def test_a_compact_twist_takes_two_rows() -> None:
    assert message_rows(twist(), 80, compact=True) == [
        "linear: {x: 0.5, y: 0.0, z: 0.0}",
        "angular: {x: 0.0, y: 0.0, z: -1.25}",
    ]


@every_case("compact", [False, True])
@every_case(
    "message",
    [
        twist(),
        LaserScan(ranges=[1.5, math.inf, 0.25]),
        String(data="p_up"),
        String(data=""),
        String(data="yes: no # 'maybe'"),
        String(data="true"),
        Float32(data=math.nan),
        SetBool.Request(data=True),
        Empty.Request(),
        Collisions(collisions=[Collision(entity_a="robot", entity_b="wall"), Collision(entity_a="other")]),
    ],
    ids=lambda message: type(message).__name__ if isinstance(message, Message) else str(message),
)
def test_it_is_yaml_of_the_same_values(message: Message, compact: bool) -> None:
    read = yaml.safe_load("\n".join(message_rows(message, 200, compact=compact)))
    assert repr(read) == repr(to_dict(message))


def test_long_lists_are_cut_with_their_length() -> None:
    scan = LaserScan(ranges=[float(number) for number in range(91)])
    rows = message_rows(scan, 60)
    assert max(map(len, rows)) <= 60
    first = next(number for number, row in enumerate(rows) if row.startswith("ranges"))
    ranges = rows[first : first + MAX_NUMBER_ROWS]
    assert ranges[0].startswith("ranges: [0.0, 1.0, ")
    assert ranges[-1].endswith(" ... 91 in all]")
    assert rows[first + MAX_NUMBER_ROWS] == "intensities: []"


@pytest.mark.parametrize("width", [8, 20, 40])
def test_no_row_is_wider_than_asked(width: int) -> None:
    for compact in (False, True):
        assert max(map(len, message_rows(twist(), width, compact=compact))) <= width
