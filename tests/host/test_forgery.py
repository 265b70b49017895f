"""A program that speaks on the pipe past the library: what it may say of its nodes is checked, all of it."""

from __future__ import annotations

import dataclasses
import json
from contextlib import suppress
from typing import Any

import pytest

from kit.host.failure import FailureKind, StudentCodeError
from kit.host.node_process import NodeProcess
from kit.host.sandbox.probe import is_level_available
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL, Level
from kit.host.student_functions import StudentFunctions
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node
from kit.ros.node.qos import QoSProfile
from tests.host.conftest import LINUX, QUICK, Speaker, Student

FORGER = """
import json, os, stat, struct, time

def pipe():
    for fd in range(3, 64):
        try:
            if stat.S_ISSOCK(os.fstat(fd).st_mode): return fd
        except OSError: pass

def say(content):
    data = json.dumps(content).encode()
    data = struct.pack(">I", len(data)) + data
    while data: data = data[os.write(pipe(), data):]

say(json.loads({frame!r}))
time.sleep = None
while True: os.sched_yield()
"""

NODE = ["node", 1, "evil", "/"]
OUT = ["publisher", 2, 1, "/cmd_vel", "geometry_msgs/msg/Twist", QoSProfile(depth=10).numbers]
SERVICE = ["service", 3, 1, "/trigger", "std_srvs/srv/Trigger"]


def reply(*events: Any) -> list[Any]:
    return ["reply", 0, None, list(events)]


FORGED: dict[str, Any] = {
    "a number that is not finite": reply(NODE, OUT, ["message", 2, [["inf", 0.0, 0.0], [0.0, 0.0, 0.0]]]),
    "a message of another type": reply(NODE, OUT, ["message", 2, ["text"]]),
    "a message from nowhere": reply(NODE, OUT, ["message", 9, [[0.0] * 3, [0.0] * 3]]),
    "a message from a service": reply(NODE, SERVICE, ["message", 3, [[0.0] * 3, [0.0] * 3]]),
    "an endpoint of no node": reply(OUT),
    "an endpoint of an endpoint": reply(NODE, OUT, ["publisher", 4, 2, *OUT[3:]]),
    "two of one number": reply(NODE, OUT, OUT),
    "two nodes of one number": reply(NODE, NODE),
    "the end of nothing": reply(NODE, ["gone", 7]),
    "a type that is not there": reply(NODE, [*OUT[:4], "os/system/Run", OUT[5]]),
    "a type that is a path": reply(NODE, [*OUT[:4], "../../etc/passwd", OUT[5]]),
    "a service's type for a topic": reply(NODE, [*OUT[:4], "std_srvs/srv/Trigger", OUT[5]]),
    "a topic's type for a service": reply(NODE, [*SERVICE[:4], "std_msgs/msg/String"]),
    "a name with an escape sequence": reply(["node", 1, "\x1b[2J", "/"]),
    "a name that is a number": reply(["node", 1, 3, "/"]),
    "a name without end": reply(["node", 1, "x" * 10_000, "/"]),
    "a relative topic": reply(NODE, [*OUT[:3], "cmd_vel", *OUT[4:]]),
    "a quality of service that is none": reply(NODE, [*OUT[:5], [9, 9, 9, 9]]),
    "a quality of service that is short": reply(NODE, [*OUT[:5], [1, 10]]),
    "a depth without end": reply(NODE, [*OUT[:5], [1, 10**12, 1, 2]]),
    "an answer that nobody asked for": reply(NODE, SERVICE, ["response", 3, 5, [True, ""]]),
    "a request from a service": reply(NODE, SERVICE, ["request", 3, 5, []]),
    "an event of no kind": reply(NODE, ["explode", 1, 1, "/x", "std_srvs/srv/Trigger"]),
    "an event of no name": reply([3, 4]),
    "too few fields": reply(["node", 1]),
    "too many fields": reply([*NODE, 0]),
    "more endpoints than anybody needs": reply(NODE, *(["client", i, 1, "/t", "std_srvs/srv/Trigger"] for i in range(2, 2100))),
    "an answer to another question": ["reply", 1, None, []],
    "functions instead of nodes": ["functions", 0, ["f"]],
    "a level of confinement": ["confined", 0],
    "a machine that cannot confine": ["refused", "no Landlock here"],
    "values instead of nodes": ["values", 0, ""],
    "what a function told": ["told", 0, None],
    "a time that is none": ["reply", 0, "now", []],
    "a time before all time": ["reply", 0, -1, []],
}  # fmt: skip


@LINUX
@pytest.mark.parametrize("name", FORGED)
def test_a_forged_answer_ends_the_process(student: Student, speaker: Speaker, name: str) -> None:
    speaker(None, ["confined", int(INTERACTIVE_LEVEL)], None, FORGED[name])
    graph = Graph(log_sink=lambda record: None)
    limits = dataclasses.replace(QUICK, frame=1 << 20)
    process = NodeProcess(graph, student(""), limits=limits)
    with suppress(StudentCodeError):
        process.wait_until_started()
        process.join()
    assert process.failure is not None
    assert process.failure.kind is FailureKind.PROTOCOL
    assert str(process.failure).isprintable()
    assert not process.is_running
    assert graph.nodes == ()
    assert not process.exchange()
    process.close()


@LINUX
def test_an_honest_answer_by_hand_is_taken(student: Student) -> None:
    """The program itself writes it, past the library: so can the frames of the test above be written by one."""
    graph = Graph(log_sink=lambda record: None)
    said: list[str] = []

    def watch(now: int, node: Node, topic: str, message: Any) -> None:
        said.append(f"{node.get_name()} {topic} {message.linear.x}")

    graph.add_message_listener(watch)
    frame = reply(NODE, OUT, SERVICE, ["message", 2, [[0.5, 0.0, 0.0], [0.0, 0.0, 0.0]]])
    with NodeProcess.start(graph, student(FORGER.format(frame=json.dumps(frame))), limits=QUICK) as process:
        assert process.failure is None
        assert said == ["evil /cmd_vel 0.5"]
        assert [node.get_name() for node in graph.nodes] == ["evil"]


@pytest.mark.sampled(4)
@LINUX
@pytest.mark.parametrize("level", Level)
def test_no_program_can_blame_the_machine(student: Student, level: Level) -> None:
    """A forged "refused" is the program's own fault, at every level: nobody may confine it less for that."""
    if not is_level_available(level):
        pytest.skip("not on this machine")
    file = student(FORGER.format(frame=json.dumps(["refused", "no Landlock here"])))
    with pytest.raises(StudentCodeError) as caught:
        StudentFunctions(file, limits=QUICK, level=level)
    assert caught.value.failure.kind is FailureKind.PROTOCOL
