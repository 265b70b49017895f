"""Checks of how fast the robot drove, and on what that depended."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from grader.check import NoParams, check
from grader.driving.drive_record import GradedDrive
from kit.arrays import FloatArray
from kit.run.recording import ACCEPT


@dataclass(frozen=True, slots=True)
class SpeedByRangeParams:
    topic: str = "/static_laser"
    """The laser's."""
    bands: tuple[str, ...] = ("0.5 0", "1.2 0.3", "inf 0.6")
    """Each the distance straight ahead up to which it holds [m], and the speed that is asked there [m/s]; nearest first. All
    must occur."""
    within: float = 0.02
    """m/s"""


@dataclass(frozen=True, slots=True)
class FlagByRangeParams:
    topic: str = "/wall_ahead"
    """Of the booleans."""
    laser: str = "/static_laser"
    """The laser's topic."""
    nearer: float = 0.5
    """m: true where something is nearer ahead."""


@dataclass(frozen=True, slots=True)
class SpeedByFlagParams:
    topic: str = "/wall_ahead"
    """Of the booleans."""
    at_true: float = 0.0
    at_false: float = 0.4
    """m/s, forward."""
    within: float = 0.02
    """m/s"""


@dataclass(frozen=True, slots=True)
class SpeedSpanParams:
    begin: float = 0.0
    end: float = 1e9
    """s of the episode."""
    low: float = 0.0
    high: float = 0.0
    """m/s, either way."""


@check(none=4, full=1, unit="rad/s of change per second")
def smooth(drive: GradedDrive, params: NoParams) -> float:
    """The robot jerks: its turning command changed by {actual} ({where}); {full} or less is smooth."""
    commands = drive.commands
    if len(commands) < 2 or drive.seconds == 0.0:
        return math.nan
    return float(np.abs(np.diff(commands[:, 2])).sum() / drive.seconds)


@check(none=2, full=1, unit="m/s")
def top_speed(drive: GradedDrive, params: NoParams) -> float:
    """The robot drove faster than is allowed: up to {actual} ({where}); the limit is {full}."""
    speeds = _speeds(drive)
    return float(np.max(speeds[~np.isnan(speeds)], initial=0.0))


def _speeds(drive: GradedDrive) -> FloatArray:
    """Returns (ticks - 1,) speeds [m/s]; NaN where the robot was reset, since that jump is no driving."""
    if drive.steps < 2:
        return np.empty(0)
    speeds: FloatArray = np.hypot(*np.diff(drive.track[:, :2], axis=0).T) / drive.recording.step_size
    sent = [entry.tick - 1 for entry in drive.recording.inputs if entry.kind != ACCEPT]
    speeds[[tick for tick in sent if 0 <= tick < len(speeds)]] = np.nan
    return speeds


@check(none=0.5, full=0.9, unit="%", params=SpeedByRangeParams)
def speed_by_range(drive: GradedDrive, params: SpeedByRangeParams) -> float:
    """The speed does not follow what the laser measures ahead: it is the asked one for {actual} of the commands, in the case
    that goes worst ({where}); {full} earns all points. Compare the numbers you publish, and when, with the task's."""
    scans, commands = drive.ahead.get(params.topic), drive.commands
    bands = [tuple(map(float, each.split())) for each in params.bands]
    if scans is None or not len(scans) or not len(commands):
        return 0.0
    cases = np.array([float(_band_of(bands, distance)) for distance in scans[:, 1]])
    return _follows(commands, scans[:, 0], cases, [speed for _, speed in bands], params.within)


def _follows(
    values: FloatArray, times: FloatArray, cases: FloatArray, asked: Sequence[float], within: float
) -> float:
    """Returns in what share of ``values`` (k, 2 or more: time [s], value) the value is the asked one, in the case that goes worst;
    0 where one of the cases never occurs.

    ``cases``: (n,) at each of ``times`` [s], the index of the value in ``asked`` that belongs to what was known then; nan where
    any value will do. A value may also answer what was known before the newest.
    """
    latest = np.searchsorted(times, values[:, 0] + 1e-9, side="right") - 1
    is_right = np.zeros(len(values), dtype=np.bool_)
    for back in (0, 1):
        case = cases[np.maximum(latest - back, 0)]
        wanted = np.array(asked)[np.nan_to_num(case).astype(int)]
        is_right |= np.isnan(case) | (np.abs(values[:, 1] - wanted) <= within)
    case = cases[np.maximum(latest, 0)]
    shares = [float(is_right[case == each].mean()) for each in range(len(asked)) if (case == each).any()]
    return min(shares) if len(shares) == len(asked) else 0.0


def _band_of(bands: Sequence[tuple[float, ...]], distance: float) -> int:
    """Returns the first band whose end is beyond a distance; the last one for nan, for nothing that was met."""
    return next((number for number, band in enumerate(bands) if distance < band[0]), len(bands) - 1)


@check(none=0.5, full=0.9, unit="%", params=FlagByRangeParams)
def flag_by_range(drive: GradedDrive, params: FlagByRangeParams) -> float:
    """What the program says of walls ahead is true for {actual} of its messages, in the case that goes worst ({where}); {full}
    earns all points. Both cases must occur. True is asked where the ray straight ahead is nearer than that, false where
    nothing within 60 degrees of it is."""
    scans, said = drive.ahead.get(params.laser), drive.flags.get(params.topic)
    if scans is None or not len(scans) or said is None or not len(said):
        return 0.0
    cases = np.where(scans[:, 1] < params.nearer, 1.0, np.where(scans[:, 2] < params.nearer, math.nan, 0.0))
    return _follows(said, scans[:, 0], cases, (0.0, 1.0), 0.0)


@check(none=0.5, full=0.9, unit="%", params=SpeedByFlagParams)
def speed_by_flag(drive: GradedDrive, params: SpeedByFlagParams) -> float:
    """The speed does not follow what is said on the topic: it is the asked one for {actual} of the commands, in the case that
    goes worst ({where}); {full} earns all points. Both cases must occur."""
    said, commands = drive.flags.get(params.topic), drive.commands
    if said is None or not len(said) or not len(commands):
        return 0.0
    return _follows(commands, said[:, 0], said[:, 1], (params.at_false, params.at_true), params.within)


@check(none=0.5, full=0.95, unit="%", params=SpeedSpanParams)
def keeps_speed(drive: GradedDrive, params: SpeedSpanParams) -> float:
    """The robot kept to the asked speed for {actual} of the time that counts here ({where}); {full} earns all points."""
    step = drive.recording.step_size
    first, after = round(params.begin / step), round(min(params.end, drive.seconds) / step)
    speeds = _speeds(drive)[first : max(first, after - 1)]
    speeds = speeds[~np.isnan(speeds)]
    return float(np.mean((speeds >= params.low) & (speeds <= params.high))) if len(speeds) else math.nan
