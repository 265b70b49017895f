"""A program on the robot's side that keeps to no rule: what it publishes is no message, but every tenth time.

``python dds_hostile_peer.py DOMAIN CONFIGURATION``. It publishes on /chatter until its input ends.
"""

import struct
import sys
import threading
from contextlib import suppress
from dataclasses import dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.pub import DataWriter
from cyclonedds.topic import Topic
from cyclonedds.util import duration

HEADER = b"\x00\x01\x00\x00"
NONSENSE = (
    HEADER,
    HEADER + struct.pack("<I", 4) + b"\xff\xfe\xfd\x00",  # no UTF-8
    HEADER + struct.pack("<I", 0),
    HEADER + struct.pack("<I", 2**31 - 1) + b"x",
    HEADER + struct.pack("<I", 2**32 - 1) + b"x",
    HEADER + struct.pack("<I", 3) + b"abc",  # no end
    b"\xff\xff\x00\x00" + struct.pack("<I", 2) + b"x\x00",
    b"",
    HEADER + b"\x05",
)


@dataclass
class String(IdlStruct, typename="std_msgs::msg::dds_::String_"):
    data_: str

    def serialize(self, *given, **named):
        turn = int(self.data_)
        if turn % 10:
            return NONSENSE[turn % 10 - 1]
        return HEADER + struct.pack("<I", 6) + b"sense\x00"


DOMAIN, CONFIGURATION = int(sys.argv[1]), sys.argv[2]
domain = Domain(DOMAIN, CONFIGURATION)
participant = DomainParticipant(DOMAIN)
reliable = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepLast(10))
chatter = DataWriter(participant, Topic(participant, "rt/chatter", String), qos=reliable)
has_ended = threading.Event()


def run() -> None:
    count = 0
    while not has_ended.wait(0.02):
        count += 1
        with suppress(Exception):  # what its own library does not send reaches nobody
            chatter.write(String(str(count)))


worker = threading.Thread(target=run)
worker.start()
sys.stdin.read()
has_ended.set()
worker.join()
