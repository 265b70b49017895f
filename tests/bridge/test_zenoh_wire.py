"""The wire of rmw_zenoh against an independent implementation of it, both ways."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

import kit.msg
from kit.cli.bridge import describe_endpoints
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import String
from kit.msg.std_srvs import SetBool
from tests.bridge.sides import Side, router, routes, twist, wire_to
from tests.waiting import wait_until

PEER = Path(__file__).parent / "independent_peer.py"
DEFINITIONS = Path(kit.msg.__file__).parent / "definitions"

needs_peer = pytest.mark.skipif(
    find_spec("zenoh_ros2_sdk") is None,
    reason="needs zenoh-ros2-sdk, an independent implementation of the wire (extra test)",
)


class Peer:
    """The program on the robot's side."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process
        self.events: list[dict[str, Any]] = []
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def of(self, what: str) -> list[dict[str, Any]]:
        return [event for event in self.events if event["what"] == what]

    def write(self, line: str) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(line + "\n")
        self._process.stdin.flush()

    def end(self) -> None:
        self._reader.join()
        assert self._process.stdout is not None
        self._process.stdout.close()

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            if line.startswith("{"):
                self.events.append(json.loads(line))


@contextmanager
def peer_at(port: int) -> Iterator[Peer]:
    environment = {
        name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "ZENOH", "ROS_"))
    }
    process = subprocess.Popen(
        [sys.executable, str(PEER), str(port), str(DEFINITIONS)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**environment, "GIT_PYTHON_REFRESH": "quiet"},
    )
    peer = Peer(process)
    try:
        wait_until(
            lambda: peer.of("ready") or process.poll() is not None, "the independent program to be ready"
        )
        assert process.poll() is None
        yield peer
    finally:
        assert process.stdin is not None
        process.stdin.close()
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        peer.end()


@needs_peer
@pytest.mark.long
def test_an_independent_implementation_talks_with_the_kit_both_ways() -> None:
    allowed = routes(send="/cmd_vel", receive="/scan /chatter", call="/switch", serve="/kit_switch")
    with router() as port, peer_at(port) as peer, Side(wire_to(port), allowed) as side:
        scans, said = side.heard(LaserScan, "/scan"), side.heard(String, "/chatter")
        side.repeat("/cmd_vel", twist(0.25, -0.5))

        def switch(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
            response.success, response.message = request.data, "by the kit"
            return response

        side.node.create_service(SetBool, "/kit_switch", switch)
        client = side.node.create_client(SetBool, "/switch")
        wait_until(lambda: scans and said and peer.of("cmd_vel"), lambda: str(side.lines))
        assert {(each["forward"], each["turn"]) for each in peer.of("cmd_vel")} == {(0.25, -0.5)}
        scan = scans[-1][1]
        assert list(scan.ranges) == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]
        assert (scan.header.frame_id, scan.header.stamp.nanosec, scan.range_max) == ("laser", 5, 8.0)
        assert said[-1][1].data.startswith("hello ")

        wait_until(client.service_is_ready, lambda: str(side.lines))
        future = client.call_async(SetBool.Request(data=True))
        wait_until(future.done, "the robot's answer")
        answer = future.result()
        assert answer is not None
        assert (answer.success, answer.message) == (False, "by the robot")
        assert [each["data"] for each in peer.of("asked")] == [True]

        wait_until(lambda: len(side.bridge.open_routes) == 5, lambda: str(side.lines))
        peer.write("call")
        wait_until(lambda: peer.of("answered"), "the kit's answer")
        assert peer.of("answered")[0]["response"] == [True, "by the kit"]


@needs_peer
@pytest.mark.long
def test_what_the_robot_has_is_listed_and_its_types_are_checked() -> None:
    with router() as port, peer_at(port):
        wire = wire_to(port)
        try:
            wait_until(lambda: len(wire.endpoints()) >= 5, "the robot's tokens")
            listed = describe_endpoints(wire.endpoints())
        finally:
            wire.close()
        assert "/scan  sensor_msgs/msg/LaserScan  publisher" in listed
        assert "/switch  std_srvs/srv/SetBool  service" in listed
        with Side(wire_to(port, domain=7), routes(receive="/scan")) as elsewhere:
            wait_until(lambda: elsewhere.lines, "the bridge's first look")
            assert not elsewhere.bridge.open_routes, "another domain is another robot"
        with Side(wire_to(port), routes(receive="/scan"), distro="humble") as humble:
            wait_until(lambda: any("definition" in line for line in humble.lines), "the refusal")
            assert not humble.bridge.open_routes
