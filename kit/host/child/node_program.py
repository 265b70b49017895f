"""Runs a ROS 2 program in the child: its nodes are in a graph whose time and messages come from the kit.

The clocks of the program follow the world's time, where that is what the program means. Where that is simulated:

====================================  ==============================================================================
``node.get_clock().now()``, timers    simulated time, from 0 at the world's start
``time.time``, ``time.time_ns``       the same simulated time, so that they can be compared with a message's stamp
``time.sleep``                        waits in simulated time
``time.localtime``, ``time.gmtime``,  with a simulated time as argument: the date and hour at which the program was
``time.ctime``                        started, plus that time; else as ever. So files get a real date (a zip archive
                                      refuses one before 1980).
``datetime.now``                      the date and hour at which the program was started, plus the simulated time
``date.today``                        the wall clock's date
``time.monotonic``,                   the simulated time in the program's own code, and a microsecond more at each reading,
``time.perf_counter``                 so that no two are equal. In libraries the wall clock's progress: their time-outs
                                      (threads, queues, sockets) are built on it.
``time.process_time``                 the processor time: for measuring how long a computation takes
====================================  ==============================================================================

Whoever reads a simulated clock again and again without waiting lets time pass: see ``kit.ros.graph.graph.MAX_READS``.
On a robot all of them show the wall clock.
"""

from __future__ import annotations

import importlib
import os
import sys
import threading
import time
from collections.abc import Callable, Sequence
from functools import cache, partial
from types import ModuleType
from typing import Any, Final, SupportsIndex

import kit
from kit.host.child.command_loop import CommandSession
from kit.host.child.import_hooks import on_import
from kit.host.child.program_input import mark_reading
from kit.host.child.student_module import StudentProgram, exit_status
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.graph_bridge import ChildBridge
from kit.host.waiter import AllThreadsWaiter
from kit.host.wire import Json
from kit.ros import SHIMS_FOLDER, install_import_names
from kit.ros.execution.context import set_default_graph_finder
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node

Seconds = float | SupportsIndex | None

_LAST_SIMULATED_S: Final = 315_532_800.0
"""1980-01-01. A simulated time is before it, a date of the wall clock is not [s]."""


_PYTHON: Final = (os.path.dirname(os.__file__) + os.sep, os.path.dirname(kit.__file__) + os.sep, "<frozen")
"""Where the modules of Python and of the kit lie."""


READING_NS: Final = 1_000
"""How much later each reading of a stopwatch is than the one before, at least [ns]."""


class _Progress:
    """Readings of a stopwatch: each later than the one before, also when the simulated time is set back."""

    def __init__(self) -> None:
        self._offset_ns = self._now_ns = self._last_ns = 0

    def read(self, now_ns: int) -> int:
        """Returns the reading for a simulated time [ns]."""
        if now_ns < self._now_ns:
            self._offset_ns += self._now_ns - now_ns
        self._now_ns = now_ns
        self._last_ns = max(now_ns + self._offset_ns, self._last_ns + READING_NS)
        return self._last_ns


def _use_simulated_dates(module: Any, seconds: Callable[[], float]) -> None:
    """Makes ``datetime.now`` and the like tell the date of a time of ``seconds``."""
    wall_class = module.datetime

    class DatetimeType(type):
        """Its classes have every datetime as an instance, also those that C code makes."""

        def __instancecheck__(cls, instance: object) -> bool:
            return isinstance(instance, wall_class)

    class datetime(wall_class, metaclass=DatetimeType):  # type: ignore[misc]  # noqa: N801 - the name that it is printed with
        @classmethod
        def now(cls, tz: Any = None) -> Any:
            return cls.fromtimestamp(seconds(), tz)

        @classmethod
        def today(cls) -> Any:
            return cls.fromtimestamp(seconds())

        @classmethod
        def utcnow(cls) -> Any:
            return cls.fromtimestamp(seconds(), module.timezone.utc).replace(tzinfo=None)

    datetime.__module__, datetime.__qualname__ = module.__name__, "datetime"
    module.datetime = datetime


def use_simulated_time(graph: Graph, libraries: Sequence[str] = ()) -> None:
    """Replaces functions of the module ``time`` in this process, as the table above says.

    A controller that uses them then behaves the same at every speed. ``libraries``: the folders of installed modules.
    """
    foreign = (*_PYTHON, *(f"{folder}{os.sep}" for folder in libraries))

    @cache
    def is_own_code(file: str) -> bool:
        """Whether a file of code belongs to the program, and not to a library or to Python."""
        return not file.startswith(foreign)

    def sleep(seconds: float) -> None:
        """Waits in simulated time."""
        if seconds < 0:
            raise ValueError("sleep length must be non-negative")
        graph.wait(lambda: False, graph.now_ns + int(seconds * 1e9), what="time.sleep()")

    started = time.time()
    wall_localtime, wall_gmtime = time.localtime, time.gmtime

    def as_date(seconds: Seconds) -> float | None:
        """A simulated time as a time of the wall clock; None, which means now, stays None."""
        if seconds is None:
            return None
        number = float(seconds)
        return started + number if 0 <= number < _LAST_SIMULATED_S else number

    def localtime(seconds: Seconds = None, /) -> time.struct_time:
        """The local date and time; a simulated time counts from the program's start."""
        return wall_localtime(as_date(seconds))

    def gmtime(seconds: Seconds = None, /) -> time.struct_time:
        """The date and time in UTC; a simulated time counts from the program's start."""
        return wall_gmtime(as_date(seconds))

    def ctime(seconds: Seconds = None, /) -> str:
        """The local date and time as text; a simulated time counts from the program's start."""
        return time.asctime(localtime(seconds))

    time.sleep = sleep  # type: ignore[assignment]  # for any number, where the stub has a list of kinds

    def time_ns() -> int:
        """The simulated time [ns]."""
        graph.count_read()
        return graph.now_ns

    progress = _Progress()

    def replace_stopwatch(name: str) -> None:
        """Replaces ``monotonic`` or ``perf_counter`` and what tells the same in nanoseconds."""
        wall, wall_ns = getattr(time, name), getattr(time, f"{name}_ns")

        def seconds() -> float:
            """The simulated time [s] for the program's own code, the wall clock's progress for that of libraries."""
            if is_own_code(sys._getframe(1).f_code.co_filename):
                return progress.read(time_ns()) / 1e9
            return float(wall())

        def nanoseconds() -> int:
            """The same [ns]."""
            if is_own_code(sys._getframe(1).f_code.co_filename):
                return progress.read(time_ns())
            return int(wall_ns())

        setattr(time, name, seconds)
        setattr(time, f"{name}_ns", nanoseconds)

    for name in ("monotonic", "perf_counter"):
        replace_stopwatch(name)
    on_import("datetime", lambda module: _use_simulated_dates(module, lambda: started + time_ns() / 1e9))
    time.time_ns = time_ns
    time.time = lambda: time_ns() / 1e9
    time.localtime = localtime
    time.gmtime = gmtime
    time.ctime = ctime


SWITCH_S: Final = 0.0005
"""How long one of a package's threads may keep the interpreter while others want it [s]."""


def run(program: StudentProgram, session: CommandSession, start: dict[str, Json]) -> None:
    """Runs the program from its start to its end: its ``main()``, or its one class of nodes."""
    as_package = "folder" in start  # run as ``ros2 run`` would: what it prints may be all that it does
    install_import_names(start.get("interfaces", {}))
    # Last, so that what is really installed comes first.
    sys.path.append(SHIMS_FOLDER)
    sys.argv = [program.file, *start["args"]]
    bridge = ChildBridge(session, start["now"], uninterrupted=session.interrupts.deferred)
    set_default_graph_finder(lambda: bridge.graph)
    use_simulated_time(bridge.graph, start["libraries"])
    if start["has_input"]:
        session.interrupts.install()
        waiter = bridge.graph.waiter
        assert isinstance(waiter, AllThreadsWaiter)  # the bridge's default
        mark_reading(partial(waiter.waiting_for_user, bridge.graph))
    bridge.graph.directory.replaced_names = frozenset(start.get("replaced", ()))
    if start["events"] is None:
        _begin_when_needed(bridge, session, start["start_s"], start["start_wall_s"])
    else:
        bridge.apply_events(start["events"])
    try:
        if start.get("entry"):
            _run_entry_point(start["entry"], program)
        else:
            module = program.load("__main__")
            # A file that asks for its own name calls what it wants to have called.
            if not bridge.has_had_nodes and not (as_package and b"__main__" in program.source):
                _run_main(module, program)
    except SystemExit as stop:
        if exit_status(stop):
            bridge.send_last_messages()
            raise
    except MemoryError:
        raise
    except BaseException:
        bridge.send_last_messages()
        raise
    for thread in threading.enumerate():
        if thread is not threading.current_thread() and not thread.daemon:
            thread.join()
    if not bridge.has_had_nodes and not as_package:
        raise _no_program_error("The program ended without creating a node.", program)
    bridge.end()


def _begin_when_needed(
    bridge: ChildBridge, session: CommandSession, start_s: float, start_wall_s: float
) -> None:
    """Makes the program wait for the parent's graph when it first needs one: so a file that cannot be loaded needs none.

    ``start_s``, ``start_wall_s``: how long the program may take to start, by processor time and by the wall clock [s], the
    wait for the parent not counted.
    """
    began = time.process_time()

    def find_graph() -> Graph:
        if not bridge.has_ticked:
            left_s = start_s - (time.process_time() - began)
            bridge.next_tick(None)
            session.set_deadline(max(SWITCH_S, left_s), start_wall_s)
        return bridge.graph

    set_default_graph_finder(find_graph)


def _run_entry_point(entry: str, program: StudentProgram) -> None:
    """Calls the function of an entry point, as the script would that an installation makes of it."""
    # A thread that polls must not keep the others from the interpreter for long.
    sys.setswitchinterval(SWITCH_S)
    name, _, function = entry.partition(":")
    module = importlib.import_module(name)
    main = getattr(module, function, None)
    if not callable(main):
        raise _no_program_error(
            f"{name} has no {function}(), which setup.py or a launch file names as an entry point.",
            program,
        )
    if isinstance(main, type) and issubclass(main, Node):  # a composable node
        _spin(main)
        return
    result = main()
    if result not in (None, 0):
        raise SystemExit(result)


def _run_main(module: ModuleType, program: StudentProgram) -> None:
    """Calls the file's ``main()``, or spins its one class of nodes, as ``ros2 run`` would."""
    main = getattr(module, "main", None)
    if callable(main):
        main()
        return
    classes = [cls for cls in vars(module).values() if isinstance(cls, type) and issubclass(cls, Node)]
    own = [cls for cls in classes if cls.__module__ == module.__name__]
    last = [cls for cls in own if not any(cls is not other and issubclass(other, cls) for other in own)]
    if len(last) != 1:
        found = "none" if not last else " and ".join(cls.__name__ for cls in last)
        raise _no_program_error(
            f"There is no main() to call. Without it, the file needs exactly one class derived from Node; it has {found}.",
            program,
        )
    _spin(last[0])


def _spin(make: Callable[[], Node]) -> None:
    import rclpy

    rclpy.init()
    rclpy.spin(make())


def _no_program_error(message: str, program: StudentProgram) -> StudentCodeError:
    return StudentCodeError(Failure(FailureKind.EXCEPTION, message, program.relative_path(program.file)))
