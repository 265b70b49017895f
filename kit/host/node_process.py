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
from kit.host.failure import Failure, GuestError
from kit.host.output import Printed
from kit.host.package_program import Installed
from kit.host.parent_bridge import Delegation
from kit.host.process import Child
from kit.host.protocol import Ended, Frame, Reply
from kit.host.sandbox.confinement import DESK_LEVEL, Level
from kit.host.sandbox.limits import DESK, Limits
from kit.host.wire import ProtocolError
from kit.ros.graph.graph import Graph


class Guest:
    """The nodes of one student's file: proxies here, the real ones in a process of their own.

    The process starts at once; ``wait_until_started`` (or ``is_started``, which does not wait) and then
    ``join`` let its nodes into the graph. ``Guest.start`` does all three. Afterwards nothing raises: when the
    student's code fails, its nodes leave the graph and ``failure`` says why.
    """

    def __init__(
        self,
        graph: Graph,
        file: Path,
        *,
        args: Sequence[str] = (),
        seed: int = 0,
        limits: Limits = DESK,
        level: Level = DESK_LEVEL,
        installed: Installed | None = None,
    ) -> None:
        """``args``: what would follow the file's name on a command line, such as ``--ros-args -p speed:=0.4``.

        ``installed``: the file is run as a part of a package, not by itself.
        """
        self.file = file
        self._graph = graph
        self._delegation = Delegation(graph)
        self._now_ns = graph.now_ns
        self._wake_ns: int | None = None
        self._first: Frame | None = None
        self._joined = False
        self.has_ended = False
        """Whether the program has come to its own end."""
        begin = {"args": list(args), "seed": seed, "now": self._now_ns, "events": self._delegation.news()}
        self._child = Child("node", file, begin, limits=limits, level=level, installed=installed)

    @classmethod
    def start(
        cls,
        graph: Graph,
        file: Path,
        *,
        args: Sequence[str] = (),
        seed: int = 0,
        limits: Limits = DESK,
        level: Level = DESK_LEVEL,
    ) -> Self:
        """A guest that has started and whose nodes are in the graph. GuestError if it does not start well."""
        guest = cls(graph, file, args=args, seed=seed, limits=limits, level=level)
        try:
            guest.wait_until_started()
        except BaseException:
            guest.close()
            raise
        guest.join()
        return guest

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def failure(self) -> Failure | None:
        """Why the student's code has stopped; None while it runs or when it has ended by itself."""
        return self._child.failure

    @property
    def pid(self) -> int:
        """Of the process above the student's, which ends when that ends."""
        return self._child.pid

    @property
    def level(self) -> Level:
        """How far the process is locked in."""
        return self._child.level

    @property
    def wake_ns(self) -> int | None:
        """When it wants to go on by itself; None: only when something is said."""
        return self._wake_ns

    @property
    def is_running(self) -> bool:
        return self._joined and self.failure is None and not self.has_ended

    def take_output(self) -> Printed:
        """What the program has printed, its log lines included, since the last time."""
        return self._child.take_output()

    def wait_until_started(self) -> None:
        """Waits until the program waits for the first time. GuestError if it fails before."""
        self._first = self._child.started()

    def is_started(self) -> bool:
        """Whether it has come so far, without waiting. GuestError if it has failed."""
        self._first = self._child.started(0)
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
        is_due = self._delegation.has_news or has_woken or now < self._now_ns
        if not is_due or not self.is_running:
            return False
        self._now_ns = now
        events = self._delegation.fetch()
        self._attend(lambda: self._child.ask("tick", now, events))
        return True

    def hang_up(self) -> None:
        """From any thread: whoever waits for an answer gets a failure instead, at once. To be closed as ever."""
        self._child.hang_up()

    def close(self) -> None:
        """Takes the nodes out of the graph and ends the process. May be called twice."""
        self._joined = False
        self._delegation.clear()
        self._child.close()

    def _attend(self, answer: Callable[[], Frame | None]) -> None:
        """Takes in an answer. What is wrong with it, or with its coming, ends the guest."""
        try:
            frame = answer()
            if not isinstance(frame, (Reply, Ended)):
                raise ProtocolError("another kind of answer")
            self._delegation.take_in(frame.events)
            self._wake_ns = frame.wake_ns if isinstance(frame, Reply) else None
            if isinstance(frame, Ended):
                self.has_ended = True
                self._delegation.clear()
        except ProtocolError as problem:
            self._child.condemn(failure_messages.nonsense(str(problem)))
            self._delegation.clear()
        except GuestError:
            self._delegation.clear()
