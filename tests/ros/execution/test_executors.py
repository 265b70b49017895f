"""Executors, tasks and threads: nodes that spin while the world, or the clock on the wall, goes on."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from kit.msg.std_msgs import Int32
from kit.ros.exceptions import ExternalShutdownException, WouldDeadlock
from kit.ros.execution import client_library as rclpy
from kit.ros.execution.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from kit.ros.execution.client_library import wait_for_message
from kit.ros.execution.context import context_of
from kit.ros.execution.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from kit.ros.execution.task import Future, Task
from kit.ros.graph.graph import Graph
from kit.ros.log import LogRecord
from kit.ros.node.node import create_graph_node
from kit.ros.node.time import Duration
from tests.waiting import wait_until

MS = 1_000_000


@contextmanager
def spinning(*executors: Executor) -> Iterator[list[BaseException]]:
    """Spins executors in threads of their own; what they raise is collected."""
    problems: list[BaseException] = []

    def spin(executor: Executor) -> None:
        try:
            executor.spin()
        except BaseException as problem:  # noqa: BLE001 - the test looks at it
            problems.append(problem)

    threads = [threading.Thread(target=spin, args=(executor,)) for executor in executors]
    for thread in threads:
        thread.start()
    try:
        yield problems
    finally:
        for executor in executors:
            executor.shutdown()
        for thread in threads:
            thread.join(5)
            assert not thread.is_alive()


class TestSpinning:
    def test_once_means_at_most_one_callback(self, graph: Graph) -> None:
        node = create_graph_node(graph, "node")
        heard: list[int] = []
        node.create_subscription(Int32, "x", lambda message: heard.append(message.data), 10)
        publisher = node.create_publisher(Int32, "x", 10)
        for number in range(3):
            publisher.publish(Int32(data=number))
        for expected in ([0], [0, 1], [0, 1, 2], [0, 1, 2]):
            rclpy.spin_once(node, timeout_sec=0)
            assert heard == expected

    def test_zero_does_not_wait_and_a_moment_waits_that_long(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        rclpy.spin_once(node, timeout_sec=0)  # for ever, if it waited: nothing will come
        began = time.monotonic()
        rclpy.spin_once(node, timeout_sec=0.05)
        assert time.monotonic() - began >= 0.05

    def test_a_timer_is_waited_for(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        called: list[str] = []
        node.create_timer(0.02, lambda: called.append("timer"))
        rclpy.spin_once(node)
        assert called == ["timer"]

    def test_until_a_future_is_done(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        future: Future[int] = Future()
        count: list[int] = []

        def tick() -> None:
            count.append(1)
            if len(count) == 3:
                future.set_result(7)

        node.create_timer(0.001, tick)
        rclpy.spin_until_future_complete(node, future, timeout_sec=5)
        assert future.result() == 7
        assert len(count) == 3

    def test_until_the_time_is_over(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        node.create_timer(0.001, lambda: None)
        rclpy.spin_until_future_complete(node, Future(), timeout_sec=0.03)

    def test_a_future_set_by_another_thread_ends_it(self, alone: Graph) -> None:
        node, future = create_graph_node(alone, "node"), Future[int]()
        threading.Timer(0.02, lambda: future.set_result(1)).start()
        rclpy.spin_until_future_complete(node, future, timeout_sec=5)
        assert future.done()

    def test_what_a_callback_raises_comes_out(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        node.create_timer(0.001, lambda: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            rclpy.spin(node)

    def test_a_callback_may_shut_down(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        node.create_timer(0.001, node.context.shutdown)
        rclpy.spin(node)
        assert not node.context.ok()

    def test_a_shutdown_from_outside_raises(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        threading.Timer(0.02, node.context.shutdown_from_outside).start()
        with pytest.raises(ExternalShutdownException):
            rclpy.spin(node)
        node.context.shutdown()  # the program's own, which comes late, not wrong
        with pytest.raises(RuntimeError):
            node.context.shutdown()

    def test_a_shutdown_from_outside_during_a_callback_raises_too(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        node.create_timer(0.001, node.context.shutdown_from_outside)
        with pytest.raises(ExternalShutdownException):
            rclpy.spin(node)

    def test_a_wait_with_a_deadline_ends_when_time_jumps_back(self, graph: Graph) -> None:
        graph.advance(1_000_000 * MS)
        node = create_graph_node(graph, "node")
        thread = threading.Thread(target=rclpy.spin_once, args=(node,), kwargs={"timeout_sec": 1.0})
        thread.start()
        wait_until(lambda: bool(graph.waiting_threads))
        graph.advance(0)
        thread.join(5)
        assert not thread.is_alive()

    def test_a_shutdown_by_the_program_in_another_thread_just_ends_it(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        threading.Timer(0.02, node.context.shutdown).start()
        rclpy.spin(node)

    def test_spinning_in_its_own_callback_is_explained(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        node.create_timer(0.001, lambda: rclpy.spin_once(node, executor=executor))
        executor = SingleThreadedExecutor(context=context_of(alone))
        executor.add_node(node)
        with pytest.raises(WouldDeadlock, match="Executor is already spinning"):
            executor.spin()

    def test_two_threads_cannot_spin_one_executor(self, alone: Graph) -> None:
        executor = SingleThreadedExecutor(context=context_of(alone))
        with spinning(executor):
            wait_until(lambda: executor.is_spinning)
            with pytest.raises(RuntimeError, match="already spinning"):
                executor.spin_once()


class TestWhoseNode:
    def test_a_spun_node_is_not_run_in_lock_step_too(self, graph: Graph) -> None:
        node, executor = create_graph_node(graph, "node"), SingleThreadedExecutor(context=context_of(graph))
        called: list[int] = []
        node.create_timer(0.1, lambda: called.append(1))
        executor.add_node(node)
        graph.advance(100 * MS)
        assert graph.run_due() == 0
        executor.spin_once(timeout_sec=0)
        assert called == [1]
        assert node.executor is executor
        assert executor.get_nodes() == [node]

    def test_what_waits_moves_with_its_node_in_order(self, graph: Graph) -> None:
        node, other = create_graph_node(graph, "node"), create_graph_node(graph, "other")
        first, second = (
            SingleThreadedExecutor(context=context_of(graph)),
            SingleThreadedExecutor(context=context_of(graph)),
        )
        heard: list[int] = []
        for reader in (node, other):
            reader.create_subscription(Int32, "x", lambda message: heard.append(message.data), 10)
        publisher = node.create_publisher(Int32, "x", 10)
        for number in range(3):
            publisher.publish(Int32(data=number))
        assert first.add_node(node)
        assert not first.add_node(node)
        node.executor = second
        assert first.get_nodes() == []
        for _ in range(3):
            second.spin_once(timeout_sec=0)
        assert heard == [0, 1, 2]
        second.remove_node(node)
        assert graph.run_due() == 3
        publisher.publish(Int32(data=9))
        graph.run_due()
        assert heard == [0, 1, 2, 0, 1, 2, 9, 9]

    def test_a_node_of_another_graph_is_refused(self, graph: Graph) -> None:
        executor = SingleThreadedExecutor(context=context_of(Graph()))
        with pytest.raises(RuntimeError, match="another graph"):
            executor.add_node(create_graph_node(graph, "node"))

    def test_an_executor_lets_go_of_its_nodes_at_the_end(self, graph: Graph) -> None:
        node = create_graph_node(graph, "node")
        with SingleThreadedExecutor(context=context_of(graph)) as executor:
            executor.add_node(node)
        assert node.executor is None


class TestGroups:
    def both_at_once(self, alone: Graph, *groups: Any) -> bool:
        """Whether two callbacks of these groups overlap in a pool of threads."""
        node = create_graph_node(alone, "node")
        meeting = threading.Barrier(2)
        met: list[bool] = []
        done: Future[None] = Future()

        def callback() -> None:
            try:
                meeting.wait(0.15)
                met.append(True)
            except threading.BrokenBarrierError:
                met.append(False)
            if len(met) == 2:
                done.set_result(None)

        conditions = [node.create_guard_condition(callback, callback_group=group) for group in groups]
        with MultiThreadedExecutor(2, context=context_of(alone)) as executor:
            executor.add_node(node)
            for condition in conditions:
                condition.trigger()
            executor.spin_until_future_complete(done, timeout_sec=5)
        return all(met)

    def test_exclusive_ones_take_turns(self, alone: Graph) -> None:
        group = MutuallyExclusiveCallbackGroup()
        assert not self.both_at_once(alone, group, group)

    def test_the_default_group_is_exclusive(self, alone: Graph) -> None:
        assert not self.both_at_once(alone, None, None)

    def test_two_exclusive_groups_overlap(self, alone: Graph) -> None:
        assert self.both_at_once(alone, MutuallyExclusiveCallbackGroup(), MutuallyExclusiveCallbackGroup())

    def test_reentrant_ones_overlap(self, alone: Graph) -> None:
        group = ReentrantCallbackGroup()
        assert self.both_at_once(alone, group, group)

    def test_a_waiting_coroutine_keeps_its_exclusive_group(self, graph: Graph) -> None:
        node = create_graph_node(graph, "node")
        order: list[str] = []
        go: Future[None] = Future()

        async def slow() -> None:
            order.append("slow begins")
            await go
            order.append("slow ends")

        slow_one = node.create_guard_condition(slow)
        quick_one = node.create_guard_condition(lambda: order.append("quick"))
        other_group = node.create_guard_condition(
            lambda: order.append("other"), callback_group=MutuallyExclusiveCallbackGroup()
        )
        for condition in (slow_one, quick_one, other_group):
            condition.trigger()
        graph.run_due()
        assert order == ["slow begins", "other"]
        go.set_result(None)
        graph.run_due()
        assert order == ["slow begins", "other", "slow ends", "quick"]

    def test_what_a_pooled_callback_raises_comes_out_of_spin(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        node.create_timer(0.001, lambda: 1 / 0)
        with MultiThreadedExecutor(2, context=context_of(alone)) as executor:
            executor.add_node(node)
            with pytest.raises(ZeroDivisionError):
                executor.spin()

    def test_four_callbacks_meet_without_a_number_of_threads(
        self, alone: Graph, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr("os.cpu_count", lambda: 1)  # what a program may do is the same on every machine
        node, group = create_graph_node(alone, "node"), ReentrantCallbackGroup()
        meeting, done = threading.Barrier(4), Future[None]()

        def callback() -> None:
            meeting.wait(10.0)
            if not done.done():
                done.set_result(None)

        conditions = [node.create_guard_condition(callback, callback_group=group) for _ in range(4)]
        with MultiThreadedExecutor(context=context_of(alone)) as executor:
            executor.add_node(node)
            for condition in conditions:
                condition.trigger()
            executor.spin_until_future_complete(done, timeout_sec=20)
        assert not meeting.broken
        assert done.done()

    def test_a_group_knows_its_entities(self, graph: Graph) -> None:
        node, group = create_graph_node(graph, "node"), MutuallyExclusiveCallbackGroup()
        timer = node.create_timer(1.0, lambda: None, group)
        assert group.has_entity(timer)
        assert group.can_execute(timer)
        node.destroy_timer(timer)
        assert not group.has_entity(timer)


class TestThreads:
    def test_one_thread_trains_while_another_spins(self, alone: Graph) -> None:
        """As the reinforcement-learning packages do it: ``step()`` publishes and blocks until the next scan."""
        world, agent = create_graph_node(alone, "world"), create_graph_node(alone, "agent")
        scans = world.create_publisher(Int32, "scan", 10)
        commands = agent.create_publisher(Int32, "cmd", 10)
        arrived = threading.Event()
        seen: list[int] = []

        def on_scan(message: Int32) -> None:
            seen.append(message.data)
            arrived.set()

        agent.create_subscription(Int32, "scan", on_scan, 10)
        world.create_subscription(
            Int32, "cmd", lambda message: scans.publish(Int32(data=message.data + 1)), 10
        )
        observations: list[int] = []

        def learn() -> None:
            for step in range(200):
                arrived.clear()
                commands.publish(Int32(data=step))
                assert arrived.wait(5)
                observations.append(seen[-1])

        executors = [SingleThreadedExecutor(context=context_of(alone)) for _ in range(2)]
        executors[0].add_node(world)
        executors[1].add_node(agent)
        with spinning(*executors) as problems:
            trainer = threading.Thread(target=learn)
            trainer.start()
            trainer.join(20)
        assert problems == []
        assert observations == list(range(1, 201))

    def test_many_threads_publish_at_once_and_nothing_is_lost(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        heard: list[int] = []
        node.create_subscription(Int32, "x", lambda message: heard.append(message.data), 10_000)
        publishers = [node.create_publisher(Int32, "x", 10_000) for _ in range(4)]
        executor = SingleThreadedExecutor(context=context_of(alone))
        executor.add_node(node)

        def send(number: int) -> None:
            for i in range(500):
                publishers[number].publish(Int32(data=number * 1000 + i))

        with spinning(executor) as problems:
            threads = [threading.Thread(target=send, args=(number,)) for number in range(4)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join(10)
            wait_until(lambda: len(heard) == 2000)
        assert problems == []
        for number in range(4):
            mine = [data for data in heard if data // 1000 == number]
            assert mine == sorted(mine)

    def test_a_spinning_thread_follows_simulated_time(self, graph: Graph) -> None:
        node, executor = create_graph_node(graph, "node"), SingleThreadedExecutor(context=context_of(graph))
        times: list[int] = []
        node.create_timer(0.1, lambda: times.append(graph.now_ns // MS))
        executor.add_node(node)
        with spinning(executor):
            for tick in range(1, 31):
                graph.advance(tick * 10 * MS)
                if tick % 10 == 0:
                    wait_until(lambda: len(times) == graph.now_ns // (100 * MS))
        assert times == [100, 200, 300]

    def test_entities_may_come_and_go_while_it_spins(self, alone: Graph) -> None:
        node, executor = create_graph_node(alone, "node"), SingleThreadedExecutor(context=context_of(alone))
        executor.add_node(node)
        called: list[int] = []
        with spinning(executor) as problems:
            wait_until(lambda: executor.is_spinning)
            for _ in range(20):
                timer = node.create_timer(0.0005, lambda: called.append(1))
                count = len(called)
                wait_until(lambda count=count: len(called) > count)
                node.destroy_timer(timer)
        assert problems == []


class StagedWaiter:
    """A waiter in a test's hands: each wait takes the next stage, as a frame from a pipe would."""

    def __init__(self, *stages: Callable[[Graph], None]) -> None:
        self.stages = list(stages)
        self.asked: list[int | None] = []
        self.inside = 0

    def is_alone(self, graph: Graph) -> bool:
        return True

    def wait(self, graph: Graph, until_ns: int | None) -> None:
        self.inside += 1
        assert self.inside == 1, "one thread calls the waiter at a time"
        self.asked.append(until_ns)
        time.sleep(0.001)
        self.stages.pop(0)(graph)
        self.inside -= 1


class TestWaiter:
    def test_time_and_messages_come_while_it_waits(self) -> None:
        waiter = StagedWaiter(*(lambda graph, t=t: graph.advance(t * 10 * MS) for t in range(1, 50)))
        graph = Graph(waiter=waiter)
        node = create_graph_node(graph, "node")
        times: list[int] = []
        done: Future[None] = Future()

        def tick() -> None:
            times.append(graph.now_ns // MS)
            if len(times) == 3:
                done.set_result(None)

        node.create_timer(0.1, tick)
        rclpy.spin_until_future_complete(node, done)
        assert times == [100, 200, 300]
        assert waiter.asked[0] == 100 * MS
        rate = node.create_rate(20.0)
        rate.sleep()
        assert graph.now_ns == 350 * MS

    def test_a_program_may_wait_inside_a_callback(self) -> None:
        waiter = StagedWaiter(*(lambda graph, t=t: graph.advance(t * 10 * MS) for t in range(1, 50)))
        graph = Graph(waiter=waiter)
        node = create_graph_node(graph, "node")
        times: list[int] = []

        def patient() -> None:
            node.get_clock().sleep_for(Duration(nanoseconds=50 * MS), node.context)
            times.append(graph.now_ns // MS)

        node.create_timer(0.1, patient)
        rclpy.spin_once(node)
        assert times == [150]

    def test_only_one_of_many_threads_calls_the_waiter(self) -> None:
        waiter = StagedWaiter(*(lambda graph, t=t: graph.advance(t * 10 * MS) for t in range(1, 500)))
        graph = Graph(waiter=waiter)
        node = create_graph_node(graph, "node")
        slept: list[int] = []

        def sleep(frequency: float) -> None:
            rate = node.create_rate(frequency)
            for _ in range(5):
                rate.sleep()
            slept.append(1)

        threads = [threading.Thread(target=sleep, args=(frequency,)) for frequency in (50.0, 33.0, 20.0)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(10)
        assert slept == [1, 1, 1]


class TestTasks:
    def test_a_task_is_a_future(self, graph: Graph) -> None:
        executor = SingleThreadedExecutor(context=context_of(graph))
        task = executor.create_task(lambda a, b: a + b, 2, b=3)
        assert not task.done()
        executor.spin_once(timeout_sec=0)
        assert task.result() == 5

    def test_a_coroutine_goes_on_when_what_it_awaits_is_there(self, graph: Graph) -> None:
        executor = SingleThreadedExecutor(context=context_of(graph))
        future = executor.create_future()
        calls: list[str] = []
        future.add_done_callback(lambda done: calls.append(done.result()))

        async def wait() -> str:
            return "got " + await future

        task = executor.create_task(wait)
        executor.spin_once(timeout_sec=0)
        assert not task.done()
        future.set_result("it")
        assert calls == [], "its executor calls back"
        executor.spin_until_future_complete(task, timeout_sec=1)
        assert task.result() == "got it"
        executor.spin_once(timeout_sec=0)
        assert calls == ["it"]

    def test_what_it_raises_is_its_exception_and_comes_out(self, graph: Graph) -> None:
        executor = SingleThreadedExecutor(context=context_of(graph))
        task = executor.create_task(lambda: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            executor.spin_once(timeout_sec=0)
        assert isinstance(task.exception(), ZeroDivisionError)
        with pytest.raises(ZeroDivisionError):
            task.result()

    def test_a_cancelled_task_does_not_run(self, graph: Graph) -> None:
        executor = SingleThreadedExecutor(context=context_of(graph))
        task = executor.create_task(lambda: pytest.fail("cancelled"))
        task.cancel()
        executor.spin_once(timeout_sec=0)
        assert task.cancelled()
        assert task.done()

    def test_a_cancelled_coroutine_is_closed_and_frees_its_group(self, graph: Graph) -> None:
        node = create_graph_node(graph, "node")
        closed: list[str] = []
        tasks: list[Task[Any]] = []

        async def wait() -> None:
            work = graph.thread_state.work
            assert work is not None
            if isinstance(work[1], Task):
                tasks.append(work[1])
            try:
                await Future()
            finally:
                closed.append("closed")

        node.create_guard_condition(wait).trigger()
        graph.run_due()
        tasks[0].cancel()
        assert closed == ["closed"]
        after: list[str] = []
        node.create_guard_condition(lambda: after.append("free")).trigger()
        graph.run_due()
        assert after == ["free"]

    def test_done_callbacks(self) -> None:
        future: Future[int] = Future()
        seen: list[Any] = []
        future.add_done_callback(seen.append)
        future.add_done_callback(lambda done: seen.append("removed") or None)
        future.set_result(1)
        future.add_done_callback(lambda done: seen.append(done.result()))
        assert seen == [future, "removed", 1]
        other: Future[int] = Future()
        assert not other.remove_done_callback(seen.append)
        other.cancel()
        assert other.cancelled()
        other.set_exception(ValueError("late"))
        with pytest.raises(ValueError, match="late"):
            other.result()


class TestWaitForMessage:
    def test_the_next_message(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        publisher = node.create_publisher(Int32, "x", 10)
        threading.Timer(0.02, lambda: publisher.publish(Int32(data=4))).start()
        arrived, message = wait_for_message(Int32, node, "x", time_to_wait=5)
        assert arrived
        assert message == Int32(data=4)
        assert list(node.subscriptions) == []

    def test_none_in_time(self, alone: Graph) -> None:
        assert wait_for_message(Int32, create_graph_node(alone, "node"), "x", time_to_wait=0.01) == (
            False,
            None,
        )


def test_a_guard_condition_triggered_twice_calls_once(graph: Graph) -> None:
    node = create_graph_node(graph, "node")
    called: list[int] = []
    condition = node.create_guard_condition(lambda: called.append(1))
    condition.trigger()
    condition.trigger()
    graph.run_due()
    assert called == [1]


def test_a_call_without_a_server_is_warned_about(alone: Graph, lines: list[LogRecord]) -> None:
    from kit.msg.std_srvs import Trigger

    node = create_graph_node(alone, "node")
    node.create_service(Trigger, "s", lambda request, response: response)
    with pytest.raises(TimeoutError):
        node.create_client(Trigger, "s").call(Trigger.Request(), timeout_sec=0.02)
    assert any("another thread spins this node" in line.text for line in lines)
