"""Messages in CDR: every type there and back, as the distributions have them."""

from __future__ import annotations

from typing import Any

import pytest

from kit.msg.example_interfaces import WString
from kit.msg.interfaces import PACKAGES, fields_of, interfaces
from kit.msg.message import Message
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import Byte, String
from kit.ros.serialization import Distro, Serializer
from tests.cases import every_case

MESSAGES = [
    cls
    for package in PACKAGES
    for cls in interfaces(package)
    if issubclass(cls, Message) and cls is not WString  # rosbags does not know wstring
]


@pytest.fixture(scope="module", params=["humble", "jazzy"])
def serializer(request: pytest.FixtureRequest) -> Serializer:
    distro: Distro = request.param
    return Serializer(distro)


@every_case("cls", MESSAGES, ids=lambda cls: cls.__ros_type__)
def test_every_message_goes_there_and_back(cls: type[Message], serializer: Serializer) -> None:
    message: Any = cls()
    back = serializer.deserialize(serializer.serialize(message), cls)
    for field in fields_of(cls, serializer.distro):
        assert str(getattr(back, field.name)) == str(getattr(message, field.name))
    assert serializer.type_hash(cls).startswith("RIHS01_")
    assert serializer.definition(cls) or not fields_of(cls, serializer.distro)


def test_a_wide_string_is_refused_with_a_reason(serializer: Serializer) -> None:
    with pytest.raises(ValueError, match="WString: the field 'data' is a wstring"):
        serializer.serialize(WString(data="a"))


def test_values_survive_to_the_bit(serializer: Serializer) -> None:
    scan = LaserScan(ranges=[1.5, float("nan"), float("inf"), 0.1])
    scan.header.frame_id = "größe"
    back = serializer.deserialize(serializer.serialize(scan), LaserScan)
    assert back.ranges.tobytes() == scan.ranges.tobytes()
    assert back.header.frame_id == "größe"
    assert serializer.deserialize(serializer.serialize(Byte(data=b"\xff")), Byte).data == b"\xff"


@every_case("data", [b"", b"\0\1\0\0", b"\0\1\0\0\xff\xff\xff\x7fabc", b"\0\1\0\0\2\0\0\0\xff\xff"])
def test_broken_bytes_are_refused(data: bytes, serializer: Serializer) -> None:
    with pytest.raises(ValueError, match="std_msgs/msg/String"):
        serializer.deserialize(data, String)
