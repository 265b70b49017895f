"""Rotations and frames."""

from __future__ import annotations

import itertools
import math
import random

import numpy as np
import pytest

from kit.msg.builtin_interfaces import Time as Stamp
from kit.msg.geometry_msgs import Quaternion, Transform, TransformStamped, Vector3
from kit.msg.std_msgs import Header
from kit.ros import rotations as r
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node, create_graph_node
from kit.ros.node.time import ClockType, Duration, Time
from kit.ros.tf import (
    Buffer,
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    StaticTransformBroadcaster,
    TransformBroadcaster,
    TransformException,
    TransformListener,
)

AXES = [
    frame + "".join(axes)
    for frame in "sr"
    for axes in itertools.product("xyz", repeat=3)
    if axes[0] != axes[1] != axes[2]
]


def turn(axis: str, angle: float) -> np.ndarray:
    """The rotation matrix about one axis, from the textbook."""
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    matrix = np.identity(3)
    matrix[i, i] = matrix[j, j] = math.cos(angle)
    matrix[i, j], matrix[j, i] = -math.sin(angle), math.sin(angle)
    return matrix


class TestRotations:
    @pytest.mark.parametrize("axes", AXES)
    def test_three_turns_about_axes(self, axes: str) -> None:
        draw = random.Random(axes)
        for _ in range(20):
            angles = [draw.uniform(-math.pi, math.pi) for _ in range(3)]
            turns = [turn(axis, angle) for axis, angle in zip(axes[1:], angles, strict=True)]
            product = turns[2] @ turns[1] @ turns[0] if axes[0] == "s" else turns[0] @ turns[1] @ turns[2]
            quaternion = r.quaternion_from_euler(*angles, axes)
            assert np.allclose(r.quaternion_matrix(quaternion)[:3, :3], product)
            assert np.allclose(r.euler_matrix(*angles, axes)[:3, :3], product)
            back = r.quaternion_from_euler(*r.euler_from_quaternion(quaternion, axes), axes)
            assert np.allclose(r.quaternion_matrix(back)[:3, :3], product)

    @pytest.mark.parametrize("axes", AXES)
    def test_where_two_axes_become_one(self, axes: str) -> None:
        middle = 0.0 if axes[1] == axes[3] else math.pi / 2
        matrix = r.euler_matrix(0.3, middle, 0.4, axes)
        assert np.allclose(r.euler_matrix(*r.euler_from_matrix(matrix, axes), axes), matrix)

    def test_roll_pitch_yaw(self) -> None:
        assert r.quaternion_from_euler(0, 0, math.pi / 2) == pytest.approx(
            (0, 0, math.sqrt(0.5), math.sqrt(0.5))
        )
        assert r.euler_from_quaternion((0.0, 0.0, 1.0, 0.0)) == pytest.approx((0, 0, math.pi))
        assert r.euler_from_quaternion([0, 0, 0, 0]) == (0, 0, 0)
        for roll, pitch, yaw in ((0.1, -0.2, 3.0), (1.0, 1.5, -3.0)):
            assert r.euler_from_quaternion(r.quaternion_from_euler(roll, pitch, yaw)) == pytest.approx(
                (roll, pitch, yaw)
            )

    def test_products_inverses_and_axes(self) -> None:
        a, b = r.quaternion_from_euler(0.1, 0.2, 0.3), r.quaternion_about_axis(0.7, (0, 0, 2))
        product = r.quaternion_matrix(a) @ r.quaternion_matrix(b)
        assert np.allclose(r.quaternion_matrix(r.quaternion_multiply(a, b)), product)
        assert r.quaternion_multiply(a, r.quaternion_inverse(a)) == pytest.approx((0, 0, 0, 1))
        assert r.quaternion_conjugate(a) == pytest.approx(r.quaternion_inverse(a))
        assert np.allclose(np.abs(r.quaternion_from_matrix(r.quaternion_matrix(a))), np.abs(a))
        assert r.rotate_vector(b, (1, 0, 5)) == pytest.approx((math.cos(0.7), math.sin(0.7), 5))

    def test_half_way_is_half_the_turn(self) -> None:
        start, end = r.quaternion_from_euler(0, 0, 0.2), r.quaternion_from_euler(0, 0, 1.2)
        assert r.euler_from_quaternion(r.quaternion_slerp(start, end, 0.5))[2] == pytest.approx(0.7)
        negative = [-part for part in end]
        assert r.euler_from_quaternion(r.quaternion_slerp(start, negative, 0.5))[2] == pytest.approx(0.7)
        assert r.quaternion_slerp(start, start, 0.3) == pytest.approx(start)

    def test_matrices(self) -> None:
        there = r.concatenate_matrices(r.translation_matrix((1, 2, 3)), r.euler_matrix(0, 0, 1))
        assert np.allclose(r.translation_from_matrix(there), (1, 2, 3))
        assert np.allclose(r.inverse_matrix(there) @ there, r.identity_matrix())
        assert r.vector_norm((3, 4)) == 5
        assert np.allclose(r.unit_vector((0, 0, 3)), (0, 0, 1))

    @pytest.mark.parametrize("axes", ["", "xyz", "qxyz", "sxxy", "sxyw", "sxyzx"])
    def test_an_unknown_sequence(self, axes: str) -> None:
        with pytest.raises(ValueError, match="axis sequence"):
            r.quaternion_from_euler(0, 0, 0, axes)


def placed(parent: str, child: str, x: float, yaw: float = 0.0, seconds: float = 0.0) -> TransformStamped:
    qx, qy, qz, qw = r.quaternion_from_euler(0.0, 0.0, yaw)
    return TransformStamped(
        header=Header(stamp=Time(seconds=seconds).to_msg(), frame_id=parent),
        child_frame_id=child,
        transform=Transform(translation=Vector3(x=x), rotation=Quaternion(x=qx, y=qy, z=qz, w=qw)),
    )


def at(seconds: float) -> Time:
    return Time(seconds=seconds, clock_type=ClockType.ROS_TIME)


def where(buffer: Buffer, target: str, source: str, time: Time | Stamp) -> tuple[float, float, float]:
    """x, y and yaw of a frame in another one."""
    found = buffer.lookup_transform(target, source, time).transform
    q = found.rotation
    return found.translation.x, found.translation.y, r.euler_from_quaternion((q.x, q.y, q.z, q.w))[2]


class TestFrames:
    @pytest.fixture
    def buffer(self) -> Buffer:
        """map -> odom -> base -> laser, and map -> beacon."""
        buffer = Buffer()
        buffer.set_transform_static(placed("map", "odom", 10.0, math.pi / 2), "test")
        for second in (1.0, 2.0, 3.0):
            buffer.set_transform(placed("odom", "base", second, seconds=second), "test")
        buffer.set_transform_static(placed("base", "laser", 0.5), "test")
        buffer.set_transform_static(placed("map", "beacon", 4.0), "test")
        return buffer

    def test_up_down_and_across(self, buffer: Buffer) -> None:
        assert where(buffer, "odom", "base", at(2)) == pytest.approx((2, 0, 0))
        assert where(buffer, "map", "laser", at(2)) == pytest.approx((10, 2.5, math.pi / 2))
        assert where(buffer, "laser", "map", at(2)) == pytest.approx((-2.5, 10, -math.pi / 2))
        assert where(buffer, "beacon", "base", at(2)) == pytest.approx((6, 2, math.pi / 2))
        assert where(buffer, "base", "base", at(2)) == pytest.approx((0, 0, 0))

    def test_between_two_times_and_the_newest(self, buffer: Buffer) -> None:
        assert where(buffer, "odom", "base", at(1.25)) == pytest.approx((1.25, 0, 0))
        assert where(buffer, "odom", "base", at(1.25).to_msg()) == pytest.approx((1.25, 0, 0))
        newest = buffer.lookup_transform("odom", "laser", Time())
        assert newest.transform.translation.x == pytest.approx(3.5)
        assert newest.header.stamp == Stamp(sec=3)
        assert (newest.header.frame_id, newest.child_frame_id) == ("odom", "laser")

    def test_the_newest_is_what_all_frames_on_the_way_have(self, buffer: Buffer) -> None:
        for second in (1.0, 2.5):
            buffer.set_transform(placed("laser", "mirror", 0.0, seconds=second), "test")
        assert buffer.lookup_transform("odom", "mirror", Time()).header.stamp == Stamp(
            sec=2, nanosec=500_000_000
        )

    def test_later_news_out_of_order_are_sorted_in(self, buffer: Buffer) -> None:
        buffer.set_transform(placed("odom", "base", 9.0, seconds=1.5), "test")
        buffer.set_transform(placed("odom", "base", 7.0, seconds=1.5), "test")
        assert where(buffer, "odom", "base", at(1.5))[0] == pytest.approx(7)

    def test_old_news_are_forgotten(self) -> None:
        buffer = Buffer(cache_time=Duration(seconds=1))
        for second in (1.0, 2.0, 5.0):
            buffer.set_transform(placed("a", "b", second, seconds=second), "test")
        with pytest.raises(ExtrapolationException, match="past"):
            buffer.lookup_transform("a", "b", at(2))

    @pytest.mark.parametrize(
        ("target", "source", "seconds", "error"),
        [
            ("odom", "base", 0.5, ExtrapolationException),
            ("odom", "base", 3.5, ExtrapolationException),
            ("odom", "nowhere", 2, LookupException),
            ("", "base", 2, InvalidArgumentException),
            ("/odom", "base", 2, InvalidArgumentException),
            ("odom", "island", 2, ConnectivityException),
        ],
    )
    def test_what_cannot_be_had(
        self, buffer: Buffer, target: str, source: str, seconds: float, error: type[Exception]
    ) -> None:
        buffer.set_transform(placed("sea", "island", 1.0, seconds=2), "test")
        with pytest.raises(error):
            buffer.lookup_transform(target, source, at(seconds))
        assert not buffer.can_transform(target, source, at(seconds))
        possible, why = buffer.can_transform(target, source, at(seconds), return_debug_tuple=True)
        assert not possible
        assert why

    def test_frames_cannot_be_each_others_parents(self) -> None:
        buffer = Buffer()
        buffer.set_transform(placed("a", "b", 1.0), "test")
        buffer.set_transform(placed("b", "a", 1.0), "test")
        with pytest.raises(ConnectivityException):
            buffer.lookup_transform("a", "b", at(0))
        with pytest.raises(InvalidArgumentException):
            buffer.set_transform(placed("a", "a", 1.0), "test")

    def test_the_tree_can_be_shown_and_cleared(self, buffer: Buffer) -> None:
        assert "laser:\n  parent: 'base'" in buffer.all_frames_as_yaml()
        buffer.clear()
        assert not buffer.can_transform("map", "base")


class TestBroadcasting:
    def test_published_transforms_reach_the_buffer(self, graph: Graph) -> None:
        talker, listener = create_graph_node(graph, "talker"), create_graph_node(graph, "listener")
        static = StaticTransformBroadcaster(talker)
        static.sendTransform(placed("map", "odom", 1.0))
        static.sendTransform([placed("base", "laser", 0.25), placed("map", "odom", 2.0)])
        buffer = Buffer()
        TransformListener(buffer, listener)
        TransformBroadcaster(talker).sendTransform(placed("odom", "base", 3.0, seconds=1))
        graph.run_due()
        assert where(buffer, "map", "laser", at(1)) == pytest.approx((5.25, 0, 0))

    def test_a_listener_can_stop(self, graph: Graph) -> None:
        node, buffer = create_graph_node(graph, "node"), Buffer()
        TransformListener(buffer, node).unregister()
        TransformBroadcaster(node).sendTransform([placed("a", "b", 1.0)])
        graph.run_due()
        assert not buffer.can_transform("a", "b")

    def test_waiting_in_a_callback_that_the_news_would_wait_for_is_not_done(self, graph: Graph) -> None:
        node = create_graph_node(graph, "node")
        buffer, problems = Buffer(node=node), []

        def look(node: Node = node) -> None:
            try:
                buffer.lookup_transform("a", "b", at(0), timeout=Duration(seconds=1))
            except TransformException as problem:
                problems.append(problem)

        node.create_guard_condition(look).trigger()
        graph.run_due()
        assert len(problems) == 1
