"""What the simulated world costs: ``python tests/benchmarks/simulation.py``.

The dissertation's robot drives in a circle and scans with 91 rays at every step, in the maze and among 5,000
wall segments; the same is done in the plain way, with pymunk's own step and one segment query per ray, without
messages and devices. Then the map ``slalom`` through the graph, with a node that gets every scan and answers with a
command; where ir-sim is installed (it is no part of the kit), the same walls and as many rays are given to it. Then a
world as large as Flatland's limits allow: 16 layers, 50 robots with lasers and bumpers, and 5,000 segments. Every figure
is the best of ``REPEATS``; how many times as fast as ir-sim is the median of ``ROUNDS``, in which both are run in turn.
"""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pymunk
from learning_engine import best, irsim_step

from kit.geometry import Pose
from kit.kernels import kernels
from kit.learning.maps.batch_map import load_batch_map
from kit.msg.geometry_msgs import Twist, Vector3
from kit.msg.sensor_msgs import LaserScan
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.run.runner import Runner
from kit.sim.plugins.laser import LaserParams
from kit.sim.simulation import Simulation, load_model, load_world
from kit.world.catalogue import find_map
from kit.world.records import Layer, Model, Polygon, SourceLocation, Walls, World

ROOT = Path(__file__).parents[2]

REPEATS, ROUNDS = 15, 5
RAYS, REACH = 91, 10.0
STEP = 0.01
FORWARD, TURN = 0.2, 1.0
"""A circle of 0.2 m radius."""

HERE = Path(__file__)
SERP = ROOT / "maps" / "robots" / "serp.model.yaml"


def pillars(count: int, size: float = 16.0) -> np.ndarray:
    """(4 * count, 4): small square pillars in a square hall, none within half a metre of the middle."""
    rng = np.random.default_rng(0)
    centers = rng.uniform(-size / 2, size / 2, (4 * count, 2))
    centers = centers[np.abs(centers).max(axis=1) > 0.6][:count]
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * 0.04
    points = centers[:, None] + corners
    return np.concatenate([points, np.roll(points, -1, axis=1)], axis=2).reshape(-1, 4)


def walled(ends: np.ndarray, names: tuple[str, ...], bits: int) -> Layer:
    walls = Walls(local_segments=ends, origin=Pose(), file=HERE, drawing_file=HERE)
    return Layer(names, bits, (1, 1, 1, 1), walls, MappingProxyType({}), SourceLocation(HERE))


def hall(count: int) -> World:
    """One robot in the middle of a hall of pillars."""
    bits = {"solid": 1, "seen": 2}
    world = World(HERE, (walled(pillars(count), ("solid", "seen"), 3),), layer_bits=MappingProxyType(bits))
    return replace(world, models=(load_model(SERP, world, name="serp", namespace="", pose=Pose()),))


def scanning(world: World) -> World:
    """The same, but every laser scans at every step."""

    def always(model: Model) -> Model:
        plugins = (
            replace(spec, params=replace(spec.params, rate=math.inf))
            if isinstance(spec.params, LaserParams)
            else spec
            for spec in model.plugins
        )
        return replace(model, plugins=tuple(plugins))

    return replace(world, models=tuple(map(always, world.models)))


def per_second(advance: Callable[[int], object], steps: int) -> float:
    """Steps per second of the best of a few runs."""
    advance(20)
    best = math.inf
    for _ in range(REPEATS):
        start = time.perf_counter()
        advance(steps)
        best = min(best, time.perf_counter() - start)
    return steps / best


def ours(world: World) -> Callable[[int], object]:
    simulation = Simulation(world, has_subscribers=lambda topic: topic.endswith("laser"))
    simulation.accept("/cmd_vel", Twist(linear=Vector3(x=FORWARD), angular=Vector3(z=TURN)))
    return simulation.step


def through_graph(world: World) -> Callable[[int], object]:
    """A runner, and a node that answers every scan of the first robot with a command."""
    graph = Graph()
    simulation = Simulation(world, has_subscribers=graph.has_subscriptions)
    runner, node = Runner(simulation, graph), create_graph_node(graph, "driver")
    driven = world.models[0].name
    topics = {(end.direction, end.type): end.topic for end in simulation.model_endpoints(driven)}
    commands = node.create_publisher(Twist, topics["subscribe", Twist], 10)

    def answer(scan: LaserScan) -> None:
        commands.publish(Twist(linear=Vector3(x=FORWARD), angular=Vector3(z=TURN)))

    node.create_subscription(LaserScan, topics["publish", LaserScan], answer, 10)

    def advance(ticks: int) -> None:
        for _ in range(ticks):
            runner.tick()

    return advance


def plain(world: World) -> Callable[[int], object]:
    """pymunk alone: walls, the robot, and a segment query for every ray."""
    space = pymunk.Space()
    for layer in world.layers:
        for x1, y1, x2, y2 in layer.walls.segments.tolist() if layer.walls else ():
            space.add(pymunk.Segment(space.static_body, (x1, y1), (x2, y2), 0))
    model = next(model for model in world.models if model.name == "serp")
    body = pymunk.Body()
    for footprint in model.bodies[0].footprints:
        assert isinstance(footprint.shape, Polygon)
        shape = pymunk.Poly(body, footprint.shape.points)
        shape.density = 1
        shape.filter = pymunk.ShapeFilter(categories=2)
        space.add(*([] if body.space else [body]), shape)
    body.angle = model.pose.theta
    body.position = model.pose.x, model.pose.y
    others = pymunk.ShapeFilter(mask=pymunk.ShapeFilter.ALL_MASKS() ^ 2)
    angles = np.linspace(-math.pi, math.pi, RAYS)

    def drive(body: pymunk.Body, gravity: object, damping: float, dt: float) -> None:
        body.velocity = pymunk.Vec2d(FORWARD, 0).rotated(body.angle)
        body.angular_velocity = TURN

    body.velocity_func = drive

    def advance(steps: int) -> None:
        for _ in range(steps):
            x, y = body.position
            ranges = []
            for angle in (angles + body.angle).tolist():
                end = (x + REACH * math.cos(angle), y + REACH * math.sin(angle))
                hit = space.segment_query_first((x, y), end, 0, others)
                ranges.append(REACH * hit.alpha if hit else math.nan)
            space.step(STEP)

    return advance


def crowd() -> World:
    """16 layers with 5,000 segments between them, and 50 robots in them, each scanning ten times a second."""
    names = [f"layer{i}" for i in range(16)]
    bits = MappingProxyType({name: 1 << i for i, name in enumerate(names)} | {"solid": 1, "seen": 2})
    parts = np.array_split(pillars(1250), 16)
    layers = tuple(
        walled(ends, (name,), 1 << i) for i, (name, ends) in enumerate(zip(names, parts, strict=True))
    )
    world = World(HERE, layers, layer_bits=bits)
    places = [Pose(-4.0 + 0.9 * (i % 10), -2.0 + 0.9 * (i // 10), float(i)) for i in range(50)]
    return replace(
        world,
        models=tuple(
            load_model(SERP, world, name=f"robot{i}", namespace=f"robot{i}", pose=pose)
            for i, pose in enumerate(places)
        ),
    )


def real_time_factor(world: World) -> float:
    simulation = Simulation(world)
    for model in world.models:
        simulation.accept(f"/{model.name}/cmd_vel", Twist(linear=Vector3(x=0.5), angular=Vector3(z=0.3)))
    return per_second(simulation.step, 50) * STEP


def main() -> None:
    compile_kernels = kernels.compile_kernels  # imports numba, which is not what is timed
    start = time.perf_counter()
    compile_kernels()
    print(f"compiled code ready: {time.perf_counter() - start:.2f} s")
    maze = load_world(ROOT / "maps" / "maze" / "world.yaml", root=ROOT / "maps")
    for name, world, steps in (("maze", maze, 2000), ("5,000 segments", hall(1250), 1000)):
        fast, slow = per_second(ours(scanning(world)), steps), per_second(plain(world), steps // 20)
        print(
            f"{name}, 91 rays at every step: {fast:,.0f} steps/s; plain pymunk: {slow:,.0f}; {fast / slow:.1f} times"
        )
    slalom = load_world(ROOT / "maps" / "slalom" / "world.yaml", root=ROOT / "maps")
    advance, step = through_graph(scanning(slalom)), irsim_step(load_batch_map(find_map("slalom")).walls)
    rounds = [
        (per_second(advance, 1000), best(step, 1) if step else math.nan) for _ in range(ROUNDS if step else 1)
    ]
    ticks, peer = (max(rates) for rates in zip(*rounds, strict=True))
    times = statistics.median(ours / theirs for ours, theirs in rounds)
    ratio = f"ir-sim: {peer:,.0f}; {times:.1f} times" if step else "ir-sim is not installed"
    print(f"slalom through the graph, 91 rays in every tick: {ticks:,.0f} ticks/s; {ratio}")
    print(f"16 layers, 50 robots, 5,000 segments: {real_time_factor(crowd()):.1f} times real time")


if __name__ == "__main__":
    main()
