"""Bridges on loopback: what passes, what does not, and what is said of it."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Any

import pytest

from kit.bridge.bridge import MAX_ANSWER, BridgeSettings, StopSocket, stop_bridges
from kit.bridge.motion_guard import SpeedLimit
from kit.bridge.wire import BridgeError, BridgeRoute, DelayMeasure, Direction, DryRunWire, InterfaceId
from kit.bridge.zenoh_wire import LEASE_MS, ZenohAddress, ZenohWire
from kit.msg.geometry_msgs import Twist
from kit.msg.std_msgs import Int32, String
from kit.ros.node.qos import DurabilityPolicy, QoSProfile
from tests.bridge.sides import Line, Side, free_port, router, routes, twist, wire_to
from tests.cases import every_case
from tests.waiting import wait_until

WATCHDOG_S = 0.2


def test_only_what_is_listed_passes() -> None:
    with (
        router() as port,
        Side(wire_to(port), routes(receive="/cmd_vel:=/robot/cmd_vel")) as robot,
        Side(
            wire_to(port),
            routes(send="/cmd_vel:=/robot/cmd_vel"),
            limit=SpeedLimit(0.4, 1.0),
        ) as pilot,
    ):
        moved, said = robot.heard(Twist, "/cmd_vel"), robot.heard(String, "/secret")
        pilot.repeat("/secret", String(data="not for the robot"))
        pilot.repeat("/cmd_vel", twist(2.0, 0.5))
        wait_until(lambda: len(moved) > 3, lambda: str((pilot.lines, robot.lines)))
        assert {(each.linear.x, each.angular.z) for _, each in moved} == {(0.4, 0.5)}
        assert not said
        wire = wire_to(port)
        try:
            wait_until(lambda: len(wire.endpoints()) >= 2, "the tokens of both")
            assert {each.name for each in wire.endpoints()} == {"/robot/cmd_vel"}
        finally:
            wire.close()


def test_a_stop_holds_until_it_is_lifted_and_the_end_is_a_stop() -> None:
    with router() as port, Side(wire_to(port), routes(receive="/cmd_vel")) as robot:
        moved = robot.heard(Twist, "/cmd_vel")
        with Side(wire_to(port), routes(send="/cmd_vel")) as pilot:
            pilot.repeat("/cmd_vel", twist(0.3))
            wait_until(lambda: moved and moved[-1][1].linear.x, lambda: str(pilot.lines))
            assert pilot.bridge.stop() == ("/cmd_vel",)
            wait_until(lambda: moved[-1][1] == Twist(), "the robot to stand")
            sent = pilot.bridge._channels[pilot.bridge.open_routes[0]].traffic
            dropped = sent.dropped
            wait_until(lambda: sent.dropped > dropped + 3, "further commands")
            assert moved[-1][1] == Twist()
            assert "STOPPED" in pilot.bridge.status_lines()[0]
            pilot.bridge.resume()
            wait_until(lambda: moved[-1][1].linear.x, "commands again")
        wait_until(lambda: moved[-1][1] == Twist(), "the robot to stand at the end")


@pytest.mark.leans_on_clock("a robot stops within its watchdog's time")
@pytest.mark.long
@pytest.mark.parametrize("loss", [0.0, 0.05])
def test_a_cut_line_stops_the_robot_within_the_watchdogs_time_and_it_goes_on(loss: float) -> None:
    with (
        router() as port,
        Line(port, delay_s=0.01, loss=loss) as line,
        Side(wire_to(port), routes(receive="/cmd_vel"), watchdog_s=WATCHDOG_S) as robot,
        Side(wire_to(line.port), routes(send="/cmd_vel"), watchdog_s=WATCHDOG_S) as pilot,
    ):
        moved = robot.heard(Twist, "/cmd_vel")
        pilot.repeat("/cmd_vel", twist(0.3))
        for end in (line.hold, line.cut):
            wait_until(lambda: moved and moved[-1][1].linear.x, lambda: str((pilot.lines, robot.lines)))
            end()
            wait_until(lambda: moved[-1][1] == Twist(), "the robot to stand")
            last = max(moment for moment, command in moved if command != Twist())
            assert (
                WATCHDOG_S * 0.5 < moved[-1][0] - last < WATCHDOG_S + 2.0
            )  # 2 s: a machine beside other work
            before = len(moved)
            line.mend()
            wait_until(lambda before=before: moved[-1][1].linear.x and len(moved) > before, "it to go on")
        assert any("stopping the robot" in text for text in robot.lines)
        assert any("resumed" in text for text in robot.lines)


@pytest.mark.leans_on_clock("a robot stops within its watchdog's time")
@pytest.mark.long
def test_a_line_that_was_cut_for_long_comes_back() -> None:
    """For longer than a connection may be silent: it is made anew."""
    with (
        router() as port,
        Line(port) as line,
        Side(wire_to(port), routes(receive="/cmd_vel"), watchdog_s=WATCHDOG_S) as robot,
        Side(wire_to(line.port), routes(send="/cmd_vel"), watchdog_s=WATCHDOG_S) as pilot,
    ):
        moved = robot.heard(Twist, "/cmd_vel")
        pilot.repeat("/cmd_vel", twist(0.3))
        wait_until(lambda: moved and moved[-1][1].linear.x, lambda: str((pilot.lines, robot.lines)))
        line.hold()
        until = time.monotonic() + 2 * LEASE_MS / 1000
        wait_until(lambda: time.monotonic() > until, "the connection to be given up")
        assert moved[-1][1] == Twist()
        line.mend()
        wait_until(lambda: moved[-1][1].linear.x, lambda: str((pilot.lines, robot.lines)))


@pytest.mark.long
def test_a_silent_controller_stops_the_robot() -> None:
    with (
        router() as port,
        Side(wire_to(port), routes(receive="/cmd_vel"), watchdog_s=10.0) as robot,
        Side(wire_to(port), routes(send="/cmd_vel"), watchdog_s=WATCHDOG_S) as pilot,
    ):
        moved = robot.heard(Twist, "/cmd_vel")
        silence = pilot.repeat("/cmd_vel", twist(0.3))
        wait_until(lambda: moved and moved[-1][1].linear.x, lambda: str(pilot.lines))
        silence()
        wait_until(lambda: moved[-1][1] == Twist(), "the robot to stand")
        assert "silent" in pilot.bridge.status_lines()[0]


@pytest.mark.long
def test_what_was_said_before_reaches_who_comes_later() -> None:
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    with router() as port, Side(wire_to(port), routes(send="/map_name")) as world:
        world.node.create_publisher(String, "/map_name", latched).publish(String(data="maze"))
        wait_until(lambda: world.bridge.open_routes, lambda: str(world.lines))
        with Side(wire_to(port), routes(receive="/map_name")) as robot:
            heard: list[str] = []
            robot.node.create_subscription(
                String, "/map_name", lambda message: heard.append(message.data), latched
            )
            wait_until(lambda: heard == ["maze"], lambda: str(robot.lines))


# What goes wrong


def test_without_a_router_it_says_so_and_what_to_start() -> None:
    with pytest.raises(BridgeError, match="rmw_zenohd"):
        ZenohWire(ZenohAddress((f"tcp/127.0.0.1:{free_port()}",), connect_timeout_s=0.1))


def test_an_address_that_is_none_is_refused() -> None:
    for endpoint in ("127.0.0.1", "127.0.0.1:7447", "udp/127.0.0.1:7447", "tcp/127.0.0.1", ""):
        with pytest.raises(BridgeError, match="tcp/192"):
            ZenohAddress((endpoint,))
    with pytest.raises(BridgeError):
        ZenohWire(ZenohAddress(listen=("tcp/192.0.2.1:1",)))  # not an address of this machine


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("type_name", "type_hash", "complaint"),
    [
        ("strange_msgs/msg/Thing", "RIHS01_00", "strange_msgs"),
        ("geometry_msgs/msg/Twist", "RIHS01_00", "another definition"),
        ("std_msgs/msg/String", "", "std_msgs/msg/String"),
    ],
)
def test_a_foreign_type_does_not_pass_and_is_named(type_name: str, type_hash: str, complaint: str) -> None:
    with router() as port, Side(wire_to(port), routes(receive="/cmd_vel")) as robot:
        moved = robot.heard(Twist, "/cmd_vel")
        foreign = wire_to(port)
        try:
            send = foreign.open_publisher(
                "/cmd_vel", InterfaceId(type_name, type_hash or "RIHS01_00"), QoSProfile(depth=1)
            )
            wait_until(lambda: any(complaint in line for line in robot.lines), lambda: str(robot.lines))
            send(b"\0\1\0\0" + bytes(48))
            assert not moved
        finally:
            foreign.close()


@pytest.mark.long
def test_bytes_that_are_no_message_are_dropped_and_said_once() -> None:
    with router() as port, Side(wire_to(port), routes(receive="/count /cmd_vel")) as robot:
        counted = robot.heard(Int32, "/count")
        robot.heard(Twist, "/cmd_vel")
        wait_until(lambda: len(robot.bridge.open_routes) == 2, lambda: str(robot.lines))
        foreign, codec = wire_to(port), robot.bridge._context.codec
        try:
            send = foreign.open_publisher("/count", codec.topic_interface(Int32), QoSProfile(depth=1))
            for data in (b"", b"\1", bytes(3), os.urandom(2), b"\0\1\0\0\5"):
                send(data)
            send(codec.serialize(Int32(data=5)))
            wait_until(lambda: counted, "the one that is right")
            assert [message.data for _, message in counted] == [5]
            assert sum("cannot be read" in line for line in robot.lines) == 1
        finally:
            foreign.close()


@every_case(
    ("texts", "complaint"),
    [
        ({}, "Nothing would pass"),
        ({"send": "/a", "receive": "/a"}, "circulate forever"),
        ({"send": "/a:=/b", "receive": "/c:=/b"}, "circulate forever"),
        ({"send": "/a /a"}, "listed twice"),
        ({"serve": "/a", "call": "/a"}, "listed twice"),
    ],
)
def test_routes_that_do_not_fit_together_are_refused(texts: dict[str, str], complaint: str) -> None:
    with pytest.raises(BridgeError, match=complaint):
        BridgeSettings(routes(**texts))


@every_case("text", ["", "/", "a b", "/a//b", "/9", ":=/a", "/a:=b c"])
def test_a_name_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(BridgeError, match="--send"):
        BridgeRoute.parse(Direction.SEND, text)


# Looking first, and stopping from elsewhere


def test_a_dry_run_shows_what_would_be_sent() -> None:
    with Side(DryRunWire(), routes(send="/cmd_vel", receive="/scan"), is_dry=True) as side:
        side.repeat("/cmd_vel", twist(9.0))
        wait_until(lambda: any("would send" in line for line in side.lines), lambda: str(side.lines))
        shown = next(line for line in side.lines if "would send" in line)
        assert "slowed down" in shown
        assert "x=0.5" in shown


def test_another_terminal_stops_every_bridge_of_the_workspace(tmp_path: Path) -> None:
    assert stop_bridges(tmp_path) == []
    told: list[str] = []
    with Side(DryRunWire(), routes(send="/cmd_vel")) as side:
        side.repeat("/cmd_vel", twist(0.1))
        wait_until(lambda: side.bridge.open_routes, lambda: str(side.lines))
        with StopSocket(side.bridge, tmp_path, "maze", told.append):
            ((name, answer),) = stop_bridges(tmp_path)
            assert name.startswith("maze-")
            assert answer == "/cmd_vel"
            assert side.bridge.is_stopped
            assert told
        assert stop_bridges(tmp_path) == []


class OfManyTopics:
    """Stands for a bridge, of which only the answer to a stop counts."""

    def __init__(self, length: int) -> None:
        self._topics = ("/a", "b" * (length - len("/a, ")))

    def stop(self) -> tuple[str, ...]:
        return self._topics


def test_the_answer_to_a_stop_comes_whole_up_to_its_limit(tmp_path: Path) -> None:
    def answer(length: int) -> str:
        bridge: Any = OfManyTopics(length)
        with StopSocket(bridge, tmp_path, "maze", lambda line: None):
            return stop_bridges(tmp_path)[0][1]

    whole = answer(MAX_ANSWER)
    assert (whole[:5], len(whole)) == ("/a, b", MAX_ANSWER)
    assert answer(MAX_ANSWER + 1) == f"{whole}... and more"


def test_lateness_is_measured_against_the_senders_quickest() -> None:
    delays = DelayMeasure()

    def add(sent_s: float, arrived_s: float, sender: bytes = b"one") -> float:
        return delays.add(sender, int(sent_s * 1e9), int(arrived_s * 1e9))

    assert add(1000.0, 0.0) == 0.0, "clocks differ"
    assert add(1000.1, 0.1) == pytest.approx(0.0, abs=1e-6)
    assert add(1000.2, 3.2) == pytest.approx(3.0, abs=1e-6)
    assert add(5.0, 3.3, b"other") == 0.0, "another sender"
    late = [add(1004.0 - 3600 + k, 4.0 + k) for k in range(40)]  # the sender's clock is set back by an hour
    assert late[0] == pytest.approx(3600, abs=1)
    assert late[-1] == pytest.approx(0.0, abs=1e-6)
