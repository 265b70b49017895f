"""Whether a program's speeds and messages follow what it was told, and what a student is told of the first that does not."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from kit.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class Following:
    """How well values follow what was known when they came."""

    share: float = 0.0
    """Of the values that are the asked ones, in the case that goes worst; 0 where a case never occurs."""
    mistake: str = ""
    """What the first wrong value of that case is, or which case never occurs; empty if nothing is wrong or there is no value."""


@dataclass(frozen=True, slots=True)
class SpeedByRangeParams:
    topic: str = "/static_laser"
    """The laser's."""
    bands: tuple[str, ...] = ("0.5 0", "1.2 0.3", "inf 0.6")
    """Each the distance straight ahead up to which it holds [m], and the speed that is asked there [m/s]; nearest first. All
    must occur."""
    within: float = 0.02
    """m/s"""

    def judge(
        self, ahead: Mapping[str, FloatArray], flags: Mapping[str, FloatArray], commands: FloatArray
    ) -> Following:
        """Judges the commands of a drive by its scans; see ``GradedDrive``."""
        scans = ahead.get(self.topic, np.empty((0, 3)))
        bands = [tuple(map(float, each.split())) for each in self.bands]
        cases = np.array([float(_band_of(bands, distance)) for distance in scans[:, 1]])
        ends = [0.0, *(end for end, _ in bands)]
        names = [
            f"{low:g} m or more ahead" if math.isinf(high) else f"less than {high:g} m ahead"
            for low, high in pairwise(ends)
        ]

        def describe(scan: int, value: float, case: int) -> str:
            met = f"{scans[scan, 1]:.2f} m" if math.isfinite(scans[scan, 1]) else "nothing (nan)"
            return (
                f"with {met} straight ahead it drives at {value:g} m/s; {bands[case][1]:g} m/s is asked for"
            )

        return _follow(
            commands, scans[:, 0], cases, [speed for _, speed in bands], self.within, names, describe
        )


@dataclass(frozen=True, slots=True)
class FlagByRangeParams:
    topic: str = "/wall_ahead"
    """Of the booleans."""
    laser: str = "/static_laser"
    """The laser's topic."""
    nearer: float = 0.5
    """m: true where something is nearer ahead."""

    def judge(
        self, ahead: Mapping[str, FloatArray], flags: Mapping[str, FloatArray], commands: FloatArray
    ) -> Following:
        """Judges what is said on the topic by the scans; see ``GradedDrive``."""
        scans, said = ahead.get(self.laser, np.empty((0, 3))), flags.get(self.topic, np.empty((0, 2)))
        cases = np.where(scans[:, 1] < self.nearer, 1.0, np.where(scans[:, 2] < self.nearer, math.nan, 0.0))
        names = [
            f"nothing nearer than {self.nearer:g} m in front",
            f"a wall nearer than {self.nearer:g} m ahead",
        ]

        def describe(scan: int, value: float, case: int) -> str:
            place = f"{scans[scan, 1]:.2f} m straight ahead" if case else names[0]
            return f"with {place} it says {bool(value)}; {bool(case)} is asked for"

        return _follow(said, scans[:, 0], cases, (0.0, 1.0), 0.0, names, describe)


@dataclass(frozen=True, slots=True)
class SpeedByFlagParams:
    topic: str = "/wall_ahead"
    """Of the booleans."""
    at_true: float = 0.0
    at_false: float = 0.4
    """m/s, forward."""
    within: float = 0.02
    """m/s"""

    def judge(
        self, ahead: Mapping[str, FloatArray], flags: Mapping[str, FloatArray], commands: FloatArray
    ) -> Following:
        """Judges the commands by what was said on the topic; see ``GradedDrive``."""
        said = flags.get(self.topic, np.empty((0, 2)))
        asked = (self.at_false, self.at_true)
        names = [f"{value} on {self.topic}" for value in (False, True)]

        def describe(message: int, value: float, case: int) -> str:
            return f"after {names[case]} it drives at {value:g} m/s; {asked[case]:g} m/s is asked for"

        return _follow(commands, said[:, 0], said[:, 1], asked, self.within, names, describe)


def _follow(
    values: FloatArray,
    times: FloatArray,
    cases: FloatArray,
    asked: Sequence[float],
    within: float,
    names: Sequence[str],
    describe: Callable[[int, float, int], str],
) -> Following:
    """Judges ``values`` (k, 2 or more: time [s], value).

    ``cases``: (n,) at each of ``times`` [s], the index of the value in ``asked`` that belongs to what was known then; nan where
    any value will do. A value may also answer what was known before the newest. ``names`` has the words for each case;
    ``describe`` is given the index of a time, a wrong value and the case that it belongs to.
    """
    if not len(times) or not len(values):
        return Following()
    latest = np.maximum(np.searchsorted(times, values[:, 0] + 1e-9, side="right") - 1, 0)
    is_right = np.zeros(len(values), dtype=np.bool_)
    for back in (0, 1):
        case = cases[np.maximum(latest - back, 0)]
        wanted = np.array(asked)[np.nan_to_num(case).astype(int)]
        is_right |= np.isnan(case) | (np.abs(values[:, 1] - wanted) <= within)
    case = cases[latest]
    shares = {
        each: float(is_right[case == each].mean()) for each in range(len(asked)) if (case == each).any()
    }
    share = min(shares.values()) if len(shares) == len(asked) else 0.0
    wrong = np.flatnonzero(~is_right)
    if len(wrong):
        worst = min(shares, key=lambda each: shares[each])
        first = np.flatnonzero(~is_right & (case == worst))[0]
        text = describe(int(latest[first]), float(values[first, 1]), worst)
        return Following(share, f"At {values[first, 0]:.1f} s, {text}.")
    missing = next((each for each in range(len(asked)) if each not in shares), None)
    return Following(share, "" if missing is None else f"There never was {names[missing]}.")


def _band_of(bands: Sequence[tuple[float, ...]], distance: float) -> int:
    """Returns the first band whose end is beyond a distance; the last one for nan, for nothing that was met."""
    return next((number for number, band in enumerate(bands) if distance < band[0]), len(bands) - 1)
