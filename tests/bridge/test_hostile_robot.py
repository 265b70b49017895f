"""A robot that sends nonsense: it is dropped, said once, and keeps nothing else from passing."""

from __future__ import annotations

import json
import random
import struct
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import Any

import pytest

from kit.bridge import channels, zenoh_wire
from kit.bridge import wire as wires
from kit.bridge.bridge import MAX_LINE, MAX_REPORTS, Bridge, BridgeSettings
from kit.bridge.channels import MAX_UNANSWERED, CalledService, SentTopic, ServedService, WireCodec
from kit.bridge.rmw_zenoh import GID_LENGTH, MAX_TOKEN, Attachment, data_key, parse_token
from kit.bridge.wire import BridgeRoute, DelayMeasure, Direction, DryRunWire, RemoteEndpoint
from kit.msg.interfaces import find_interface, interface_names
from kit.msg.message import Message
from kit.msg.std_msgs import String
from kit.msg.std_srvs import SetBool
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.ros.node.qos import QoSProfile
from tests.bridge.sides import Side, router, routes, wire_to
from tests.bridge.test_channels import World
from tests.waiting import wait_until

zenoh = pytest.importorskip("zenoh", reason="needs eclipse-zenoh, of the extras robot and test")

TOKEN = "@ros2_lv/0/robot/0/1"
TOKENS = (
    f"{TOKEN}/NN/%/%/a/topic/std_msgs::msg::dds_::String_/h/q",  # a node with the parts of a topic
    f"{TOKEN}/XX/%/%/a/%topic/std_msgs::msg::dds_::String_/h/q",
    f"{TOKEN}/MP/%/%/a/%topic/..::..::dds_::passwd_/h/q",
    f"{TOKEN}/MP/%/%/a/%topic/no type/h/q",
    f"{TOKEN}/MP",
    f"{TOKEN}/MP/%/%/{'a' * 5000}/%topic/std_msgs::msg::dds_::String_/h/q",
)
ATTACHMENTS = (
    None,
    b"",
    b"x" * 7,
    Attachment(1, 2**62, b"a" * GID_LENGTH).pack(),
    Attachment(-(2**63), -(2**63), b"b" * GID_LENGTH).pack(),
    struct.pack("<qqB16s", 1, 1, 200, b"c"),
)
CODEC = WireCodec("jazzy")


class Robot:
    """A session of Zenoh's that keeps to no rule of ROS."""

    def __init__(self, port: int) -> None:
        config = zenoh.Config()
        settings = {
            "mode": "client",
            "connect/endpoints": [f"tcp/127.0.0.1:{port}"],
            "scouting/multicast/enabled": False,
        }
        for path, value in settings.items():
            config.insert_json5(path, json.dumps(value))
        self._session = zenoh.open(config)
        self._tokens: list[Any] = []

    def announce(self, token: str) -> None:
        self._tokens.append(self._session.liveliness().declare_token(token))

    def put(self, key: str, data: bytes, attachment: bytes | None) -> None:
        self._session.put(key, data, attachment=attachment)

    def ask(self, key: str, data: bytes, attachment: bytes | None) -> int:
        """Returns the number of answers."""
        asked = self._session.get(key, payload=data, attachment=attachment, timeout=0.3)
        return sum(reply.ok is not None for reply in asked)

    def close(self) -> None:
        self._session.close()


def test_nonsense_from_a_robot_leaves_no_traceback_and_sense_passes(
    capfd: pytest.CaptureFixture[str],
) -> None:
    with router() as port, Side(wire_to(port), routes(receive="/topic", serve="/switch")) as side:
        heard = side.heard(String, "/topic")
        side.node.create_service(SetBool, "/switch", lambda request, response: response)
        wait_until(lambda: len(side.bridge.open_routes) == 2, lambda: str(side.lines))
        robot = Robot(port)
        try:
            for token in TOKENS:
                robot.announce(token)
            topic = data_key(0, "/topic", "std_msgs/msg/String", CODEC.topic_interface(String).type_hash)
            switch = data_key(
                0, "/switch", "std_srvs/srv/SetBool", CODEC.service_interface(SetBool).type_hash
            )
            for attachment in ATTACHMENTS:
                for data in (b"", b"\0", b"\xff" * 40, b"\0\1\0\0\xff\xff\xff\xffx"):
                    robot.put(topic, data, attachment)
                assert not robot.ask(switch, b"\xff", attachment)
            sense = Attachment(1, 1, b"d" * GID_LENGTH).pack()
            robot.put(topic, CODEC.serialize(String(data="sense")), sense)
            wait_until(lambda: heard, lambda: str(side.lines))
            assert robot.ask(switch, CODEC.serialize(SetBool.Request(data=True)), sense) == 1
        finally:
            robot.close()
        assert [message.data for _, message in heard] == ["sense"]
        assert sum("cannot be read" in line for line in side.lines) == 2, "once for each route"
    said = capfd.readouterr()
    assert "Traceback" not in said.out + said.err
    assert "callback error" not in said.out + said.err


def test_a_robot_that_announces_endpoints_without_end_fills_no_memory(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(zenoh_wire, "MAX_ENDPOINTS", 5)
    with router() as port:
        wire, robot = wire_to(port), Robot(port)
        try:
            for number in range(20):
                robot.announce(f"{TOKEN}/MP/%/%/a/%t{number}/std_msgs::msg::dds_::String_/h/::,:,:,,")
            wait_until(lambda: len(wire.endpoints()) >= 5, "endpoints")
            robot.ask("0/nothing", b"", None)  # whatever was announced before has arrived
            assert len(wire.endpoints()) == 5
        finally:
            robot.close()
            wire.close()
    assert parse_token(TOKENS[0]) is None
    long_name = "a" * MAX_TOKEN
    assert parse_token(f"{TOKEN}/MP/%/%/{long_name}/%t/std_msgs::msg::dds_::String_/h/q") is None


def test_senders_without_end_fill_no_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(wires, "MAX_SENDERS", 3)
    delays = DelayMeasure()
    for number in range(50):
        assert delays.add(bytes([number]), 0, 10**9) == 0.0
    assert len(delays._quickest) == 3


class AnnouncingWire(DryRunWire):
    """A wire on which the test announces endpoints."""

    def __init__(self) -> None:
        self.announced: list[RemoteEndpoint] = []

    def endpoints(self) -> tuple[RemoteEndpoint, ...]:
        return tuple(self.announced)


def test_what_a_robot_calls_itself_is_no_command_of_a_terminal_and_fills_no_screen() -> None:
    wire, lines = AnnouncingWire(), list[str]()
    node = create_graph_node(Graph(log_sink=lambda record: None), "bridge")
    settings = BridgeSettings((BridgeRoute.parse(Direction.RECEIVE, "/topic"),))
    bridge = Bridge(node, wire, settings, lines.append)
    for number in range(5 * MAX_REPORTS):
        name = f"\x1b[2J{number}\n\u202ereceive /topic: ok" + "x" * 5000
        wire.announced = [RemoteEndpoint("/topic", f"a/msg/{name}", "", "publisher", name)]
        bridge._looked_s = float("-inf")
        bridge.poll()
    assert len(lines) == MAX_REPORTS + 1
    assert "not shown" in lines[-1]
    assert all(line.isprintable() and len(line) <= MAX_LINE + 3 for line in lines)


def test_what_is_too_large_does_not_wait_in_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(channels, "MAX_MESSAGE_BYTES", 1000)
    world = World()
    channel = world.received(String)
    for text in ("x" * 1000, "x" * 900):
        world.wire.receive(CODEC.serialize(String(data=text)), 0.0)
    assert len(channel._arrived) == 1
    channel.deliver()
    world.graph.run_due()
    assert [len(each.data) for each in world.heard] == [900]
    assert len(world.lines) == 1


class Endless:
    """Sends another message whenever one is read."""

    def __init__(self, send: Callable[[], None]) -> None:
        self._send = send
        self.count = 0

    def deserialize(self, data: bytes, cls: type[Message]) -> Any:
        self.count += 1
        assert self.count < 1000, "the world stands still"
        self._send()
        return CODEC.deserialize(data, cls)


def test_a_robot_that_sends_faster_than_it_is_read_does_not_hold_the_world() -> None:
    world = World()
    topic, service = world.received(String), served(world, lambda request, response: response)
    message, request = CODEC.serialize(String(data="x")), CODEC.serialize(SetBool.Request(data=True))
    for channel, send in (
        (topic, lambda: world.wire.receive(message, 0.0)),
        (service, lambda: world.wire.request(request, lambda data: None)),
    ):
        send()
        endless = Endless(send)
        channel._context = replace(channel._context, codec=endless)  # type: ignore[arg-type]  # has the one method called
        channel.deliver()
        channel.deliver()
        assert endless.count == 2


def served(world: World, answer: Callable[..., Any] | None) -> ServedService:
    if answer is not None:
        world.node.create_service(SetBool, "/switch", answer)
    route = BridgeRoute.parse(Direction.SERVE, "/switch")
    return ServedService(route, CODEC.service_interface(SetBool), world.context, SetBool)


def test_a_robot_that_is_gone_before_its_answer_ends_nothing() -> None:
    world = World()
    channel = served(world, lambda request, response: response)

    def gone(data: bytes) -> None:
        raise RuntimeError("the query is closed")

    answered: list[bytes] = []
    request = CODEC.serialize(SetBool.Request(data=True))
    for reply in (gone, answered.append):
        world.wire.request(request, reply)
    channel.deliver()
    world.graph.run_due()
    assert len(answered) == 1
    assert ["the query is closed" in line for line in world.lines] == [True]


def test_requests_without_end_that_the_world_does_not_answer_fill_no_memory() -> None:
    world = World()
    channel = served(world, lambda request, response: response)
    request = CODEC.serialize(SetBool.Request(data=True))
    for _ in range(3 * MAX_UNANSWERED):
        world.wire.request(request, lambda data: None)
        channel.deliver()  # and the world does not run
    assert channel._client.pending_count == MAX_UNANSWERED
    assert channel.traffic.dropped == 2 * MAX_UNANSWERED


class RefusingWire(DryRunWire):
    """A wire that takes nothing."""

    def open_publisher(self, *_: Any) -> Callable[[bytes], None]:
        return self._refuse

    def open_client(self, *_: Any) -> Callable[..., None]:
        return self._refuse

    def _refuse(self, *_: Any) -> None:
        raise RuntimeError("the session is closed")


@pytest.mark.parametrize("direction", [Direction.SEND, Direction.CALL])
def test_a_wire_that_takes_nothing_ends_no_node(direction: Direction) -> None:
    world = World()
    world.context = channels.ChannelContext(
        world.context.node, RefusingWire(), CODEC, world.lines.append, world.context.group
    )
    route = BridgeRoute.parse(direction, "/name")
    if direction is Direction.SEND:
        SentTopic(route, CODEC.topic_interface(String), world.context, String, QoSProfile(depth=10), None)
        world.node.create_publisher(String, "/name", 10).publish(String(data="x"))
    else:
        CalledService(route, CODEC.service_interface(SetBool), world.context, SetBool)
        world.node.create_client(SetBool, "/name").call_async(SetBool.Request())
    world.graph.run_due()
    assert ["the session is closed" in line for line in world.lines] == [True]


@pytest.mark.long
def test_bytes_that_are_nearly_a_message_are_read_or_refused_for_every_type() -> None:
    rng = random.Random(39)
    for name in interface_names():
        cls = find_interface(name)
        if not issubclass(cls, Message):
            continue
        try:
            whole = CODEC.serialize(cls())
        except ValueError:  # a type that cannot pass
            continue
        for _ in range(20):
            data = bytearray(whole) + rng.randbytes(rng.choice((0, 0, 9, 200)))
            at = rng.randrange(len(data))
            number = struct.pack("<I", rng.choice((0, 5, 10**6, 2**31 - 1, 2**31, 2**32 - 1)))
            data[at : at + 4] = rng.choice((number, rng.randbytes(4), b""))
            with suppress(ValueError):
                assert isinstance(CODEC.deserialize(bytes(data), cls), cls)
