"""Simulated keyboards: how well ``hold`` guesses, on the systems students have, over links that jitter."""

from __future__ import annotations

import heapq
from dataclasses import dataclass, field

import numpy as np
import pytest

from kit.tui.input.drive import KeyboardDrive
from kit.tui.input.key_rhythm import Rhythm
from kit.tui.input.modes import HoldMode

ONE_WAY = 0.03
TAP = 0.08
HOLD = 2.5


@dataclass(frozen=True)
class Keyboard:
    """How a system repeats a held key [s], and what one of our keys may do on it."""

    delay: float
    period: float
    false_releases: float = 0.06
    """Per hold, with 15 ms of jitter, once the rhythm is learned."""
    stop: tuple[float, float] = (0.27, 0.33)
    """Stop latency [s], median and 95th percentile."""
    tap: float = 0.85
    """How long [s] a tap drives, median."""


KEYBOARDS = {
    "Linux console": Keyboard(0.25, 1 / 10.9, tap=0.4),
    "shortest delay, 50 Hz": Keyboard(0.2, 0.02, false_releases=0.15, tap=0.35),
    "GNOME, Windows": Keyboard(0.5, 1 / 33),
    "KDE": Keyboard(0.6, 1 / 25),
    "X.org": Keyboard(0.66, 1 / 25),
    "macOS, short": Keyboard(0.5, 1 / 11),
    "macOS, long": Keyboard(1.02, 1 / 11, stop=(0.3, 0.36), tap=1.25),
}


@dataclass
class Drives:
    """What came out of a session."""

    false_releases: list[int] = field(default_factory=list)
    latencies: list[float] = field(default_factory=list)
    taps: list[float] = field(default_factory=list)
    learned: Rhythm = field(default_factory=Rhythm)


def arrivals(sent: list[float], jitter: float, random: np.random.Generator) -> list[float]:
    """When keys sent at these times arrive: later by an exponential delay, but in order."""
    late = np.array(sent) + ONE_WAY + (random.exponential(jitter, len(sent)) if jitter else 0.0)
    return [float(time) for time in np.maximum.accumulate(late)]


def session(keyboard: Keyboard, jitter: float, seed: int, times: int) -> Drives:
    """So many taps and holds of W, in random order, with pauses, told to one KeyboardDrive."""
    random, drives, now = np.random.default_rng(seed), Drives(), [0.0]
    drive = KeyboardDrive(lambda: now[0])
    start = 1.0
    for hold in random.permutation([True, False] * times):
        length = HOLD if hold else TAP
        repeats = np.arange(start + keyboard.delay, start + length, keyboard.period)
        events = arrivals([start, *repeats], jitter, random)
        heapq.heapify(events)
        changes: list[tuple[float, str]] = []
        while events or drive.deadline is not None:
            deadline = drive.deadline
            if events and (deadline is None or events[0] < deadline):
                now[0] = heapq.heappop(events)
                messages = drive.press("w")
            else:
                assert deadline is not None
                now[0] = max(now[0], deadline)
                messages = drive.tick()
            changes += [(now[0], message) for message in messages]
        ends = [time for time, message in changes if message == "r_up"]
        if hold:
            drives.false_releases.append(len(ends) - 1)
            drives.latencies.append(ends[-1] - (start + length))
        else:
            drives.taps.append(ends[-1] - changes[0][0])
        start = now[0] + float(random.uniform(0.3, 2.0))
    assert isinstance(drive._mode, HoldMode)
    drives.learned = drive._mode.rhythm
    return drives


@pytest.mark.parametrize("keyboard", KEYBOARDS.values(), ids=KEYBOARDS)
def test_without_jitter_no_hold_is_interrupted_once_the_rhythm_is_known(keyboard: Keyboard) -> None:
    drives = session(keyboard, 0.0, seed=1, times=30)
    assert sum(drives.false_releases) <= 4  # a delay of 1.02 s takes four holds to learn
    assert not any(drives.false_releases[6:])
    assert drives.learned.delay == pytest.approx(keyboard.delay, rel=0.02)
    assert drives.learned.period == pytest.approx(keyboard.period, rel=0.02)
    assert not drives.learned.uneven


@pytest.mark.parametrize("keyboard", KEYBOARDS.values(), ids=KEYBOARDS)
def test_over_an_ordinary_link(keyboard: Keyboard) -> None:
    drives = session(keyboard, 0.015, seed=2, times=200)
    assert np.mean(drives.false_releases) <= keyboard.false_releases
    assert np.median(drives.latencies) <= keyboard.stop[0]
    assert np.percentile(drives.latencies, 95) <= keyboard.stop[1]
    assert np.median(drives.taps) <= keyboard.tap


@pytest.mark.parametrize("keyboard", KEYBOARDS.values(), ids=KEYBOARDS)
def test_over_a_bad_link_it_still_stops(keyboard: Keyboard) -> None:
    drives = session(keyboard, 0.06, seed=3, times=100)
    assert np.percentile(drives.latencies, 95) <= 0.75
    # At worst the last repeat arrives when the key already counted as released, and looks like a press.
    assert max(drives.latencies) <= drives.learned.first_timeout + 0.8


def test_a_bad_link_is_noticed_and_an_ordinary_one_is_not() -> None:
    keyboard = KEYBOARDS["GNOME, Windows"]
    assert session(keyboard, 0.06, seed=4, times=20).learned.uneven
    assert not session(keyboard, 0.015, seed=4, times=20).learned.uneven


def test_taps_teach_nothing_wrong() -> None:
    """Someone who taps five times a second is not a keyboard with a delay of 0.2 s."""
    rhythm, now = Rhythm(), 0.0
    rhythm.start(now)
    for _ in range(50):
        now += 0.2
        rhythm.note_repeat(now)
    assert rhythm.delay == 0.5
    assert not rhythm.uneven
