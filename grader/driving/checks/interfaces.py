"""Checks of a program's nodes and topics: names, types, rates, quality of service, and what it prints and answers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from grader.check import NoParams, check
from grader.driving.drive_record import GradedDrive
from grader.driving.message_rate import MessageRate


@dataclass(frozen=True, slots=True)
class TopicRateParams:
    topic: str = "/cmd_vel"
    rate: float = 10.0
    """Messages per second."""


@dataclass(frozen=True, slots=True)
class TopicsParams:
    topics: tuple[str, ...] = ("/cmd_vel geometry_msgs/msg/Twist",)
    """Each a name; after a space optionally the message type, and after another the only node that may publish
    it."""
    least: int = 1
    """Messages on each of them."""


@dataclass(frozen=True, slots=True)
class AnswerParams:
    call: str = ""
    """Its name in the trial."""
    holds: str = ""
    """Text that the answer, as JSON, must contain."""


@dataclass(frozen=True, slots=True)
class PrintedTextParams:
    text: str = ""
    """Text that printed lines should contain."""
    seconds: float = 1.0
    """Seconds between two such lines."""


@dataclass(frozen=True, slots=True)
class HeardTopicsParams:
    node: str = "/driver"
    topics: tuple[str, ...] = ("/wall_ahead",)
    """All to which the node subscribes, and no other."""


@dataclass(frozen=True, slots=True)
class ProfilesParams:
    ends: tuple[str, ...] = ()
    """Each as ``/node publishes /topic BEST_EFFORT VOLATILE 5``, or ``subscribes``; the last words may be left out."""


@dataclass(frozen=True, slots=True)
class NodeNamesParams:
    nodes: tuple[str, ...] = ()
    """Full names that the program's nodes must have, letter by letter."""


@check(none=0.5, full=0.1, unit="%", params=TopicRateParams, is_explained=True)
def rate(drive: GradedDrive, params: TopicRateParams) -> float:
    """The program's messages do not come at the asked rate: it is off by {actual} ({where}); {full} is
    allowed. A timer sets the rate, not a sleep."""
    traffic = drive.traffic.get(params.topic)
    if traffic is None or drive.seconds == 0.0 or params.rate <= 0.0:
        return math.inf
    return MessageRate(traffic.per_second, params.rate, drive.seconds).error


@check(none=0, full=1, unit="%", params=TopicsParams)
def topics(drive: GradedDrive, params: TopicsParams) -> float:
    """Of the asked topics the program published {actual} ({where}). Compare the names and the types with
    what the task says: `kit ros topic list` shows what there is, `kit ros node info` who publishes."""
    published = [_is_published(drive, params.least, *each.split()) for each in params.topics]
    return sum(published) / len(published) if published else math.nan


def _is_published(drive: GradedDrive, least: int, name: str, kind: str = "", node: str = "") -> bool:
    traffic = drive.traffic.get(name)
    if traffic is None or traffic.count < least:
        return False
    return kind in ("", traffic.kind) and (not node or traffic.nodes == (node,))


@check(none=1, full=0, unit="changes")
def obeys(drive: GradedDrive, params: NoParams) -> float:
    """The program tried to change the world instead of driving in it: {actual} ({where}). Only what the task allows
    works here."""
    return float(len(drive.refused))


@check(none=0, full=1, words=("not as asked", "as asked"), params=AnswerParams, is_explained=True)
def answered(drive: GradedDrive, params: AnswerParams) -> float:
    """The program was called while it drove, and did not answer as asked ({where})."""
    return float(params.holds in drive.answers.get(params.call, ""))


@check(none=0.5, full=0.1, unit="%", params=PrintedTextParams, is_explained=True)
def says(drive: GradedDrive, params: PrintedTextParams) -> float:
    """The program does not print the required text at the required rate: it is off by {actual} ({where}); {full} is
    allowed. A timer sets the rate, and `self.get_logger().info(...)` prints."""
    if drive.seconds == 0.0 or params.seconds <= 0.0:
        return math.nan
    return MessageRate(drive.lines_with(params.text), 1.0 / params.seconds, drive.seconds).error


@check(none=0, full=1, unit="%", params=NodeNamesParams)
def named(drive: GradedDrive, params: NodeNamesParams) -> float:
    """Of the node names that the task asks for {actual} are there ({where}). A node's name is what super().__init__ is
    given; capital and small letters differ."""
    known = [name in drive.connections.nodes for name in params.nodes]
    return sum(known) / len(known) if known else math.nan


@check(none=0, full=1, words=("to other topics", "to these alone"), params=HeardTopicsParams)
def hears(drive: GradedDrive, params: HeardTopicsParams) -> float:
    """The node listens to other topics than the task says ({where})."""
    return 1.0 if set(drive.connections.heard.get(params.node, ())) == set(params.topics) else 0.0


@check(none=0, full=1, unit="%", params=ProfilesParams, is_explained=True)
def profiles(drive: GradedDrive, params: ProfilesParams) -> float:
    """Of the asked publishers and subscriptions {actual} are there with the asked quality of service, and with no other
    ({where})."""
    found = [f"{line} " for line in drive.connections.profiles]
    asked = [_has_qos_profile(found, end) for end in params.ends]
    return sum(asked) / len(asked) if asked else math.nan


def _has_qos_profile(found: Sequence[str], end: str) -> bool:
    place = " ".join(end.split()[:3])
    lines = [line for line in found if line.startswith(f"{place} ")]
    return bool(lines) and all(line.startswith(f"{end} ") for line in lines)
