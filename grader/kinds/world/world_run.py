"""Runs a submitted world with a driver of the assignment's, and searches for a path between its walls. Runs in the world process."""

from __future__ import annotations

import math
from contextlib import ExitStack
from pathlib import Path
from typing import Final

import numpy as np

from grader.kinds.world.facts import RunFacts, TopicStatistics, WorldRunSpec
from grader.kinds.world.world_reading import draw_world
from kit.arrays import FloatArray
from kit.fields.occupancy_grid import ClearanceGrid, flood_fill, wall_distances
from kit.geometry import convex_hull
from kit.host.failure import StudentCodeError
from kit.host.node_process import NodeProcess
from kit.msg.message import Message
from kit.msg.nav_msgs import Odometry
from kit.msg.sensor_msgs import LaserScan
from kit.render.scene import Disc
from kit.ros.graph.directory import NodeLike
from kit.ros.graph.graph import Graph
from kit.run.episode import EndReason, controller_arguments, run_until, when_failed, when_reached
from kit.run.lockstep import Observer
from kit.run.metrics import MetricsRecorder
from kit.run.runner import Runner
from kit.run.scenario import Scenario
from kit.sim.simulation import Simulation
from kit.world.catalogue import MapCase
from kit.world.records import Circle, Model, World

CELL: Final = 0.02
"""m; larger in a large world."""
MAX_CELLS: Final = 1_000
"""Cells along one side of the grid."""
MARGIN_CELLS: Final = 4
"""Cells around the walls."""


def search_path(
    walls: FloatArray, start: tuple[float, float], target: tuple[float, float] | None, radius: float
) -> tuple[bool, bool]:
    """Returns (whether a disc of this radius [m] can move from start to target, whether walls enclose it).

    ``walls``: (n, 4) ``x1 y1 x2 y2`` [m]. Without a target the first is False.
    """
    points = np.concatenate([walls.reshape(-1, 2), [start], [] if target is None else [target]], axis=None)
    points = points.reshape(-1, 2)
    low, size = points.min(axis=0) - radius, np.ptp(points, axis=0) + 2 * radius
    cell = max(CELL, float(size.max()) / MAX_CELLS)
    columns, rows = (math.ceil(side / cell) + 2 * MARGIN_CELLS for side in size)
    x0, y0 = (low + (0.5 - MARGIN_CELLS) * cell).tolist()
    x, y = x0 + cell * np.arange(columns), y0 + cell * np.arange(rows)
    nearest = max(radius, cell)  # nothing slips through a wall between the middles of two cells
    grid = ClearanceGrid((x0, y0), cell, wall_distances(x, y, walls, nearest))
    reached = flood_fill(grid.clearance >= nearest, grid.cell_at(*start))
    is_open = reached[0].any() or reached[-1].any() or reached[:, 0].any() or reached[:, -1].any()
    return target is not None and bool(reached[grid.cell_at(*target)]), bool(reached.any() and not is_open)


STEP: Final = 0.01
"""s"""
SETTLE_S: Final = 0.5
"""Seconds that joints get to pull their bodies together."""
RECORD_INTERVAL: Final = 5
"""Ticks between two points of the trail, and two measurements of the joints."""


class TopicRecorder:
    """Counts the world's messages on each topic, and measures how much laser and odometry readings spread."""

    def __init__(self, graph: Graph, world_node: NodeLike) -> None:
        self._world_node = world_node
        self._counts: dict[str, int] = {}
        self._scans: dict[str, tuple[FloatArray, FloatArray]] = {}
        self.stop = graph.add_message_listener(self._on_message)

    def _on_message(self, time_ns: int, node: NodeLike, name: str, message: Message) -> None:
        if node is not self._world_node:
            return
        count = self._counts[name] = self._counts.get(name, 0) + 1
        if (read := _readings(message)) is not None:
            # Welford's running mean and sum of squares; nan, for nothing hit, stays nan.
            mean, squares = self._scans.get(name, (np.zeros_like(read), np.zeros_like(read)))
            ahead = mean + (read - mean) / count
            self._scans[name] = ahead, squares + (read - mean) * (read - ahead)

    def statistics(self) -> tuple[TopicStatistics, ...]:
        return tuple(
            TopicStatistics(topic, count, self._spread(topic, count)) for topic, count in self._counts.items()
        )

    def _spread(self, topic: str, count: int) -> float:
        if topic not in self._scans or count < 2:
            return 0.0
        variances = self._scans[topic][1] / (count - 1)
        variances = variances[np.isfinite(variances)]
        return float(math.sqrt(variances.mean())) if len(variances) else 0.0


def _readings(message: Message) -> FloatArray | None:
    """Returns the numbers of a message that noise affects: a scan's ranges, an odometry's position."""
    if isinstance(message, LaserScan):
        return np.array(message.ranges, dtype=np.float64)
    if isinstance(message, Odometry):
        at = message.pose.pose.position
        return np.array([at.x, at.y])
    return None


class PathObserver(Observer):
    """Records the robot's path, and the largest gap of any joint."""

    def __init__(self, model: Model | None, world: World) -> None:
        self._model = model
        self._world = world
        self.trail: list[tuple[float, float]] = []
        self.joint_gap, self.widest_joint = 0.0, ""

    def on_step(self, simulation: Simulation) -> None:
        if simulation.tick % RECORD_INTERVAL:
            return
        if self._model is not None:
            x, y, _ = simulation.pose(self._model.name)
            self.trail.append((x, y))
        if simulation.tick * STEP < SETTLE_S:
            return
        poses = {(body.model, body.body): body.pose for body in simulation.state().bodies}
        for model in self._world.models:
            for joint in model.joints:
                first, second = (
                    poses[model.name, end.body].transform_point(*end.point) for end in joint.anchors
                )
                if (gap := math.dist(first, second)) > self.joint_gap:
                    self.joint_gap, self.widest_joint = gap, joint.name


def run_world(world: World, spec: WorldRunSpec) -> RunFacts:
    """Runs the world for the time of ``spec``, or until the target is reached."""
    graph = Graph(log_sink=lambda record: None)
    simulation = Simulation(world, seed=spec.seed, step_size=STEP)
    runner = Runner(simulation, graph)
    driving = [m.name for m in world.models if any(p.type.endswith("Drive") for p in m.plugins)]
    model_name = spec.robot or next(iter(driving), "")
    model = next((each for each in world.models if each.name == model_name), None)
    case = None
    if spec.target is not None and model is not None:
        case = MapCase("", model.pose, spec.target, spec.radius, (0.0, 0.0), (0.0, 0.0), False, "", None)
    scenario = Scenario(str(world.file), "", world, None if model is None else model.name, case)
    metrics, path_recorder, topic_recorder = (
        MetricsRecorder.for_scenario(scenario),
        PathObserver(model, world),
        TopicRecorder(graph, runner.node),
    )
    runner.observers += [metrics, path_recorder]
    problem, ticks = _drive(runner, metrics, spec, scenario, model_name in driving), simulation.tick
    topic_recorder.stop()
    score, radius = metrics.metrics, 0.0 if model is None else model_width(model) / 2
    is_reachable = is_enclosed = False
    if model is not None:
        is_reachable, is_enclosed = search_path(world.wall_segments, model.pose[:2], spec.target, radius)
    disc = None if spec.target is None else Disc(*spec.target, spec.radius)
    return RunFacts(
        problem=problem,
        seconds=ticks * STEP,
        topics=topic_recorder.statistics(),
        reached_s=score.reached_s,
        start=() if model is None else (model.pose.x, model.pose.y),
        target_distance=score.target_m
        if score.target_m is not None and math.isfinite(score.target_m)
        else None,
        distance=score.distance_m,
        undriven=_undriven_way(world, spec, model, ticks) if spec.driver and model is not None else 0.0,
        bumps=score.bumps,
        joint_gap=path_recorder.joint_gap,
        widest_joint=path_recorder.widest_joint,
        is_reachable=is_reachable,
        is_enclosed=is_enclosed,
        picture=draw_world(
            world,
            simulation,
            target=disc,
            trail=np.array(path_recorder.trail, dtype=np.float64).reshape(-1, 2),
        ),
    )


def _undriven_way(world: World, spec: WorldRunSpec, model: Model, ticks: int) -> float:
    """Returns how far the robot moves in this many ticks without the driver [m]: what moves it then is no drive of its own."""
    simulation = Simulation(world, seed=spec.seed, step_size=STEP)
    runner = Runner(simulation, Graph(log_sink=lambda record: None))
    path = PathObserver(model, world)
    runner.observers.append(path)
    run_until(runner, ticks=ticks)
    return max((math.dist(path.trail[0], each) for each in path.trail), default=0.0)


def _drive(
    runner: Runner, metrics: MetricsRecorder, spec: WorldRunSpec, scenario: Scenario, drives: bool
) -> str:
    """Ticks until the time is over or the target reached. Returns why it could not, or nothing."""
    with ExitStack() as stack:
        node_process: NodeProcess | None = None
        if spec.driver:
            if scenario.driven is None or not drives:
                subject = f"The model {spec.robot}" if spec.robot else "No model of this world"
                return f"{subject} has {'no' if spec.robot else 'a'} drive for our driver to move."
            try:
                node_process = NodeProcess.start(
                    runner.graph, Path(spec.driver), args=controller_arguments(scenario), seed=spec.seed
                )
            except StudentCodeError as error:
                return f"Our driver does not start: {error}"
            runner.participants.append(stack.enter_context(node_process))
        ends = [when_failed(node_process)] if node_process is not None else []
        if spec.until_reached:
            ends.append(when_reached(metrics))
        end = run_until(runner, limit_s=spec.time_s, ends=ends)
        if node_process is not None and end is EndReason.FAILED:
            return f"Our driver stopped: {node_process.failure}"
    return ""


def model_width(model: Model) -> float:
    """Returns the smallest width [m] over all directions of the hull of the model's solid footprints."""
    points: list[tuple[float, float]] = []
    for body in model.bodies:
        for footprint in body.footprints:
            if footprint.sensor or not footprint.collision:
                continue
            shape = footprint.shape
            corners = shape.points if not isinstance(shape, Circle) else _circle_points(shape)
            points += [body.pose.transform_point(*corner) for corner in corners]
    hull = np.array(convex_hull(tuple(points))).reshape(-1, 2) if len(points) > 2 else np.empty((0, 2))
    if len(hull) < 3:
        return 0.0
    sides = np.roll(hull, -1, axis=0) - hull
    across = np.column_stack([-sides[:, 1], sides[:, 0]]) / np.maximum(np.hypot(*sides.T)[:, None], 1e-12)
    return float(min(np.ptp(hull @ direction) for direction in across))


def _circle_points(shape: Circle) -> list[tuple[float, float]]:
    (x, y), radius = shape.center, shape.radius
    turns = (math.tau * i / 16 for i in range(16))
    return [(x + radius * math.cos(turn), y + radius * math.sin(turn)) for turn in turns]
