"""The record of one graded episode, which checks measure and to which nothing comes from the student's process."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from grader.driving.circle_fit import CircleFit, fit_circle
from grader.driving.message_rate import MessageRate
from grader.driving.service_calls import NO_ANSWER, NO_SERVICE
from grader.driving.waypoints import pass_waypoints
from kit.arrays import FloatArray
from kit.geometry import Pose
from kit.host.failure import Failure
from kit.plain_text import counted, join_names
from kit.render.clearance import nearest_wall_distances, side_wall_distances
from kit.render.scene import Disc, Scene, SceneBody
from kit.render.world_text import scene_rows
from kit.ros.graph.connections import NodeConnections
from kit.ros.node.timer import TIMER_WITHOUT_CALLBACK
from kit.run.metrics import DriveMetrics
from kit.run.recording import ACCEPT, Recording, save_recording
from kit.run.scenario import Scenario
from kit.world.catalogue import map_names
from kit.world.records import Circle, Polygon

CLEARANCE_INTERVAL = 5
"""Ticks between two measurements of the clearance: 0.05 s, in which a robot at 1 m/s moves 5 cm."""

NARROW = 0.021
"""m/s: a range of speeds that is no wider is told by its middle."""

MOST_ANSWER = 160
"""Characters of a program's answer that are quoted."""

COLUMNS, ROWS = 60, 18
"""Size of the picture, in characters."""

BARE_CHECKS = frozenset({"runs", "obeys", "bumps", "clearance"})
"""Checks that a connection without another end does not explain."""
MOTION_CHECKS = frozenset(
    {"moves", "gets_about", "circle", "reached", "in_time", "approach", "comes_by", "comes_back", "faces"}
)
"""Checks of where the robot comes, which nothing but a command brings about."""
DISTANCE_CHECKS = frozenset({"moves", "gets_about"})
"""Checks of how far the robot gets."""
FOLLOWING_CHECKS = frozenset({"speed_by_range", "flag_by_range", "speed_by_flag"})
"""Checks of whether something follows what the program was told."""
COMMAND = "geometry_msgs/msg/Twist"
NO_COMMAND = "It published no command at all: what is computed must be published, too."
NOT_HOME = "The world refused a request: it named another robot, or another pose than the start's, of which x, y and theta count."
NO_CIRCLE = "It hardly moves, or drives along a line: a circle is asked for."
COUNTED_CHECKS = frozenset({"says", "rate"})
"""Checks of how often something comes."""


@dataclass(frozen=True, slots=True)
class TopicTraffic:
    """What the program published on one topic."""

    kind: str
    """Type of the message, such as ``geometry_msgs/msg/Twist``."""
    count: int
    nodes: tuple[str, ...] = ()
    """Full names of the nodes that published it."""
    per_second: Mapping[int, int] = field(default_factory=dict)
    """Messages in each second of the episode in which there were some."""


@dataclass(frozen=True, eq=False)
class GradedDrive:
    """One finished episode."""

    trial: str
    label: str
    """Name of the episode without secrets: ``maze, secret seed 2``."""
    seed: int
    secret: bool
    scenario: Scenario
    limit_s: float
    recording: Recording
    score: DriveMetrics
    failure: Failure | None
    """Why the program stopped; None if it ran to the end."""
    traffic: Mapping[str, TopicTraffic]
    """What the program's nodes published, by topic."""
    refused: tuple[str, ...]
    """World services that the program called and was refused."""
    printed: tuple[str, ...]
    fingerprint: str
    level: int
    answers: Mapping[str, str] = field(default_factory=dict)
    """What the program answered, by call; see ``grader.driving.service_calls``."""
    bump_ticks: tuple[int, ...] = ()
    """The ticks at which the robot began to touch something."""
    connections: NodeConnections = field(default_factory=NodeConnections)
    """The program's nodes at the end; empty for a program that stopped, and for a drive by hand."""
    printed_at: tuple[int, ...] = ()
    """The second of the episode in which each line was printed."""
    ahead: Mapping[str, FloatArray] = field(default_factory=dict)
    """By a laser's topic, (k, 3): the time of each scan [s], its range straight ahead, and its nearest range within 60 degrees
    to either side of that [m]; nan where nothing was met."""
    flags: Mapping[str, FloatArray] = field(default_factory=dict)
    """By the topic of a ``std_msgs/msg/Bool``, (k, 2): the time of each tick in which the program published one [s], and the
    last one's value, 0 or 1."""
    feedback_remaining: Mapping[str, FloatArray] = field(default_factory=dict)
    """By the topic of an action's feedback with a number ``remaining``, (k, 2): the time of each tick in which the program
    published one [s], and the last one's number."""

    @property
    def steps(self) -> int:
        return self.recording.ticks

    @property
    def seconds(self) -> float:
        return self.recording.ticks * self.recording.step_size

    @property
    def outcome(self) -> str:
        """Describes how the episode ended."""
        if self.failure is not None:
            return f"stopped ({self.failure.kind.value})"
        if self.score.reached_s is not None:
            return f"reached after {self.score.reached_s:.1f} s"
        bumps = f", {counted(self.score.bumps, 'bump')}" if self.score.bumps else ""
        return f"not reached{bumps}"

    @cached_property
    def track(self) -> FloatArray:
        """(ticks, 3) the robot's poses."""
        return self.recording.track(self.scenario.robot or "") if self.steps else np.empty((0, 3))

    @cached_property
    def clearances(self) -> FloatArray:
        """(k,) from the robot's hull to the nearest wall [m], every ``CLEARANCE_INTERVAL`` ticks; 0 where it touches."""
        walls = self.walls
        if not len(walls) or not len(self.track):
            return np.full(max(1, len(self.track) // CLEARANCE_INTERVAL), math.inf)
        poses = self.track[::CLEARANCE_INTERVAL].tolist()
        return nearest_wall_distances([self.body(Pose(*row)) for row in poses], walls)

    def side_clearances(self, *, left: bool, within: float) -> FloatArray:
        """Returns (k,) the same from the walls to one side of the robot; infinite beyond ``within`` [m]."""
        track = self.track[::CLEARANCE_INTERVAL]
        if not len(self.walls) or not len(track):
            return np.full(max(1, len(track)), math.inf)
        return side_wall_distances(self.body(Pose()), track, self.walls, left=left, within=within)

    @cached_property
    def walls(self) -> FloatArray:
        """(n, 4) every wall of the world."""
        return self.scenario.world.wall_segments

    @cached_property
    def commands(self) -> FloatArray:
        """(k, 3) the robot's commands: time [s], forward [m/s], turn [rad/s]."""
        rows = [
            (
                entry.tick * self.recording.step_size,
                entry.content[2]["linear"]["x"],
                entry.content[2]["angular"]["z"],
            )
            for entry in self.recording.inputs
            if entry.kind == ACCEPT and entry.content[1] == "geometry_msgs/msg/Twist"
        ]
        return np.array(rows, dtype=np.float64).reshape(-1, 3)

    @cached_property
    def speeds(self) -> FloatArray:
        """(ticks - 1,) speeds [m/s]; NaN where the robot was reset, since that jump is no driving."""
        if self.steps < 2:
            return np.empty(0)
        speeds: FloatArray = np.hypot(*np.diff(self.track[:, :2], axis=0).T) / self.recording.step_size
        sent = [entry.tick - 1 for entry in self.recording.inputs if entry.kind != ACCEPT]
        speeds[[tick for tick in sent if 0 <= tick < len(speeds)]] = np.nan
        return speeds

    def speeds_between(self, begin: float, end: float) -> FloatArray:
        """Returns (k,) the speeds [m/s] from one time of the episode to another [s], without resets."""
        step = self.recording.step_size
        first, after = round(begin / step), round(min(end, self.seconds) / step)
        speeds = self.speeds[first : max(first, after - 1)]
        return speeds[~np.isnan(speeds)]

    def body(self, pose: Pose) -> SceneBody:
        """Returns the robot's body at a pose."""
        model = next(model for model in self.scenario.world.models if model.name == self.scenario.robot)
        footprints = [footprint.shape for footprint in model.bodies[0].footprints]
        polygons = tuple(
            np.array([pose.transform_point(*point) for point in shape.points])
            for shape in footprints
            if isinstance(shape, Polygon)
        )
        discs = tuple(
            Disc(*pose.transform_point(*shape.center), shape.radius)
            for shape in footprints
            if isinstance(shape, Circle)
        )
        return SceneBody(model.name, pose, polygons, discs, is_robot=True)

    def explain(self, check: str, params: Any = None) -> str:
        """Names the mistake behind a lost check, where it can be told.

        Nothing is said of a secret episode: a program chooses its names and could pass on what it saw.
        """
        if self.secret or check in BARE_CHECKS:
            return ""
        if check == "named":
            return f"There is {join_names(self.connections.nodes)}." if self.connections.nodes else ""
        if check == "hears":
            heard = self.connections.heard.get(params.node)
            if heard is None:
                return f"There is no node {params.node}."
            return (
                f"{params.node} listens on {join_names(heard)}."
                if heard
                else f"{params.node} listens on nothing."
            )
        if check == "profiles":
            return self._explain_profiles(params.ends)
        if check in MOTION_CHECKS and not any(
            each.kind.startswith(COMMAND) for each in self.traffic.values()
        ):
            return " ".join([NO_COMMAND, *self._idle_timers(), *self.connections.mistakes])
        if check == "circle":
            fit = self.fit_circle(params.after)
            return NO_CIRCLE if fit is None else fit.describe(params.radius, params.turning)
        if check == "comes_by" and len(self.track):
            path = self.track[::CLEARANCE_INTERVAL]
            return pass_waypoints(path, params.places, params.within).describe()
        if check == "faces" and len(self.commands) and self.commands[-1, 2]:
            time_s, _, turn = self.commands[-1]
            return f"It still turns: its last command, at {time_s:.1f} s, was {turn:g} rad/s, which holds until the next one."
        if check == "keeps_speed":
            return self._explain_speed(params)
        if check == "answered":
            return self._explain_answer(params.call, params.holds)
        if check in DISTANCE_CHECKS and self.bump_ticks:
            return f"It touches something after {self.bump_ticks[0] * self.recording.step_size:.1f} s."
        topics = self._topic_mistakes(params.topics) if check == "topics" else ()
        counts = self._counts(check, params) if check in COUNTED_CHECKS and params is not None else ()
        follows = check in FOLLOWING_CHECKS and params.judge(self.ahead, self.flags, self.commands).mistake
        wrong = [follows] if follows else []
        if check == "goes_home" and "move_model" in self.refused:
            wrong.append(NOT_HOME)
        return " ".join([*counts, *wrong, *self._idle_timers(), *topics, *self.connections.mistakes])

    def _idle_timers(self) -> Iterator[str]:
        if any(TIMER_WITHOUT_CALLBACK in line for line in self.printed):
            yield TIMER_WITHOUT_CALLBACK

    def fit_circle(self, after: float) -> CircleFit | None:
        """Returns the circle nearest to the way after so many seconds; None if it goes nowhere."""
        return fit_circle(self.track[round(after / self.recording.step_size) :, :2])

    def lines_with(self, text: str) -> Counter[int]:
        """How many lines with the text, in whatever letters, were printed in each second of the episode."""
        lines = zip(self.printed_at, self.printed, strict=True)
        return Counter(second for second, line in lines if text.casefold() in line.casefold())

    def _counts(self, check: str, params: Any) -> Iterator[str]:
        """Yields how often something came that is asked for at a rate, and how often it should; see ``PrintedTextParams`` and
        ``TopicRateParams``."""
        per_second: Mapping[int, int] = {}
        if check == "says":
            asked = 1.0 / params.seconds if params.seconds > 0.0 else 0.0
            per_second = self.lines_with(params.text)
            came = f"It printed “{params.text}” {counted(sum(per_second.values()), 'time')}"
        else:
            asked = params.rate
            if params.topic in self.traffic:
                per_second = self.traffic[params.topic].per_second
            came = f"{counted(sum(per_second.values()), 'message')} came on {params.topic}"
        if asked > 0.0 and self.seconds > 0.0:
            yield MessageRate(per_second, asked, self.seconds).describe(came)

    def _explain_speed(self, params: Any) -> str:
        """Says how fast the robot drove, and how fast it should have; see ``SpeedSpanParams``."""
        begin, end = params.begin, min(params.end, self.seconds)
        speeds = self.speeds_between(begin, end)
        if not len(speeds):
            return ""
        slow, fast = np.quantile(speeds, (0.1, 0.9))
        driven, asked = _range_text(slow, fast), _range_text(params.low, params.high)
        return f"From {begin:g} s to {end:g} s it drove at {driven} m/s; {asked} m/s is asked for."

    def _explain_answer(self, call: str, holds: str) -> str:
        """Says what the program answered instead; see ``AnswerParams``."""
        answer = self.answers.get(call, NO_ANSWER)[:MOST_ANSWER]
        said = {NO_ANSWER: "There was no answer in time", NO_SERVICE: "There was no such service"}
        return f"{said.get(answer, f'The answer was {answer}')}; one with {holds} is asked for."

    def _explain_profiles(self, ends: Iterable[str]) -> str:
        """Says what the first of the asked ends is instead; see ``ProfilesParams``."""
        lines = self.connections.profiles
        for end in ends:
            place = " ".join(end.split()[:3])
            if any(f"{line} ".startswith(f"{end} ") for line in lines):
                continue
            found = [line for line in lines if line.startswith(f"{place} ")]
            return f"Asked: {end}. There: {found[0]}." if found else f"Nothing {place}."
        return ""

    def _topic_mistakes(self, topics: Iterable[str]) -> Iterator[str]:
        """Yields what is wrong with topics that are not published as asked; see ``TopicsParams``."""
        for topic in topics:
            name, kind, node, *_ = [*topic.split(), "", ""]
            traffic = self.traffic.get(name)
            if traffic is None:
                yield f"Nothing came on {name}."
            elif kind not in ("", traffic.kind):
                yield f"{name} carries {traffic.kind}, not {kind}."
            elif node and traffic.nodes != (node,):
                yield f"{name} is published by {join_names(traffic.nodes)}, not by {node}."

    def picture(self, check: str = "") -> str:
        """Draws the robot's path and its last pose in plain characters; the same for every check."""
        return self._picture

    def replay_title(self) -> str:
        return f"The worst episode, {self.label} ({self.outcome})"

    def save_replay(self, file: Path) -> bool:
        """Saves the recording; returns whether its world is none of the kit's. Raises OSError."""
        save_recording(self.recording, file)
        return self.recording.place not in map_names()

    @cached_property
    def _picture(self) -> str:
        if not len(self.track):
            return ""
        case = self.scenario.case
        scene = Scene(
            walls=self.walls,
            bodies=(self.body(Pose(*self.track[-1].tolist())),),
            targets=(Disc(*case.target, case.target_radius),) if case else (),
            trails=(self.track[::CLEARANCE_INTERVAL, :2].copy(),),
        )
        return "\n".join(row.rstrip() for row in scene_rows(scene, COLUMNS, ROWS))


def _range_text(low: float, high: float) -> str:
    """Writes a range of speeds; a narrow one as its middle."""
    return f"{(low + high) / 2:.2g}" if high - low <= NARROW else f"{low:.2g} to {high:.2g}"
