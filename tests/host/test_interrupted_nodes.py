"""A program that is asked to end does what it does at Ctrl-C."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from kit.host.node_process import INTERRUPT_S, NodeProcess
from kit.msg.std_msgs import String
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.run.lockstep import exchange_until_idle
from tests.host.conftest import QUICK, Student

TICK_NS = 10_000_000

PROGRAM = """
import atexit, threading, time
import rclpy
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("recorder")
says = node.create_publisher(String, "said", 10)
count = 0

def say(text):
    says.publish(String(data=text))

def tick():
    global count
    count += 1

def spin():
    {spin}

node.create_timer(0.1, tick)
try:
    spin()
except (KeyboardInterrupt, ExternalShutdownException):
    {caught}
finally:
    {cleanup}
"""
SPINS = {
    "spin": "rclpy.spin(node)",
    "spin once": "while rclpy.ok(): rclpy.spin_once(node, timeout_sec=0.05)",
    "threads": "executor = MultiThreadedExecutor(); executor.add_node(node); executor.spin()",
    "beside another thread": "threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start(); time.sleep(1000)",
    "polling": "while True: rclpy.spin_once(node, timeout_sec=0)",
    "join": "thread = threading.Thread(target=rclpy.spin, args=(node,), daemon=True); thread.start(); thread.join()",
    "computing": "t0 = time.time()\n    while time.time() - t0 < 1000: rclpy.spin_once(node, timeout_sec=0)",
}


class Run:
    """A program in a graph, for some ticks."""

    def __init__(self, file: Path, seconds: float = 0.5) -> None:
        self.heard: list[str] = []
        self.graph = Graph(log_sink=lambda record: None)
        listener = create_graph_node(self.graph, "listener")
        listener.create_subscription(String, "said", lambda message: self.heard.append(message.data), 100)
        self.process = NodeProcess.start(self.graph, file, limits=QUICK)
        while self.graph.now_ns < seconds * 1e9:
            exchange_until_idle(self.graph, [self.process])
            self.graph.advance(self.graph.now_ns + TICK_NS)

    def interrupt(self) -> list[str]:
        """Asks the program to end; returns what it prints then."""
        self.process.take_output()
        self.process.interrupt()
        self.graph.run_due()
        return [line.text for line in self.process.take_output().lines]


@pytest.fixture
def runs() -> Iterator[list[Run]]:
    made: list[Run] = []
    yield made
    for run in made:
        run.process.close()


def started(
    student: Student, runs: list[Run], *, spin: str = "spin", caught: str = "pass", cleanup: str = "pass"
) -> Run:
    runs.append(Run(student(PROGRAM.format(spin=SPINS[spin], caught=caught, cleanup=cleanup))))
    return runs[-1]


@pytest.mark.sampled(3)
@pytest.mark.parametrize("spin", SPINS)
def test_what_it_does_at_its_end_is_done(student: Student, runs: list[Run], spin: str) -> None:
    cleanup = "open('saved.txt', 'w').write(str(count)); say('saved'); print('saved', count > 2)"
    run = started(student, runs, spin=spin, cleanup=cleanup)
    assert run.interrupt() == ["saved True"]
    assert run.heard == ["saved"]
    assert run.process.has_ended
    assert run.process.failure is None


def test_it_may_wait_at_its_end(student: Student, runs: list[Run]) -> None:
    cleanup = "say('slower'); time.sleep(0.5); say('stopped'); atexit.register(print, 'registered')"
    run = started(student, runs, cleanup=cleanup)
    assert run.interrupt() == ["registered"]
    assert run.heard == ["slower", "stopped"]
    assert run.process.has_ended


def test_who_catches_nothing_has_not_failed(student: Student, runs: list[Run]) -> None:
    run = started(student, runs, caught="raise")
    assert run.interrupt() == []
    assert run.process.has_ended
    assert run.process.failure is None


def test_a_mistake_in_what_it_does_then_is_told(student: Student, runs: list[Run]) -> None:
    run = started(student, runs, cleanup="nobody.close()")
    run.interrupt()
    assert run.process.failure is not None
    assert "nobody" in str(run.process.failure)


@pytest.mark.long
@pytest.mark.parametrize("caught", ["spin()", "time.sleep(1000)", "while True: pass"])
def test_who_goes_on_is_ended(student: Student, runs: list[Run], caught: str) -> None:
    run = started(student, runs, caught=caught)
    run.interrupt()
    assert run.process.failure is None
    assert run.graph.now_ns < (0.5 + INTERRUPT_S) * 1e9
    run.process.close()


def test_a_program_whose_thread_outlives_its_main_one_ends_without_a_failure(
    student: Student, runs: list[Run]
) -> None:
    file = student(
        """
        import atexit, threading, time
        import rclpy

        def work():
            while True:
                time.sleep(0.5)

        def main():
            rclpy.init()
            rclpy.create_node("brief")
            atexit.register(print, "the end")
            threading.Thread(target=work).start()
        """
    )
    runs.append(Run(file))
    assert runs[-1].interrupt() == ["the end"]
    assert runs[-1].process.failure is None
