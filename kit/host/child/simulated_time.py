"""Makes the clocks of a student's program follow the world's time, where that is what the program means.

In a program whose graph has simulated time:

====================================  ==============================================================================
``node.get_clock().now()``, timers    simulated time, from 0 at the world's start
``time.time``, ``time.time_ns``       the same simulated time, so that they can be compared with a message's stamp
``time.sleep``                        waits in simulated time
``time.localtime``, ``time.gmtime``,  with a simulated time as argument: the date and hour at which the program was
``time.ctime``                        started, plus that time; else as ever. So files get a real date (a zip archive
                                      refuses one before 1980).
``datetime.now``, ``date.today``      the wall clock: a date, not for measuring
``time.monotonic``,                   the wall clock's progress: right for measuring how long a computation takes,
``time.perf_counter``                 wrong for measuring how long the robot moves. The standard library's own
                                      time-outs (threads, queues, sockets) are built on them.
====================================  ==============================================================================

On a robot all of them show the wall clock.
"""

from __future__ import annotations

import time
from typing import Final, SupportsIndex

from kit.ros.graph.graph import Graph

Seconds = float | SupportsIndex | None

_LAST_SIMULATED_S: Final = 315_532_800.0
"""1980-01-01. A simulated time is before it, a date of the wall clock is not [s]."""


def use_simulated_time(graph: Graph) -> None:
    """Replaces functions of the module ``time`` in this process, as the table above says.

    A controller that uses them then behaves the same at every speed.
    """

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
    time.time_ns = lambda: graph.now_ns
    time.time = lambda: graph.now_ns / 1e9
    time.localtime = localtime
    time.gmtime = gmtime
    time.ctime = ctime
