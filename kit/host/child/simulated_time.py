"""Makes the clocks of a program in the child follow the world's time.

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
``asyncio``                           its loops wait in simulated time
``threading.Timer``, and the program  wait in simulated time
calling ``Event.wait`` with a limit
``time.process_time``                 the processor time: for measuring how long a computation takes
====================================  ==============================================================================

Whoever reads a simulated clock again and again without waiting lets time pass: see ``kit.ros.graph.graph.MAX_READS``. So does
who asks another thread's event, queue, lock or future (``kit.host.child.simulated_polls``).
On a robot all of them show the wall clock.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, Final, SupportsIndex

import kit
from kit.host.child.import_hooks import on_import
from kit.host.child.simulated_polls import use_simulated_polls
from kit.host.child.simulated_waits import SimulatedWaits
from kit.ros.graph.graph import Graph

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

    class datetime(wall_class, metaclass=DatetimeType):  # type: ignore[misc, valid-type]  # noqa: N801 - the name that it is printed with
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


def _use_simulated_loops(module: Any, graph: Graph) -> None:
    """Makes the event loops of asyncio go by the graph's time."""
    module.BaseEventLoop.time = lambda loop: graph.now_ns / 1e9


def _use_simulated_selectors(module: Any, graph: Graph) -> None:
    """Makes event loops that have nothing to do wait in the graph."""
    loop_class = module.BaseSelectorEventLoop
    initialize, wake = loop_class.__init__, loop_class._write_to_self

    def initialize_with_graph(loop: Any, *args: Any, **kwargs: Any) -> None:
        initialize(loop, *args, **kwargs)
        loop._clock_resolution = LOOP_RESOLUTION_S
        loop._selector = _GraphSelector(loop._selector, graph)

    def wake_in_graph(loop: Any) -> None:
        wake(loop)
        graph.notify()

    loop_class.__init__, loop_class._write_to_self = initialize_with_graph, wake_in_graph


class _GraphSelector:
    """A selector whose waits are waits in the graph; all else is the real one's."""

    def __init__(self, selector: Any, graph: Graph) -> None:
        self._selector, self._graph = selector, graph

    def __getattr__(self, name: str) -> Any:
        return getattr(self._selector, name)

    def select(self, timeout: float | None = None) -> list[Any]:
        """Waits until a file is ready, or for that long [s, simulated]; returns the files that are ready."""
        found: list[Any] = self._selector.select(0)
        if found or (timeout is not None and timeout <= 0):
            self._graph.count_read()
            return found

        def is_ready() -> bool:
            found.extend(self._selector.select(0))
            return bool(found)

        until = None if timeout is None else self._graph.now_ns + max(1, round(timeout * 1e9))
        has_sockets = (
            len(self._selector.get_map()) > 1
        )  # besides the one by which other threads wake the loop
        while not found and (until is None or self._graph.now_ns < until):
            step = self._graph.now_ns + SOCKET_STEP_NS
            self._graph.wait(
                is_ready, (step if until is None else min(step, until)) if has_sockets else until
            )
            if not has_sockets:
                break
        return found


LOOP_RESOLUTION_S: Final = 1e-6
"""What asyncio takes for the same instant [s]: more than the error of a time as a float."""
SOCKET_STEP_NS: Final = 10_000_000
"""How often a loop that has sockets looks at them [ns, simulated]."""


def use_simulated_time(graph: Graph, libraries: Sequence[str] = ()) -> SimulatedWaits:
    """Replaces functions of the module ``time`` in this process, as the table above says.

    A controller that uses them then behaves the same at every speed. ``libraries``: the folders of installed modules.
    Returns the waits of the program's threads for each other.
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
        graph.wait(lambda: False, waits.clock.end_of(seconds), what="time.sleep()")

    waits = SimulatedWaits(graph, _PYTHON[0], is_own_code)
    waits.install()
    use_simulated_polls(graph, waits, is_own_code)
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
            caller = sys._getframe(1).f_code.co_filename
            if is_own_code(caller):
                return progress.read(time_ns()) / 1e9
            if waits.is_waiting_code(caller) and waits.is_program():
                return waits.clock.read()
            return float(wall())

        def nanoseconds() -> int:
            """The simulated time [ns]."""
            if is_own_code(sys._getframe(1).f_code.co_filename):
                return progress.read(time_ns())
            return int(wall_ns())

        setattr(time, name, seconds)
        setattr(time, f"{name}_ns", nanoseconds)

    for name in ("monotonic", "perf_counter"):
        replace_stopwatch(name)
    on_import("datetime", lambda module: _use_simulated_dates(module, lambda: started + time_ns() / 1e9))
    on_import("asyncio.base_events", lambda module: _use_simulated_loops(module, graph))
    on_import("asyncio.selector_events", lambda module: _use_simulated_selectors(module, graph))
    time.time_ns = time_ns
    time.time = lambda: time_ns() / 1e9
    time.localtime = localtime
    time.gmtime = gmtime
    time.ctime = ctime
    return waits
