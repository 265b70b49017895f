"""Runs a test for launch_testing: the launch that the file describes, and its tests as one more program in the same time.

The file runs in one process, which requests processes as a launch file does and tests what they do (see
``kit.host.child.launch_test_program``). It is a program of the graph, so its tests wait in simulated time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final, cast

from kit.host.failure import StudentCodeError
from kit.host.graph_bridge import LAUNCH_CHANNEL, LAUNCH_OVER
from kit.host.node_process import NodeProcess
from kit.host.output import ProgramOutput
from kit.host.program_start import PackageProgram
from kit.host.protocol import GraphEvent
from kit.host.wire import Json, ProtocolError, integer, items, number, text
from kit.launch.launch_file_process import LaunchTarget
from kit.launch.launch_run import Launch, LaunchOutputLine
from kit.launch.plain_launch import run_plain_launch
from kit.launch.program_lookup import program_of_file
from kit.launch.requests import Request, parse_request
from kit.ros.graph.graph import Graph
from kit.ros.log import LogRecord
from kit.run.lockstep import ClosableParticipant
from kit.run.pacing import MAXIMUM

OUTCOMES: Final = ("passed", "failure", "error", "skipped")


@dataclass(frozen=True, slots=True)
class TestedCase:
    """How one test ended."""

    __test__ = False  # none of pytest's

    case: str
    """The name of its class."""
    name: str
    seconds: float
    """Simulated time that it took [s]."""
    outcome: str
    """One of OUTCOMES."""
    message: str


@dataclass(frozen=True, slots=True)
class TestedLaunch:
    """How the tests of one launch ended."""

    __test__ = False

    suffix: str
    """The values that it was launched with, as the end of a name; may be empty."""
    cases: tuple[TestedCase, ...]
    reason: str
    """Why the tests were not run, or not to their end; empty if they were."""
    is_failed: bool


class LaunchTestFile:
    """One launch of a test file: what a ``Launch`` needs of its launch file. All failures are raised as StudentCodeError."""

    def __init__(
        self,
        target: LaunchTarget,
        graph: Graph,
        arguments: Mapping[str, str],
        run: int,
        *,
        seed: int,
        package: PackageProgram,
    ) -> None:
        """``run``: the number of the launch, from 0, where the file is launched for several values."""
        self.run_count = 1
        """How many launches the file has; known when the first has begun."""
        self.result: TestedLaunch | None = None
        self.wake_ns: int | None = None
        """When the launch's next timer is due [ns]; None without timers."""
        self._requests: list[Request] = []
        self._node = NodeProcess(
            graph,
            target.file,
            seed=seed,
            package=package,
            launch_test={"run": run, "arguments": dict(arguments)},
        )
        self._send = self._node.open_channel(LAUNCH_CHANNEL, self._receive)

    @property
    def is_busy(self) -> bool:
        """Whether the program of the tests is running."""
        return self._node.is_running

    def start(self) -> list[Request]:
        """Waits until the file is loaded; returns its first requests."""
        self._node.wait_until_started()
        self._node.join()
        return self._take_requests()

    def advance(self, now_ns: int, events: list[Json]) -> list[Request]:
        """Sends events, now; returns the requests that follow."""
        for event in events:
            self._send(event)
        self._node.exchange()
        return self._take_requests()

    def end(self, events: list[Json]) -> None:
        """Sends the last events: every process has ended. The tests that come after the end begin."""
        self.advance(0, [*events, [LAUNCH_OVER]])

    def exchange(self) -> list[Request] | None:
        """Exchanges messages, as a participant of the lock-step, and returns the requests that have come; None if there was
        nothing to exchange."""
        return self._take_requests() if self._node.exchange() else None

    def _take_requests(self) -> list[Request]:
        if self._node.failure is not None:
            raise StudentCodeError(self._node.failure)
        requests, self._requests = self._requests, []
        return requests

    def take_output(self) -> ProgramOutput:
        """Removes and returns what the tests have printed."""
        return self._node.take_output()

    def close(self) -> None:
        self._node.close()

    def _receive(self, fields: list[Json]) -> None:
        wake, requests = items(fields, 2)
        self.wake_ns = None if wake is None else integer(wake, 0, 2**63 - 1)
        for request in items(requests):
            kind, *content = items(request)
            if kind == "runs":
                self.run_count = integer(*content)
            elif kind == "tested":
                self.result = _parse_tested(*items(content, 4))
            else:
                try:
                    self._requests.append(parse_request(GraphEvent(text(kind), content)))
                except TypeError as problem:  # too many or too few parts
                    raise ProtocolError(str(problem)) from None


def _parse_tested(suffix: Json, cases: Json, reason: Json, is_failed: Json) -> TestedLaunch:
    return TestedLaunch(
        _any_text(suffix),
        tuple(_parse_case(*items(case, 5)) for case in items(cases)),
        _any_text(reason),
        is_failed is True,
    )


def _parse_case(case: Json, name: Json, seconds: Json, outcome: Json, message: Json) -> TestedCase:
    if outcome not in OUTCOMES:
        raise ProtocolError("no outcome of a test")
    return TestedCase(
        _any_text(case), _any_text(name), number(seconds), cast(str, outcome), _any_text(message)
    )


def _any_text(value: Json) -> str:
    if type(value) is not str:
        raise ProtocolError("no text")
    return value


def run_launch_test(
    target: LaunchTarget,
    arguments: Mapping[str, str],
    *,
    seed: int = 0,
    workspace: Path | None = None,
    name: str = "",
    on_output: Callable[[LaunchOutputLine], None],
    make_companion: Callable[[Graph], ClosableParticipant | None] = lambda graph: None,
    log: Callable[[LogRecord], None] = lambda record: None,
) -> list[TestedLaunch]:
    """Runs every launch of a test file, one after the other, as fast as possible; returns how their tests ended.

    Raises StudentCodeError, ProcessStartError, WorldError, OSError, and KeyboardInterrupt.
    """
    tested: list[TestedLaunch] = []
    run_count = 1
    while len(tested) < run_count:
        graph = Graph()
        package = program_of_file(target.file, Path.cwd(), target.search, workspace, name)
        file = LaunchTestFile(target, graph, arguments, len(tested), seed=seed, package=package)
        launch = Launch(
            target, graph, seed=seed, workspace=workspace, name=name, on_output=on_output, launch_file=file
        )
        run_plain_launch(launch, seed=seed, factor=MAXIMUM, make_companion=make_companion, log=log)
        run_count = file.run_count
        tested.append(
            file.result or TestedLaunch("", (), "; ".join(launch.failures) or "the tests did not end", True)
        )
    return tested
