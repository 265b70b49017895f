"""Runs a launch file with all its processes in one graph, and its ticks where it has no world.

Of its lifecycle nodes it requests transitions, one after the other, and reports those that they make.
"""

from __future__ import annotations

import signal
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple

from kit.host.failure import StudentCodeError
from kit.host.wire import Json
from kit.launch.launch_bounds import INTERACTIVE_BOUNDS, LaunchBounds
from kit.launch.launch_file_process import LaunchFile, LaunchFileProcess, LaunchTarget
from kit.launch.processes import (
    CommandProcess,
    Process,
    ProcessExit,
    ProcessStartError,
    ProgramUnavailable,
)
from kit.launch.program_lookup import StartContext, is_builtin, start_process
from kit.launch.requests import (
    EndRequest,
    LogRequest,
    OutputRequest,
    Request,
    ShutdownRequest,
    StartRequest,
    TimerRequest,
    TransitionRequest,
    WatchRequest,
    WorldRequest,
)
from kit.msg.lifecycle_msgs import ChangeState, Transition, TransitionEvent
from kit.ros.exceptions import InvalidServiceNameException, InvalidTopicNameException
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node, create_graph_node
from kit.run.connection_watch import ConnectionWatch
from kit.run.lockstep import Participant, exchange_until_idle

if TYPE_CHECKING:
    from kit.run.session import SceneAddition


class _Call(NamedTuple):
    request: TransitionRequest
    client: Any
    future: Any


class LifecycleTransitions:
    """The transitions that a launch file wants, each made as soon as its node is there.

    ``log`` receives what went wrong, ``report`` the event of each transition of a watched node.
    """

    def __init__(
        self, graph: Graph, log: Callable[[str, str], object], report: Callable[[list[Json]], object]
    ) -> None:
        self._graph, self._log, self._report = graph, log, report
        self._node: Node | None = None
        self._waiting: list[TransitionRequest] = []
        self._call: _Call | None = None

    def add(self, request: TransitionRequest) -> None:
        """Requests one more, after those before it."""
        self._waiting.append(request)

    def watch(self, node: str) -> None:
        """Reports every transition of a node from now on."""

        def on_event(event: Any) -> None:
            labels = (event.transition.label, event.start_state.label, event.goal_state.label)
            self._report(["transitioned", node, *labels])

        try:
            self._own_node().create_subscription(TransitionEvent, f"{node}/transition_event", on_event, 10)
        except InvalidTopicNameException as problem:
            self._log(str(problem), "ERROR")

    def poll(self) -> None:
        """Goes on with what has become possible; never waits."""
        if self._call is not None and self._call.future.done():
            request, client, future = self._call
            assert self._node is not None
            self._node.destroy_client(client)
            self._call = None
            response = future.result()
            if response is None or not response.success:
                self._log(f"{request.node} refused transition {request.transition}", "ERROR")
                self._waiting = [each for each in self._waiting if each.node != request.node]
        if self._call is None and self._waiting:
            self._begin(self._waiting[0])

    def close(self) -> None:
        """Leaves the graph."""
        if self._node is not None:
            self._node.destroy_node()
            self._node = None

    def _own_node(self) -> Node:
        if self._node is None:
            self._node = create_graph_node(self._graph, "launch_ros", "/")
        return self._node

    def _begin(self, request: TransitionRequest) -> None:
        service = f"{request.node}/change_state"
        if service not in self._graph.directory.services:
            return  # the node is not there yet
        try:
            client = self._own_node().create_client(ChangeState, service)
        except InvalidServiceNameException as problem:
            self._log(str(problem), "ERROR")
            self._waiting.pop(0)
            return
        wanted = ChangeState.Request(transition=Transition(id=request.transition))
        self._call = _Call(request, client, client.call_async(wanted))
        self._waiting.pop(0)


KILLED: Final = 128 + signal.SIGKILL
"""The exit code of a program that did not end when it was asked to."""
POLL_INTERVAL_S: Final = 0.05
"""How often processes are polled while the simulated time does not advance [s]."""


@dataclass(frozen=True, slots=True)
class LaunchOutputLine:
    """A line printed by a process, or logged by the launch itself."""

    program: str
    """``random_walk-2``, or ``launch``."""
    text: str
    stream: Literal["out", "err"] = "out"
    severity: str | None = None
    """The severity of a line that the launch logs; None for a line that a program printed."""

    def __str__(self) -> str:
        if self.severity is None:
            return f"[{self.program}] {self.text}"
        return f"[{self.severity}] [{self.program}]: {self.text}"


@dataclass(slots=True)
class _RunningProcess:
    """A process with the request that it was started for."""

    request: StartRequest
    process: Process
    started_ns: int
    """When it was started [ns of the graph]; what was started before the first tick, just before that."""


class Launch:
    """A launch file and the processes it has started: a participant of the lock-step. Close it when done.

    ``load`` runs the launch file and collects its requests; ``start_processes`` starts the processes and waits until
    they are in the graph. From then on ``exchange`` is called in each tick and does not wait. The launch's time is
    the graph's, without its jumps. Each line that is printed or logged is passed to ``on_output``.
    """

    def __init__(
        self,
        target: LaunchTarget,
        graph: Graph,
        *,
        arguments: Mapping[str, str] | None = None,
        seed: int = 0,
        workspace: Path | None = None,
        name: str = "",
        bounds: LaunchBounds = INTERACTIVE_BOUNDS,
        on_output: Callable[[LaunchOutputLine], None] = lambda line: None,
        launch_file: LaunchFile | None = None,
    ) -> None:
        """``launch_file``: the process that runs the file, where that is not simply a launch file; closed with the launch."""
        self.target = target
        self.graph = graph
        self.world: WorldRequest | None = None
        """The world that the launch file asks for; None as long as it has asked for none."""
        self.wants_view = False
        """Whether it has asked for RViz or another viewer."""
        self.additions: list[SceneAddition] = []
        """What is drawn with the world and is not part of it."""
        self.failures: list[str] = []
        """Failures of its processes and of the launch file, as text."""
        self._has_ended = False
        """Whether all processes have been ended, by the launch file or by the user."""
        self.delays_command_ends = False
        """Whether the end of a command that is started within a tick counts in the next one at the earliest: in a run that waits
        for commands, so that it does not depend on how fast they are."""
        self._on_output = on_output
        self._start_context = StartContext(
            graph,
            target.search,
            seed,
            self._log,
            self._request_world,
            self._request_view,
            workspace,
            name,
            bounds,
            add_to_scene=self.additions.append,
        )
        self._transitions = LifecycleTransitions(graph, self._log, self._report)
        self._connection_watch = ConnectionWatch(
            graph, self._watched_nodes, lambda text: self._log(text, "WARN")
        )
        self._started = 0
        self._waiting: list[StartRequest] = []
        self._running: dict[int, _RunningProcess] = {}
        self._events: list[Json] = []
        self._reports_output = False
        self._clock_ns = 0
        self._settled_ns = 0
        """When the last of the timers is due that no timer has set."""
        self._seen_ns = graph.now_ns
        self._polled_s = 0.0
        self._has_sent = False
        """Whether a program sent something in the last exchange, which others may not have received yet."""
        self._launch_file: LaunchFile = launch_file or LaunchFileProcess(
            target.file, target.folder, target.search, arguments or {}, bounds
        )

    def load(self) -> None:
        """Runs the launch file and collects its requests; builtin programs start at once.

        Raises StudentCodeError, ProcessStartError.
        """
        self._carry_out(self._launch_file.start())
        self._start_waiting(is_builtin)
        if not (self._started or self.world or self.has_programs or self.has_timers):
            self._log(f"{self.target.file.name} starts no program: its LaunchDescription has no Node.")

    def start_processes(self) -> None:
        """Starts the requested processes and waits until they are in the graph. Raises ProcessStartError."""
        self._start_waiting(started_ns=self.graph.now_ns - 1)
        self._tell_events()
        for running in list(self._running.values()):
            running.process.wait_until_started()
        self._start_requested()
        self._poll_processes()

    @property
    def is_over(self) -> bool:
        """Whether all processes have been ended, and the launch file has nothing more to do."""
        return self._has_ended and not self._launch_file.is_busy

    @property
    def has_programs(self) -> bool:
        """True if a process runs or waits that can end by itself, or the launch file is still to hear of an end, or is busy."""
        return any(not running.process.is_builtin for running in self._running.values()) or bool(
            self._waiting or self._events or self._launch_file.is_busy
        )

    @property
    def commands(self) -> dict[CommandProcess, int]:
        """The processes that run by the wall clock, and not in the lock-step, and when each was started [ns of the graph]."""
        every = self._running.values()
        return {each.process: each.started_ns for each in every if isinstance(each.process, CommandProcess)}

    @property
    def has_timers(self) -> bool:
        """True if the launch file has timers that are not due yet."""
        return self._launch_file.wake_ns is not None

    def exchange(self) -> bool:
        """Exchanges messages with all programs, and polls the processes at most once per tick. True if any sent
        something."""
        now = self.graph.now_ns
        is_late = not self._has_sent and time.monotonic() - self._polled_s > POLL_INTERVAL_S
        if now != self._seen_ns or is_late:
            self._clock_ns += max(0, now - self._seen_ns)
            self._seen_ns = now
            self._poll_processes()
        had_sent, self._has_sent = self._has_sent, False
        with self._launch_file_failures():
            requests = self._launch_file.exchange()
            if requests is not None:
                self._has_sent = True
                self._carry_out(requests)
        if self._has_sent:
            self._start_requested()
        for running in list(self._running.values()):
            self._has_sent |= running.process.exchange()
        if self._has_sent or not had_sent:
            return self._has_sent
        # All have received what a program has sent before it ended: its end counts in the tick in which it comes, however
        # long that takes.
        has_ended = any(self._poll(running) is not None for running in self._running.values())
        if has_ended:
            self._poll_processes()
        return has_ended

    def interrupt(self, reason: str) -> None:
        """Ends the launch for the user: the launch file may react, then all processes are ended."""
        if not self._has_ended:
            self._log(f"ended by the user: {reason}")
            self._advance_launch_file([["interrupted", reason]])
            self._end_all_processes()

    def tell_unconnected(self) -> None:
        """Warns, at the end of a run, of what its programs still connect to that has no other end."""
        self._connection_watch.tell_all()

    def close(self) -> None:
        """Ends all processes. May be called twice."""
        self._end_all_processes(tells=False)
        self._transitions.close()
        self._launch_file.close()

    def _poll_processes(self) -> None:
        self._polled_s = time.monotonic()
        if self._has_ended:
            return
        for number, running in list(self._running.items()):
            ended = self._poll(running)
            self._pass_on_output(running)
            if ended is not None:
                self._record_exit(number, running, ended)
        self._transitions.poll()
        self._connection_watch.look()
        wake = self._launch_file.wake_ns
        if self._events or (wake is not None and wake <= self._clock_ns):
            self._tell_events()
            self._start_requested()
        elif self._launch_file.is_busy and not (self._running or self._waiting or self.has_timers):
            self._end_all_processes()  # as ROS 2 ends a launch in which nothing runs any more

    def _poll(self, running: _RunningProcess) -> ProcessExit | None:
        is_command = isinstance(running.process, CommandProcess)
        if self.delays_command_ends and is_command and running.started_ns == self.graph.now_ns:
            return None
        return running.process.poll()

    def _start_requested(self) -> None:
        try:
            # Time stands still until they are there: they are in step from the tick in which they were due.
            while every := self._start_waiting():
                self._tell_events()  # what waits for their start comes before what they say
                for started in every:
                    started.wait_until_started()
                    self._has_sent = True  # it may have ended already: its end counts in this tick
        except ProcessStartError as problem:
            self._record_failure(str(problem))
            self._end_all_processes()

    def _tell_events(self) -> None:
        """Tells the launch file what has happened since, and lets the timers fire that are due."""
        events, self._events = self._events, []
        self._advance_launch_file(events)

    def _advance_launch_file(self, events: list[Json]) -> None:
        with self._launch_file_failures():
            self._carry_out(self._launch_file.advance(self._clock_ns, events))

    @contextmanager
    def _launch_file_failures(self) -> Iterator[None]:
        """Ends the launch if its file fails."""
        try:
            yield
        except StudentCodeError as error:
            self._record_failure(f"the launch file stopped: {error.failure}")
            self._end_all_processes(tells=False)

    def _carry_out(self, requests: list[Request]) -> None:
        self._pass_on_file_output()
        for request in requests:
            if isinstance(request, StartRequest):
                self._waiting.append(request)
            elif isinstance(request, LogRequest):
                self._log(request.text, request.severity)
            elif isinstance(request, OutputRequest):
                self._reports_output = True
            elif isinstance(request, TransitionRequest):
                self._transitions.add(request)
            elif isinstance(request, WatchRequest):
                self._transitions.watch(request.node)
            elif isinstance(request, TimerRequest):
                self._settled_ns = max(self._settled_ns, request.due_ns)
            elif isinstance(request, EndRequest):
                self._end_process(request.number)
            elif isinstance(request, ShutdownRequest):
                self._log(f"everything is stopped: {request.reason}")
                self._end_all_processes()

    def _start_waiting(
        self,
        which: Callable[[StartRequest], bool] = lambda request: True,
        *,
        started_ns: int | None = None,
    ) -> list[Process]:
        """Starts the processes that wait to be started, and returns them. ``started_ns``: by default now. Raises
        ProcessStartError."""
        chosen = [request for request in self._waiting if which(request)]
        self._waiting = [request for request in self._waiting if not which(request)]
        max_processes = self._start_context.bounds.max_processes
        started: list[Process] = []
        for request in chosen:
            self._started += 1
            if max_processes is not None and self._started > max_processes:
                raise ProcessStartError(f"{request.where}more than {max_processes} processes are started")
            try:
                process = start_process(request, self._start_context)
            except ProgramUnavailable as problem:
                self._log(f"skipped: {problem}", "WARN", name=request.name)
                continue
            self._running[request.number] = _RunningProcess(
                request, process, self.graph.now_ns if started_ns is None else started_ns
            )
            started.append(process)
            self._events.append(["started", request.number, process.pid])
            self._log(f"process started with pid [{process.pid}]", name=request.name)
        return started

    def _record_exit(
        self, number: int, running: _RunningProcess, ended: ProcessExit, *, was_asked: bool = False
    ) -> None:
        """``was_asked``: it was asked to end, so that it is no failure of the launch."""
        pid, name = running.process.pid, running.request.name
        running.process.close()
        del self._running[number]
        self._events.append(["exited", number, pid, ended.code])
        if ended.code == 0:
            self._log(f"process has finished cleanly [pid {pid}]", name=name)
            return
        self._log(f"process has died [pid {pid}, exit code {ended.code}]", "ERROR", name=name)
        if was_asked:
            return
        reason = ended.reason or f"exit code {ended.code}"
        self.failures.append(f"{name}: {reason}")
        if ended.reason:
            self._on_output(LaunchOutputLine(name, ended.reason, "err"))

    def _end_process(self, number: int) -> None:
        running = self._running.get(number)
        if running is not None:
            running.process.close()
            self._pass_on_output(running)
            self._record_exit(number, running, _exit_of(running.process), was_asked=True)
        self._waiting = [request for request in self._waiting if request.number != number]

    def _end_all_processes(self, *, tells: bool = True) -> None:
        """``tells``: whether the launch file hears of it, where it goes on after the end."""
        had_ended, self._has_ended = self._has_ended, True
        for number, running in self._running.items():
            self._pass_on_output(running)
            running.process.close()
            self._pass_on_output(running)
            self._events.append(["exited", number, running.process.pid, _exit_of(running.process).code])
        self._running.clear()
        self._waiting.clear()
        events, self._events = self._events, []
        if tells and not had_ended:
            with self._launch_file_failures():
                self._launch_file.end(events)
            self._pass_on_file_output()

    def _pass_on_file_output(self) -> None:
        for line in self._launch_file.take_output().lines:
            self._on_output(LaunchOutputLine("launch", line.text, line.stream))

    def _pass_on_output(self, running: _RunningProcess) -> None:
        for text, stream in running.process.take_lines():
            self._on_output(LaunchOutputLine(running.request.name, text, stream))
            if self._reports_output:
                self._events.append(["printed", running.request.number, f"{text}\n", stream == "out"])

    def _log(self, text: str, severity: str = "INFO", *, name: str = "launch") -> None:
        self._on_output(
            LaunchOutputLine(name, text, "err" if severity in ("ERROR", "FATAL") else "out", severity)
        )

    def _report(self, event: list[Json]) -> None:
        """Queues an event for the launch file."""
        self._events.append(event)

    def _watched_nodes(self) -> frozenset[str]:
        """Its programs' nodes; none while others are still to be started, which may be the other ends."""
        if self._waiting or (self.has_timers and self._clock_ns < self._settled_ns):
            return frozenset()
        return frozenset[str]().union(*(running.process.node_names for running in self._running.values()))

    def _record_failure(self, text: str) -> None:
        self.failures.append(text)
        self._log(text, "ERROR")

    def _request_world(self, world: WorldRequest) -> None:
        if self.world is not None:
            raise ProcessStartError(
                f"{world.where}a launch can have only one flatland_server; this is the second"
            )
        self.world = world

    def _request_view(self) -> None:
        self.wants_view = True


def _exit_of(process: Process) -> ProcessExit:
    """How a closed process has ended; one that was asked to end and did not is killed, and what the kit itself runs just ends."""
    return process.poll() or ProcessExit(0 if process.is_builtin else KILLED)


class GraphOnlyRun:
    """Ticks the programs of a launch without a world: a graph and its participants, with a clock."""

    def __init__(self, graph: Graph, step_size: float = 0.01) -> None:
        """``step_size``: simulated time of a tick [s]."""
        self.graph = graph
        self.step_size = step_size
        self.participants: list[Participant] = []

    def exchange_until_idle(self) -> None:
        """Runs callbacks and exchanges messages until nothing is due; time stands still."""
        exchange_until_idle(self.graph, self.participants)

    def tick(self) -> None:
        """Exchanges messages until no participant has any; then advances the time by a step."""
        self.exchange_until_idle()
        self.graph.advance(self.graph.now_ns + round(self.step_size * 1e9))
