"""The time that tests may take, and how one that goes on for too long is ended."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from grader.evidence.submission_clock import SHORTEST_S


class TestTimeUsedUp(BaseException):
    """The tests have used up their time. No ``Exception``, so that no test takes it for one of its own."""

    __test__ = False  # no class of tests


class TestDeadline:
    """Ends tests that go on for too long: what they examine was made by the student's program, and may be anything."""

    __test__ = False  # no class of tests

    def __init__(self, limit_s: float) -> None:
        self._ends = time.monotonic() + limit_s

    @contextmanager
    def watch(self) -> Iterator[None]:
        """Raises TestTimeUsedUp in the block when the time is used up; afterwards, where signals cannot interrupt it."""
        if time.monotonic() >= self._ends:
            raise TestTimeUsedUp
        if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
            yield
            if time.monotonic() >= self._ends:
                raise TestTimeUsedUp
            return
        began = time.monotonic()
        handler = signal.signal(signal.SIGALRM, _raise_time_used_up)
        outer_s, interval_s = signal.setitimer(signal.ITIMER_REAL, max(SHORTEST_S, self._ends - began))
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, handler)
            if outer_s:  # somebody else's alarm goes on
                left = max(SHORTEST_S, outer_s - (time.monotonic() - began))
                signal.setitimer(signal.ITIMER_REAL, left, interval_s)


def _raise_time_used_up(*_: object) -> None:
    raise TestTimeUsedUp
