"""Clocks. In a simulation, clocks of every type tell the simulation's time: nothing depends on the computer."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from kit.ros.exceptions import NotInitializedException
from kit.ros.node.time import ClockType, Duration, Time

if TYPE_CHECKING:
    from kit.ros.execution.context import Context
    from kit.ros.graph.graph import Graph


class Clock:
    """Tells the time of the default context's graph."""

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
        """Whose time it tells."""
        from kit.ros.execution.context import get_default_context

        return self._graph or get_default_context().graph

    def now(self) -> Time:
        """The time now."""
        graph = self.graph
        if self._clock_type is ClockType.STEADY_TIME and not graph.is_simulated:
            return Time(nanoseconds=time.monotonic_ns(), clock_type=self._clock_type)
        return Time(nanoseconds=graph.now_ns, clock_type=self._clock_type)

    def sleep_until(self, until: Time, context: Context | None = None) -> bool:
        """Waits until that time has come; false if the context was shut down before.

        Raises ValueError for a time of another clock, NotInitializedException without a running context.
        """
        if until.clock_type != self._clock_type:
            raise ValueError("until's clock type does not match this clock's type")
        return self.sleep_for(until - self.now(), context)

    def sleep_for(self, rel_time: Duration, context: Context | None = None) -> bool:
        """Waits that long; false if the context was shut down before."""
        from kit.ros.execution.context import get_default_context

        context = context or get_default_context()
        if not context.ok():
            raise NotInitializedException("context has not been initialised")
        graph = self.graph
        until = graph.now_ns + rel_time.nanoseconds
        graph.wait(lambda: not context.ok(), until, what="clock.sleep_for()")
        return context.ok()


class ROSClock(Clock):
    """A node's clock."""

    def __init__(self, graph: Graph | None = None) -> None:
        super().__init__(clock_type=ClockType.ROS_TIME)
        self._graph = graph

    @property
    def ros_time_is_active(self) -> bool:
        """Whether it tells simulated time."""
        return self.graph.is_simulated
