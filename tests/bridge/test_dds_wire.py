"""The wire of DDS, against cyclonedds with types written by hand, and the kit's own bytes read by it."""

from __future__ import annotations

import json
import random
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from kit.bridge.wire import BridgeError
from kit.msg.interfaces import find_message, interface_names
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import String
from kit.ros.serialization import Serializer
from tests.bridge.sides import Side, routes, twist
from tests.waiting import wait_until

pytest.importorskip("cyclonedds", reason="needs cyclonedds, of the extras robot and test")

from kit.bridge.dds_wire import DdsAddress, DdsWire, idl_struct

PEER = Path(__file__).parent / "dds_peer.py"

FILLED: dict[str, dict[str, Any]] = {
    "std_msgs/msg/String": {"data": "hällo"},
    "std_msgs/msg/Empty": {},
    "std_msgs/msg/Char": {"data": 65},
    "std_msgs/msg/Bool": {"data": True},
    "geometry_msgs/msg/Twist": {},
    "geometry_msgs/msg/PoseWithCovariance": {"covariance": [float(k) for k in range(36)]},
    "sensor_msgs/msg/LaserScan": {"ranges": [1.5, 2.5], "range_max": 8.0},
    "sensor_msgs/msg/JointState": {"name": ["a", "bcd"], "position": [1.0, 2.0]},
    "nav_msgs/msg/OccupancyGrid": {"data": [0, 100, -1]},
    "flatland_msgs/msg/Collisions": {},
}


@pytest.mark.parametrize("name", FILLED)
def test_the_kits_bytes_are_those_of_cyclonedds(name: str) -> None:
    cls = find_message(name)
    data = Serializer().serialize(cls(**FILLED[name]))
    struct = idl_struct(cls)
    again = struct.deserialize(data).serialize(use_version_2=False)
    assert again.rstrip(b"\0") == data.rstrip(b"\0")  # either may fill up to a whole word
    assert Serializer().deserialize(again, cls) == cls(**FILLED[name])


@pytest.mark.long
def test_every_message_of_the_kit_passes() -> None:
    serializer, refused = Serializer(), []
    for name in interface_names():
        if "/msg/" not in name:
            continue
        cls = find_message(name)
        try:
            struct = idl_struct(cls)
        except ValueError:
            refused.append(name)
            continue
        data = serializer.serialize(cls())
        again = struct.deserialize(data).serialize(use_version_2=False)
        assert again.rstrip(b"\0") == data.rstrip(b"\0"), name
        assert serializer.deserialize(again, cls) == cls(), name
    assert refused == ["example_interfaces/msg/WString"]


def test_what_cannot_pass_is_said() -> None:
    with pytest.raises(ValueError, match="wstring"):
        idl_struct(find_message("example_interfaces/msg/WString"))


class Robot:
    """The program on the robot's side."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process
        self.commands: list[dict[str, float]] = []
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            self.commands.append(json.loads(line))

    def end(self) -> None:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.close()
        try:
            self._process.wait(30)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._reader.join()
        self._process.stdout.close()


@contextmanager
def robot_at(address: DdsAddress, program: Path = PEER) -> Iterator[Robot]:
    configuration = address.configuration()
    assert configuration is not None
    process = subprocess.Popen(
        [sys.executable, str(program), str(address.domain), configuration],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    robot = Robot(process)
    try:
        yield robot
    finally:
        robot.end()


def loopback() -> DdsAddress:
    """A domain of its own for each test, on this machine alone."""
    return DdsAddress(random.SystemRandom().randrange(20, 200), "127.0.0.1", ("127.0.0.1",))


@pytest.mark.long
def test_a_program_with_types_of_its_own_talks_with_the_kit_both_ways() -> None:
    address = loopback()
    with (
        robot_at(address) as robot,
        Side(DdsWire(address), routes(send="/cmd_vel", receive="/scan /chatter")) as side,
    ):
        scans, said = side.heard(LaserScan, "/scan"), side.heard(String, "/chatter")
        side.repeat("/cmd_vel", twist(9.0, -0.5))
        wait_until(lambda: scans and said and robot.commands, lambda: str(side.lines))
        assert {(each["forward"], each["turn"]) for each in robot.commands} == {(0.5, -0.5)}
        scan = scans[-1][1]
        assert list(scan.ranges) == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]
        assert (scan.header.frame_id, scan.header.stamp.nanosec, scan.range_max) == ("laser", 5, 8.0)
        assert said[-1][1].data.startswith("hello ")
        side.bridge.stop()
        wait_until(lambda: robot.commands[-1] == {"forward": 0.0, "turn": 0.0}, "the robot to stand")


@pytest.mark.long
def test_nonsense_of_a_robot_is_said_once_and_sense_passes(capfd: pytest.CaptureFixture[str]) -> None:
    address = loopback()
    with (
        robot_at(address, PEER.with_name("dds_hostile_peer.py")),
        Side(DdsWire(address), routes(receive="/chatter")) as side,
    ):
        said = side.heard(String, "/chatter")
        wait_until(lambda: len(said) >= 5, lambda: str(side.lines))
        assert "sense" in {message.data for _, message in said}
        assert sum("cannot be read" in line for line in side.lines) == 1
    told = capfd.readouterr()
    # cyclonedds itself writes a line in hexadecimal digits for each packet that is none.
    assert "Traceback" not in told.out + told.err


@pytest.mark.long
def test_an_interface_that_is_not_there_is_said() -> None:
    with pytest.raises(BridgeError, match="DDS does not work"):
        DdsWire(DdsAddress(random.SystemRandom().randrange(20, 200), "no_such_interface"))
