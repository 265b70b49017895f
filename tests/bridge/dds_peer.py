"""A program on the robot's side that knows nothing of the kit: cyclonedds, with types written by hand as rosidl's are.

``python dds_peer.py DOMAIN CONFIGURATION``. It publishes /scan and /chatter, and tells of each /cmd_vel that comes, a line
of JSON each, until its input ends.
"""

import json
import sys
import threading
from dataclasses import dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import float32, float64, int32, sequence, uint32
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration


@dataclass
class Vector3(IdlStruct, typename="geometry_msgs::msg::dds_::Vector3_"):
    x_: float64
    y_: float64
    z_: float64


@dataclass
class Twist(IdlStruct, typename="geometry_msgs::msg::dds_::Twist_"):
    linear_: Vector3
    angular_: Vector3


@dataclass
class String(IdlStruct, typename="std_msgs::msg::dds_::String_"):
    data_: str


@dataclass
class Time(IdlStruct, typename="builtin_interfaces::msg::dds_::Time_"):
    sec_: int32
    nanosec_: uint32


@dataclass
class Header(IdlStruct, typename="std_msgs::msg::dds_::Header_"):
    stamp_: Time
    frame_id_: str


@dataclass
class LaserScan(IdlStruct, typename="sensor_msgs::msg::dds_::LaserScan_"):
    header_: Header
    angle_min_: float32
    angle_max_: float32
    angle_increment_: float32
    time_increment_: float32
    scan_time_: float32
    range_min_: float32
    range_max_: float32
    ranges_: sequence[float32]
    intensities_: sequence[float32]


DOMAIN, CONFIGURATION = int(sys.argv[1]), sys.argv[2]
domain = Domain(DOMAIN, CONFIGURATION)
participant = DomainParticipant(DOMAIN)
reliable = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepLast(10))
quick = Qos(Policy.Reliability.BestEffort, Policy.History.KeepLast(5))
chatter = DataWriter(participant, Topic(participant, "rt/chatter", String), qos=reliable)
scans = DataWriter(participant, Topic(participant, "rt/scan", LaserScan), qos=reliable)
commands = DataReader(participant, Topic(participant, "rt/cmd_vel", Twist), qos=quick)
has_ended = threading.Event()


def run() -> None:
    count = 0
    while not has_ended.wait(0.05):
        count += 1
        chatter.write(String(f"hello {count}"))
        header = Header(Time(count, 5), "laser")
        scans.write(
            LaserScan(header, -1.5, 1.5, 0.5, 0.0, 0.1, 0.0, 8.0, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0], [])
        )
        for twist in commands.take(20):
            print(json.dumps({"forward": twist.linear_.x_, "turn": twist.angular_.z_}), flush=True)


worker = threading.Thread(target=run)
worker.start()
sys.stdin.read()
has_ended.set()
worker.join()
