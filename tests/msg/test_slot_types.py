"""The types of fields are those of rosidl_parser.definition, of every message that the kit brings."""

from __future__ import annotations

import pytest

from kit.msg import geometry_msgs, nav_msgs, sensor_msgs, std_msgs
from kit.msg.slot_types import (
    AbstractNestedType,
    AbstractType,
    Array,
    BasicType,
    BoundedSequence,
    BoundedString,
    BoundedWString,
    NamespacedType,
    UnboundedSequence,
    UnboundedString,
    slot_type,
)


@pytest.mark.parametrize(
    ("idl", "expected"),
    [
        ("boolean", BasicType("boolean")),
        ("string", UnboundedString()),
        ("string<10>", BoundedString(10)),
        ("sequence<wstring<3>, 2>", BoundedSequence(BoundedWString(3), 2)),
        ("octet[4]", Array(BasicType("octet"), 4)),
        ("sequence<double, 5>", BoundedSequence(BasicType("double"), 5)),
        ("sequence<std_msgs/Header>", UnboundedSequence(NamespacedType(("std_msgs", "msg"), "Header"))),
    ],
)
def test_a_type_is_read(idl: str, expected: AbstractType) -> None:
    assert slot_type(idl) == expected


def test_a_message_tells_the_type_of_each_slot() -> None:
    odometry = nav_msgs.Odometry()
    types = dict(zip(odometry.__slots__, odometry.SLOT_TYPES, strict=True))
    assert types["_header"] == NamespacedType(("std_msgs", "msg"), "Header")
    assert types["_child_frame_id"] == UnboundedString()
    assert geometry_msgs.PoseWithCovariance.SLOT_TYPES[1] == Array(BasicType("double"), 36)
    assert std_msgs.Empty.SLOT_TYPES == ()


def test_a_program_that_looks_into_any_message_tells_lists_from_values() -> None:
    scan = sensor_msgs.LaserScan(ranges=[1.0, 2.0])
    lists = [
        slot.lstrip("_")
        for slot, kind in zip(scan.__slots__, scan.SLOT_TYPES, strict=True)
        if isinstance(kind, AbstractNestedType) and not kind.has_maximum_size()
    ]
    assert lists == ["ranges", "intensities"]
