"""Views: one instant of a session as immutable records, a scene to draw and the figures beside it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kit.arrays import FloatArray
from kit.geometry import Pose
from kit.host.failure import Failure
from kit.msg.sensor_msgs import LaserScan
from kit.plain_text import format_clock
from kit.render.scene import Disc, Scene, Trail
from kit.ros.log import LogRecord
from kit.run.metrics import DriveMetrics
from kit.run.scene_bodies import scene_bodies
from kit.sim.state import BodyState, FootprintOutline, LatestScan, SimulationState

if TYPE_CHECKING:
    from kit.run.session import Session

ROBOT_SIDES = (("front", 0.0), ("left", math.pi / 2), ("right", -math.pi / 2), ("back", math.pi))
"""Name and direction [rad] of the middle of each quarter around a robot."""


def format_log(record: LogRecord) -> str:
    """Formats a log message as one line: ``0:01.2 driver: Hello``."""
    return f"{format_clock(record.time_ns / 1e9)} {record.name}: {record.text}"


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """One instant of a session; may be handed to another thread."""

    title: str
    """Name of the case, or of the map or world."""
    scene: Scene
    tick: int
    time_s: float
    pose: Pose | None
    """The robot's; None without one."""
    speed: tuple[float, float]
    """Forward [m/s] and turning [rad/s]."""
    nearest: tuple[tuple[str, float | None], ...]
    """For each side of the robot the smallest range [m] of its laser; None: nothing in range. Empty: no laser."""
    laser: FloatArray
    """(LASER_DIRECTIONS,): the smallest range [m] of its laser in each direction in the robot's frame, from -180 degrees
    counter-clockwise to 180; NaN: nothing in range, or no ray."""
    metrics: DriveMetrics
    paused: bool
    controller: str | None
    program: Path | None
    """The controller's file."""
    failure: Failure | None
    messages: tuple[LogRecord, ...]
    """The last few, oldest first."""


@dataclass(frozen=True, slots=True)
class _Snapshot:
    """The state of the world, read once for each view."""

    state: SimulationState
    outlines: tuple[FootprintOutline, ...]
    scans: tuple[LatestScan, ...]


LASER_DIRECTIONS = 120
NO_LASER: FloatArray = np.full(LASER_DIRECTIONS, np.nan)


class ViewBuilder:
    """Builds views of one session and keeps the trail of its robot."""

    def __init__(self, session: Session, *, messages: int = 8) -> None:
        self._session = session
        self._messages = messages
        self._walls = session.scenario.world.wall_segments
        ends = (
            ()
            if session.scenario.robot is None
            else session.runner.simulation.model_endpoints(session.scenario.robot)
        )
        has_laser = any(end.type is LaserScan for end in ends)
        self._unknown_sides = tuple((side, None) for side, _ in ROBOT_SIDES) if has_laser else ()
        """What is nearest before the first scan."""
        self._trail = Trail()
        self._tick = 0
        self.shows_beams = False
        """Whether views show the laser's rays, not only where they end."""

    def build(self) -> View:
        """The session as it is now; called in the thread that ticks."""
        session = self._session
        simulation, robot = session.runner.simulation, session.scenario.robot
        if simulation.tick < self._tick:  # it was reset
            self._trail.clear()
        self._tick = simulation.tick
        snapshot = _Snapshot(
            simulation.state(),
            simulation.outlines(),
            tuple(scan for scan in simulation.latest_scans() if scan.model == robot),
        )
        driven = next((body for body in snapshot.state.bodies if body.model == robot), None)
        if driven is not None:
            self._trail.add(driven.pose.x, driven.pose.y)
        scenario = session.scenario
        view = View(
            title=scenario.case.name if scenario.case is not None else scenario.title,
            scene=self._scene(snapshot),
            tick=simulation.tick,
            time_s=simulation.time_ns / 1e9,
            pose=driven.pose if driven else None,
            speed=_body_velocity(driven.pose, driven.velocity) if driven else (0.0, 0.0),
            nearest=_nearest_by_side(snapshot.scans[0]) if snapshot.scans else self._unknown_sides,
            laser=_nearest_by_direction(snapshot.scans[0], driven) if snapshot.scans and driven else NO_LASER,
            metrics=session.metrics.metrics,
            paused=session.runner.paused,
            controller=session.controller.name if session.controller else None,
            program=session.controller.file if session.controller else None,
            failure=session.failure,
            messages=tuple(session.messages)[-self._messages :],
        )
        return session.shown(view)

    def _scene(self, snapshot: _Snapshot) -> Scene:
        case, drivers = self._session.scenario.case, self._session.scenario.drivers
        models = dict.fromkeys((*drivers, *(outline.model for outline in snapshot.outlines)))  # drivers first
        poses = {model: snapshot.state.pose(model) for model in models}
        return Scene(
            walls=self._walls,
            bodies=(
                *scene_bodies(snapshot.outlines, poses, drivers),
                *(body for addition in self._session.additions for body in addition.bodies),
            ),
            strokes=tuple(stroke for addition in self._session.additions for stroke in addition.strokes),
            hits=np.concatenate([np.empty((0, 2)), *(scan.hits for scan in snapshot.scans)]),
            beams=np.concatenate([np.empty((0, 4)), *(_beam_segments(scan) for scan in snapshot.scans)]),
            shows_beams=self.shows_beams,
            targets=(Disc(*case.target, case.target_radius),) if case else (),
            trails=(self._trail.points,),
            contacts=np.array(
                [point for contact in snapshot.state.contacts for point in contact.points]
            ).reshape(-1, 2),
        )


def _beam_segments(scan: LatestScan) -> FloatArray:
    hits = scan.hits
    return np.column_stack([np.full_like(hits, scan.pose[:2]), hits])


def _body_velocity(pose: Pose, velocity: tuple[float, float, float]) -> tuple[float, float]:
    vx, vy, turn = velocity
    return math.cos(pose.theta) * vx + math.sin(pose.theta) * vy, turn


def _nearest_by_direction(scan: LatestScan, robot: BodyState) -> FloatArray:
    angles = np.arctan2(scan.beams.sin, scan.beams.cos) + (scan.pose.theta - robot.pose.theta)
    turns = np.mod(angles / (2 * math.pi) + 0.5, 1.0)
    bins = np.minimum((turns * LASER_DIRECTIONS).astype(int), LASER_DIRECTIONS - 1)
    nearest = np.full(LASER_DIRECTIONS, np.inf)
    np.minimum.at(nearest, bins, np.where(np.isnan(scan.ranges), np.inf, scan.ranges))
    result: FloatArray = np.where(np.isinf(nearest), np.nan, np.maximum(nearest, 0.0))  # noise goes below 0
    return result


def _nearest_by_side(scan: LatestScan) -> tuple[tuple[str, float | None], ...]:
    angles = np.arctan2(scan.beams.sin, scan.beams.cos)
    found = []
    for side, middle in ROBOT_SIDES:
        quarter = scan.ranges[np.abs(np.angle(np.exp(1j * (angles - middle)))) <= math.pi / 4]
        seen = quarter[~np.isnan(quarter)]
        found.append((side, max(0.0, float(seen.min())) if len(seen) else None))  # noise goes below 0
    return tuple(found)
