"""What a face sees of a session at one instant: a scene to draw and the figures beside it. Safe to hand over."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kit.geometry import Pose
from kit.host.failure import Failure
from kit.render.scene import Body, Disc, FloatArray, Scene
from kit.render.trail import Trail
from kit.ros.log import LogRecord
from kit.run.metrics import DriveMetrics
from kit.sim.state import SimulationState

if TYPE_CHECKING:
    from kit.run.session import Session
    from kit.sim.state import FootprintOutline, LatestScan

SIDES = (("front", 0.0), ("left", math.pi / 2), ("right", -math.pi / 2), ("back", math.pi))
"""Of a robot: name and direction [rad] of the middle of each quarter."""


def clock(seconds: float, digits: int = 1) -> str:
    """Minutes and seconds: ``1:02.3``. Cut, not rounded: a clock does not show what is not over."""
    minutes, rest = divmod(math.floor(seconds * 10**digits + 1e-6), 60 * 10**digits)
    return f"{minutes}:{rest / 10**digits:0{3 + digits}.{digits}f}"


def said(record: LogRecord) -> str:
    """One message, as a line: ``0:01.2 driver: Hello``."""
    return f"{clock(record.time_ns / 1e9)} {record.name}: {record.text}"


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """One instant of a session."""

    place: str
    """What its map or case is called."""
    scene: Scene
    tick: int
    time_s: float
    pose: Pose | None
    """The robot's."""
    speed: tuple[float, float]
    """Forward [m/s] and turning [rad/s]."""
    nearest: tuple[tuple[str, float | None], ...]
    """For each side of the robot what its laser saw nearest [m]; None: nothing in range. Empty: no laser."""
    metrics: DriveMetrics
    paused: bool
    controller: str | None
    failure: Failure | None
    messages: tuple[LogRecord, ...]
    """The last few, oldest first."""


@dataclass(frozen=True, slots=True)
class _Standing:
    """The world as it stands, taken once for a view."""

    state: SimulationState
    outlines: tuple[FootprintOutline, ...]
    scans: tuple[LatestScan, ...]


NO_BEAMS = np.empty((0, 4))


class Showing:
    """Makes views of one session, and remembers where its robot has been."""

    def __init__(self, session: Session, *, messages: int = 8) -> None:
        self._session = session
        self._messages = messages
        self._walls: FloatArray = np.concatenate(
            [np.empty((0, 4)), *(layer.walls.segments for layer in session.place.world.layers if layer.walls)]
        )
        self._trail = Trail()
        self._tick = 0
        self.beams = False
        """Whether to show the laser's rays, not only where they end."""

    def view(self) -> View:
        session = self._session
        simulation, robot = session.runner.simulation, session.place.robot
        if simulation.tick < self._tick:  # it was reset
            self._trail.clear()
        self._tick = simulation.tick
        standing = _Standing(
            simulation.state(),
            simulation.outlines(),
            tuple(scan for scan in simulation.latest_scans() if scan.model == robot),
        )
        driven = next((body for body in standing.state.bodies if body.model == robot), None)
        if driven is not None:
            self._trail.add(driven.pose.x, driven.pose.y)
        place = session.place
        return View(
            place=place.case.name if place.case is not None else place.title,
            scene=self._scene(standing),
            tick=simulation.tick,
            time_s=simulation.time_ns / 1e9,
            pose=driven.pose if driven else None,
            speed=_forward_and_turn(driven.pose, driven.velocity) if driven else (0.0, 0.0),
            nearest=_nearest(standing.scans[0]) if standing.scans else (),
            metrics=session.metrics.metrics,
            paused=session.runner.paused,
            controller=session.controller.name if session.controller else None,
            failure=session.failure,
            messages=tuple(session.messages)[-self._messages :],
        )

    def _scene(self, view: _Standing) -> Scene:
        case = self._session.place.case
        return Scene(
            walls=self._walls,
            bodies=_bodies(view, self._session.place.drivers),
            hits=np.concatenate([np.empty((0, 2)), *(scan.hits for scan in view.scans)]),
            beams=np.concatenate([np.empty((0, 4)), *(_beams(scan) for scan in view.scans)])
            if self.beams
            else NO_BEAMS,
            targets=(Disc(*case.target, case.target_radius),) if case else (),
            trails=(self._trail.points,),
            contacts=np.array([point for contact in view.state.contacts for point in contact.points]).reshape(
                -1, 2
            ),
        )


def _bodies(view: _Standing, drivers: tuple[str, ...]) -> tuple[Body, ...]:
    """One picture body per model: its footprints, and the pose of its first body."""
    shapes: dict[str, list[FootprintOutline]] = {}
    for outline in view.outlines:
        shapes.setdefault(outline.model, []).append(outline)
    order = (*drivers, *(model for model in shapes if model not in drivers))
    return tuple(
        Body(
            model,
            view.state.pose(model),
            tuple(np.array(outline.points) for outline in shapes[model] if not outline.radius),
            tuple(Disc(*outline.points[0], outline.radius) for outline in shapes[model] if outline.radius),
            robot=model in drivers,
        )
        for model in order
        if model in shapes
    )


def _beams(scan: LatestScan) -> FloatArray:
    hits = scan.hits
    return np.column_stack([np.full_like(hits, scan.pose[:2]), hits])


def _forward_and_turn(pose: Pose, velocity: tuple[float, float, float]) -> tuple[float, float]:
    vx, vy, turn = velocity
    return math.cos(pose.theta) * vx + math.sin(pose.theta) * vy, turn


def _nearest(scan: LatestScan) -> tuple[tuple[str, float | None], ...]:
    angles = np.arctan2(scan.beams.sin, scan.beams.cos)
    found = []
    for side, middle in SIDES:
        quarter = scan.ranges[np.abs(np.angle(np.exp(1j * (angles - middle)))) <= math.pi / 4]
        seen = quarter[~np.isnan(quarter)]
        found.append((side, max(0.0, float(seen.min())) if len(seen) else None))  # noise goes below 0
    return tuple(found)
