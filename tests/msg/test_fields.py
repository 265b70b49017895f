"""What a field of a message takes, what it refuses, and what it then says."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable

import numpy as np
import pytest

from kit.msg.builtin_interfaces import Time
from kit.msg.fields import FieldError
from kit.msg.geometry_msgs import PoseArray, PoseWithCovariance, Twist, Vector3
from kit.msg.message import Message, check_message
from kit.msg.rcl_interfaces import IntegerRange, ParameterDescriptor, ParameterValue
from kit.msg.sensor_msgs import Imu, JointState, LaserScan
from kit.msg.std_msgs import (
    Bool,
    Byte,
    ByteMultiArray,
    Char,
    Float32,
    Int8,
    String,
    UInt8,
    UInt8MultiArray,
    UInt64,
)
from tests.cases import every_case


@every_case("data", [1.0, -0.0, math.inf, math.nan, np.float64(2.5)])
def test_a_float_field_takes_every_float(data: float) -> None:
    assert Vector3(x=data).x == data or math.isnan(data)


def test_a_whole_number_is_no_float_and_the_error_writes_the_right_one() -> None:
    twist = Twist()
    with pytest.raises(FieldError, match=r"The 'x' field must be of type 'float', not int: write 3\.0"):
        twist.linear.x = 3
    assert twist.linear.x == 0.0


def test_the_error_is_the_one_ros_raises() -> None:
    with pytest.raises(AssertionError):
        Vector3(x=1)


@every_case(
    ("make", "hint"),
    [
        (lambda: Float32(data=np.float32(1.5)), "float(...)"),
        (lambda: Int8(data=np.int64(1)), "int(...)"),
        (lambda: Int8(data=1.0), "int(...)"),
        (lambda: String(data=5), "str(...)"),
        (lambda: Bool(data=1), "True"),
        (lambda: Twist(linear=Vector3), "Vector3()"),
        (lambda: LaserScan(ranges=np.zeros(3, dtype=np.float32)), ".tolist()"),
        (lambda: LaserScan(ranges=(float(i) for i in range(3))), "list(...)"),
        (lambda: PoseWithCovariance(covariance=np.zeros(36, dtype=np.float32)), ".astype('float64')"),
    ],
)
def test_a_refusal_names_the_way_out(make: Callable[[], Message], hint: str) -> None:
    with pytest.raises(FieldError) as refusal:
        make()
    assert hint in str(refusal.value)


@pytest.mark.parametrize(
    ("cls", "low", "high"), [(Int8, -128, 127), (UInt8, 0, 255), (UInt64, 0, 2**64 - 1), (Char, 0, 255)]
)
def test_a_whole_number_keeps_to_its_range(cls: type[Message], low: int, high: int) -> None:
    assert [cls(data=low).data, cls(data=high).data] == [low, high]
    for beyond in (low - 1, high + 1):
        with pytest.raises(FieldError, match=f"{low} to {high}"):
            cls(data=beyond)


def test_a_truth_value_is_a_whole_number_and_travels_as_one() -> None:
    message = UInt8(data=True)
    assert (message.data, type(message.data)) == (1, int)
    message.data = False
    assert type(message.data) is int
    with pytest.raises(FieldError):
        Float32(data=True)


def test_a_float32_has_a_range_but_may_be_infinite() -> None:
    assert Float32(data=-math.inf).data == -math.inf
    with pytest.raises(FieldError):
        Float32(data=1e39)


def test_a_byte_is_one_byte() -> None:
    assert Byte().data == b"\0"
    assert Byte(data=b"x").data == b"x"
    for wrong in (b"", b"xy", 7):
        with pytest.raises(FieldError):
            Byte(data=wrong)


class TestSequences:
    def test_numbers_become_an_array_rounded_to_their_size(self) -> None:
        scan = LaserScan(ranges=[0.1, 2.0])
        assert isinstance(scan.ranges, array)
        assert scan.ranges.typecode == "f"
        assert scan.ranges[0] == np.float32(0.1)
        assert scan.ranges.index(2.0) == 1

    def test_an_array_of_the_right_kind_is_kept_as_it_is(self) -> None:
        ranges = array("f", [1.0])
        assert LaserScan(ranges=ranges).ranges is ranges

    def test_an_array_of_another_kind_is_refused(self) -> None:
        with pytest.raises(FieldError, match=r"array\('f'.*not array\('d'"):
            LaserScan(ranges=array("d", [1.0]))

    @pytest.mark.parametrize("values", [(1.0,), [1.0], {1.0}, range(0)])
    def test_sequences_and_sets_do(self, values: object) -> None:
        assert list(LaserScan(ranges=values).ranges) == list(values)

    def test_one_wrong_item_is_named(self) -> None:
        with pytest.raises(FieldError, match=r"ranges\[2\]"):
            LaserScan(ranges=[1.0, 2.0, 3])

    def test_bytes_are_numbers(self) -> None:
        assert UInt8MultiArray(data=b"\1\2").data == array("B", [1, 2])

    @pytest.mark.parametrize("wrong", ["text", 5, None])
    def test_what_is_no_sequence_is_refused(self, wrong: object) -> None:
        with pytest.raises(FieldError):
            LaserScan(ranges=wrong)

    def test_texts_truths_and_bytes_are_lists(self) -> None:
        assert JointState(name=("a", "b")).name == ["a", "b"]
        assert ParameterValue(bool_array_value=[True]).bool_array_value == [True]
        assert ByteMultiArray(data=[b"a"]).data == [b"a"]
        with pytest.raises(FieldError, match=r"name\[1\]"):
            JointState(name=["a", 2])

    def test_a_list_of_messages_stays_the_callers_list(self) -> None:
        poses: list[object] = []
        message = PoseArray(poses=poses)
        poses.append(5)
        assert message.poses == [5]
        with pytest.raises(FieldError, match=r"poses\[0\]"):
            check_message(message)

    def test_a_bound_holds(self) -> None:
        two = [IntegerRange(), IntegerRange()]
        with pytest.raises(FieldError, match="at most 1 items, not 2"):
            ParameterDescriptor(integer_range=two)


class TestFixedArrays:
    def test_they_are_numpy_arrays_and_stay_the_same_one(self) -> None:
        message = PoseWithCovariance()
        assert message.covariance.dtype == np.float64
        message.covariance[7] = 0.25
        assert message.covariance[7] == 0.25
        assert message.covariance.shape == (36,)

    def test_lists_do_if_they_have_the_length(self) -> None:
        assert PoseWithCovariance(covariance=[0.5] * 36).covariance[35] == 0.5
        with pytest.raises(FieldError, match="exactly 36 items, not 3"):
            PoseWithCovariance(covariance=[0.0] * 3)
        with pytest.raises(FieldError, match=r"covariance\[0\]"):
            PoseWithCovariance(covariance=[0] * 36)

    def test_a_numpy_array_must_have_the_size(self) -> None:
        with pytest.raises(FieldError, match="exactly 9 items, not 8"):
            Imu(orientation_covariance=np.zeros(8))


def test_a_check_finds_what_was_put_in_at_any_depth() -> None:
    message = PoseArray()
    check_message(message)
    message.header.stamp = Time(sec=1)
    message.poses.append(None)
    with pytest.raises(FieldError, match=r"poses\[0\]"):
        check_message(message)
