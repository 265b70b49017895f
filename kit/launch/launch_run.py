"""A launch: one launch file being carried out, with all its processes, in one graph."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

from kit.host.failure import GuestError
from kit.host.wire import Json
from kit.launch.advice import advice
from kit.launch.errors import CannotStart
from kit.launch.launch_file_process import LaunchFile
from kit.launch.launch_file_search import LaunchTarget
from kit.launch.processes import Ended, Process
from kit.launch.program_lookup import DESK_BOUNDS, Bounds, Means, is_ours, start
from kit.launch.requests import End, EndAll, Listen, Request, Say, Start
from kit.launch.world import WorldWanted
from kit.ros.graph.graph import Graph

LOOK_S: Final = 0.05
"""While time stands still: seconds between two looks at the processes."""


@dataclass(frozen=True, slots=True)
class Line:
    """Something said: by a process, or by the launch itself."""

    program: str
    """``random_walk-2``, or ``launch``."""
    text: str
    stream: Literal["out", "err"] = "out"
    severity: str | None = None
    """Of what the launch says of a program or of itself; None: the program's own words."""

    def __str__(self) -> str:
        if self.severity is None:
            return f"[{self.program}] {self.text}"
        return f"[{self.severity}] [{self.program}]: {self.text}"


@dataclass(slots=True)
class _Running:
    request: Start
    process: Process


class Launch:
    """Everything that one launch file has started. A guest of whoever ticks; close it when done.

    ``begin`` reads the launch file and notes what it wants; ``start`` starts that and waits until it is there.
    From then on ``exchange`` sees to what follows: it is called in each tick and does not wait. The launch's time
    is the graph's, without its jumps. What is said goes to ``say``.
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
        bounds: Bounds = DESK_BOUNDS,
        say: Callable[[Line], None] = lambda line: None,
    ) -> None:
        self.target = target
        self.graph = graph
        self.world: WorldWanted | None = None
        """What the launch file has asked Flatland's server for, as soon as it has."""
        self.wants_view = False
        """Whether it has asked for RViz or the like."""
        self.failures: list[str] = []
        """What has gone wrong with its processes."""
        self.is_over = False
        """Whether everything has been ended, by the launch file's wish or the user's."""
        self._say = say
        self._means = Means(
            graph,
            target.search,
            seed,
            self._tell,
            self._want_world,
            self._want_view,
            workspace,
            name,
            bounds,
        )
        self._started = 0
        self._waiting: list[Start] = []
        self._running: dict[int, _Running] = {}
        self._happened: list[Json] = []
        self._listens = False
        self._clock_ns = 0
        self._seen_ns = graph.now_ns
        self._looked_s = 0.0
        self._file = LaunchFile(target.file, target.folder, target.search, arguments or {}, bounds)

    def begin(self) -> None:
        """Reads the launch file and notes what it wants at once; what the kit has itself is there at once.

        Raises GuestError, CannotStart.
        """
        self._carry_out(self._file.begin())
        self._start_waiting(is_ours)

    def start(self) -> None:
        """Starts what is wanted so far, and waits until it is there. Raises CannotStart."""
        self._start_waiting()
        for running in list(self._running.values()):
            running.process.wait_until_started()
        self._look()

    @property
    def has_programs(self) -> bool:
        """Whether anything runs that can come to an end by itself."""
        return any(not running.process.is_ours for running in self._running.values()) or bool(self._waiting)

    @property
    def wants_time(self) -> bool:
        """Whether the launch file wants to go on later."""
        return self._file.wake_ns is not None

    def exchange(self) -> bool:
        """As a runner's guest: talks with all programs; now and then looks who has ended, and what follows."""
        now = self.graph.now_ns
        if now != self._seen_ns or time.monotonic() - self._looked_s > LOOK_S:
            self._clock_ns += max(0, now - self._seen_ns)
            self._seen_ns = now
            self._look()
        heard = False
        for running in list(self._running.values()):
            heard |= running.process.exchange()
        return heard

    def interrupt(self, reason: str) -> None:
        """The user wants the end: the launch file may react, then everything is ended."""
        if not self.is_over:
            self._tell(f"ended by the user: {reason}")
            self._ask([["interrupted", reason]])
            self._end_all()

    def close(self) -> None:
        """Ends everything at once. May be called twice."""
        self.is_over = True
        self._waiting.clear()
        for running in self._running.values():
            running.process.close()
        self._running.clear()
        self._file.close()

    def _look(self) -> None:
        self._looked_s = time.monotonic()
        if self.is_over:
            return
        for number, running in list(self._running.items()):
            ended = running.process.poll()
            self._print(running)
            if ended is not None:
                self._note_end(number, running, ended)
        wake = self._file.wake_ns
        if self._happened or (wake is not None and wake <= self._clock_ns):
            happened, self._happened = self._happened, []
            self._ask(happened)
            try:
                self._start_waiting()
            except CannotStart as problem:
                self._fail(str(problem))
                self._end_all()

    def _ask(self, happened: list[Json]) -> None:
        try:
            self._carry_out(self._file.go_on(self._clock_ns, happened))
        except GuestError as error:
            self._fail(f"the launch file stopped: {error.failure}")
            self._end_all()

    def _carry_out(self, requests: list[Request]) -> None:
        for line in self._file.take_output().lines:
            self._say(Line("launch", line.text, line.stream))
        for request in requests:
            if isinstance(request, Start):
                self._waiting.append(request)
            elif isinstance(request, Say):
                self._tell(request.text, request.severity)
            elif isinstance(request, Listen):
                self._listens = True
            elif isinstance(request, End):
                self._end(request.number)
            elif isinstance(request, EndAll):
                self._tell(f"everything is ended: {request.reason}")
                self._end_all()

    def _start_waiting(self, which: Callable[[Start], bool] = lambda request: True) -> None:
        chosen = [request for request in self._waiting if which(request)]
        self._waiting = [request for request in self._waiting if not which(request)]
        most = self._means.bounds.most
        for request in chosen:
            self._started += 1
            if most is not None and self._started > most:
                raise CannotStart(f"{request.where}more than {most} processes are started")
            process = start(request, self._means)
            self._running[request.number] = _Running(request, process)
            self._happened.append(["started", request.number, process.pid])
            self._tell(f"process started with pid [{process.pid}]", name=request.name)

    def _note_end(self, number: int, running: _Running, ended: Ended) -> None:
        pid, name = running.process.pid, running.request.name
        running.process.close()
        del self._running[number]
        self._happened.append(["exited", number, pid, ended.code])
        if ended.code == 0:
            self._tell(f"process has finished cleanly [pid {pid}]", name=name)
            return
        self._tell(f"process has died [pid {pid}, exit code {ended.code}]", "ERROR", name=name)
        reason = ended.reason or f"exit code {ended.code}"
        self.failures.append(f"{name}: {reason}")
        if ended.reason:
            self._say(Line(name, ended.reason, "err"))
        hint = advice(ended.reason)
        if hint:
            self._say(Line(name, hint, "err"))

    def _end(self, number: int) -> None:
        running = self._running.get(number)
        if running is not None:
            running.process.close()
            self._note_end(number, running, Ended(0))
        self._waiting = [request for request in self._waiting if request.number != number]

    def _end_all(self) -> None:
        for running in self._running.values():
            self._print(running)
            running.process.close()
        self._running.clear()
        self._waiting.clear()
        self.is_over = True

    def _print(self, running: _Running) -> None:
        for text, stream in running.process.take_lines():
            self._say(Line(running.request.name, text, stream))
            if self._listens:
                self._happened.append(["printed", running.request.number, f"{text}\n", stream == "out"])

    def _tell(self, text: str, severity: str = "INFO", *, name: str = "launch") -> None:
        self._say(Line(name, text, "err" if severity in ("ERROR", "FATAL") else "out", severity))

    def _fail(self, text: str) -> None:
        self.failures.append(text)
        self._tell(text, "ERROR")

    def _want_world(self, wanted: WorldWanted) -> None:
        if self.world is not None:
            raise CannotStart(f"{wanted.where}a launch has one flatland_server, and this would be the second")
        self.world = wanted

    def _want_view(self) -> None:
        self.wants_view = True
