"""Runs one program that was written outside, as ``kit launch`` would, and compares what it does with what is expected.

A program is started beside its helpers by a launch file, in a room with a robot, with turtlesim, or with the graph alone.
All is measured on the topics: the way and the turn by odometry (or by turtle1's pose), and the messages that the programs
publish.
"""

from __future__ import annotations

import math
import re
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import yaml

from kit.host.failure import StudentCodeError
from kit.inspection.server import InspectionServer
from kit.inspection.sockets import sockets_folder, world_name
from kit.launch.launch_file_process import find_launch_file, find_test_file
from kit.launch.launch_run import Launch, LaunchOutputLine
from kit.launch.launch_test import run_launch_test
from kit.launch.plain_launch import LaunchLimit, run_plain_launch
from kit.launch.processes import ProcessStartError
from kit.msg.message import type_name
from kit.ros.graph.graph import Graph

FOLDER: Final = Path(__file__).parent
SETS: Final = (
    *("first", "second", "third", "fourth", "fifth", "sixth"),
    *("seventh", "eighth", "ninth", "tenth", "eleventh", "twelfth", "thirteenth"),
)
"""Folders of programs, in the order in which they were written."""
LIMIT_S: Final = 200.0
"""How long one program may take, by the wall clock [s]."""
WORLD_NODES: Final = frozenset({"/flatland_server", "/turtlesim"})
"""What these publish is not the programs' doing."""
POSE_TOPICS: Final = {"room": "/odom", "turtlesim": "/turtle1/pose"}
LOGGED_BY_FILE: Final = "launch"
"""The name under which lines of LogInfo are logged."""
RECENT_NS: Final = 200_000_000
"""A turtle whose last pose is no older than this when the run ends is there."""
TURTLE_POSE: Final = re.compile(r"/(\w+)/pose")

_LAUNCH_FILE: Final = """
from launch import LaunchDescription
from launch.actions import ExecuteProcess, IncludeLaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        {world}
        *[IncludeLaunchDescription(file, launch_arguments=[word.split(":=") for word in words])
          for file, words in {launch_files!r}],
        *[ExecuteProcess(cmd=["python3", file, *words], name=file.rpartition("/")[2], output="screen")
          for file, words in {programs!r}],
    ])
"""
_WORLDS: Final = {
    "room": "Node(package='flatland_server', executable='flatland_server', "
    f"parameters=[{{'world_path': {str(FOLDER / 'room' / 'world.yaml')!r}, 'update_rate': 100.0, 'step_size': 0.01}}]),",
    "turtlesim": "Node(package='turtlesim', executable='turtlesim_node'),",
    "none": "",
}


@dataclass(frozen=True, slots=True)
class OutsideProgram:
    """A program, which may be a launch file, and what its author expects of it."""

    name: str
    folder: Path
    """Where it and the packages lie that it uses."""
    file: Path
    is_launch_file: bool
    is_launch_test: bool
    world: str
    seconds: float
    arguments: tuple[str, ...]
    beside: tuple[Path, ...]
    expect: dict[str, Any]

    @property
    def number(self) -> str:
        return self.name.partition("_")[0]


def programs_of(name: str) -> list[OutsideProgram]:
    """Reads the programs of a folder beside this module, in the order of their numbers."""
    return [_read(file) for file in sorted((FOLDER / name).glob("[0-9]*.yaml"))]


def _read(file: Path) -> OutsideProgram:
    card = yaml.safe_load(file.read_text(encoding="utf-8"))
    return OutsideProgram(
        file.stem,
        file.parent,
        file.parent / card.get("file", f"{file.stem}.py"),
        card.get("launch", False),
        card.get("launch_test", False),
        card["world"],
        card["seconds"],
        tuple(str(each) for each in card.get("arguments", ())),
        tuple(file.parent / name for name in card.get("beside", ())),
        card["expect"],
    )


@dataclass(slots=True)
class Track:
    """The way of a robot or a turtle."""

    first: tuple[float, float] | None = None
    last: tuple[float, float, float] = (0.0, 0.0, 0.0)
    path: float = 0.0
    turned: float = 0.0
    seen_ns: int = 0

    def add(self, x: float, y: float, theta: float, now_ns: int) -> None:
        if self.first is None:
            self.first = (x, y)
        else:
            self.path += math.hypot(x - self.last[0], y - self.last[1])
            self.turned += math.remainder(theta - self.last[2], math.tau)
        self.last, self.seen_ns = (x, y, theta), now_ns

    @property
    def moved(self) -> float:
        return 0.0 if self.first is None else math.dist(self.first, self.last[:2])


@dataclass(slots=True)
class Outcome:
    """What a program and its helpers did."""

    lines: list[tuple[str, str]] = field(default_factory=list)
    """What was printed, each line with its stream."""
    tracks: dict[str, Track] = field(default_factory=dict)
    published: dict[str, list[str]] = field(default_factory=dict)
    """The type of each message that the programs published, by topic."""
    status: int | None = None
    """The exit status; None while it runs."""
    complaints: list[str] = field(default_factory=list)


class _LimitedServer(InspectionServer):
    """Serves the world to the programs' commands, and ends a run that takes too long."""

    def __init__(self, graph: Graph, folder: Path, world: str) -> None:
        super().__init__(graph, folder, world)
        self._until = time.monotonic() + LIMIT_S

    def exchange(self) -> bool:
        if time.monotonic() > self._until:
            raise TimeoutError
        return super().exchange()


def run_program(program: OutsideProgram, seed: int = 0) -> Outcome:
    """Runs a program beside its helpers, or a launch test, and compares what it does with what is expected."""
    if program.is_launch_test:
        return _run_test(program, seed)
    graph, outcome = Graph(), Outcome()
    program_name = program.file.name
    ending = re.compile(r"process has (finished cleanly|died) \[pid \d+(?:, exit code (\d+))?")

    def on_message(now_ns: int, node: Any, topic: str, message: Any) -> None:
        if topic == "/odom" and program.world == "room":
            pose = message.pose.pose
            theta = 2 * math.atan2(pose.orientation.z, pose.orientation.w)
            _track(outcome, topic).add(pose.position.x, pose.position.y, theta, now_ns)
        elif program.world == "turtlesim" and TURTLE_POSE.fullmatch(topic):
            _track(outcome, topic).add(message.x, message.y, message.theta, now_ns)
        if node.get_fully_qualified_name() not in WORLD_NODES:
            outcome.published.setdefault(topic, []).append(type_name(type(message)))

    def on_output(line: LaunchOutputLine) -> None:
        if line.severity is None or line.program == LOGGED_BY_FILE:
            outcome.lines.append((line.text, line.stream))
        elif line.program.startswith(program_name) and (found := ending.match(line.text)):
            outcome.status = int(found[2] or 0)

    with tempfile.TemporaryDirectory() as folder:
        launch_file = Path(folder) / "outside.launch.py"
        itself = [(str(program.file), list(program.arguments))]
        launch_files, programs = (itself, []) if program.is_launch_file else ([], itself)
        programs += [(str(each), []) for each in program.beside]
        text = _LAUNCH_FILE.format(world=_WORLDS[program.world], launch_files=launch_files, programs=programs)
        launch_file.write_text(text, encoding="utf-8")
        target = find_launch_file(str(launch_file), None, (program.folder,))
        name, workspace = target.name, Path(folder) / "workspace"
        launch = Launch(
            target, graph, seed=seed, workspace=workspace, name=world_name(name), on_output=on_output
        )
        graph.add_message_listener(on_message)
        has_subscriptions = graph.has_subscriptions
        graph.has_subscriptions = lambda topic: (
            topic == "/odom" or has_subscriptions(topic)
        )  # to be published
        try:
            run_plain_launch(
                launch,
                seed=seed,
                limit=LaunchLimit(None, program.seconds),
                make_companion=lambda graph: _LimitedServer(graph, sockets_folder(workspace), name),
            )
        except (StudentCodeError, ProcessStartError) as problem:
            outcome.complaints.append(f"the launch failed: {problem}")
        except TimeoutError:
            outcome.complaints.append(f"not done after {LIMIT_S:g} s of the wall clock")
    outcome.complaints += _complaints(program, outcome, graph.now_ns)
    return outcome


def _run_test(program: OutsideProgram, seed: int) -> Outcome:
    outcome = Outcome()
    with tempfile.TemporaryDirectory() as folder:
        try:
            tested = run_launch_test(
                find_test_file(program.file, ()),
                dict(word.split(":=", 1) for word in program.arguments),
                seed=seed,
                workspace=Path(folder),
                on_output=lambda line: outcome.lines.append((line.text, line.stream)),
            )
        except (StudentCodeError, ProcessStartError) as problem:
            outcome.complaints.append(f"the launch failed: {problem}")
        else:
            outcome.status = int(any(each.is_failed for each in tested))
    outcome.complaints += _complaints(program, outcome, 0)
    return outcome


def _first_missing(patterns: Sequence[str], lines: Sequence[tuple[str, str]]) -> str | None:
    """Returns the first pattern that is not printed after those before it.

    What is printed and what is logged are two streams, which have no common order: each has its own place.
    """
    rest = {name: "\n".join(text for text, stream in lines if stream == name) for name in ("out", "err")}
    for pattern in patterns:
        for stream, text in rest.items():
            if match := re.search(pattern, text, re.MULTILINE):
                rest[stream] = text[match.end() :]
                break
        else:
            return pattern
    return None


def _track(outcome: Outcome, topic: str) -> Track:
    return outcome.tracks.setdefault(topic, Track())


def _complaints(program: OutsideProgram, outcome: Outcome, now_ns: int) -> list[str]:
    """What differs from what is expected."""
    expect, found = program.expect, []
    track = _track(outcome, POSE_TOPICS.get(program.world, ""))
    for name, value in (("moved", track.moved), ("path", track.path), ("turned", track.turned)):
        if name in expect and not expect[name][0] <= value <= expect[name][1]:
            found.append(f"{name} {value:.2f}, not {expect[name]}")
    if "position" in expect:
        wanted = expect["position"]
        if math.dist(track.last[:2], (wanted["x"], wanted["y"])) > wanted["within"]:
            found.append(f"at ({track.last[0]:.2f}, {track.last[1]:.2f}), not ({wanted['x']}, {wanted['y']})")
    for topic, wanted in expect.get("published", {}).items():
        types = outcome.published.get(topic, [])
        if not wanted["count"][0] <= len(types) <= wanted["count"][1]:
            found.append(f"{len(types)} messages on {topic}, not {wanted['count']}")
        if types and set(types) != {wanted["type"]}:
            found.append(f"{topic} of type {', '.join(sorted(set(types)))}, not {wanted['type']}")
    if missing := _first_missing(expect.get("prints", ()), outcome.lines):
        last = (outcome.lines or [("nothing", "out")])[-1][0]
        found.append(f"never printed {missing!r}; the last line was: {last}")
    if "ends" in expect and expect["ends"] != (outcome.status is not None):
        found.append("it did not end" if expect["ends"] else f"it ended with status {outcome.status}")
    if "status" in expect and outcome.status != expect["status"]:
        found.append(f"exit status {outcome.status}, not {expect['status']}")
    if "turtles" in expect:
        there = {
            topic.split("/")[1]
            for topic, each in outcome.tracks.items()
            if TURTLE_POSE.fullmatch(topic) and now_ns - each.seen_ns <= RECENT_NS
        }
        if there != set(expect["turtles"]):
            found.append(f"turtles {', '.join(sorted(there))}, not {', '.join(sorted(expect['turtles']))}")
    return found
