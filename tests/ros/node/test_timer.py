"""Timers and rates, in simulated time and in real time."""

from __future__ import annotations

import threading
import time
from typing import Any

import pytest

from kit.ros.exceptions import InvalidHandle, ROSInterruptException, WouldDeadlock
from kit.ros.execution.context import context_of
from kit.ros.execution.executors import SingleThreadedExecutor
from kit.ros.graph.graph import Graph
from kit.ros.log import LogRecord
from kit.ros.node.node import Node, create_graph_node
from kit.ros.node.timer import TIMER_WITHOUT_CALLBACK, PeriodicSchedule

MS = 1_000_000
SECOND = 1000 * MS


@pytest.fixture
def node(graph: Graph) -> Node:
    return create_graph_node(graph, "node")


def run(graph: Graph, until_ns: int, step_ns: int = 10 * MS) -> None:
    """Ticks from now on, up to and with ``until_ns``."""
    while graph.now_ns < until_ns:
        graph.advance(graph.now_ns + step_ns)
        graph.run_due()


def test_a_timer_with_nothing_to_call_is_warned_of(graph: Graph, node: Node, lines: list[LogRecord]) -> None:
    node.create_timer(1.0, None)
    run(graph, SECOND)
    assert sum(TIMER_WITHOUT_CALLBACK in str(line) for line in lines) == 1


def calls_of(graph: Graph, node: Node, period: float) -> list[int]:
    """Where a timer notes the times [ms] at which it is called."""
    times: list[int] = []
    node.create_timer(period, lambda: times.append(graph.now_ns // MS))
    return times


def test_the_first_turn_comes_after_one_period(graph: Graph, node: Node) -> None:
    times = calls_of(graph, node, 0.1)
    graph.run_due()
    run(graph, SECOND)
    assert times == list(range(100, 1001, 100))


def test_a_period_that_ticks_do_not_divide_keeps_its_rhythm(graph: Graph, node: Node) -> None:
    times = calls_of(graph, node, 0.025)
    run(graph, SECOND // 10)
    assert times == [30, 50, 80, 100]


def test_missed_turns_are_left_out_but_for_the_one_that_is_due(graph: Graph, node: Node) -> None:
    times = calls_of(graph, node, 0.003)
    run(graph, 30 * MS)
    assert times == [10, 20, 30, 30]


def test_a_long_pause_is_not_caught_up_with(graph: Graph, node: Node) -> None:
    times = calls_of(graph, node, 0.1)
    graph.advance(10 * SECOND + 50 * MS)
    graph.run_due()
    run(graph, 10 * SECOND + 250 * MS)
    assert times == [10050, 10100, 10200]


def test_a_period_of_zero_comes_once_a_tick(graph: Graph, node: Node) -> None:
    times = calls_of(graph, node, 0)
    run(graph, 30 * MS)
    assert times == [10, 20, 30]


class TestTimeThatJumpsBack:
    """A world that is reset starts again at time 0; timers must go on with it."""

    def test_timers_begin_a_new_period(self, graph: Graph, node: Node) -> None:
        times = calls_of(graph, node, 0.1)
        run(graph, 10 * SECOND)
        times.clear()
        graph.advance(0)
        run(graph, 300 * MS)
        assert times == [100, 200, 300]

    def test_a_small_jump_within_the_period_changes_nothing(self, graph: Graph, node: Node) -> None:
        times = calls_of(graph, node, 0.1)
        run(graph, 160 * MS)
        graph.advance(130 * MS)
        run(graph, 210 * MS)
        assert times == [100, 200]

    def test_cancelled_timers_stay_so(self, graph: Graph, node: Node) -> None:
        timer = node.create_timer(0.1, lambda: pytest.fail("cancelled"))
        timer.cancel()
        graph.advance(SECOND)
        graph.advance(0)
        run(graph, SECOND)


class TestControl:
    def test_cancel_and_reset(self, graph: Graph, node: Node) -> None:
        times: list[int] = []
        timer = node.create_timer(0.1, lambda: times.append(graph.now_ns // MS))
        run(graph, 150 * MS)
        timer.cancel()
        assert timer.is_canceled()
        assert timer.time_until_next_call() is None
        run(graph, 500 * MS)
        timer.reset()
        assert not timer.is_canceled()
        run(graph, 700 * MS)
        assert times == [100, 600, 700]

    def test_reset_puts_off_a_running_timer(self, graph: Graph, node: Node) -> None:
        """The watchdog that every tutorial has."""
        times: list[int] = []
        watchdog = node.create_timer(0.1, lambda: times.append(graph.now_ns // MS))
        for tick in range(1, 40):
            graph.advance(tick * 10 * MS)
            if tick < 20 and tick % 5 == 0:
                watchdog.reset()
            graph.run_due()
        assert times == [250, 350]

    def test_it_tells_its_times(self, graph: Graph, node: Node) -> None:
        timer = node.create_timer(0.1, lambda: None)
        graph.advance(30 * MS)
        assert timer.time_since_last_call() == 30 * MS
        assert timer.time_until_next_call() == 70 * MS
        assert not timer.is_ready()
        graph.advance(100 * MS)
        assert timer.is_ready()
        assert timer.timer_period_ns == 100 * MS

    def test_a_new_period_holds_after_the_next_turn(self, graph: Graph, node: Node) -> None:
        times: list[int] = []
        timer = node.create_timer(0.1, lambda: times.append(graph.now_ns // MS))
        timer.timer_period_ns = 50 * MS
        run(graph, 220 * MS)
        assert times == [100, 150, 200]

    def test_it_may_be_made_without_being_started(self, graph: Graph, node: Node) -> None:
        timer = node.create_timer(0.1, lambda: pytest.fail("not started"), autostart=False)
        run(graph, 300 * MS)
        assert timer.is_canceled()

    def test_a_destroyed_timer_does_nothing(self, graph: Graph, node: Node) -> None:
        timer = node.create_timer(0.1, lambda: pytest.fail("destroyed"))
        graph.advance(SECOND)
        assert node.destroy_timer(timer)
        graph.run_due()
        with pytest.raises(InvalidHandle):
            timer.reset()

    def test_a_timer_that_cancels_itself_comes_once(self, graph: Graph, node: Node) -> None:
        times: list[int] = []

        def once() -> None:
            times.append(graph.now_ns // MS)
            timer.cancel()

        timer = node.create_timer(0.1, once)
        run(graph, SECOND)
        assert times == [100]

    def test_a_parameter_gets_the_turns_times(self, graph: Graph, node: Node) -> None:
        infos: list[Any] = []
        node.create_timer(0.025, infos.append)
        run(graph, 30 * MS)
        assert infos[0].expected_call_time.nanoseconds == 25 * MS
        assert infos[0].actual_call_time.nanoseconds == 30 * MS

    @pytest.mark.parametrize("period", [-1, -0.001])
    def test_a_negative_period_is_refused(self, node: Node, period: float) -> None:
        with pytest.raises(ValueError, match="non-negative"):
            node.create_timer(period, lambda: None)

    def test_what_is_no_callback_is_refused(self, node: Node) -> None:
        with pytest.raises(TypeError):
            node.create_timer(0.1, "tick")
        with pytest.raises(TypeError, match="0 or 1"):
            node.create_timer(0.1, lambda a, b: None)


def test_the_schedule_is_that_of_ros(graph: Graph) -> None:
    schedule = PeriodicSchedule(10, 0)
    assert schedule.due_ns == 10
    schedule.call(10)
    assert schedule.due_ns == 20
    schedule.call(30)
    assert schedule.due_ns == 30, "just in time for the next turn"
    schedule.call(30)
    schedule.call(71)
    assert schedule.due_ns == 80


class TestRates:
    @pytest.mark.parametrize("frequency", [0, -1.0])
    def test_a_frequency_is_positive(self, node: Node, frequency: float) -> None:
        with pytest.raises(ValueError, match="> 0"):
            node.create_rate(frequency)

    def test_it_keeps_time_and_asks_for_a_spinning_thread(self, alone: Graph, lines: list[Any]) -> None:
        rate = create_graph_node(alone, "node").create_rate(100.0)
        began = time.monotonic()
        for _ in range(5):
            rate.sleep()
        assert 0.045 < time.monotonic() - began < 2
        assert sum("another thread spins" in line.text for line in lines) == 1

    def test_it_follows_simulated_time_and_its_jumps(self, graph: Graph) -> None:
        rate = create_graph_node(graph, "node").create_rate(10.0)
        slept: list[int] = []
        ready = threading.Barrier(2)

        def loop() -> None:
            for _ in range(3):
                ready.wait(5)
                rate.sleep()
                slept.append(graph.now_ns // MS)
                ready.wait(5)

        thread = threading.Thread(target=loop)
        thread.start()
        for moment in (100, 200, 50):
            ready.wait(5)
            graph.advance(moment * MS)
            if moment == 50:  # back before the last turn: a new period
                time.sleep(0.02)
                assert len(slept) == 2
                graph.advance(150 * MS)
            ready.wait(5)
        thread.join(5)
        assert slept == [100, 200, 150]

    def test_a_shutdown_wakes_it(self, graph: Graph) -> None:
        rate = create_graph_node(graph, "node").create_rate(10.0)
        threading.Timer(0.02, context_of(graph).try_shutdown).start()
        with pytest.raises(ROSInterruptException):
            rate.sleep()

    def test_in_a_callback_of_its_own_executor_it_is_explained(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        rate = node.create_rate(100.0)
        node.create_timer(0.001, rate.sleep)
        executor = SingleThreadedExecutor(context=context_of(alone))
        executor.add_node(node)
        with pytest.raises(WouldDeadlock, match="inside a callback"):
            executor.spin_once(timeout_sec=5)
