"""What it costs that student code runs in a process of its own: ``python tests/benchmarks/host.py``.

The same controller, with the same scan of 91 rays in and the same command out at each step, once as a process
and once in our own process. Then how long a start takes on each level of confinement, and how fast a student's
reward function is called in batches.
"""

from __future__ import annotations

import math
import sys
import time
from array import array
from collections.abc import Callable
from functools import partial
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

from kit.ros.execution.context import context_of
from kit.ros.node.node import create_graph_node

sys.path.insert(0, str(Path(__file__).parents[2]))

from kit.controllers import find_controller
from kit.host.node_process import NodeProcess
from kit.host.sandbox.probe import probe_levels
from kit.host.sandbox.sandbox_config import Level
from kit.host.student_functions import StudentFunctions
from kit.msg.geometry_msgs import Twist
from kit.msg.sensor_msgs import LaserScan
from kit.ros import install_import_names
from kit.ros.execution.context import default_context
from kit.ros.graph.graph import Graph

STEPS = 5000
TICK_NS = 10_000_000
BATCH = 4096
REWARD = "def reward(distance, heading, collision):\n    return -distance - 0.1 * abs(heading) - 10.0 * collision\n"


def steps_per_second(controller: Path, *, level: Level | None) -> float:
    """With a process on this level, or, for None, with the same node in this process."""
    graph = Graph(log_sink=lambda record: None)
    commands: list[Twist] = []
    world = create_graph_node(graph, "world")
    world.create_subscription(Twist, "cmd_vel", commands.append, 10)
    scans = world.create_publisher(LaserScan, "static_laser", 10)
    scan = LaserScan(ranges=array("f", [math.nan if i % 9 == 0 else 0.5 + i / 91 for i in range(91)]))
    process = None if level is None else NodeProcess.start(graph, controller, level=level)
    if process is None:
        in_this_process(graph, controller)
    exchange: Callable[[], bool] = process.exchange if process is not None else lambda: False
    for step in range(STEPS + 500):
        if step == 500:
            began = time.perf_counter()
        graph.advance((step + 1) * TICK_NS)
        scans.publish(scan)
        while True:
            graph.run_due()
            if not exchange():
                break
    rate = STEPS / (time.perf_counter() - began)
    assert len(commands) == STEPS + 500
    if process is not None:
        process.close()
    return rate


def in_this_process(graph: Graph, controller: Path) -> Any:
    """The file's node, in lock-step with the graph. Trusted files only, as here."""
    install_import_names()
    spec = spec_from_file_location("controller", controller)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    with default_context(context_of(graph)):
        return module.Avoid()


def start_ms(make: Callable[[], Any]) -> float:
    """Median of several."""
    times = []
    for _ in range(9):
        began = time.perf_counter()
        made = make()
        times.append((time.perf_counter() - began) * 1000)
        made.close()
    return median(times)


def main() -> None:
    controller = find_controller("avoid").file
    own = steps_per_second(controller, level=None)
    print(f"steps per second, in this process            {own:10.0f}")
    levels = [support.level for support in probe_levels() if support.is_available]
    for level in levels:
        rate = steps_per_second(controller, level=level)
        cost = 1e6 / rate - 1e6 / own
        print(
            f"steps per second, process on level {level:d}           {rate:10.0f}   {own / rate:.1f} times slower, {cost:.0f} us more a step"
        )
    for level in levels:
        milliseconds = start_ms(partial(NodeProcess.start, Graph(), controller, level=level))
        print(f"start of a node on level {level:d} [ms]              {milliseconds:10.1f}")
    with TemporaryDirectory() as folder:
        file = Path(folder, "reward.py")
        file.write_text(REWARD)
        for level in levels:
            milliseconds = start_ms(partial(StudentFunctions, file, level=level))
            print(f"start of a reward on level {level:d} [ms]            {milliseconds:10.1f}")
        records = [
            {"distance": i / 7, "heading": math.sin(i), "collision": i % 50 == 0} for i in range(BATCH)
        ]
        with StudentFunctions(file) as functions:
            began, calls = time.perf_counter(), 0
            while time.perf_counter() - began < 2:
                functions.call_batch("reward", records)
                calls += 1
            rate = calls * BATCH / (time.perf_counter() - began)
        print(f"rewards per second, {BATCH} a call           {rate:10.0f}")


if __name__ == "__main__":
    main()
