"""What arrives from a wire while the world does not take it: so much waits, and a stop is never lost."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from kit.bridge.channels import MAX_WAITING, ChannelContext, ReceivedTopic, ServedService, WireCodec
from kit.bridge.motion_guard import MotionGuard, SpeedLimit
from kit.bridge.wire import BridgeRoute, Direction, DryRunWire, InterfaceId, OnMessage, Reply
from kit.msg.geometry_msgs import Twist, Vector3
from kit.msg.std_msgs import Int32
from kit.msg.std_srvs import SetBool
from kit.ros.execution.callback_groups import ReentrantCallbackGroup
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.ros.node.qos import QoSProfile


class WireFromTest(DryRunWire):
    """A wire whose messages and requests the test makes."""

    receive: OnMessage
    request: Callable[[bytes, Reply], None]

    def open_subscription(
        self, name: str, interface: InterfaceId, qos: QoSProfile, on_message: OnMessage
    ) -> None:
        self.receive = on_message

    def open_service(
        self, name: str, interface: InterfaceId, on_request: Callable[[bytes, Reply], None]
    ) -> None:
        self.request = on_request


class World:
    """A world's end of the wire."""

    def __init__(self) -> None:
        self.graph = Graph(log_sink=lambda record: None)
        self.wire, self.codec = WireFromTest(), WireCodec("jazzy")
        self.lines: list[str] = []
        self.heard: list[Any] = []
        self.node = create_graph_node(self.graph, "mine")
        bridge = create_graph_node(self.graph, "kit_bridge")
        self.context = ChannelContext(
            bridge, self.wire, self.codec, self.lines.append, ReentrantCallbackGroup()
        )

    def received(self, cls: type[Any], guard: MotionGuard | None = None) -> ReceivedTopic:
        """The channel of a topic, whose messages are in ``heard`` after ``run_due``."""
        qos = QoSProfile(depth=2 * MAX_WAITING)
        self.node.create_subscription(cls, "/topic", self.heard.append, qos)
        route = BridgeRoute.parse(Direction.RECEIVE, "/topic")
        return ReceivedTopic(route, self.codec.topic_interface(cls), self.context, cls, qos, guard)


@pytest.fixture
def world() -> World:
    return World()


@pytest.mark.parametrize("count", [MAX_WAITING, MAX_WAITING + 1])
def test_of_messages_that_wait_the_newest_are_kept(world: World, count: int) -> None:
    channel = world.received(Int32)
    for number in range(count):
        world.wire.receive(world.codec.serialize(Int32(data=number)), 0.0)
    channel.deliver()
    world.graph.run_due()
    assert [each.data for each in world.heard] == list(range(count))[-MAX_WAITING:]


@pytest.mark.parametrize("is_lifted", [False, True])
def test_messages_that_arrive_after_a_stop_do_not_push_it_out(world: World, is_lifted: bool) -> None:
    guard = MotionGuard(Twist, SpeedLimit(), watchdog_s=60.0)
    channel = world.received(Twist, guard)

    def command(forward: float) -> None:
        world.wire.receive(world.codec.serialize(Twist(linear=Vector3(x=forward))), 0.0)

    command(0.1)
    channel.deliver()
    command(0.2)
    guard.stop()
    channel.send_stop()
    if is_lifted:
        guard.resume()
    for _ in range(MAX_WAITING + 1):
        command(0.3)
    channel.deliver()
    world.graph.run_due()
    speeds = [each.linear.x for each in world.heard]
    assert speeds == [0.1, 0.0, *[0.3] * (MAX_WAITING if is_lifted else 0)]


@pytest.mark.parametrize("beyond", [0, 1])
def test_of_requests_that_wait_the_oldest_gets_no_answer_and_that_is_said(world: World, beyond: int) -> None:
    def switch(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        response.success = request.data
        return response

    world.node.create_service(SetBool, "/switch", switch)
    route = BridgeRoute.parse(Direction.SERVE, "/switch")
    channel = ServedService(route, world.codec.service_interface(SetBool), world.context, SetBool)
    answered: list[int] = []
    for number in range(MAX_WAITING + beyond):
        request = world.codec.serialize(SetBool.Request(data=True))
        world.wire.request(request, lambda data, number=number: answered.append(number))
    channel.deliver()
    world.graph.run_due()
    assert answered == list(range(beyond, MAX_WAITING + beyond))
    assert channel.traffic.dropped == beyond
    assert ["ask again" in line for line in world.lines] == [True] * beyond
