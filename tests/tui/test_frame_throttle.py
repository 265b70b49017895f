"""Frame throttle against a simulated link: the picture stays young at every speed, and never stalls for good."""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, field

import pytest

from kit.tui.frame_throttle import FAST, MOST_UNDER_WAY, SLOW, TIMEOUT, FrameThrottle

FRAME = 1000
"""Bytes of a frame."""


@dataclass
class Link:
    """A link with a delay each way and an endless buffer in front of a narrow pipe: what SSH looks like."""

    rate: float
    """Bytes per second."""
    delay: float
    """Seconds, one way."""
    answers: Callable[[float], bool] = lambda now: True
    free_at: float = 0.0
    events: list[float] = field(default_factory=list)
    lags: list[float] = field(default_factory=list)

    def send(self, now: float) -> None:
        self.free_at = max(self.free_at, now) + FRAME / self.rate
        shown = self.free_at + self.delay
        self.lags.append(shown - now)
        if self.answers(now):
            heapq.heappush(self.events, shown + self.delay)


def play(link: Link, end: float, throttle: FrameThrottle | None = None, start: float = 0.0) -> list[float]:
    """Draws whenever allowed; the times of the frames."""
    throttle = throttle or FrameThrottle()
    now, drawn = start, []
    while now < end:
        while link.events and link.events[0] <= now:
            throttle.answered(heapq.heappop(link.events))
        if throttle.may_draw(now):
            throttle.drawn(now)
            link.send(now)
            throttle.sent(now)
            drawn.append(now)
        now += 0.001
    return drawn


def rate(drawn: list[float], start: float, end: float) -> float:
    return sum(start <= time < end for time in drawn) / (end - start)


def test_a_fast_link_gets_twenty_frames_a_second() -> None:
    drawn = play(Link(1e7, 0.001), 10)
    assert rate(drawn, 2, 10) == pytest.approx(FAST, abs=0.5)


def test_a_link_of_40_ms_round_trip_gets_twenty_too() -> None:
    drawn = play(link := Link(125e3, 0.020), 10)
    assert rate(drawn, 2, 10) == pytest.approx(FAST, abs=0.5)
    assert max(link.lags) < 0.1


@pytest.mark.parametrize(
    ("bytes_per_second", "delay"), [(30e3, 0.02), (9600, 0.02), (2400, 0.05), (30e3, 0.3)]
)
def test_the_picture_is_never_older_than_a_few_frames_take(bytes_per_second: float, delay: float) -> None:
    drawn = play(link := Link(bytes_per_second, delay), 20)
    assert max(link.lags) <= MOST_UNDER_WAY * FRAME / bytes_per_second + delay + 1e-6
    # Nor is the link left idle for long.
    possible = min(SLOW, bytes_per_second / FRAME)
    assert rate(drawn, 5, 20) > 0.6 * min(possible, 1 / (2 * delay + FRAME / bytes_per_second))


def test_a_slow_link_is_asked_for_ten_frames_a_second_at_most() -> None:
    drawn = play(Link(1e7, 0.2), 10)
    assert rate(drawn, 2, 10) <= SLOW + 0.5


def test_a_link_that_slows_down_and_recovers() -> None:
    throttle = FrameThrottle()
    link = Link(1e7, 0.005)
    play(link, 5, throttle)
    assert throttle.fps == FAST
    slow = Link(5e3, 0.02)
    play(slow, 15, throttle, start=5)
    assert throttle.fps == SLOW
    assert throttle.lag is not None
    assert throttle.lag > 0.2
    play(Link(1e7, 0.005), 25, throttle, start=15)
    assert throttle.fps == FAST


def test_a_terminal_that_never_answers_gets_ten_frames_a_second_after_the_first_timeout() -> None:
    drawn = play(Link(1e7, 0.001, answers=lambda now: False), 12)
    assert drawn[0] == 0.0
    assert drawn[1] == pytest.approx(TIMEOUT, abs=0.01)
    assert rate(drawn, 3, 12) == pytest.approx(SLOW, abs=0.5)


def test_a_lost_answer_costs_a_pause_and_no_more() -> None:
    lost = Link(1e7, 0.005, answers=lambda now: not 3.0 < now < 3.2)
    drawn = play(lost, 30)
    gaps = [after - before for before, after in itertools.pairwise(drawn)]
    assert max(gaps) <= TIMEOUT + 0.1
    assert rate(drawn, 6, 30) > 0.9 * SLOW


def test_a_link_that_stood_still_goes_on() -> None:
    """Nothing arrives for five seconds, then everything does."""
    throttle, link = FrameThrottle(), Link(1e7, 0.005)
    play(link, 3, throttle)
    link.free_at, link.events = 8.0, []
    times = play(link, 20, throttle, start=3)
    assert rate(times, 12, 20) > 0.9 * SLOW


def test_an_answer_nobody_asked_for_changes_nothing() -> None:
    throttle = FrameThrottle()
    throttle.answered(1.0)
    assert throttle.lag is None
    assert throttle.allowed == 1


def test_the_wait_is_until_the_next_frame_is_due() -> None:
    throttle = FrameThrottle()
    assert throttle.wait(5.0) == 0
    throttle.drawn(5.0)
    throttle.sent(5.0)
    throttle.answered(5.001)
    assert throttle.fps == FAST
    assert throttle.wait(5.02) == pytest.approx(0.03, abs=0.03)
    assert throttle.wait(5.2) == 0


def test_late_frames_do_not_slow_the_rate() -> None:
    """A timer that rings a few milliseconds late each time still gets its twenty."""
    throttle, now, frames = FrameThrottle(), 0.0, 0
    while now < 20.0:
        wait = throttle.wait(now)
        if wait > 0:
            now += wait + 0.004
            continue
        throttle.drawn(now)
        throttle.sent(now)
        throttle.answered(now + 0.001)
        frames += 1
    assert frames / 20 == pytest.approx(FAST, rel=0.03)


def test_the_fastest_rate_can_be_chosen() -> None:
    drawn = play(Link(1e7, 0.001), 10, FrameThrottle(fastest=5))
    assert rate(drawn, 2, 10) == pytest.approx(5, abs=0.5)
    assert not math.isnan(rate(drawn, 0, 1))


def test_a_link_is_congested_when_pictures_wait_in_it_and_not_when_it_is_far() -> None:
    far, full = FrameThrottle(), FrameThrottle()
    for number in range(20):
        for throttle, lag in ((far, 0.6), (full, 0.05 + 0.04 * number)):
            throttle.sent(number)
            throttle.answered(number + lag)
    assert not far.is_congested
    assert full.is_congested
