"""Checks of how the robot kept from walls, and of what it did after touching one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grader.check import NoParams, check
from grader.driving.drive_record import GradedDrive


@dataclass(frozen=True, slots=True)
class DistanceBandParams:
    low: float = 0.3
    high: float = 0.5
    """m"""
    side: str = ""
    """``left`` or ``right``: only a wall on this side of the robot counts; empty for any."""


@check(none=3, full=0, unit="bumps")
def bumps(drive: GradedDrive, params: NoParams) -> float:
    """The robot touched something: {actual} in the worst episode ({where}); {full} are allowed for all points."""
    return float(drive.score.bumps)


@check(none=0.02, full=0.1, unit="m")
def clearance(drive: GradedDrive, params: NoParams) -> float:
    """The robot came within {actual} of a wall ({where}); at least {full} are wanted all the way."""
    return float(drive.clearances.min())


@check(none=0.3, full=0.9, unit="%", params=DistanceBandParams)
def keeps_distance(drive: GradedDrive, params: DistanceBandParams) -> float:
    """The robot kept the asked distance to the wall, on the asked side, for {actual} of its time in the worst episode
    ({where}); {full} earns all points."""
    near = (
        drive.side_clearances(left=params.side == "left", within=params.high)
        if params.side
        else drive.clearances
    )
    return float(np.mean((near >= params.low) & (near <= params.high)))


@check(none=0, full=1, unit="%")
def goes_home(drive: GradedDrive, params: NoParams) -> float:
    """After {actual} of its bumps the robot was sent home within half a second, and not otherwise ({where}). A bump is a message
    on collisions; going home is a request to the service /move_model."""
    # Before the first tick it is the grader who puts the robot at its start.
    sent = np.array([each.tick for each in drive.recording.inputs if each.kind == "move_model" and each.tick])
    bumps = np.array(drive.bump_ticks)
    if not len(sent) or not len(bumps):
        return 0.0
    waited = sent[None, :] - bumps[:, None]
    soon = (waited >= 0) & (waited <= 0.5 / drive.recording.step_size)
    return float(min(soon.any(axis=1).mean(), soon.any(axis=0).mean()))
