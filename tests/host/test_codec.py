"""Messages on the pipe: every type there is, to the bit, and nothing that does not fit."""

from __future__ import annotations

import math
import random
from array import array
from typing import Any

import pytest

from kit.host.codec import Codec, NotFiniteError
from kit.host.wire import HEADER, Json, ProtocolError, decode, encode
from kit.msg.fields import FLOAT32, FieldKind, FixedArrayKind, MessageKind, ScalarKind, SequenceKind
from kit.msg.geometry_msgs import Twist, TwistWithCovariance
from kit.msg.interfaces import find_message, interface_names
from kit.msg.message import Message
from kit.msg.rcl_interfaces import ParameterValue
from kit.msg.sensor_msgs import BatteryState, LaserScan, NavSatFix, Range
from kit.msg.std_msgs import ByteMultiArray, Float32, Float64MultiArray, Int8, String, UInt64
from tests.cases import every_case

OURS, CHILDS = Codec(in_child=False), Codec(in_child=True)
MESSAGES = [name for name in interface_names() if "/msg/" in name]


def filled(kind: FieldKind, chance: random.Random) -> Any:
    """Some value of this kind."""
    if isinstance(kind, MessageKind):
        return some_message(kind.cls, chance)
    if isinstance(kind, FixedArrayKind):
        return [filled(kind.item, chance) for _ in range(kind.length)]
    if isinstance(kind, SequenceKind):
        return [filled(kind.item, chance) for _ in range(chance.randint(0, min(3, kind.bound or 3)))]
    assert isinstance(kind, ScalarKind)
    if kind.python_type is float:
        value = chance.gauss(0, 1000)
        return array("f", [value])[0] if kind is FLOAT32 else value
    if kind.python_type is int:
        return chance.randint(int(kind.low), int(kind.high))
    return {bool: chance.random() < 0.5, str: "Grüße\n\t\x1b", bytes: bytes([chance.randrange(256)])}[
        kind.python_type
    ]


def some_message(cls: type[Message], chance: random.Random) -> Message:
    return cls(**{field.name: filled(field.kind, chance) for field in cls.__ros_fields__})


def carried(content: Json) -> Json:
    return decode(encode(content)[HEADER.size :])


@every_case("name", MESSAGES)
def test_every_message_travels_both_ways(name: str) -> None:
    cls, chance = find_message(name), random.Random(name)
    for message in (cls(), some_message(cls, chance), some_message(cls, chance)):
        for sender, receiver in ((OURS, CHILDS), (CHILDS, OURS)):
            assert receiver.unpack(cls, carried(sender.pack(message))) == message


def test_what_somebody_has_looked_at_travels_too() -> None:
    """A fixed array becomes one of numpy's when it is read."""
    message = TwistWithCovariance()
    message.covariance[3] = 0.25
    copy = CHILDS.unpack(TwistWithCovariance, carried(OURS.pack(message)))
    assert copy.covariance[3] == 0.25


def test_readings_may_be_infinite() -> None:
    scan = LaserScan(ranges=array("f", [math.nan, math.inf, -math.inf, -0.0]))
    for sender, receiver in ((OURS, CHILDS), (CHILDS, OURS)):
        assert (
            receiver.unpack(LaserScan, carried(sender.pack(scan))).ranges.tobytes() == scan.ranges.tobytes()
        )
    for sender, receiver in ((OURS, CHILDS), (CHILDS, OURS)):
        for message in (
            Range(range=math.inf),
            NavSatFix(latitude=math.nan, position_covariance=[math.inf] * 9),
            BatteryState(current=math.nan, cell_voltage=[math.nan, 3.7]),
            Float32(data=math.inf),
            ParameterValue(double_value=math.inf, double_array_value=array("d", [math.nan])),
            Float64MultiArray(data=[0.5, -math.inf]),
        ):
            copy = receiver.unpack(type(message), carried(sender.pack(message)))
            assert repr(copy) == repr(message)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_childs_commands_may_not(value: float) -> None:
    twist = Twist()
    twist.angular.z = value
    with pytest.raises(NotFiniteError, match=r"^angular\.z$"):
        CHILDS.pack(twist)
    with pytest.raises(ProtocolError):
        OURS.unpack(Twist, carried(OURS.pack(twist)))
    assert repr(CHILDS.unpack(Twist, carried(OURS.pack(twist))).angular.z) == repr(value)
    covariance = TwistWithCovariance()
    covariance.covariance[7] = value
    with pytest.raises(NotFiniteError, match=r"^covariance$"):
        CHILDS.pack(covariance)


@every_case(
    ("cls", "content"),
    [
        (Twist, None),
        (Twist, {}),
        (Twist, [[0.0, 0.0, 0.0]]),
        (Twist, [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], 0]),
        (Twist, [[0.0, 0.0], [0.0, 0.0, 0.0]]),
        (Twist, [[0.0, 0.0, "0"], [0.0, 0.0, 0.0]]),
        (Twist, [[0.0, 0.0, True], [0.0, 0.0, 0.0]]),
        (Twist, [[0.0, 0.0, None], [0.0, 0.0, 0.0]]),
        (Twist, [[0.0, 0.0, "nan"], [0.0, 0.0, 0.0]]),
        (Twist, [[0.0, 0.0, 10**30], [0.0, 0.0, 0.0]]),
        (Int8, [128]),
        (Int8, [-129]),
        (Int8, [1.0]),
        (Int8, [True]),
        (UInt64, [2**64]),
        (UInt64, [-1]),
        (String, [3]),
        (String, [None]),
        (String, [["a"]]),
        (ByteMultiArray, [[[], 0], ["QQ=="]]),
        (ByteMultiArray, [[[], 0], [256]]),
        (TwistWithCovariance, [[[0.0] * 3, [0.0] * 3], "AAAA"]),
        (TwistWithCovariance, [[[0.0] * 3, [0.0] * 3], "not base64!"]),
        (TwistWithCovariance, [[[0.0] * 3, [0.0] * 3], [0.0] * 36]),
    ],
    ids=str,
)
def test_what_does_not_fit_is_refused(cls: type[Message], content: Json) -> None:
    with pytest.raises(ProtocolError):
        OURS.unpack(cls, content)


def test_text_that_is_no_text_is_mended() -> None:
    assert OURS.unpack(String, ["half \ud800"]).data == "half ?"
