"""Timers and rates, and the schedule by which both are due."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from kit.ros.exceptions import InvalidHandle, ROSInterruptException, WouldDeadlock
from kit.ros.execution.callback_groups import NO_WORK, CallbackGroup
from kit.ros.node.endpoint import CallbackEntity, Destroyable, EntityOwner, accepted_argument_count
from kit.ros.node.time import Time

if TYPE_CHECKING:
    from kit.ros.node.clock import Clock


TIMER_WITHOUT_CALLBACK = (
    "A timer has nothing to call: was its function called instead of given? "
    "Write create_timer(seconds, self.name), without parentheses after the name."
)


class PeriodicSchedule:
    """The due times of something periodic: one period after its start, then every period.

    Missed periods are skipped, not made up for; the phase is kept.
    """

    def __init__(self, period_ns: int, now_ns: int) -> None:
        self.period_ns = period_ns
        self.last_ns = now_ns
        self.due_ns = now_ns + period_ns

    def start(self, now_ns: int) -> None:
        """Begins a new period now."""
        self.last_ns = now_ns
        self.due_ns = now_ns + self.period_ns

    def call(self, now_ns: int) -> None:
        """Records a call at ``now_ns`` and sets the next due time."""
        self.last_ns = now_ns
        self.due_ns += self.period_ns
        if self.period_ns == 0:
            # As often as possible, but not twice in one instant: in a simulation that would never end.
            self.due_ns = now_ns + 1
        elif self.due_ns < now_ns:
            missed = -(-(now_ns - self.due_ns) // self.period_ns)
            self.due_ns += missed * self.period_ns

    def rewind(self, now_ns: int) -> bool:
        """Starts a new period if time has jumped back before the last call; True if it did."""
        if now_ns < self.last_ns:
            self.start(now_ns)
            return True
        return False


class TimerInfo(NamedTuple):
    """The argument of a timer callback that takes one."""

    expected_call_time: Time
    actual_call_time: Time


class Timer(CallbackEntity):
    """Calls back every period. ``Node.create_timer`` makes one."""

    def __init__(
        self,
        handle: EntityOwner,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup,
        timer_period_ns: int,
        clock: Clock,
        *,
        autostart: bool = True,
    ) -> None:
        self._handle = handle
        self._graph = handle.graph
        self.callback = callback
        self._with_info = callback is not None and accepted_argument_count(callback, (0, 1), "a timer") == 1
        self.callback_group = callback_group
        self._clock = clock
        self.number = self._graph.next_number()
        self._schedule = PeriodicSchedule(timer_period_ns, self._graph.now_ns)
        self._cancelled = not autostart
        if autostart:
            handle.ready_queue.add_timer(self)

    def __repr__(self) -> str:
        return f"timer of {self._schedule.period_ns / 1e9:g} s in {self._handle.full_name}"

    __str__ = __repr__

    @property
    def due_ns(self) -> int:
        """The time of the next call [ns]; -1 if it is cancelled or destroyed."""
        return -1 if self._cancelled or self._destroyed else self._schedule.due_ns

    @property
    def clock(self) -> Clock:
        return self._clock

    @property
    def timer_period_ns(self) -> int:
        self._check_not_destroyed()
        return self._schedule.period_ns

    @timer_period_ns.setter
    def timer_period_ns(self, value: int) -> None:
        """Takes effect after the call that is already scheduled."""
        self._schedule.period_ns = int(value)

    def is_ready(self) -> bool:
        """True if it is due."""
        self._check_not_destroyed()
        return not self._cancelled and self._schedule.due_ns <= self._graph.now_ns

    def is_canceled(self) -> bool:
        self._check_not_destroyed()
        return self._cancelled

    def cancel(self) -> None:
        """Stops the calls until ``reset``."""
        self._check_not_destroyed()
        self._cancelled = True

    def reset(self) -> None:
        """Starts a new period now, also if it was cancelled."""
        self._check_not_destroyed()
        with self._graph.lock:
            self._cancelled = False
            self._schedule.start(self._graph.now_ns)
            self._handle.ready_queue.add_timer(self)

    def time_since_last_call(self) -> int:
        """Nanoseconds since the last call."""
        self._check_not_destroyed()
        return self._graph.now_ns - self._schedule.last_ns

    def time_until_next_call(self) -> int | None:
        """Nanoseconds until the next call, negative if it is late; None if it is cancelled."""
        self._check_not_destroyed()
        return None if self._cancelled else self._schedule.due_ns - self._graph.now_ns

    def rewind(self) -> None:
        """Adapts to a jump back in time. With the graph's lock held."""
        if self._schedule.rewind(self._graph.now_ns) and not self._cancelled:
            self._handle.ready_queue.add_timer(self)

    def take(self) -> Any:
        now = self._graph.now_ns
        due = self.due_ns
        if due < 0 or now < due:
            return NO_WORK
        self._schedule.call(now)
        self._handle.ready_queue.add_timer(self)
        return (due, now)

    def run(self, taken: tuple[int, int]) -> Any:
        if self.callback is None:
            return None
        if not self._with_info:
            return self.callback()
        due, now = (Time(nanoseconds=time_ns, clock_type=self._clock.clock_type) for time_ns in taken)
        return self.callback(TimerInfo(due, now))

    def _unregister(self) -> None:
        self._cancelled = True


_SLEEPS_BEFORE_WARNING = 3
"""A thread that will spin the node may need some time to start."""


class Rate(Destroyable):
    """Keeps a loop at a frequency: ``rate.sleep()``. ``Node.create_rate`` makes one.

    On a robot another thread must spin the node meanwhile; here it works without, with a warning.
    """

    def __init__(self, handle: EntityOwner, period_ns: int) -> None:
        self._handle = handle
        self._graph = handle.graph
        self._schedule = PeriodicSchedule(period_ns, self._graph.now_ns)
        self._sleeps_without_spin = 0

    def __repr__(self) -> str:
        return f"rate of {1e9 / self._schedule.period_ns:g} Hz"

    def sleep(self) -> None:
        """Waits for the end of the current period.

        Raises ROSInterruptException after a shutdown, WouldDeadlock in a callback that its timer would have
        to wait for.
        """
        if self._destroyed:
            raise InvalidHandle("Rate cannot sleep because it has been destroyed")
        graph, schedule, context = self._graph, self._schedule, self._handle.context
        self._raise_if_deadlock()
        self._sleeps_without_spin += not self._handle.is_spun
        if self._sleeps_without_spin == _SLEEPS_BEFORE_WARNING:
            self._handle.logger.warning(
                "rate.sleep() works here, but hangs on a robot unless another thread spins this node"
            )

        def is_over() -> bool:
            return graph.now_ns >= schedule.due_ns or self._destroyed or not context.ok()

        while not graph.wait(is_over, schedule.due_ns, what="rate.sleep()"):
            pass
        if not context.ok():
            raise ROSInterruptException
        schedule.call(graph.now_ns)

    def rewind(self) -> None:
        """Adapts to a jump back in time. With the graph's lock held."""
        self._schedule.rewind(self._graph.now_ns)

    def _raise_if_deadlock(self) -> None:
        work = self._graph.thread_state.work
        if work is not None and work[0] is self._handle.ready_queue and work[0].is_exclusive:
            raise WouldDeadlock(
                "rate.sleep() inside a callback would wait forever: the executor that must end the sleep waits "
                "for this callback to return. Do part of the work in each call of a timer instead."
            )

    def _unregister(self) -> None:
        self._graph.notify()
