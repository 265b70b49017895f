"""Services and clients."""

from __future__ import annotations

import threading
from typing import Any

import pytest

from kit.msg.flatland_msgs import MoveModel
from kit.msg.geometry_msgs import Pose2D
from kit.msg.std_srvs import Empty, SetBool, Trigger
from kit.ros.exceptions import InvalidServiceNameException, NodeFailure, WouldDeadlock
from kit.ros.execution.callback_groups import MutuallyExclusiveCallbackGroup
from kit.ros.execution.context import context_of
from kit.ros.execution.executors import MultiThreadedExecutor, SingleThreadedExecutor
from kit.ros.execution.task import Future
from kit.ros.graph.graph import Graph
from kit.ros.log import LogRecord
from kit.ros.node.node import Node, create_graph_node

SECOND = 1_000_000_000


@pytest.fixture
def node(graph: Graph) -> Node:
    return create_graph_node(graph, "node")


def test_a_call_is_answered_within_the_tick(graph: Graph, node: Node) -> None:
    moved: list[str] = []

    def move(request: MoveModel.Request, response: MoveModel.Response) -> MoveModel.Response:
        moved.append(request.name)
        response.success = True
        return response

    node.create_service(MoveModel, "move_model", move)
    future = node.create_client(MoveModel, "move_model").call_async(
        MoveModel.Request(name="robot", pose=Pose2D(x=1.0))
    )
    assert not future.done()
    assert future.result() is None
    graph.run_due()
    assert moved == ["robot"]
    assert future.done()
    assert future.result().success


def test_a_new_client_for_each_call_inside_a_callback(graph: Graph, node: Node) -> None:
    """As the packages written for Flatland do it."""
    answered: list[bool] = []
    node.create_service(SetBool, "switch", lambda request, response: SetBool.Response(success=request.data))

    def on_timer() -> None:
        client = node.create_client(SetBool, "switch")
        assert client.wait_for_service()
        client.call_async(SetBool.Request(data=True)).add_done_callback(
            lambda future: answered.append(future.result().success)
        )

    node.create_timer(0.1, on_timer)
    for tick in range(1, 6):
        graph.advance(tick * SECOND // 10)
        graph.run_due()
    assert answered == [True] * 5


def test_requests_are_copies_and_so_are_responses(graph: Graph, node: Node) -> None:
    kept: list[Any] = []

    def answer(request: Any, response: Any) -> Any:
        kept.extend((request, response))
        return response

    node.create_service(SetBool, "s", answer)
    request = SetBool.Request(data=True)
    future = node.create_client(SetBool, "s").call_async(request)
    request.data = False
    graph.run_due()
    assert kept[0].data is True
    assert future.result() is not kept[1]


def test_a_coroutine_may_answer_later(graph: Graph, node: Node) -> None:
    outcome: Future[str] = Future()

    async def answer(request: Any, response: Any) -> Any:
        response.message = await outcome
        return response

    node.create_service(Trigger, "s", answer)
    future = node.create_client(Trigger, "s").call_async(Trigger.Request())
    graph.run_due()
    assert not future.done()
    outcome.set_result("late but there")
    graph.run_due()
    assert future.result().message == "late but there"


def test_a_coroutine_callback_may_await_a_service(graph: Graph, node: Node) -> None:
    heard: list[str] = []
    client = node.create_client(Trigger, "s")
    node.create_service(
        Trigger,
        "s",
        lambda request, response: Trigger.Response(message="yes"),
        callback_group=MutuallyExclusiveCallbackGroup(),
    )
    client.callback_group = MutuallyExclusiveCallbackGroup()

    async def ask() -> None:
        heard.append((await client.call_async(Trigger.Request())).message)

    node.create_timer(0.1, ask)
    graph.advance(SECOND // 10)
    graph.run_due()
    assert heard == ["yes"]


def test_the_oldest_server_answers(graph: Graph, node: Node) -> None:
    first = node.create_service(Trigger, "s", lambda request, response: Trigger.Response(message="first"))
    node.create_service(Trigger, "s", lambda request, response: Trigger.Response(message="second"))
    client = node.create_client(Trigger, "s")
    futures = [client.call_async(Trigger.Request())]
    graph.run_due()
    node.destroy_service(first)
    futures.append(client.call_async(Trigger.Request()))
    graph.run_due()
    assert [future.result().message for future in futures] == ["first", "second"]


def test_a_service_without_server_is_warned_about(graph: Graph, node: Node, lines: list[LogRecord]) -> None:
    client = node.create_client(Trigger, "nobody")
    assert not client.service_is_ready()
    future = client.call_async(Trigger.Request())
    graph.run_due()
    assert not future.done()
    assert "no node serves '/nobody'" in lines[0].text


def test_a_service_of_another_type_does_not_answer(node: Node) -> None:
    node.create_service(Empty, "s", lambda request, response: response)
    assert not node.create_client(Trigger, "s").service_is_ready()


class TestMistakes:
    def test_the_forgotten_return_is_named(self, graph: Graph, node: Node) -> None:
        node.create_service(Trigger, "s", lambda request, response: None)
        node.create_client(Trigger, "s").call_async(Trigger.Request())
        with pytest.raises(NodeFailure, match=r"'/s' must return its response.*return response"):
            graph.run_due()

    @pytest.mark.parametrize("wrong", [None, Trigger, Trigger.Response(), SetBool.Request(), "x"])
    def test_only_its_own_requests_can_be_sent(self, node: Node, wrong: Any) -> None:
        client = node.create_client(Trigger, "s")
        for call in (client.call_async, client.call):
            with pytest.raises(TypeError, match=r"Expected Trigger\.Request"):
                call(wrong)

    def test_a_callback_needs_two_parameters(self, node: Node) -> None:
        with pytest.raises(TypeError, match="2 argument"):
            node.create_service(Trigger, "s", lambda request: request)

    def test_names_are_checked(self, node: Node) -> None:
        with pytest.raises(InvalidServiceNameException):
            node.create_client(Trigger, "no spaces")

    def test_a_pending_request_can_be_given_up(self, graph: Graph, node: Node) -> None:
        node.create_service(Trigger, "s", lambda request, response: response)
        client = node.create_client(Trigger, "s")
        future = client.call_async(Trigger.Request())
        client.remove_pending_request(future)
        graph.run_due()
        assert not future.done()


class TestBlockingCalls:
    """``Client.call`` waits for a callback; it must not be one that waits for the caller."""

    def serve(self, node: Node) -> None:
        node.create_service(Trigger, "s", lambda request, response: Trigger.Response(message="done"))

    def test_in_another_thread_than_the_spinning_one(self, alone: Graph) -> None:
        server, asker = create_graph_node(alone, "server"), create_graph_node(alone, "asker")
        self.serve(server)
        executor = SingleThreadedExecutor(context=context_of(alone))
        executor.add_node(server)
        executor.add_node(asker)
        thread = threading.Thread(target=executor.spin)
        thread.start()
        response = asker.create_client(Trigger, "s").call(Trigger.Request())
        executor.shutdown()
        thread.join(5)
        assert response is not None
        assert response.message == "done"

    def test_in_a_callback_of_a_single_thread_it_is_explained_instead_of_hanging(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        self.serve(node)
        client = node.create_client(Trigger, "s")
        node.create_timer(0.001, lambda: client.call(Trigger.Request()))
        executor = SingleThreadedExecutor(context=context_of(alone))
        executor.add_node(node)
        with pytest.raises(WouldDeadlock, match="call_async"):
            executor.spin_once(timeout_sec=5)

    def test_many_threads_do_not_help_in_one_exclusive_group(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        self.serve(node)
        client = node.create_client(Trigger, "s")
        node.create_timer(0.001, lambda: client.call(Trigger.Request()))
        with MultiThreadedExecutor(2, context=context_of(alone)) as executor:
            executor.add_node(node)
            with pytest.raises(WouldDeadlock, match="callback group of its own"):
                executor.spin()

    @pytest.mark.parametrize("has_own_group", [False, True])
    def test_one_that_is_awaited_in_its_own_group_is_told(self, has_own_group: bool) -> None:
        logged: list[str] = []
        graph = Graph(log_sink=lambda record: logged.append(record.text))
        node = create_graph_node(graph, "node")
        server = create_graph_node(graph, "server")
        server.create_service(Trigger, "s", lambda request, response: response)
        group = MutuallyExclusiveCallbackGroup() if has_own_group else None
        client = node.create_client(Trigger, "s", callback_group=group)
        answers: list[Any] = []

        async def ask() -> None:
            answers.append(await client.call_async(Trigger.Request()))

        node.create_timer(1.0, ask)
        graph.advance(10**9)
        graph.run_due()
        assert len(answers) == has_own_group
        assert any("mutually exclusive" in text for text in logged) is not has_own_group

    def test_many_threads_and_a_group_of_its_own_do(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        self.serve(node)
        client = node.create_client(Trigger, "s", callback_group=MutuallyExclusiveCallbackGroup())
        answers: list[Any] = []
        done: Future[None] = Future()

        def ask() -> None:
            timer.cancel()
            answers.append(client.call(Trigger.Request()).message)
            done.set_result(None)

        timer = node.create_timer(0.001, ask, callback_group=MutuallyExclusiveCallbackGroup())
        with MultiThreadedExecutor(3, context=context_of(alone)) as executor:
            executor.add_node(node)
            executor.spin_until_future_complete(done, timeout_sec=5)
        assert answers == ["done"]

    def test_a_time_out(self, alone: Graph) -> None:
        node = create_graph_node(alone, "node")
        node.create_service(Trigger, "s", lambda request, response: response)
        with pytest.raises(TimeoutError):
            node.create_client(Trigger, "s").call(Trigger.Request(), timeout_sec=0.02)

    def test_waiting_for_a_service_that_comes_later(self, alone: Graph) -> None:
        client = create_graph_node(alone, "asker").create_client(Trigger, "s")
        assert not client.wait_for_service(timeout_sec=0.01)
        server = create_graph_node(alone, "server")
        threading.Timer(0.02, lambda: self.serve(server)).start()
        assert client.wait_for_service(timeout_sec=5)
