"""Fuzzes the pipe to a student's process: true conversations with frames damaged, in every state of the protocol.

The parent's side is the kit's own, down to the graph. In place of the child a thread speaks, which costs a hundredth
of a process.
"""

from __future__ import annotations

import json
import os
import random
import socket
import struct
import subprocess
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any, Final
from unittest.mock import patch

from kit.host import process, program_start
from kit.host.failure import FailureKind, StudentCodeError
from kit.host.node_process import NodeProcess
from kit.host.process import Role
from kit.host.protocol import ALLOWED_FRAMES, ConfinementRefused, ProcessState
from kit.host.sandbox.limits import MIB, Limits
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL
from kit.host.student_functions import StudentFunctions
from kit.host.wire import HEADER, Json
from kit.launch.launch_file_process import LaunchFileProcess
from kit.msg.geometry_msgs import Twist
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_srvs import SetBool, Trigger
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from tests.fuzz.damage import damage_bytes, damage_json, nudge_json

LIMITS: Final = Limits(start_s=30.0, reply_s=30.0, frame=1 * MIB, messages=200)
TICKS: Final = 3
TICK_NS: Final = 100_000_000

NODE_PROGRAM: Final = """
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan
from std_srvs.srv import SetBool, Trigger

class Everything(Node):
    def __init__(self):
        super().__init__("everything", namespace="fuzz")
        self.declare_parameter("speed", 0.5)
        self.drive = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(LaserScan, "/scan", self.see, 10)
        self.create_service(SetBool, "/switch", self.switch)
        self.ask = self.create_client(Trigger, "/answer")
        self.create_timer(0.05, self.go)

    def see(self, scan):
        self.get_logger().info(f"{len(scan.ranges)} rays")

    def switch(self, request, response):
        response.success = request.data
        return response

    def go(self):
        command = Twist()
        command.linear.x = self.get_parameter("speed").value
        self.drive.publish(command)
        self.ask.call_async(Trigger.Request())

rclpy.init()
rclpy.spin(Everything())
"""
FUNCTIONS_PROGRAM: Final = "def f(x):\n    return x\n"
LAUNCH_PROGRAM: Final = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo, TimerAction
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("speed", default_value="0.5", description="how fast"),
        LogInfo(msg="hello"),
        Node(package="demo", executable="drive", name="drive", parameters=[{"speed": 0.5}], remappings=[("a", "b")]),
        TimerAction(period=0.1, actions=[LogInfo(msg="later")]),
    ])
"""

ROLE_OF_STATE: Final[dict[ProcessState, Role]] = {
    ProcessState.STARTING_NODE: "node",
    ProcessState.TICKING: "node",
    ProcessState.IDLE: "node",
    ProcessState.STARTING_LAUNCH: "launch",
    ProcessState.STARTING_FUNCTIONS: "functions",
    ProcessState.CALLING_BATCH: "functions",
    ProcessState.CALLING_JSON: "functions",
}
"""The states in which a student's program is there. In ``CONFINING`` every role is tried."""
OTHER_FRAMES: Final[tuple[list[Json], ...]] = (
    ["confined", int(INTERACTIVE_LEVEL)],
    ["refused", "no Landlock"],
    ["functions", 0, ["f"]],
    ["values", 1, "AAAAAAAA8D8="],
    ["told", 1, [1.5, "a", None, [True]]],
    ["ended", 1, []],
    ["failed", 1, "exception", "NameError: x", "work.py", 3, 1],
    ["reply", 0, None, []],
)
HEAR: Final = None
"""A step of a script: wait for a frame of the parent's."""


class ScriptedProcess:
    """Stands in for ``subprocess.Popen``: a thread plays a script of bytes, and frames to be waited for."""

    script: Sequence[bytes | None] = ()

    def __init__(self, command: object, *, stdin: int, **_: object) -> None:
        self.pid = 2**31 - 1  # no process has it
        self._pipe = socket.socket(fileno=os.dup(stdin))
        self.stdout, out = _pipe()
        self.stderr, err = _pipe()
        self._thread = threading.Thread(target=self._play, args=(self.script, out, err))
        self._thread.start()

    def wait(self, timeout: float | None = None) -> int:
        self._thread.join(timeout)
        if self._thread.is_alive():
            raise subprocess.TimeoutExpired("a script", timeout or 0.0)
        return 0

    def kill(self) -> None:
        self._pipe.shutdown(socket.SHUT_RDWR)

    def _play(self, script: Sequence[bytes | None], *streams: int) -> None:
        try:
            for step in script:
                if step is HEAR:
                    (length,) = HEADER.unpack(self._pipe.recv(HEADER.size, socket.MSG_WAITALL))
                    self._pipe.recv(length, socket.MSG_WAITALL)
                if step is not None:
                    self._pipe.sendall(step)
        except (OSError, struct.error):  # the parent has disconnected
            pass
        finally:
            self._pipe.close()
            for stream in streams:
                os.close(stream)


def _pipe() -> tuple[IO[bytes], int]:
    read, write = os.pipe()
    return os.fdopen(read, "rb", 0), write


@contextmanager
def scripted(script: Sequence[bytes | None]) -> Iterator[None]:
    """Has the next process be played by a script instead of being started."""
    played = type("_Played", (ScriptedProcess,), {"script": script})
    with program_start.started_by(played):
        yield


def packed(content: Json) -> bytes:
    """A frame, of values that the kit's own encoder would refuse too."""
    data = json.dumps(content, ensure_ascii=True).encode()
    return struct.pack(">I", len(data)) + data


class Conversation:
    """Talks with a process of one role as the kit does, whatever that says."""

    def __init__(self, role: Role, file: Path, question: str = "call") -> None:
        self._role, self._file, self._question = role, file, question

    def run(self) -> FailureKind | None:
        """Returns why the program has failed; None if it has not."""
        try:
            return {"node": self._drive, "functions": self._call, "launch": self._launch}[self._role]()
        except StudentCodeError as error:
            return error.failure.kind

    def _drive(self) -> FailureKind | None:
        graph = Graph(log_sink=lambda record: None)
        world = create_graph_node(graph, "world")
        scans = world.create_publisher(LaserScan, "scan", 10)
        world.create_subscription(Twist, "cmd_vel", lambda message: None, 10)
        world.create_service(Trigger, "answer", lambda request, response: response)
        switch = world.create_client(SetBool, "switch")
        with NodeProcess.start(graph, self._file, limits=LIMITS) as program:
            for tick in range(1, TICKS + 1):
                graph.advance(tick * TICK_NS)
                scans.publish(LaserScan(ranges=[1.0, 2.0]))
                switch.call_async(SetBool.Request(data=True))
                for _ in range(4):
                    graph.run_due()
                    if not program.exchange():
                        break
            program.take_output()
            failure = program.failure
        return None if failure is None else failure.kind

    def _call(self) -> None:
        with StudentFunctions(self._file, limits=LIMITS) as functions:
            if self._question == "call":
                functions.call_batch("f", [{"x": 1.0}])
            else:
                functions.call_json("f", {"x": 1.0})

    def _launch(self) -> None:
        launch = LaunchFileProcess(self._file, self._file.parent, [], {})
        try:
            launch.start()
            for tick in range(1, TICKS + 1):
                launch.advance(tick * TICK_NS, [])
        finally:
            launch.close()


class FrameTarget:
    """Damages one frame of a true conversation, or says another one in its place."""

    def __init__(self, folder: Path) -> None:
        sources = {"node": NODE_PROGRAM, "functions": FUNCTIONS_PROGRAM, "launch": LAUNCH_PROGRAM}
        self._files = {role: folder / f"{role}.py" for role in sources}
        for role, file in self._files.items():
            file.write_text(sources[role])
        self._spoken = {
            (role, question): _record(Conversation(role, self._files[role], question))
            for role, question in (("node", ""), ("launch", ""), ("functions", "call"), ("functions", "tell"))
        }

    def attempt(self, rng: random.Random) -> str:
        """Plays one damaged conversation. AssertionError if it ends as none may."""
        state = rng.choice(list(ProcessState))
        role = ROLE_OF_STATE.get(state) or rng.choice(("node", "functions", "launch"))
        question = "" if role != "functions" else "tell" if state is ProcessState.CALLING_JSON else "call"
        spoken = self._spoken[role, question]
        at = _position(rng, state, len(spoken))
        script: list[bytes | None] = []
        for frame in spoken[:at]:
            script += [HEAR, packed(frame)]
        script += [HEAR, *([packed(spoken[at])] if state is ProcessState.IDLE else [])]
        script.append(_damaged(rng, spoken[at]))
        with scripted(script):
            kind = Conversation(role, self._files[role], question).run()
        allowed_early = ConfinementRefused in ALLOWED_FRAMES[state]
        assert kind is not FailureKind.CONFINEMENT or allowed_early, "a frame has taken the confinement away"
        return f"{state.value}: {'taken' if kind is None else kind.value}"


def _position(rng: random.Random, state: ProcessState, count: int) -> int:
    """Which frame of a conversation comes in this state: ``confined`` first, then the answer to ``start``."""
    if state is ProcessState.CONFINING:
        return 0
    if state.name.startswith("STARTING"):
        return 1
    return rng.randrange(2, count)


def _damaged(rng: random.Random, frame: list[Json]) -> bytes:
    """Returns the bytes of a frame that is damaged, or of another kind; one in ten is left as it is."""
    content: Any = frame if rng.random() < 0.7 else rng.choice(OTHER_FRAMES)
    way = rng.randrange(10)
    if way == 0:
        return packed(content)
    if way < 5:
        return packed(damage_json(rng, content))
    if way < 8:
        return packed(nudge_json(rng, content))
    data = packed(content)
    if way == 8:  # the length stays right
        body = damage_bytes(rng, {"frame": data[HEADER.size :]}, "frame")
        return HEADER.pack(len(body)) + body
    return damage_bytes(rng, {"frame": data}, "frame")


def _record(conversation: Conversation) -> list[list[Json]]:
    """Returns what a real process says in a conversation."""
    spoken: list[list[Json]] = []
    decode: Callable[[bytes], Json] = process.decode

    def listen(data: bytes) -> Json:
        spoken.append(decode(data))
        return decode(data)

    with patch.object(process, "decode", listen):
        failure = conversation.run()
    assert failure is None, failure
    return spoken
