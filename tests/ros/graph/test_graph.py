"""Lock-step: order, determinism, time, failures, endless talk, and what others see of it."""

from __future__ import annotations

from typing import Any

import pytest

from kit.msg.geometry_msgs import Twist
from kit.msg.std_msgs import Int32, String
from kit.msg.std_srvs import Trigger
from kit.ros.exceptions import NodeFailure, NotInitializedException, WouldDeadlock
from kit.ros.execution.context import Context, context_of, default_context, get_default_context
from kit.ros.graph.graph import MAX_CALLBACKS, MAX_POLLS, MAX_ROUNDS, Graph
from kit.ros.log import LogRecord
from kit.ros.node.node import Node, create_graph_node
from kit.ros.node.qos import HistoryPolicy, QoSProfile
from kit.ros.node.time import Duration

SECOND = 1_000_000_000


def test_a_key_turns_the_wheels_within_one_tick(graph: Graph) -> None:
    keyboard, teleop, robot = (create_graph_node(graph, name) for name in ("keyboard", "teleop", "robot"))
    driven: list[float] = []
    commands = teleop.create_publisher(Twist, "cmd_vel", 10)

    def on_key(key: String) -> None:
        command = Twist()
        command.linear.x = 0.5 if key.data == "p_up" else 0.0
        commands.publish(command)

    teleop.create_subscription(String, "keys", on_key, 10)
    robot.create_subscription(Twist, "cmd_vel", lambda command: driven.append(command.linear.x), 10)
    keyboard.create_publisher(String, "keys", 10).publish(String(data="p_up"))
    assert graph.run_due() == 2
    assert driven == [0.5]


def test_callbacks_come_in_the_order_in_which_their_causes_came(graph: Graph) -> None:
    node = create_graph_node(graph, "node")
    order: list[str] = []
    publishers = {name: node.create_publisher(Int32, name, 10) for name in "ab"}
    for name in "ab":
        for reader in ("first", "second"):
            node.create_subscription(
                Int32, name, lambda m, who=f"{name}:{reader}": order.append(f"{who}:{m.data}"), 10
            )
    node.create_timer(0.2, lambda: order.append("slow timer, older"))
    node.create_timer(0.1, lambda: order.append("fast timer"))
    node.create_timer(0.2, lambda: order.append("slow timer, younger"))
    publishers["b"].publish(Int32(data=1))
    publishers["a"].publish(Int32(data=2))
    graph.advance(SECOND // 5)
    graph.run_due()
    assert order == [
        "b:first:1",
        "b:second:1",
        "a:first:2",
        "a:second:2",
        "fast timer",
        "slow timer, older",
        "slow timer, younger",
        "fast timer",
    ]


def chatter(graph: Graph) -> list[tuple[int, str]]:
    """A busy little system with all kinds of callbacks; what it says, with the time."""
    said: list[tuple[int, str]] = []
    a, b = create_graph_node(graph, "a"), create_graph_node(graph, "b", "/ns")
    numbers = a.create_publisher(Int32, "/numbers", 5)
    client = b.create_client(Trigger, "/ask")

    def on_number(message: Int32) -> None:
        said.append((graph.now_ns, f"number {message.data}"))
        if message.data % 3 == 0:
            client.call_async(Trigger.Request()).add_done_callback(
                lambda future: said.append((graph.now_ns, future.result().message))
            )

    async def answer(request: Any, response: Any) -> Any:
        response.message = f"answer at {graph.now_ns}"
        return response

    b.create_subscription(Int32, "/numbers", on_number, 5)
    a.create_service(Trigger, "/ask", answer)
    count = iter(range(10**6))
    a.create_timer(0.013, lambda: numbers.publish(Int32(data=next(count))))
    b.create_timer(0.007, lambda: said.append((graph.now_ns, "tock")))
    for tick in range(500):
        graph.advance(tick * SECOND // 100)
        graph.run_due()
    return said


def test_the_same_inputs_give_the_same_run() -> None:
    first, second = chatter(Graph()), chatter(Graph())
    assert len(first) > 1000
    assert first == second


def test_nothing_due_costs_nothing_and_does_nothing(graph: Graph) -> None:
    create_graph_node(graph, "node").create_timer(1.0, lambda: None)
    assert graph.run_due() == 0
    graph.advance(SECOND)
    assert graph.run_due() == 1
    assert graph.run_due() == 0


class TestEndlessTalk:
    def test_it_ends_the_tick_and_is_named_once(self, graph: Graph, lines: list[LogRecord]) -> None:
        node = create_graph_node(graph, "parrot")
        publisher = node.create_publisher(Int32, "echo", 10)
        heard: list[int] = []

        def repeat(message: Int32) -> None:
            heard.append(message.data)
            publisher.publish(Int32(data=message.data + 1))

        node.create_subscription(Int32, "echo", repeat, 10)
        publisher.publish(Int32())
        done = graph.run_due()
        assert 0 < done == len(heard) <= MAX_CALLBACKS
        assert graph.run_due() > 0, "the rest waits for the next tick"
        assert heard == list(range(len(heard)))
        assert [line.text for line in lines if "/echo" in line.text and "own messages" in line.text] == [
            lines[0].text
        ]

    def test_an_explosion_of_messages_is_cut_off_too(self, graph: Graph) -> None:
        node = create_graph_node(graph, "rabbits")
        everything = QoSProfile(history=HistoryPolicy.KEEP_ALL)
        publisher = node.create_publisher(Int32, "echo", everything)

        def multiply(message: Int32) -> None:
            publisher.publish(message)
            publisher.publish(message)

        node.create_subscription(Int32, "echo", multiply, everything)
        publisher.publish(Int32())
        assert graph.run_due() == MAX_CALLBACKS


class TestFailures:
    def test_a_failing_callback_says_whose_it_is(self, graph: Graph) -> None:
        node = create_graph_node(graph, "clumsy", "/ns")
        node.create_timer(0.1, lambda: 1 / 0)
        graph.advance(SECOND)
        with pytest.raises(NodeFailure, match="/ns/clumsy failed: ZeroDivisionError") as failure:
            graph.run_due()
        assert failure.value.node_name == node.get_fully_qualified_name()
        assert isinstance(failure.value.cause, ZeroDivisionError)

    def test_a_handler_hears_of_it_and_the_others_go_on(self, graph: Graph) -> None:
        failures: list[NodeFailure] = []
        graph.on_failure = failures.append
        done: list[str] = []
        create_graph_node(graph, "clumsy").create_timer(0.1, lambda: [][0])
        create_graph_node(graph, "steady").create_timer(0.1, lambda: done.append("done"))
        graph.advance(SECOND // 10)
        graph.run_due()
        assert [failure.node_name for failure in failures] == ["/clumsy"]
        assert done == ["done"]

    def test_without_a_handler_the_rest_waits_for_the_next_call(self, graph: Graph) -> None:
        done: list[str] = []
        node = create_graph_node(graph, "node")
        node.create_timer(0.1, lambda: [][0])
        node.create_timer(0.1, lambda: done.append("done"))
        graph.advance(SECOND // 10)
        with pytest.raises(NodeFailure):
            graph.run_due()
        graph.run_due()
        assert done == ["done"]


class TestWaitingInLockStep:
    """Time stands still while a callback runs: what would wait for ever says so."""

    @pytest.mark.parametrize(
        "wait",
        [
            lambda node, client: client.call(Trigger.Request()),
            lambda node, client: client.wait_for_service(),
            lambda node, client: client.wait_for_service(timeout_sec=1.0),
            lambda node, client: node.create_rate(10).sleep(),
            lambda node, client: node.get_clock().sleep_for(Duration(seconds=1), node.context),
        ],
    )
    def test_a_callback_must_not_wait(self, graph: Graph, wait: Any) -> None:
        node = create_graph_node(graph, "impatient")
        client = node.create_client(Trigger, "nobody")
        node.create_timer(0.1, lambda: wait(node, client))
        graph.advance(SECOND)
        with pytest.raises(NodeFailure) as failure:
            graph.run_due()
        assert isinstance(failure.value.cause, WouldDeadlock)

    def test_spinning_in_a_callback_is_explained(self, graph: Graph) -> None:
        from kit.ros.execution.client_library import spin_once

        node = create_graph_node(graph, "node")
        node.create_timer(0.1, lambda: spin_once(node))
        graph.advance(SECOND)
        with pytest.raises(NodeFailure, match="lock-step"):
            graph.run_due()

    def test_the_thread_that_advances_time_must_not_wait_for_it(self, graph: Graph) -> None:
        node = create_graph_node(graph, "node")
        graph.run_due()
        with pytest.raises(WouldDeadlock, match="thread"):
            node.create_client(Trigger, "nobody").wait_for_service(timeout_sec=1.0)

    def test_what_is_there_already_is_not_waited_for(self, graph: Graph) -> None:
        node = create_graph_node(graph, "node")
        node.create_service(Trigger, "here", lambda request, response: response)
        ready: list[bool] = []
        node.create_timer(0.1, lambda: ready.append(node.create_client(Trigger, "here").wait_for_service()))
        graph.advance(SECOND // 10)
        graph.run_due()
        assert ready == [True]


class TestTime:
    def test_only_a_simulated_graph_can_be_advanced(self) -> None:
        with pytest.raises(RuntimeError):
            Graph(None).advance(5)
        assert Graph(7).now_ns == 7
        assert not Graph(None).is_simulated

    def test_every_clock_of_a_simulation_tells_its_time(self, graph: Graph) -> None:
        from kit.ros.node.clock import Clock
        from kit.ros.node.time import ClockType

        graph.advance(3 * SECOND + 5)
        node = create_graph_node(graph, "node")
        assert node.get_clock().now().seconds_nanoseconds() == (3, 5)
        with default_context(context_of(graph)):
            for clock_type in ClockType:
                assert Clock(clock_type=clock_type).now().nanoseconds == 3 * SECOND + 5


def test_discard_forgets_what_is_on_its_way(graph: Graph) -> None:
    node = create_graph_node(graph, "node")
    heard: list[Any] = []
    publisher = node.create_publisher(Int32, "x", 10)
    node.create_subscription(Int32, "x", heard.append, 10)
    client = node.create_client(Trigger, "s")
    node.create_service(Trigger, "s", lambda request, response: heard.append(request))
    publisher.publish(Int32())
    client.call_async(Trigger.Request())
    graph.discard_messages()
    assert graph.run_due() == 0
    assert heard == []
    publisher.publish(Int32(data=2))
    graph.run_due()
    assert [message.data for message in heard] == [2]


class TestWatching:
    def test_a_message_listener_receives_every_message(self, graph: Graph) -> None:
        seen: list[tuple[int, str, str, str]] = []
        stop = graph.add_message_listener(
            lambda time_ns, node, topic, message: seen.append(
                (time_ns, node.get_name(), topic, repr(message)[:20])
            )
        )
        node = create_graph_node(graph, "talker")
        node.create_publisher(String, "unheard", 10).publish(String(data="x"))
        node.create_service(Trigger, "ask", lambda request, response: response)
        create_graph_node(graph, "asker").create_client(Trigger, "ask").call_async(Trigger.Request())
        graph.advance(5)
        graph.run_due()
        topics = [entry[:3] for entry in seen if "param" not in entry[2] and entry[2] != "/rosout"]
        assert topics == [(0, "talker", "/unheard"), (0, "asker", "/ask"), (5, "talker", "/ask")]
        stop()
        node.create_publisher(String, "later", 10).publish(String())
        assert all(entry[2] != "/later" for entry in seen)


class TestNodesWithoutContext:
    def test_hosting_makes_them_belong(self, graph: Graph) -> None:
        class Controller(Node):
            def __init__(self) -> None:
                super().__init__("controller")

        with default_context(context_of(graph)):
            node = Controller()
            assert get_default_context() is context_of(graph)
        assert graph.nodes == (node,)
        assert get_default_context() is not context_of(graph)

    def test_the_command_line_of_the_program_means_nothing_to_a_graphs_own_context(
        self, graph: Graph, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr("sys.argv", ["kit", "--ros-args", "-r", "__node:=hijacked"])
        assert create_graph_node(graph, "mine").get_name() == "mine"

    def test_a_context_must_be_initialised(self, graph: Graph) -> None:
        with pytest.raises(NotInitializedException):
            Node("early", context=Context(graph))


def test_a_destroyed_node_is_gone_with_all_it_made(graph: Graph) -> None:
    node = create_graph_node(graph, "node")
    node.create_publisher(Int32, "x", 10)
    node.create_subscription(Int32, "x", lambda message: None, 10)
    node.create_client(Trigger, "s")
    node.create_service(Trigger, "s", lambda request, response: response)
    node.create_timer(0.1, lambda: pytest.fail("it is gone"))
    assert graph.subscription_count("/x") == 1
    assert [graph.has_subscriptions(topic) for topic in ("/x", "/y")] == [True, False]
    node.destroy_node()
    assert graph.nodes == ()
    assert graph.directory.topics == {}
    assert graph.directory.services == graph.directory.clients == {}
    assert graph.subscription_count("/x") == 0
    assert not graph.has_subscriptions("/x")
    graph.advance(SECOND)
    assert graph.run_due() == 0


def test_two_nodes_of_one_name_are_warned_about(graph: Graph, lines: list[LogRecord]) -> None:
    create_graph_node(graph, "twin")
    create_graph_node(graph, "twin")
    assert any("/twin" in line.text for line in lines)


@pytest.mark.parametrize(("value", "cure"), [(True, "write Int32(data=...)"), (Int32, "write Int32()")])
def test_a_bare_value_on_a_topic_is_refused_with_the_message_to_write(
    graph: Graph, value: object, cure: str
) -> None:
    publisher: Any = create_graph_node(graph, "node").create_publisher(Int32, "numbers", 10)
    with pytest.raises(TypeError) as refused:
        publisher.publish(value)
    assert cure in str(refused.value)


def test_what_nodes_say_to_each_other_without_end_goes_on_in_the_next_tick(graph: Graph) -> None:
    """Each round has the callbacks of the round before to answer."""
    node = create_graph_node(graph, "echo")
    publisher = node.create_publisher(Int32, "number", 10)
    heard: list[int] = []

    def answer(message: Int32) -> None:
        heard.append(message.data)
        publisher.publish(Int32(data=message.data + 1))

    node.create_subscription(Int32, "number", answer, 10)
    publisher.publish(Int32(data=0))
    graph.run_due()
    assert heard == list(range(MAX_ROUNDS))
    graph.run_due()
    assert heard == list(range(2 * MAX_ROUNDS))


class CountingWaiter:
    """A waiter for which nothing ever changes."""

    def __init__(self) -> None:
        self.count = 0

    def is_alone(self, graph: Graph) -> bool:
        return True

    def wait(self, graph: Graph, until_ns: int | None) -> None:
        self.count += 1


def test_a_program_may_poll_so_often_at_one_instant_and_then_has_to_wait() -> None:
    waiter = CountingWaiter()
    graph = Graph(waiter=waiter)

    def poll(times: int) -> int:
        for _ in range(times):
            assert not graph.wait(lambda: False, until_ns=graph.now_ns)
        return waiter.count

    assert poll(MAX_POLLS) == 0
    graph.advance(SECOND)  # a new instant, a new count
    assert poll(MAX_POLLS) == 0
    assert poll(1) == 1
    assert poll(MAX_POLLS) == 1
    assert poll(1) == 2
