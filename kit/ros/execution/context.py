"""Contexts: the state between ``rclpy.init()`` and ``rclpy.shutdown()``, and the graph it belongs to."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from types import TracebackType
from typing import Any

from kit.ros.execution.arguments import RosArguments, parse_ros_arguments
from kit.ros.graph.graph import Graph
from kit.ros.log import LoggingSeverity, LogRecord


def _domain_of_environment() -> int:
    """``ROS_DOMAIN_ID``, or 0. A graph is one domain: the number is told, and separates nothing here."""
    text = os.environ.get("ROS_DOMAIN_ID", "").strip()
    if text and not text.isdecimal():
        raise RuntimeError(f"ROS_DOMAIN_ID is not an integral number: '{text}'")
    return int(text or 0)


class Context:
    """The state of a program in a graph. Without a graph, one on the system's time is made."""

    def __init__(self, graph: Graph | None = None) -> None:
        self._graph = graph
        self._lock = threading.Lock()
        self._initialised = False
        self._ok = False
        self.ended_from_outside = False
        """Whether something other than the program itself shut it down."""
        self.global_executor: Any = None
        """The executor of ``rclpy.spin`` calls that name none; untyped, since executors are built on contexts."""
        self._may_shut_down_late = False
        self._domain_id = 0
        self._callbacks: list[Callable[[], object]] = []
        self.arguments = RosArguments()
        """The ROS arguments that ``init`` was given; they apply to every node."""

    @property
    def graph(self) -> Graph:
        if self._graph is None:
            self._graph = Graph(None)
        return self._graph

    def init(
        self,
        args: Sequence[str] | None = None,
        *,
        initialize_logging: bool = True,
        domain_id: int | None = None,
    ) -> None:
        """Initialises it. ``args`` None means the program's command line. RuntimeError the second time."""
        with self._lock:
            if self._initialised:
                raise RuntimeError("Context.init() must only be called once")
            if domain_id is not None and domain_id < 0:
                raise RuntimeError(f"Domain id ({domain_id}) should not be lower than zero.")
            self.arguments = parse_ros_arguments(sys.argv[1:] if args is None else args)
            self._domain_id = _domain_of_environment() if domain_id is None else domain_id
            self._initialised = self._ok = True
        log = self.graph.log
        for name, level in self.arguments.log_levels:
            if name:
                log.levels[name] = level
            else:
                log.level = level

    def ok(self) -> bool:
        """True between init and shutdown."""
        return self._ok

    def shutdown(self) -> None:
        """Shuts down and ends all waits. RuntimeError if the program itself has done so before."""
        if self._may_shut_down_late:
            # The program could not know of the shutdown from outside; its own is late, not wrong.
            self._may_shut_down_late = False
            return
        if not self._shut_down():
            raise RuntimeError(
                "Context must be initialized before it can be shutdown, and shutdown only once"
            )

    def try_shutdown(self) -> None:
        """Shuts down unless it has been shut down."""
        self._shut_down()

    def shutdown_from_outside(self) -> None:
        """Shuts down for a signal or for the process's host; the program's own shutdown may still follow."""
        self._shut_down(from_outside=True)

    def on_shutdown(self, callback: Callable[[], object]) -> None:
        """Calls ``callback()`` at shutdown."""
        if not callable(callback):
            raise TypeError(f"callback should be a callable, got {type(callback)}")
        with self._lock:
            if self._ok:
                self._callbacks.append(callback)
                return
        callback()

    def get_domain_id(self) -> int:
        return self._domain_id

    def __enter__(self) -> Context:
        if not self._initialised:
            self.init()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.try_shutdown()

    def _shut_down(self, *, from_outside: bool = False) -> bool:
        with self._lock:
            if not self._ok:
                return False
            self.ended_from_outside = self._may_shut_down_late = from_outside
            self._ok = False
            callbacks, self._callbacks = self._callbacks, []
        for callback in callbacks:
            callback()
        self.graph.notify()
        return True


class _DefaultContext:
    """The context that is used where none is named. There is one per program, as in ROS 2, whose API has no other
    place for it; it is the only state this package keeps outside a graph."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.find_graph: Callable[[], Graph] | None = None
        self.context: Context | None = None

    def get(self) -> Context:
        with self.lock:
            if self.context is None:
                self.context = Context(None if self.find_graph is None else self.find_graph())
            return self.context

    def detach(self) -> Context:
        """Removes the context, so that the next ``get`` makes a new one."""
        context = self.get()
        with self.lock:
            self.context = None
        return context


_DEFAULT = _DefaultContext()
_OVERRIDE: ContextVar[Context | None] = ContextVar("override", default=None)


def get_default_context(*, shutting_down: bool = False) -> Context:
    """The default context; with ``shutting_down`` the next call returns a new one."""
    override = _OVERRIDE.get()
    if override is not None:
        return override
    return _DEFAULT.detach() if shutting_down else _DEFAULT.get()


def set_default_graph(graph: Graph | None) -> None:
    """Puts every default context from now on into this graph; None: into a graph on the system's time.

    Called before a program written for ROS 2 runs in this process.
    """
    set_default_graph_finder(None if graph is None else lambda: graph)


def set_default_graph_finder(find_graph: Callable[[], Graph] | None) -> None:
    """Sets a graph that is found when a program first needs it: ``find_graph`` is called for each default
    context, and may wait."""
    with _DEFAULT.lock:
        _DEFAULT.find_graph = find_graph
        _DEFAULT.context = None


def context_of(graph: Graph) -> Context:
    """The context that the nodes of a graph share, initialised: ``Node("name", context=context_of(graph))``."""
    with graph.lock:
        if graph.shared_context is None:
            context = Context(graph)
            context.init(())
            graph.shared_context = context
        shared: Context = graph.shared_context
        return shared


def log_as_kit(text: str, *, is_warning: bool = False) -> None:
    """Logs a line of the kit's own in the default context's graph: for the packages in ``shims``."""
    graph = get_default_context().graph
    severity = LoggingSeverity.WARN if is_warning else LoggingSeverity.INFO
    graph.log.sink(LogRecord(graph.now_ns, severity, "kit", text, "", "", 0))


@contextmanager
def default_context(context: Context) -> Iterator[None]:
    """Makes ``context`` the default in this block and thread, for nodes whose constructor takes none."""
    token = _OVERRIDE.set(context)
    try:
        yield
    finally:
        _OVERRIDE.reset(token)
