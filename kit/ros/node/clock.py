"""Clocks. In a simulation, clocks of every type show the simulated time, so that nothing depends on the computer."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from enum import IntEnum
from typing import NamedTuple, Self, cast

from kit.ros.exceptions import NotInitializedException
from kit.ros.execution.context import Context, get_default_context
from kit.ros.graph.graph import Graph
from kit.ros.node.time import ClockType, Duration, Time


class ClockChange(IntEnum):
    """How a clock's source of time has changed in a jump. Here it never changes: a world's time is simulated throughout."""

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4


class JumpThreshold:
    """Which jumps of a clock are told: forward by at least ``min_forward``, back by at least ``min_backward`` (negative).

    None: such jumps are not told. Raises ValueError for a duration of the wrong sign, and if nothing is told.
    """

    def __init__(
        self, *, min_forward: Duration | None, min_backward: Duration | None, on_clock_change: bool = True
    ) -> None:
        if min_forward is not None and min_forward.nanoseconds <= 0:
            raise ValueError("min_forward must be a positive non-zero duration")
        if min_backward is not None and min_backward.nanoseconds >= 0:
            raise ValueError("min_backward must be a negative non-zero duration")
        if min_forward is None and min_backward is None and not on_clock_change:
            raise ValueError("At least one jump threshold must be enabled")
        self.min_forward, self.min_backward = min_forward, min_backward
        self.on_clock_change = on_clock_change

    def is_exceeded(self, delta_ns: int) -> bool:
        """True for a jump that is to be told."""
        if delta_ns >= 0:
            return self.min_forward is not None and delta_ns >= self.min_forward.nanoseconds
        return self.min_backward is not None and delta_ns <= self.min_backward.nanoseconds


class TimeJump(NamedTuple):
    """The argument of a callback after a jump."""

    clock_change: ClockChange
    delta: Duration
    """The time after the jump minus that before it."""


class JumpHandle:
    """Callbacks for the jumps of a clock, until ``unregister``. Also a context manager, which unregisters them."""

    def __init__(
        self,
        *,
        clock: Clock,
        threshold: JumpThreshold,
        pre_callback: Callable[[], object] | None,
        post_callback: Callable[[TimeJump], object] | None,
    ) -> None:
        """Raises ValueError without a callback, and for one that cannot be called."""
        if pre_callback is None and post_callback is None:
            raise ValueError("One of pre_callback or post_callback must be callable")
        for name, callback in (("pre_callback", pre_callback), ("post_callback", post_callback)):
            if callback is not None and not callable(callback):
                raise ValueError(f"{name} must be callable if given")
        self._graph = clock.graph
        self._threshold, self._pre_callback, self._post_callback = threshold, pre_callback, post_callback
        self._change = (
            ClockChange.ROS_TIME_NO_CHANGE
            if clock.clock_type is ClockType.ROS_TIME
            else ClockChange.SYSTEM_TIME_NO_CHANGE
        )
        with self._graph.lock:
            self._graph.time_jump_listeners.append(self)

    def __enter__(self) -> JumpHandle:
        return self

    def __exit__(self, *_: object) -> None:
        self.unregister()

    def unregister(self) -> None:
        """Ends the callbacks. May be called twice."""
        with self._graph.lock, suppress(ValueError):
            self._graph.time_jump_listeners.remove(self)

    def before_jump(self, delta_ns: int) -> None:
        if self._pre_callback is not None and self._threshold.is_exceeded(delta_ns):
            self._pre_callback()

    def after_jump(self, delta_ns: int) -> None:
        if self._post_callback is not None and self._threshold.is_exceeded(delta_ns):
            self._post_callback(TimeJump(self._change, Duration(nanoseconds=delta_ns)))


class Clock:
    """Shows the time of the default context's graph. One of ROS_TIME is a ROSClock."""

    def __new__(cls, *, clock_type: ClockType = ClockType.SYSTEM_TIME) -> Self:
        is_ros = cls is Clock and clock_type is ClockType.ROS_TIME
        return cast("Self", object.__new__(ROSClock)) if is_ros else object.__new__(cls)

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
        """The time now. A program that reads it again and again without waiting lets simulated time pass."""
        graph = self.graph
        graph.count_read()
        if self._clock_type is ClockType.STEADY_TIME and not graph.is_simulated:
            return Time(nanoseconds=time.monotonic_ns(), clock_type=self._clock_type)
        return Time(nanoseconds=graph.now_ns, clock_type=self._clock_type)

    def create_jump_callback(
        self,
        threshold: JumpThreshold,
        *,
        pre_callback: Callable[[], object] | None = None,
        post_callback: Callable[[TimeJump], object] | None = None,
    ) -> JumpHandle:
        """Calls back before and after jumps, such as when a world is reset. The callbacks must be quick.

        Raises ValueError without a callback.
        """
        return JumpHandle(
            clock=self, threshold=threshold, pre_callback=pre_callback, post_callback=post_callback
        )

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

    def __new__(cls, graph: Graph | None = None) -> Self:
        return object.__new__(cls)

    def __init__(self, graph: Graph | None = None, *, clock_type: ClockType = ClockType.ROS_TIME) -> None:
        """``clock_type``: of no effect; what ``Clock`` was called with."""
        super().__init__(clock_type=ClockType.ROS_TIME)
        self._graph = graph

    @property
    def ros_time_is_active(self) -> bool:
        """True if the time is simulated."""
        return self.graph.is_simulated
