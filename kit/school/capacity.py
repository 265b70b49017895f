"""How many students a machine carries, by what one costs; and what many learners need, by a simulation of their hand-ins.

Nothing here is measured: ``kit/school/class_costs.py`` measures. What is assumed of people stands in ``Habits``, and is told with
every result.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from kit.arrays import FloatArray

SEED: Final = 2026
HOUR_S: Final = 3600.0
RESERVE: Final = 0.2
"""Share of a machine that stays free: for its system, and for moments that are worse than the mean."""


@dataclass(frozen=True, slots=True)
class UseCost:
    """What one student costs who drives, and what one check costs."""

    drive_cores: float
    """Cores that a drive on the screen keeps busy."""
    drive_bytes: float
    """Memory of a drive, with its share of what several have in common [bytes]."""
    check_core_s: float
    """Seconds of one core that a check takes."""
    check_s: float
    """Wall clock of a check on a machine that does nothing else [s]."""
    check_bytes: float
    """Memory of a check at its most [bytes]."""


@dataclass(frozen=True, slots=True)
class Habits:
    """What is assumed of learners."""

    seconds_between_checks: float = 300.0
    """In a class, from one check of a student to the next [s]."""
    hand_ins: int = 3
    """Each learner's, until the deadline."""
    days: float = 14.0
    """From the hand-out to the deadline."""
    mean_hours_left: float = 24.0
    """Mean time before the deadline of a hand-in [h]: their number grows exponentially towards it."""
    work_s: float = HOUR_S
    """How long somebody drives and programs before each hand-in [s]."""
    wait_s: float = 60.0
    """How long 95 of 100 wait for a check to begin, at most [s]."""


@dataclass(frozen=True, slots=True)
class MachineSize:
    """What a machine has."""

    cores: int
    memory_bytes: float
    """What programs may still take [bytes]."""


@dataclass(frozen=True, slots=True)
class ClassCapacity:
    """How many students a machine carries at once."""

    by_cores: int
    by_memory: int

    @property
    def students(self) -> int:
        return min(self.by_cores, self.by_memory)

    @property
    def scarce(self) -> str:
        """What there is too little of first."""
        return "cores" if self.by_cores < self.by_memory else "memory"


def class_capacity(machine: MachineSize, cost: UseCost, habits: Habits) -> ClassCapacity:
    """Students who all drive at once and check now and then.

    >>> cost = UseCost(0.1, 100e6, 3.0, 3.0, 200e6)
    >>> class_capacity(MachineSize(2, 4e9), cost, Habits(seconds_between_checks=300)).students
    14
    """
    cores = cost.drive_cores + cost.check_core_s / habits.seconds_between_checks
    memory = cost.drive_bytes + cost.check_bytes * cost.check_s / habits.seconds_between_checks
    free = 1.0 - RESERVE
    return ClassCapacity(
        math.floor(machine.cores * free / cores), math.floor(machine.memory_bytes * free / memory)
    )


@dataclass(frozen=True, slots=True)
class ServerNeed:
    """What learners need who share servers."""

    learners: int
    check_cores: int
    """Cores for checks alone, where learners drive on machines of their own."""
    check_bytes: float
    waits_s: float
    """What 95 of 100 wait at most for a check to begin [s]."""
    last_hour: int
    """Hand-ins in the last hour."""
    most_at_work: int
    """The most who drive and program at one time."""
    drive_cores: int
    """Cores for those, if they work on the servers too."""
    drive_bytes: float


def server_need(learners: int, cost: UseCost, habits: Habits) -> ServerNeed:
    """Simulates all hand-ins until a deadline, and finds the fewest cores with which no more than 1 of 20 waits too long."""
    times = hand_in_times(learners * habits.hand_ins, habits)
    cores = fewest_cores(times, cost.check_core_s, habits.wait_s)
    at_work = most_at_once(times - habits.work_s, habits.work_s)
    return ServerNeed(
        learners,
        cores,
        cores * cost.check_bytes,
        float(np.quantile(waits(times, cores, cost.check_core_s), 0.95)),
        int((times > -HOUR_S).sum()),
        at_work,
        math.ceil(at_work * cost.drive_cores / (1.0 - RESERVE)),
        at_work * cost.drive_bytes / (1.0 - RESERVE),
    )


def hand_in_times(count: int, habits: Habits, seed: int = SEED) -> FloatArray:
    """(count,) the times of hand-ins in order [s], 0 at the deadline: exponentially more towards it, by inversion."""
    mean, longest = habits.mean_hours_left * HOUR_S, habits.days * 24 * HOUR_S
    drawn = np.random.default_rng(seed).random(count)
    before = -mean * np.log1p(-drawn * -math.expm1(-longest / mean))
    return np.sort(-before)


def waits(times: FloatArray, cores: int, service_s: float) -> FloatArray:
    """(n,) how long each waits whose turn comes in order, where every check takes one of ``cores`` equally long [s].

    >>> waits(np.array([0.0, 0.0, 1.0]), 1, 2.0).tolist()
    [0.0, 2.0, 3.0]
    """
    begins = times.tolist()
    for i in range(cores, len(begins)):
        # Who came ``cores`` earlier has just left: all are served equally long, so they leave in the order in which they came.
        begins[i] = max(begins[i], begins[i - cores] + service_s)
    return np.asarray(begins) - times


def fewest_cores(times: FloatArray, service_s: float, wait_s: float) -> int:
    """The fewest cores with which 95 of 100 wait no longer than ``wait_s``."""

    def is_enough(cores: int) -> bool:
        return bool(np.quantile(waits(times, cores, service_s), 0.95) <= wait_s)

    enough = 1
    while not is_enough(enough):
        enough *= 2
    too_few = enough // 2
    while enough - too_few > 1:
        middle = (enough + too_few) // 2
        enough, too_few = (middle, too_few) if is_enough(middle) else (enough, middle)
    return enough


def most_at_once(begins: FloatArray, length_s: float) -> int:
    """How many of these spans of equal length contain the same moment, at most."""
    return int(
        max(
            (
                np.searchsorted(begins, begins, side="right")
                - np.searchsorted(begins, begins - length_s, side="right")
            ),
            default=0,
        )
    )
