"""A student's nodes as guests in our graph.

Each tick, the runner alternates ``graph.run_due()`` and every guest's ``exchange()`` until all is quiet. So a
key that reaches a student's node in one tick moves the wheels in the same tick, wherever the node runs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Self

from kit.host import failure_messages
from kit.host.failure import Failure, StudentCodeError
from kit.host.graph_bridge import ParentBridge
from kit.host.output import Printed
from kit.host.package_program import Installed
from kit.host.process import StudentProcess
from kit.host.protocol import Ended, Frame, Reply
from kit.host.sandbox.confinement import INTERACTIVE_LEVEL, Level
from kit.host.sandbox.limits import INTERACTIVE_LIMITS, Limits
from kit.host.wire import ProtocolError
from kit.ros.graph.graph import Graph


class NodeProcess:
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
        installed: Installed | None = None,
    ) -> None:
        """``args``: what would follow the file's name on a command line, such as ``--ros-args -p speed:=0.4``.

        ``installed``: the file is run as a part of a package, not by itself.
        """
        self.file = file
        self._graph = graph
        self._bridge = ParentBridge(graph)
        self._now_ns = graph.now_ns
        self._wake_ns: int | None = None
        self._first: Frame | None = None
        self._joined = False
        self.has_ended = False
        """Whether the program has come to its own end."""
        begin = {"args": list(args), "seed": seed, "now": self._now_ns, "events": self._bridge.take_changes()}
        self._process = StudentProcess("node", file, begin, limits=limits, level=level, installed=installed)

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
    ) -> Self:
        """A process that has started and whose nodes are in the graph. StudentCodeError if it does not start well."""
        process = cls(graph, file, args=args, seed=seed, limits=limits, level=level)
        try:
            process.wait_until_started()
        except BaseException:
            process.close()
            raise
        process.join()
        return process

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def failure(self) -> Failure | None:
        """Why the student's code has stopped; None while it runs or when it has ended by itself."""
        return self._process.failure

    @property
    def pid(self) -> int:
        """Of the process above the student's, which ends when that ends."""
        return self._process.pid

    @property
    def level(self) -> Level:
        """How far the process is locked in."""
        return self._process.level

    @property
    def wake_ns(self) -> int | None:
        """When it wants to go on by itself; None: only when something is said."""
        return self._wake_ns

    @property
    def is_running(self) -> bool:
        return self._joined and self.failure is None and not self.has_ended

    def take_output(self) -> Printed:
        """What the program has printed, its log lines included, since the last time."""
        return self._process.take_output()

    def wait_until_started(self) -> None:
        """Waits until the program waits for the first time. StudentCodeError if it fails before."""
        self._first = self._process.started()

    def is_started(self) -> bool:
        """Whether it has come so far, without waiting. StudentCodeError if it has failed."""
        self._first = self._process.started(0)
        return self._first is not None

    def join(self) -> None:
        """Lets the nodes into the graph, with what they have said so far."""
        assert self._first is not None, "join before started"
        self._joined = True
        self._attend(lambda: self._first)

    def exchange(self) -> bool:
        """One question and its answer, if anything is due; false if nothing was."""
        now = self._graph.now_ns
        # Not twice at one time for the time's sake: what wants to go on at once would go on for ever.
        has_woken = self._wake_ns is not None and self._wake_ns <= now and now != self._now_ns
        is_due = self._bridge.has_pending or has_woken or now < self._now_ns
        if not is_due or not self.is_running:
            return False
        self._now_ns = now
        events = self._bridge.take_pending()
        self._attend(lambda: self._process.ask("tick", now, events))
        return True

    def disconnect(self) -> None:
        """From any thread: whoever waits for an answer gets a failure instead, at once. To be closed as ever."""
        self._process.disconnect()

    def close(self) -> None:
        """Takes the nodes out of the graph and ends the process. May be called twice."""
        self._joined = False
        self._bridge.clear()
        self._process.close()

    def _attend(self, answer: Callable[[], Frame | None]) -> None:
        """Takes in an answer. What is wrong with it, or with its coming, ends the process."""
        try:
            frame = answer()
            if not isinstance(frame, (Reply, Ended)):
                raise ProtocolError("another kind of answer")
            self._bridge.apply_events(frame.events)
            self._wake_ns = frame.wake_ns if isinstance(frame, Reply) else None
            if isinstance(frame, Ended):
                self.has_ended = True
                self._bridge.clear()
        except ProtocolError as problem:
            self._process.fail(failure_messages.nonsense(str(problem)))
            self._bridge.clear()
        except StudentCodeError:
            self._bridge.clear()
