"""Clocks. In a simulation, clocks of every type show the simulated time, so that nothing depends on the computer."""

from __future__ import annotations

import time

from kit.ros.exceptions import NotInitializedException
from kit.ros.execution.context import Context, get_default_context
from kit.ros.graph.graph import Graph
from kit.ros.node.time import ClockType, Duration, Time


class Clock:
    """Shows the time of the default context's graph."""

    def __init__(self, *, clock_type: ClockType = ClockType.SYSTEM_TIME) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        self._clock_type = clock_type
        self._graph: Graph | None = None

    def __repr__(self) -> str:
        return f"{type(self).__name__}(clock_type={self._clock_type.name})"

    @property
    def clock_type(self) -> ClockType:
        return self._clock_type

    @property
    def graph(self) -> Graph:
        """The graph this clock reads its time from."""
        return self._graph or get_default_context().graph

    def now(self) -> Time:
        """The time now."""
        graph = self.graph
        if self._clock_type is ClockType.STEADY_TIME and not graph.is_simulated:
            return Time(nanoseconds=time.monotonic_ns(), clock_type=self._clock_type)
        return Time(nanoseconds=graph.now_ns, clock_type=self._clock_type)

    def sleep_until(self, until: Time, context: Context | None = None) -> bool:
        """Waits until a time; False if the context was shut down before.

        Raises ValueError for a time of another clock, NotInitializedException without a running context.
        """
        if until.clock_type != self._clock_type:
            raise ValueError("until's clock type does not match this clock's type")
        return self.sleep_for(until - self.now(), context)

    def sleep_for(self, rel_time: Duration, context: Context | None = None) -> bool:
        """Waits for a duration; False if the context was shut down before."""
        context = context or get_default_context()
        if not context.ok():
            raise NotInitializedException("context has not been initialised")
        graph = self.graph
        until = graph.now_ns + rel_time.nanoseconds
        graph.wait(lambda: not context.ok(), until, what="clock.sleep_for()")
        return context.ok()


class ROSClock(Clock):
    """The clock of a node."""

    def __init__(self, graph: Graph | None = None) -> None:
        super().__init__(clock_type=ClockType.ROS_TIME)
        self._graph = graph

    @property
    def ros_time_is_active(self) -> bool:
        """True if the time is simulated."""
        return self.graph.is_simulated
