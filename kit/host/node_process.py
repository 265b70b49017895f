"""Runs a student's nodes in a process of their own, as part of the kit's graph.

In each tick, the runner alternates ``graph.run_due()`` and ``exchange()`` of every process until nothing is left to do.
So a key that reaches a student's node in one tick moves the wheels in the same tick, wherever the node runs.
"""

from __future__ import annotations

import signal
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Final, Self

from kit.host.failure import (
    FailureKind,
    StudentCodeError,
    protocol_violation,
    refused_name,
    too_many_messages,
    too_much_kept,
)
from kit.host.graph_bridge import INTERRUPT, INTERRUPTED, KeptLimitError, MessageLimitError, ParentBridge
from kit.host.process import HostedFile, StudentProcess
from kit.host.program_start import PackageProgram
from kit.host.program_terminal import ProgramStreams
from kit.host.protocol import HOLD_NS, Ended, Frame, Reply
from kit.host.proxy_nodes import ForeignNameError, NameScope, ReservedNameError
from kit.host.sandbox.limits import INTERACTIVE_LIMITS, Limits
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL, Level
from kit.host.wire import Json, ProtocolError
from kit.ros.graph.graph import Graph

INTERRUPT_S: Final = 3.0
"""How long a program may go on that has been asked to end, simulated and by the wall clock [s]."""


class NodeProcess(HostedFile):
    """The nodes of one student's file: proxies here, the real ones in a process of their own.

    The process starts at once; ``wait_until_started`` (or ``is_started``, which does not wait) and then
    ``join`` let its nodes into the graph. ``NodeProcess.start`` does all three. Afterwards nothing raises: when the
    student's code fails, its nodes leave the graph and ``failure`` says why.
    """

    def __init__(
        self,
        graph: Graph,
        file: Path,
        *,
        args: Sequence[str] = (),
        seed: int = 0,
        limits: Limits = INTERACTIVE_LIMITS,
        level: Level = INTERACTIVE_LEVEL,
        package: PackageProgram | None = None,
        loads_first: bool = False,
        streams: ProgramStreams | None = None,
        replaces: NodeProcess | None = None,
        scope: NameScope | None = None,
        launch_test: Mapping[str, Json] | None = None,
    ) -> None:
        """``args``: what would follow the file's name on a command line, such as ``--ros-args -p speed:=0.4``.

        ``seed``: that of the run. The program's random numbers are seeded with a one-way derivative of it.

        ``package``: the file is run as a part of a package, not by itself.

        ``loads_first``: the program is loaded without the graph, and waits before it uses that: ``wait_until_started``
        then waits for this, and ``enter_graph`` comes between it and ``join``. What the graph holds may be made
        meanwhile.

        ``streams``: what the program reads and writes where it is run by hand.

        ``replaces``: the process that is to end before this one joins. That its nodes have the same names is no mistake.

        ``scope``: the names that it may use, where other programs take part that it must not disturb; by default all.

        ``launch_test``: the file is a test for launch_testing, which is run as this says: ``kit.host.child.launch_test_program``.
        """
        self.file = file
        self._graph = graph
        self._limits = limits
        self._bridge = ParentBridge(graph, limits.messages, limits.kept, scope=scope)
        self._now_ns = graph.now_ns
        self._wake_ns: int | None = None
        self._is_interrupted = False
        self._bridge.open_channel(INTERRUPTED, self._note_interrupted)
        self._first_answer: Frame | None = None
        self._is_joined = False
        self._is_tick_requested = False
        self.has_ended = False
        """Whether the program has ended by itself."""
        events = None if loads_first else self._bridge.take_changes()
        start: dict[str, Json] = {
            "args": list(args),
            "seed": seed,
            "now": self._now_ns,
            "events": events,
        }
        if launch_test is not None:
            start["launch_test"] = dict(launch_test)
        if replaces is not None:
            start["replaced"] = sorted(replaces.node_names)
        super().__init__(
            StudentProcess("node", file, start, limits=limits, level=level, package=package, streams=streams)
        )

    @property
    def exit_code(self) -> int:
        """Of a program that has ended without a failure: that of SIGINT if it did not catch KeyboardInterrupt."""
        return -signal.SIGINT if self._is_interrupted else 0

    def _note_interrupted(self, fields: list[Json]) -> None:
        self._is_interrupted = True

    @property
    def node_names(self) -> frozenset[str]:
        """The full names of its nodes that are in the graph."""
        return self._bridge.node_names

    def open_channel(self, name: str, apply: Callable[[list[Json]], object]) -> Callable[..., None]:
        """Adds a kind of event to those of the graph: ``apply`` is called with the fields of each that comes, the function that
        is returned sends one in the next ``exchange``. To be called before ``join``."""
        return self._bridge.open_channel(name, apply)

    @classmethod
    def start(
        cls,
        graph: Graph,
        file: Path,
        *,
        args: Sequence[str] = (),
        seed: int = 0,
        limits: Limits = INTERACTIVE_LIMITS,
        level: Level = INTERACTIVE_LEVEL,
        scope: NameScope | None = None,
    ) -> Self:
        """Starts a process and waits until its nodes are in the graph. Raises StudentCodeError if it fails before."""
        process = cls(graph, file, args=args, seed=seed, limits=limits, level=level, scope=scope)
        try:
            process.wait_until_started()
        except BaseException:  # Ctrl-C too: the process must not outlive it; raised again
            process.close()
            raise
        process.join()
        return process

    @property
    def wake_ns(self) -> int | None:
        """When the program must run again [ns of simulated time]; None: not before an event."""
        return self._wake_ns

    @property
    def is_running(self) -> bool:
        return self._is_joined and self.failure is None and not self.has_ended

    def wait_until_started(self) -> None:
        """Waits until the program waits for the first time. Raises StudentCodeError if it fails before."""
        self._first_answer = self._process.wait_started()

    def enter_graph(self) -> None:
        """Lets a program that ``loads_first`` go on into the graph, until it waits for the first time. Raises
        StudentCodeError if it fails before."""
        loaded = self._first_answer
        if not isinstance(loaded, Reply):
            return  # it has ended
        if loaded.events:
            raise self._process.fail(protocol_violation("events before it was in a graph"))
        self._now_ns = self._graph.now_ns
        self._first_answer = self._process.continue_start("tick", self._now_ns, self._bridge.take_pending())

    def is_started(self) -> bool:
        """Returns whether the program has waited for the first time; does not block. Raises StudentCodeError if it failed."""
        self._first_answer = self._process.wait_started(0)
        return self._first_answer is not None

    def join(self) -> None:
        """Adds the program's nodes to the graph, with what they have published so far."""
        assert self._first_answer is not None, "join before started"
        self._is_joined = True
        self._apply_answer(lambda: self._first_answer)

    def exchange(self) -> bool:
        """Exchanges one command and its answer, if anything is due; returns whether something was."""
        now = self._graph.now_ns
        # Only once at one time: a program that wants to run again at once would run for ever.
        has_woken = self._wake_ns is not None and self._wake_ns <= now and now != self._now_ns
        is_due = self._bridge.has_pending or has_woken or now < self._now_ns or self._is_tick_requested
        if not is_due or not self.is_running:
            return False
        self._is_tick_requested = False
        self._now_ns = now
        events = self._bridge.take_pending()
        self._apply_answer(lambda: self._process.request("tick", now, events))
        return True

    def request_tick(self) -> None:
        """Requests, from any thread, that the next ``exchange`` takes place though nothing is due."""
        self._is_tick_requested = True
        self._graph.notify()

    def interrupt(self) -> None:
        """Lets the program end as at Ctrl-C: it gets KeyboardInterrupt, and time of its own while it goes on, INTERRUPT_S at
        most. What it publishes meanwhile counts now. To be closed all the same."""
        if not self.is_running:
            return
        end_s, now_ns = time.monotonic() + INTERRUPT_S, self._graph.now_ns
        end_ns = now_ns + round(INTERRUPT_S * 1e9)
        self._apply_answer(partial(self._process.finish_request, INTERRUPT_S), is_optional=True)
        events: list[Json] = [*self._bridge.take_pending(), [INTERRUPT]]
        while self.is_running and now_ns <= end_ns and (left_s := end_s - time.monotonic()) > 0:
            self._apply_answer(partial(self._process.request, "tick", now_ns, events, wall_s=left_s))
            if self._wake_ns is None and not self._bridge.has_pending:
                break
            now_ns = max(now_ns, self._wake_ns or 0)
            events = self._bridge.take_pending()
        if self.failure is not None and self.failure.kind is FailureKind.TIMEOUT:
            self._process.failure = None  # it was to be ended

    def disconnect(self) -> None:
        """Disconnects, from any thread: whatever waits for an answer fails at once. Still to be closed."""
        self._process.disconnect()

    def close(self) -> None:
        """Removes the nodes from the graph and ends the process. May be called twice."""
        self._is_joined = False
        self._bridge.clear()
        super().close()

    def _apply_answer(self, answer: Callable[[], Frame | None], *, is_optional: bool = False) -> None:
        """Applies an answer. A wrong or missing one ends the process. ``is_optional``: there may be none."""
        try:
            frame = answer()
            if frame is None and is_optional:
                return
            if not isinstance(frame, (Reply, Ended)):
                raise ProtocolError("another kind of answer")
            if isinstance(frame, Reply) and frame.wake_ns == HOLD_NS:
                raise ProtocolError("time to stand still")
            began = time.monotonic()
            try:
                self._bridge.apply_events(frame.events)
            finally:
                self._process.charge(time.monotonic() - began)
            self._wake_ns = frame.wake_ns if isinstance(frame, Reply) else None
            if isinstance(frame, Ended):
                self.has_ended = True
                self._bridge.clear()
        except MessageLimitError:
            self._process.fail(too_many_messages(self._limits.messages or 0, self.file))
            self._bridge.clear()
        except KeptLimitError:
            self._process.fail(too_much_kept(self._limits.kept or 0, self.file))
            self._bridge.clear()
        except (ReservedNameError, ForeignNameError) as problem:
            self._process.fail(refused_name(str(problem), self.file))
            self._bridge.clear()
        except ProtocolError as problem:
            self._process.fail(protocol_violation(str(problem)))
            self._bridge.clear()
        except StudentCodeError:
            self._bridge.clear()
