"""Checks of controllers, each a function of one recorded drive."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np

from grader.check import Check, NoParams, check
from grader.driving.drive_record import CLEARANCE_INTERVAL, GradedDrive
from kit.arrays import FloatArray
from kit.geometry import Pose
from kit.run.recording import ACCEPT


@dataclass(frozen=True, slots=True)
class TopicRateParams:
    topic: str = "/cmd_vel"
    rate: float = 10.0
    """Messages per second."""


@dataclass(frozen=True, slots=True)
class TopicsParams:
    topics: tuple[str, ...] = ("/cmd_vel geometry_msgs/msg/Twist",)
    """Each a name; after a space optionally the message type, and after another the only node that may publish
    it."""
    least: int = 1
    """Messages on each of them."""


@dataclass(frozen=True, slots=True)
class DistanceBandParams:
    low: float = 0.3
    high: float = 0.5
    """m"""
    side: str = ""
    """``left`` or ``right``: only a wall on this side of the robot counts; empty for any."""


@dataclass(frozen=True, slots=True)
class WaypointParams:
    places: tuple[str, ...] = ("1 0",)
    """Waypoints in order: x and y [m] in the frame of the robot's start."""
    within: float = 0.15
    """m"""


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


@dataclass(frozen=True, slots=True)
class AnswerParams:
    call: str = ""
    """Its name in the trial."""
    holds: str = ""
    """Text that the answer, as JSON, must contain."""


@dataclass(frozen=True, slots=True)
class PrintedTextParams:
    text: str = ""
    """Text that printed lines should contain."""
    seconds: float = 1.0
    """Seconds between two such lines."""


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


@dataclass(frozen=True, slots=True)
class HeardTopicsParams:
    node: str = "/driver"
    topics: tuple[str, ...] = ("/wall_ahead",)
    """All to which the node subscribes, and no other."""


@dataclass(frozen=True, slots=True)
class ProfilesParams:
    ends: tuple[str, ...] = ()
    """Each as ``/node publishes /topic BEST_EFFORT VOLATILE 5``, or ``subscribes``; the last words may be left out."""


@dataclass(frozen=True, slots=True)
class NodeNamesParams:
    nodes: tuple[str, ...] = ()
    """Full names that the program's nodes must have, letter by letter."""


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


@check(none=4, full=1, unit="rad/s of change per second")
def smooth(drive: GradedDrive, params: NoParams) -> float:
    """The robot jerks: its turning command changed by {actual} ({where}); {full} or less is smooth."""
    commands = drive.commands
    if len(commands) < 2 or drive.seconds == 0.0:
        return math.nan
    return float(np.abs(np.diff(commands[:, 2])).sum() / drive.seconds)


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


@check(none=2.0, full=1.2)
def short_way(drive: GradedDrive, params: NoParams) -> float:
    """The way was {actual} times as long as the straight line to the target ({where}); {full} or less earns all
    points."""
    case = drive.scenario.case
    if case is None or drive.score.reached_s is None or not len(drive.track):
        return math.inf
    straight = math.hypot(drive.track[0, 0] - case.target[0], drive.track[0, 1] - case.target[1])
    return drive.score.distance_m / max(straight - case.target_radius, 1e-9)


@check(none=0.5, full=0.1, unit="%", params=TopicRateParams)
def rate(drive: GradedDrive, params: TopicRateParams) -> float:
    """The program's messages do not come at the asked rate: it is off by {actual} ({where}); {full} is
    allowed. A timer sets the rate, not a sleep."""
    traffic = drive.traffic.get(params.topic)
    if traffic is None or drive.seconds == 0.0 or params.rate <= 0.0:
        return math.inf
    return _rate_error(traffic.per_second, params.rate, drive.seconds)


def _rate_error(per_second: Mapping[int, int], rate: float, seconds: float) -> float:
    """Returns how far what comes ``rate`` times a second is off: over all, or by the share of the time in which there is less than half
    or more than twice as much of it, whichever is more. All at once is no rate.

    ``per_second``: how much of it came in each second. The first second does not count as such a time: a program begins in it.
    """
    mean_error = abs(sum(per_second.values()) / seconds - rate) / rate
    length = max(1, math.ceil(LEAST_PER_SPAN / rate))
    spans = [
        sum(per_second.get(each, 0) for each in range(first, first + length)) / (length * rate)
        for first in range(1, int(seconds) - length + 1, length)
    ]
    uneven = sum(not 0.4 < share < 2.5 for share in spans) / len(spans) if spans else 0.0
    return max(mean_error, uneven)


LEAST_PER_SPAN: Final = 4
"""Messages or lines that a span of time should hold that is looked at by itself."""


@check(none=0, full=1, unit="%", params=TopicsParams)
def topics(drive: GradedDrive, params: TopicsParams) -> float:
    """Of the asked topics the program published {actual} ({where}). Compare the names and the types with
    what the task says: `kit ros topic list` shows what there is, `kit ros node info` who publishes."""
    published = [_is_published(drive, params.least, *each.split()) for each in params.topics]
    return sum(published) / len(published) if published else math.nan


def _is_published(drive: GradedDrive, least: int, name: str, kind: str = "", node: str = "") -> bool:
    traffic = drive.traffic.get(name)
    if traffic is None or traffic.count < least:
        return False
    return kind in ("", traffic.kind) and (not node or traffic.nodes == (node,))


@check(none=1, full=0, unit="changes")
def obeys(drive: GradedDrive, params: NoParams) -> float:
    """The program tried to change the world instead of driving in it: {actual} ({where}). Only what the task allows
    works here."""
    return float(len(drive.refused))


@check(none=0, full=1, unit="%", params=WaypointParams)
def comes_by(drive: GradedDrive, params: WaypointParams) -> float:
    """Of the asked places the robot came by {actual}, in their order, in the worst episode ({where}). Compare its way
    in the picture with what was asked."""
    if not len(drive.track):
        return 0.0
    start, passed = Pose(*drive.track[0].tolist()), 0
    path = drive.track[::CLEARANCE_INTERVAL, :2]
    for place in params.places:
        x, y = (float(number) for number in place.split())
        near = np.flatnonzero(np.hypot(*(path - start.transform_point(x, y)).T) <= params.within)
        if not len(near):
            break
        path, passed = path[near[0] :], passed + 1
    return passed / len(params.places)


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
    told = drive.remaining.get(params.topic)
    if told is None or len(told) < params.least or not len(drive.track):
        return 0.0
    ticks = np.clip(np.round(told[:, 0] / drive.recording.step_size).astype(int), 0, len(drive.track) - 1)
    left = np.radians(params.turned) - drive.track[ticks, 2]
    off = np.abs(np.abs(np.arctan2(np.sin(left), np.cos(left))) - np.abs(told[:, 1]))
    return float(np.mean(off <= np.radians(params.within)))


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


@check(none=0, full=1, words=("not as asked", "as asked"), params=AnswerParams)
def answered(drive: GradedDrive, params: AnswerParams) -> float:
    """The program was called while it drove, and did not answer as asked ({where})."""
    return float(params.holds in drive.answers.get(params.call, ""))


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


@check(none=0.5, full=0.1, unit="%", params=PrintedTextParams)
def says(drive: GradedDrive, params: PrintedTextParams) -> float:
    """The program does not print the required text at the required rate: it is off by {actual} ({where}); {full} is
    allowed. A timer sets the rate, and `self.get_logger().info(...)` prints."""
    if drive.seconds == 0.0 or params.seconds <= 0.0:
        return math.nan
    seconds = zip(drive.printed_at, drive.printed, strict=True)
    said = Counter(second for second, line in seconds if params.text.casefold() in line.casefold())
    return _rate_error(said, 1.0 / params.seconds, drive.seconds)


@check(none=0.5, full=0.1, unit="%", params=CircleParams)
def circle(drive: GradedDrive, params: CircleParams) -> float:
    """The robot's way should be a circle of the asked radius, to the asked side; its points are off by {actual} of that
    ({where}); {full} is allowed. A circle's radius is the speed divided by the rate of turning; a circle to the other
    side is off by twice its radius, and what is driven back on the same arc counts too."""
    path = drive.track[round(params.after / drive.recording.step_size) :, :2]
    if len(path) < 10 or params.radius <= 0.0:
        return math.inf
    # Kasa's fit: x2 + y2 = 2 a x + 2 b y + c is linear in the middle (a, b).
    rows = np.column_stack((2 * path, np.ones(len(path))))
    (a, b, _), *_ = np.linalg.lstsq(rows, (path**2).sum(axis=1), rcond=None)
    spokes = path - (a, b)
    crosses = spokes[:-1, 0] * spokes[1:, 1] - spokes[:-1, 1] * spokes[1:, 0]
    if params.turning not in ("", "left", "right"):
        raise ValueError(f"turning is left or right, not {params.turning}")
    if not np.any(crosses):
        return math.inf
    radii = np.hypot(spokes[:, 0], spokes[:, 1])
    if params.turning not in ("", "left" if crosses.sum() > 0.0 else "right"):
        radii = -radii
    # What it drives back on the same arc is no way round.
    back = 1.0 - abs(crosses.sum()) / np.abs(crosses).sum()
    return max(float(np.abs(radii - params.radius).max()) / params.radius, float(back))


@check(none=0, full=1, unit="%", params=NodeNamesParams)
def named(drive: GradedDrive, params: NodeNamesParams) -> float:
    """Of the node names that the task asks for {actual} are there ({where}). A node's name is what super().__init__ is
    given; capital and small letters differ."""
    known = [name in drive.connections.nodes for name in params.nodes]
    return sum(known) / len(known) if known else math.nan


@check(none=0, full=1, words=("to other topics", "to these alone"), params=HeardTopicsParams)
def hears(drive: GradedDrive, params: HeardTopicsParams) -> float:
    """The node listens to other topics than the task says ({where})."""
    return 1.0 if set(drive.connections.heard.get(params.node, ())) == set(params.topics) else 0.0


@check(none=0, full=1, unit="%", params=ProfilesParams)
def profiles(drive: GradedDrive, params: ProfilesParams) -> float:
    """Of the asked publishers and subscriptions {actual} are there with the asked quality of service, and with no other
    ({where})."""
    found = [f"{line} " for line in drive.connections.profiles]
    asked = [_has_profile(found, end) for end in params.ends]
    return sum(asked) / len(asked) if asked else math.nan


def _has_profile(found: Sequence[str], end: str) -> bool:
    place = " ".join(end.split()[:3])
    lines = [line for line in found if line.startswith(f"{place} ")]
    return bool(lines) and all(line.startswith(f"{end} ") for line in lines)


CHECKS: Final[Mapping[str, Check]] = MappingProxyType(
    {
        each.name: each
        for each in (
            runs,
            reached,
            in_time,
            approach,
            bumps,
            clearance,
            keeps_distance,
            smooth,
            moves,
            gets_about,
            top_speed,
            short_way,
            rate,
            topics,
            obeys,
            circle,
            named,
            hears,
            profiles,
            comes_by,
            comes_back,
            faces,
            remaining_turn,
            speed_by_range,
            flag_by_range,
            speed_by_flag,
            says,
            keeps_speed,
            answered,
            goes_home,
        )
    }
)
"""Every check of a drive, by name."""
