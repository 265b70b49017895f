"""What the conversation costs: ``python tests/benchmarks/conversation.py``.

Scans of 91 rays to ten subscriptions, in lock-step and to a thread that spins; then the maze world with a node
that drives by its scans, through the graph and by plain function calls: the difference is the graph's share of a
tick. Then what starting costs. Every figure is the best or the median of several runs.
"""

from __future__ import annotations

import subprocess
import sys
import threading
import time
from array import array
from collections.abc import Callable
from statistics import median

from kit.msg.geometry_msgs import Twist, Vector3
from kit.msg.sensor_msgs import LaserScan
from kit.ros.execution.context import context_of
from kit.ros.execution.executors import SingleThreadedExecutor
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.run.runner import Runner
from kit.run.scenario import scenario_on_map
from kit.sim.simulation import Simulation
from kit.world.catalogue import find_map

RAYS, READERS, SCANS = 91, 10, 2000
TICKS, REPEATS = 2000, 9


def per_second(work: Callable[[], object], count: int) -> float:
    """How often per second ``work``, which does ``count`` of them at once; the best of several runs."""
    best = 0.0
    for _ in range(REPEATS):
        began = time.perf_counter()
        work()
        best = max(best, count / (time.perf_counter() - began))
    return best


def lock_step() -> float:
    """Scans published and received by all readers, per second."""
    graph = Graph()
    node = create_graph_node(graph, "node")
    received: list[int] = []
    for _ in range(READERS):
        node.create_subscription(LaserScan, "scan", lambda scan: received.append(1), 10)
    publisher = node.create_publisher(LaserScan, "scan", 10)
    ranges = array("f", [1.5]) * RAYS

    def work() -> None:
        received.clear()
        for _ in range(SCANS):
            publisher.publish(LaserScan(ranges=ranges))
            graph.run_due()
        assert len(received) == SCANS * READERS

    return per_second(work, SCANS)


def free_running() -> float:
    """The same to another thread, which spins."""
    graph = Graph(None)
    talker, listener = create_graph_node(graph, "talker"), create_graph_node(graph, "listener")
    received: list[int] = []
    for _ in range(READERS):
        listener.create_subscription(LaserScan, "scan", lambda scan: received.append(1), SCANS)
    publisher = talker.create_publisher(LaserScan, "scan", 10)
    ranges = array("f", [1.5]) * RAYS
    executor = SingleThreadedExecutor(context=context_of(graph))
    executor.add_node(listener)
    thread = threading.Thread(target=executor.spin)
    thread.start()

    def work() -> None:
        received.clear()
        for _ in range(SCANS):
            publisher.publish(LaserScan(ranges=ranges))
        while len(received) < SCANS * READERS:
            time.sleep(0.0005)

    rate = per_second(work, SCANS)
    executor.shutdown()
    thread.join()
    return rate


def command(scan: LaserScan) -> Twist:
    """Forward, or a turn where a wall is near."""
    if scan.ranges[RAYS // 2] < 0.4:
        return Twist(angular=Vector3(z=1.5))
    return Twist(linear=Vector3(x=0.5))


LISTENED = ("/static_laser", "/cmd_vel")


def bare_ticks() -> Callable[[], object]:
    """Ticks of the maze with the driver called directly."""
    simulation = Simulation(scenario_on_map(find_map("maze")).world, has_subscribers=LISTENED.__contains__)

    def work() -> None:
        for _ in range(TICKS):
            for sent in simulation.step():
                if sent.topic == "/static_laser":
                    simulation.accept("/cmd_vel", command(sent.message))

    return work


def graph_ticks() -> Callable[[], object]:
    """Ticks of the same world with the same driver, through nodes and topics."""
    graph = Graph()
    world = scenario_on_map(find_map("maze")).world
    runner = Runner(
        Simulation(world, has_subscribers=lambda topic: graph.subscription_count(topic) > 0), graph
    )
    node = create_graph_node(graph, "driver")
    drive = node.create_publisher(Twist, "/cmd_vel", 10)
    node.create_subscription(LaserScan, "/static_laser", lambda scan: drive.publish(command(scan)), 10)

    def work() -> None:
        for _ in range(TICKS):
            runner.tick()

    return work


def side_by_side(*works: Callable[[], object]) -> list[float]:
    """Microseconds per tick of each, in turns, so that a busy computer is busy for all; the best of several."""
    best = [float("inf")] * len(works)
    for _ in range(REPEATS):
        for i, work in enumerate(works):
            began = time.perf_counter()
            work()
            best[i] = min(best[i], (time.perf_counter() - began) / TICKS * 1e6)
    return best


def start_ms(code: str) -> float:
    """Milliseconds that a fresh process takes for the code, beyond what an empty one takes; median of several."""
    timed = f"import time; t = time.perf_counter(); {code}; print((time.perf_counter() - t) * 1000)"
    runs = [
        subprocess.run([sys.executable, "-c", timed], capture_output=True, text=True, check=True)
        for _ in range(9)
    ]
    return median(float(run.stdout) for run in runs)


def main() -> None:
    rate = lock_step()
    print(
        f"91-ray scans to {READERS} readers, lock-step [1/s]        {rate:10.0f}   {rate * READERS:.0f} deliveries/s"
    )
    rate = free_running()
    print(
        f"91-ray scans to {READERS} readers, spinning [1/s]         {rate:10.0f}   {rate * READERS:.0f} deliveries/s"
    )
    bare, whole = side_by_side(bare_ticks(), graph_ticks())
    share = (whole - bare) / whole
    print(f"maze tick, driver called directly [us]            {bare:10.1f}")
    print(f"maze tick, driver through the graph [us]          {whole:10.1f}   the graph's share: {share:.0%}")
    print(
        f"import kit.ros [ms]                               {start_ms('import kit.ros.execution.client_library'):10.1f}"
    )
    node = "from kit.ros.node.node import create_graph_node as c; from kit.ros.graph.graph import Graph; c(Graph(), 'n')"
    print(f"import and make a node [ms]                       {start_ms(node):10.1f}")


if __name__ == "__main__":
    main()
