"""Two wheelchairs by classical means: the potential fields of Tables 4.6 and 5.3, and what beats them."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from kit.controllers import ControllerFile
from kit.fields import adjacency
from kit.fields.controller_setup import ControllerSetup, mean_position
from kit.geometry import Pose
from kit.render.clearance import nearest_wall
from kit.render.scene import SceneBody
from kit.run.episode import run_until, when, when_failed
from kit.run.lockstep import Observer
from kit.run.metrics import MetricsRecorder
from kit.run.scenario import Scenario, find_scenario
from kit.run.session import Session
from kit.sim.simulation import Simulation
from kit.study.printed_tables import ADJACENCY_BY_POSES, POTENTIAL_FIELDS, SUCCESS, printed_table

SAMPLE_TICKS: Final = 10
"""Ticks between two samples of the robots: ten samples a second, as often as their lidars scan."""
SAMPLE_S: Final = 0.1
"""The same in seconds."""
TIME_LIMIT_S: Final = 180.0
STUCK_S: Final = 20.0
STUCK_DISTANCE_M: Final = 0.05
"""Robots whose middle is no farther [m] from where it was so long [s] ago are stuck."""
START_SHIFT: Final = (0.02, 0.02, 0.05)
"""Starts differ by up to so much [m, m, rad] from one run to the next; those of the first run are exact."""


@dataclass(frozen=True, slots=True)
class PairRunResult:
    """One run."""

    end: str
    """How it ended: ``reached`` (every robot's hull within the target's radius), ``collided``, ``stuck``, ``late``, ``failed``."""
    why: str
    time_s: float
    by_geometry: float
    """Share of the time the robots were side by side: equations 4.2 to 4.6, repaired."""
    by_rays: float
    """The same as four rays tell: equations 4.7 to 4.9."""
    adjacency_score: float
    """Mean adjacency score, 0 to 1."""
    path_m: float
    """The mean of the robots'."""
    nearest_wall_m: float
    """The smallest distance between a hull and a wall."""
    jerk: float
    """Root mean square of the robots' forward jerk [m/s^3], from speeds ten times a second."""
    poses: tuple[tuple[Pose, ...], ...] = ()
    """Where the robots were, every ``SAMPLE_S``."""


@dataclass(frozen=True, slots=True)
class PairSummary:
    """Several runs of one case with one controller: means, but for what says otherwise."""

    case: str
    controller: str
    runs: int
    accuracy: float
    by_geometry: float
    by_rays: float
    adjacency_score: float
    path_m: float
    time_s: float
    nearest_wall_m: float
    """The smallest of all."""
    jerk: float
    failures: tuple[tuple[int, str], ...]
    """For each way to fail: how many runs failed so, and how the first of them did."""
    broken: int = 0
    """Runs whose program failed, perhaps on a machine too slow for it: they say nothing of the method."""

    @classmethod
    def of(cls, case: str, controller: str, outcomes: list[PairRunResult]) -> PairSummary:
        def mean(name: str) -> float:
            return float(np.mean([getattr(outcome, name) for outcome in outcomes]))

        failed: dict[str, list[PairRunResult]] = {}
        for each in outcomes:
            if each.end != "reached":
                failed.setdefault(each.end, []).append(each)
        return cls(
            case,
            controller,
            len(outcomes),
            accuracy=sum(each.end == "reached" for each in outcomes) / len(outcomes),
            by_geometry=mean("by_geometry"),
            by_rays=mean("by_rays"),
            adjacency_score=mean("adjacency_score"),
            path_m=mean("path_m"),
            time_s=mean("time_s"),
            nearest_wall_m=min(each.nearest_wall_m for each in outcomes),
            jerk=mean("jerk"),
            failures=tuple((len(some), f"{end}: {some[0].why}") for end, some in failed.items()),
            broken=len(failed.get("failed", ())),
        )


def run_repeatedly(
    scenario: Scenario,
    controller: ControllerFile,
    *,
    runs: int,
    seed: int = 0,
    on_run: Callable[[int, PairRunResult], None] = lambda number, outcome: None,
) -> PairSummary:
    """``runs`` runs, each with another start nearby and other noise. Raises what ``run_once`` raises."""
    outcomes = []
    for number in range(runs):
        outcomes.append(run_once(shift_start_poses(scenario, seed, number), controller, seed=seed + number))
        on_run(number, outcomes[-1])
    name = scenario.case.name if scenario.case is not None else scenario.name
    return PairSummary.of(name, controller.name, outcomes)


def shift_start_poses(scenario: Scenario, seed: int, number: int) -> Scenario:
    """The scenario with its robots a little beside where they start; exactly there in run 0."""
    generator = np.random.default_rng((seed, number))
    shift = {name: generator.uniform(-1, 1, 3) * START_SHIFT * (number > 0) for name in scenario.partners}
    models = tuple(
        replace(model, pose=Pose(*(np.array(model.pose) + shift[model.name]).tolist()))
        if model.name in shift
        else model
        for model in scenario.world.models
    )
    return replace(scenario, world=replace(scenario.world, models=models))


def run_once(scenario: Scenario, controller: ControllerFile, *, seed: int = 0) -> PairRunResult:
    """One run to its end. Raises LookupError for a scenario without a target, WorldError for a wrong layout."""
    if scenario.case is None:
        raise LookupError(f"{scenario.name} has no target to drive to: it needs a map of the catalogue.")
    case = scenario.case
    setup = ControllerSetup.load(
        scenario.world.file, scenario.partners, case.target, case.target_radius, charges=scenario.charges
    )
    with Session(scenario, seed=seed, always_scan=True) as session:
        log = _PairObserver(scenario)
        session.runner.observers.append(log)
        session.drive_with(controller)
        session.wait_until_driven()
        run_until(session.runner, ends=(when(lambda: log.end is not None), when_failed(session)))
        session.poll()
        return log.outcome(log.end or "failed", _failure_reason(log, session, setup))


def _failure_reason(log: _PairObserver, session: Session, setup: ControllerSetup) -> str:
    """Why a run did not reach the target; empty if it did."""
    if log.end is None:
        return str(session.failure)
    if log.end == "stuck":
        refusals = [record.text for record in session.messages if record.text.startswith("Not driving")]
        return " ".join(refusals) or _describe_stuck(setup, log.middle)
    return {
        "collided": log.touched,
        "late": f"still on the way after {TIME_LIMIT_S:.0f} s",
        "reached": "",
    }[log.end]


def _describe_stuck(setup: ControllerSetup, middle: tuple[float, float]) -> str:
    traps = setup.flow.traps()
    near = min(traps, key=lambda trap: math.dist(trap[:2], middle), default=None)
    stuck = f"no progress at ({middle[0]:.2f}, {middle[1]:.2f})"
    if near is None or math.dist(near[:2], middle) > 0.3:
        return stuck
    return (
        f"{stuck}, in the field's trap at ({near.x:.2f}, {near.y:.2f}), where walls push as strongly as the target "
        f"pulls; {near.share:.0%} of the floor leads there"
    )


class _PairObserver(Observer):
    """Watches a run, as one of the runner's observers, until it is over."""

    def __init__(self, scenario: Scenario) -> None:
        assert scenario.case is not None
        self._metrics = MetricsRecorder.for_scenario(scenario)
        self._names = scenario.partners
        self._walls = scenario.world.wall_segments
        self._poses: list[list[Pose]] = []
        self._sides: list[tuple[bool, bool, float]] = []
        self._nearest = math.inf
        self._recent: deque[tuple[float, float]] = deque(maxlen=round(STUCK_S * 10))
        self.end: str | None = None
        self.touched = ""

    @property
    def middle(self) -> tuple[float, float]:
        """Mean position of the robots [m] at the last sample."""
        return self._recent[-1]

    def on_step(self, simulation: Simulation) -> None:
        if self.end is not None:
            return
        self._metrics.on_step(simulation)
        if self._metrics.total_bumps:
            self.end, self.touched = "collided", self._contact(simulation)
        if simulation.tick % SAMPLE_TICKS:
            return
        poses = [simulation.pose(name) for name in self._names]
        self._poses.append(poses)
        self._recent.append(mean_position(poses))
        if len(poses) == 2:
            self._sides.append(self._adjacency(simulation, *poses))
        self._nearest = min(self._nearest, self._wall_distance(simulation))
        if self._metrics.all_reached_s is not None:
            self.end = self.end or "reached"
        elif (
            len(self._recent) == self._recent.maxlen
            and math.dist(self._recent[0], self.middle) < STUCK_DISTANCE_M
        ):
            self.end = self.end or "stuck"
        elif simulation.time_ns / 1e9 >= TIME_LIMIT_S:
            self.end = self.end or "late"

    def outcome(self, end: str, why: str) -> PairRunResult:
        poses = np.array(self._poses, dtype=float).reshape(-1, len(self._names), 3)
        steps = np.diff(poses[..., :2], axis=0)
        ahead = np.stack((np.cos(poses[:-1, :, 2]), np.sin(poses[:-1, :, 2])), axis=-1)
        speeds = (steps * ahead).sum(axis=-1) * 10
        jerk = np.diff(np.concatenate((np.zeros((1, len(self._names))), speeds)), 2, axis=0) * 100
        sides = np.array(self._sides, dtype=float).reshape(-1, 3)
        shares = sides.mean(axis=0) if len(sides) else np.full(3, math.nan)
        return PairRunResult(
            end,
            why,
            len(poses) / 10,
            by_geometry=float(shares[0]),
            by_rays=float(shares[1]),
            adjacency_score=float(shares[2]),
            path_m=float(np.hypot(steps[..., 0], steps[..., 1]).sum() / len(self._names)),
            nearest_wall_m=self._nearest,
            jerk=float(np.sqrt((jerk**2).mean())) if len(jerk) else 0.0,
            poses=tuple(map(tuple, self._poses)),
        )

    def _adjacency(self, simulation: Simulation, left: Pose, right: Pose) -> tuple[bool, bool, float]:
        views = {view.model: view.ranges for view in simulation.latest_scans()}
        rays = [
            views[name][list(which)]
            for name, which in zip(self._names, adjacency.SIDE_RAYS, strict=True)
            if name in views and len(views[name]) == 91
        ]
        by_rays = len(rays) == 2 and bool(adjacency.is_adjacent_by_rays(*rays))
        return (
            bool(adjacency.is_adjacent_by_poses(left, right)),
            by_rays,
            float(adjacency.adjacency_score(left, right)),
        )

    def _wall_distance(self, simulation: Simulation) -> float:
        hulls: dict[str, list[Any]] = {name: [] for name in self._names}
        for outline in simulation.outlines():
            if outline.model in hulls and not outline.radius:
                hulls[outline.model].append(np.array(outline.points))
        return min(
            nearest_wall(SceneBody(name, simulation.pose(name), tuple(hulls[name])), self._walls)[0]
            for name in hulls
        )

    def _contact(self, simulation: Simulation) -> str:
        for contact in simulation.state().contacts:
            for one, other in ((contact.entity_a, contact.entity_b), (contact.entity_b, contact.entity_a)):
                if one in self._names and contact.points:
                    x, y = contact.points[0]
                    what = f"the {other} one" if other in self._names else "a wall"
                    return f"the {one} one touched {what} at ({x:.2f}, {y:.2f})"
        return "something was touched"


@dataclass(frozen=True, slots=True)
class PrintedPairResult:
    """The dissertation's result for a case; None where it gives none."""

    title: str
    map: str
    case: str
    accuracy: float | None
    adjacency: float | None


def printed_pair_results(table: str) -> tuple[PrintedPairResult, ...]:
    """What the potential fields of Table ``4.6`` or ``5.3`` reached, case by case."""
    printed = printed_table(table)
    accuracy, adjacency = (
        printed.column_of(POTENTIAL_FIELDS, measure) for measure in (SUCCESS, ADJACENCY_BY_POSES)
    )
    assert accuracy is not None
    assert adjacency is not None
    successes, shares = printed.case_cells(accuracy), printed.case_cells(adjacency)
    return tuple(
        PrintedPairResult(title, place, case, successes.get(case), shares.get(case))
        for title, (place, case) in zip(printed.rows, printed.cases, strict=True)
    )


TABLE_46: Final = printed_pair_results("4.6")
"""The columns APF of Table 4.6."""

TABLE_53: Final = printed_pair_results("5.3")


def run_tables(
    runs: int, seed: int, controllers: tuple[ControllerFile, ...]
) -> Iterator[tuple[PrintedPairResult, tuple[PairSummary, ...]]]:
    """Both tables, row by row, as they are done."""
    for printed in (*TABLE_46, *TABLE_53):
        scenario = find_scenario(printed.map, printed.case)
        yield printed, tuple(run_repeatedly(scenario, each, runs=runs, seed=seed) for each in controllers)
