"""A check of controllers: how far the robot turned."""

from __future__ import annotations

import numpy as np

from grader.check import NoParams, check
from grader.driving.drive_record import GradedDrive


@check(none=0, full=6.28, unit="rad")
def turns(drive: GradedDrive, params: NoParams) -> float:
    """The robot turned only {actual} ({where}); {full} are wanted."""
    return float(np.abs(np.diff(np.unwrap(drive.track[:, 2]))).sum())
