"""Checks of where the robot came: targets, places in their order, directions, circles."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from grader.check import NoParams, check
from grader.driving.drive_record import CLEARANCE_INTERVAL, GradedDrive
from grader.driving.waypoints import pass_waypoints


@dataclass(frozen=True, slots=True)
class WaypointParams:
    places: tuple[str, ...] = ("1 0",)
    """Waypoints in order: x and y [m] in the frame of the robot's start."""
    within: float = 0.15
    """m"""


@dataclass(frozen=True, slots=True)
class CircleParams:
    radius: float = 0.5
    """m"""
    after: float = 1.0
    """s: the drive before this time is ignored."""
    turning: str = ""
    """left or right; empty: to either side."""


@dataclass(frozen=True, slots=True)
class HeadingParams:
    turned: float = 90.0
    """Degrees by which the robot is turned at the end, counter-clockwise."""
    against: str = "start"
    """What they are counted from: ``start``, its heading there, or ``world``, the x axis."""


@dataclass(frozen=True, slots=True)
class RemainingTurnParams:
    topic: str = "/turn_to/_action/feedback"
    """Of the action's feedback."""
    turned: float = 0.0
    """Degrees: the heading that is wanted, against the world's x axis."""
    within: float = 10.0
    """Degrees"""
    least: int = 10
    """Messages."""


@check(none=0, full=1, words=("stopped early", "runs to the end"))
def runs(drive: GradedDrive, params: NoParams) -> float:
    """Your program stopped before the episode was over ({where}). {passed} of {count} episodes ran through."""
    return 1.0 if drive.failure is None else 0.0


@check(none=0, full=1, words=("not reached", "reached"))
def reached(drive: GradedDrive, params: NoParams) -> float:
    """The robot reached its target in {passed} of {count} episodes. Look at {where}."""
    return 1.0 if drive.score.reached_s is not None else 0.0


@check(none=60, full=30, unit="s")
def in_time(drive: GradedDrive, params: NoParams) -> float:
    """The slowest episode ({where}) took {actual} to the target; {full} earn all points. An episode that never gets
    there counts as endless."""
    return math.inf if drive.score.reached_s is None else drive.score.reached_s


@check(none=0, full=0.9, unit="%")
def approach(drive: GradedDrive, params: NoParams) -> float:
    """In the worst episode ({where}) the robot closed {actual} of the distance to its target; {full} earns all
    points."""
    case = drive.scenario.case
    if case is None or not len(drive.track):
        return math.nan
    away = np.hypot(drive.track[:, 0] - case.target[0], drive.track[:, 1] - case.target[1])
    if drive.score.reached_s is not None or away[0] <= case.target_radius:
        return 1.0
    return float((away[0] - away.min()) / (away[0] - case.target_radius))


@check(none=0.5, full=3, unit="m")
def moves(drive: GradedDrive, params: NoParams) -> float:
    """The robot drove only {actual} ({where}); {full} are wanted."""
    return drive.score.distance_m


@check(none=1, full=3, unit="m")
def gets_about(drive: GradedDrive, params: NoParams) -> float:
    """The robot drove only {actual} where it had not been before ({where}); {full} are wanted. To and fro on one place, or
    round and round, leads nowhere."""
    places = np.floor(drive.track[::CLEARANCE_INTERVAL, :2] / PLACE_SIZE)
    return PLACE_SIZE * (len(np.unique(places, axis=0)) - 1) if len(places) else 0.0


PLACE_SIZE: Final = 0.2
"""Width and height of a square in which a robot has been or not [m]."""


@check(none=2.0, full=1.2)
def short_way(drive: GradedDrive, params: NoParams) -> float:
    """The way was {actual} times as long as the straight line to the target ({where}); {full} or less earns all
    points."""
    case = drive.scenario.case
    if case is None or drive.score.reached_s is None or not len(drive.track):
        return math.inf
    straight = math.hypot(drive.track[0, 0] - case.target[0], drive.track[0, 1] - case.target[1])
    return drive.score.distance_m / max(straight - case.target_radius, 1e-9)


@check(none=0, full=1, unit="%", params=WaypointParams, is_explained=True)
def comes_by(drive: GradedDrive, params: WaypointParams) -> float:
    """Of the asked places the robot came by {actual}, in their order, in the worst episode ({where})."""
    if not len(drive.track):
        return 0.0
    path = drive.track[::CLEARANCE_INTERVAL]
    return pass_waypoints(path, params.places, params.within).passed / len(params.places)


@check(none=1, full=0.15, unit="m")
def comes_back(drive: GradedDrive, params: NoParams) -> float:
    """At its end the robot stands {actual} from where it began ({where}); at most {full} earns all points."""
    if not len(drive.track):
        return math.nan
    return float(math.dist(drive.track[0, :2], drive.track[-1, :2]))


@check(none=45, full=5, unit="degrees", params=HeadingParams)
def faces(drive: GradedDrive, params: HeadingParams) -> float:
    """At its end the robot faces {actual} away from the asked direction ({where}); at most {full} earns all points."""
    if not len(drive.track):
        return math.nan
    if params.against not in ("start", "world"):
        raise ValueError(f"against is start or world, not {params.against}")
    turned = float(drive.track[-1, 2] - (drive.track[0, 2] if params.against == "start" else 0.0))
    return abs(math.degrees(math.remainder(turned - math.radians(params.turned), math.tau)))


@check(none=0.5, full=0.9, unit="%", params=RemainingTurnParams)
def remaining_turn(drive: GradedDrive, params: RemainingTurnParams) -> float:
    """How far the robot still has to turn is told rightly by {actual} of the action's feedback ({where}); {full} earns all
    points. It is the angle from its heading to the wanted one, the short way round."""
    told = drive.feedback_remaining.get(params.topic)
    if told is None or len(told) < params.least or not len(drive.track):
        return 0.0
    ticks = np.clip(np.round(told[:, 0] / drive.recording.step_size).astype(int), 0, len(drive.track) - 1)
    left = np.radians(params.turned) - drive.track[ticks, 2]
    off = np.abs(np.abs(np.arctan2(np.sin(left), np.cos(left))) - np.abs(told[:, 1]))
    return float(np.mean(off <= np.radians(params.within)))


@check(none=0.5, full=0.1, unit="%", params=CircleParams, is_explained=True)
def circle(drive: GradedDrive, params: CircleParams) -> float:
    """The robot's way should be a circle of the asked radius, to the asked side; its points are off by {actual} of that
    ({where}); {full} is allowed. A circle's radius is the speed divided by the rate of turning; a circle to the other
    side is off by twice its radius, and what is driven back on the same arc counts too."""
    if params.turning not in ("", "left", "right"):
        raise ValueError(f"turning is left or right, not {params.turning}")
    fit = drive.fit_circle(params.after)
    return math.inf if fit is None or params.radius <= 0.0 else fit.off(params.radius, params.turning)
