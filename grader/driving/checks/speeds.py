"""Checks of how fast the robot drove, and on what that depended."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from grader.check import NoParams, check
from grader.driving.drive_record import GradedDrive
from grader.driving.following import FlagByRangeParams, SpeedByFlagParams, SpeedByRangeParams


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
    speeds = drive.speeds
    return float(np.max(speeds[~np.isnan(speeds)], initial=0.0))


@check(none=0.5, full=0.9, unit="%", params=SpeedByRangeParams, is_explained=True)
def speed_by_range(drive: GradedDrive, params: SpeedByRangeParams) -> float:
    """The speed does not follow what the laser measures ahead: it is the asked one for {actual} of the commands, in the case
    that goes worst ({where}); {full} earns all points. Compare the numbers you publish, and when, with the task's."""
    return params.judge(drive.ahead, drive.flags, drive.commands).share


@check(none=0.5, full=0.9, unit="%", params=FlagByRangeParams, is_explained=True)
def flag_by_range(drive: GradedDrive, params: FlagByRangeParams) -> float:
    """What the program says of walls ahead is true for {actual} of its messages, in the case that goes worst ({where}); {full}
    earns all points. Both cases must occur. True is asked where the ray straight ahead is nearer than that, false where
    nothing within 60 degrees of it is."""
    return params.judge(drive.ahead, drive.flags, drive.commands).share


@check(none=0.5, full=0.9, unit="%", params=SpeedByFlagParams, is_explained=True)
def speed_by_flag(drive: GradedDrive, params: SpeedByFlagParams) -> float:
    """The speed does not follow what is said on the topic: it is the asked one for {actual} of the commands, in the case that
    goes worst ({where}); {full} earns all points. Both cases must occur."""
    return params.judge(drive.ahead, drive.flags, drive.commands).share


@check(none=0.5, full=0.95, unit="%", params=SpeedSpanParams, is_explained=True)
def keeps_speed(drive: GradedDrive, params: SpeedSpanParams) -> float:
    """The robot kept to the asked speed for {actual} of the time that counts here ({where}); {full} earns all points."""
    speeds = drive.speeds_between(params.begin, params.end)
    return float(np.mean((speeds >= params.low) & (speeds <= params.high))) if len(speeds) else math.nan
