"""Places that a robot should come by in their order, and what a student is told of the first that it missed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from kit.arrays import FloatArray
from kit.geometry import Pose


@dataclass(frozen=True, slots=True)
class WaypointsPassed:
    """How many of the places a robot came by, one after the other."""

    passed: int
    places: Sequence[str]
    """Each x and y [m] in the frame of the robot's start."""
    nearest: float
    """m, from the first place that was missed to the way after the place before; 0 if none was missed."""

    def describe(self) -> str:
        """Returns what is told of a way that misses a place."""
        if self.passed == len(self.places):
            return ""
        x, y = map(float, self.places[self.passed].split())
        along = f"{abs(x):g} m {'ahead of' if x > 0 else 'behind'}" if x else ""
        beside = f"{abs(y):g} m to the {'left' if y > 0 else 'right'} of" if y else ""
        place = " and ".join(filter(None, (along, beside)))
        where = f"{place} its start" if place else "its start"
        before = f"comes by {self.passed} of {len(self.places)} places, then " if self.passed else ""
        return f"The robot {before}misses the next, {where}, by {self.nearest:.2g} m."


def pass_waypoints(track: FloatArray, places: Sequence[str], within: float) -> WaypointsPassed:
    """Follows a robot's way from place to place.

    Args:
        track: (n, 3) the robot's poses, at least one.
        places: each x and y [m] in the frame of the first pose.
        within: how near to a place counts [m].
    """
    start, path = Pose(*track[0].tolist()), track[:, :2]
    for passed, place in enumerate(places):
        x, y = (float(number) for number in place.split())
        distances = np.hypot(*(path - start.transform_point(x, y)).T)
        near = np.flatnonzero(distances <= within)
        if not len(near):
            return WaypointsPassed(passed, places, float(distances.min()))
        path = path[near[0] :]
    return WaypointsPassed(len(places), places, 0.0)
