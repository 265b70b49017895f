"""Action servers and clients."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from kit.msg.action_msgs import CancelGoal, GoalStatus
from kit.msg.example_interfaces import AddTwoInts, Fibonacci
from kit.msg.interfaces import find_interface_or_event
from kit.msg.std_msgs import String
from kit.msg.tf2_msgs import LookupTransform
from kit.ros.action.client import ActionClient, ClientGoalHandle
from kit.ros.action.goal_states import uuid_bytes
from kit.ros.action.server import ActionServer, CancelResponse, GoalResponse, ServerGoalHandle
from kit.ros.bag_storage import Storage
from kit.ros.bags import BagRecorder, read_messages
from kit.ros.exceptions import InvalidHandle, RCLError, ServerGoneError, WouldDeadlock
from kit.ros.execution.callback_groups import ReentrantCallbackGroup
from kit.ros.execution.context import context_of
from kit.ros.execution.executors import MultiThreadedExecutor, SingleThreadedExecutor
from kit.ros.execution.task import Future
from kit.ros.graph.graph import Graph
from kit.ros.log import LogRecord
from kit.ros.node.node import Node, create_graph_node
from kit.ros.node.qos import QoSProfile
from kit.ros.node.service_introspection import ServiceIntrospectionState

SECOND = 1_000_000_000


@pytest.fixture
def node(graph: Graph) -> Node:
    return create_graph_node(graph, "node")


@pytest.fixture
def client(graph: Graph) -> ActionClient:
    return ActionClient(create_graph_node(graph, "client"), Fibonacci, "fibonacci")


def count(goal_handle: ServerGoalHandle) -> Any:
    """Executes a goal: the Fibonacci numbers, each as feedback."""
    sequence = [0, 1]
    for _ in range(1, goal_handle.request.order):
        sequence.append(sequence[-1] + sequence[-2])
        goal_handle.publish_feedback(Fibonacci.Feedback(sequence=sequence))
    goal_handle.succeed()
    return Fibonacci.Result(sequence=sequence)


def accepted(graph: Graph, client: ActionClient, order: int = 5, **options: Any) -> ClientGoalHandle:
    future = client.send_goal_async(Fibonacci.Goal(order=order), **options)
    graph.run_due()
    handle = future.result()
    assert handle is not None
    assert handle.accepted
    return handle


class Waiting:
    """Executes goals that end when ``go_on`` is called, or when they are canceled."""

    def __init__(self, node: Node, **options: Any) -> None:
        self.events: dict[bytes, Future[None]] = {}
        self.handles: list[ServerGoalHandle] = []
        options.setdefault("cancel_callback", lambda goal_handle: CancelResponse.ACCEPT)
        self.server = ActionServer(node, Fibonacci, "fibonacci", self.execute, **options)

    async def execute(self, goal_handle: ServerGoalHandle) -> Any:
        self.handles.append(goal_handle)
        event = self.events[uuid_bytes(goal_handle.goal_id)] = Future()
        await event
        if goal_handle.is_cancel_requested:
            goal_handle.canceled()
        else:
            goal_handle.succeed()
        return Fibonacci.Result(sequence=[goal_handle.request.order])

    def go_on(self) -> None:
        for event in self.events.values():
            event.set_result(None)


def test_a_goal_with_feedback_and_result(graph: Graph, node: Node, client: ActionClient) -> None:
    ActionServer(node, Fibonacci, "fibonacci", count)
    heard: list[list[int]] = []
    handle = accepted(
        graph, client, feedback_callback=lambda message: heard.append(list(message.feedback.sequence))
    )
    result = handle.get_result_async()
    graph.run_due()
    assert list(result.result().result.sequence) == [0, 1, 1, 2, 3, 5]
    assert result.result().status == GoalStatus.STATUS_SUCCEEDED
    assert handle.status == GoalStatus.STATUS_SUCCEEDED
    assert heard == [[0, 1, 1], [0, 1, 1, 2], [0, 1, 1, 2, 3], [0, 1, 1, 2, 3, 5]]


def test_a_goal_is_known_to_be_accepted_before_its_feedback_comes(
    graph: Graph, node: Node, client: ActionClient
) -> None:
    heard: list[str] = []

    async def on_accepted(future: Future[ClientGoalHandle]) -> None:
        heard.append("accepted")
        handle = future.result()
        assert handle is not None
        await handle.get_result_async()
        heard.append("result")

    ActionServer(node, Fibonacci, "fibonacci", count)
    future = client.send_goal_async(Fibonacci.Goal(order=3), lambda message: heard.append("feedback"))
    future.add_done_callback(on_accepted)
    graph.run_due()
    assert heard == ["accepted", "feedback", "feedback", "result"]


def test_feedback_reaches_only_the_goal_that_it_is_about(
    graph: Graph, node: Node, client: ActionClient
) -> None:
    waiting = Waiting(node)
    heard: list[tuple[str, int]] = []
    accepted(graph, client, 1, feedback_callback=lambda m: heard.append(("a", m.feedback.sequence[0])))
    accepted(graph, client, 2, feedback_callback=lambda m: heard.append(("b", m.feedback.sequence[0])))
    for handle in waiting.handles:
        handle.publish_feedback(Fibonacci.Feedback(sequence=[handle.request.order]))
    graph.run_due()
    assert heard == [("a", 1), ("b", 2)]


@pytest.mark.parametrize("answer", [GoalResponse.REJECT, True, None])
def test_a_goal_that_is_not_accepted(
    graph: Graph, node: Node, client: ActionClient, lines: list[LogRecord], answer: Any
) -> None:
    async def decide(goal: Any) -> Any:
        return answer

    ActionServer(node, Fibonacci, "fibonacci", count, goal_callback=decide)
    future = client.send_goal_async(Fibonacci.Goal(order=3))
    graph.run_due()
    assert not future.result().accepted
    assert bool([line for line in lines if "GoalResponse" in line.text]) == (
        answer is not GoalResponse.REJECT
    )
    result = future.result().get_result_async()
    graph.run_due()
    assert result.result().status == GoalStatus.STATUS_UNKNOWN


def test_cancelling(graph: Graph, node: Node, client: ActionClient) -> None:
    waiting = Waiting(node)
    handle = accepted(graph, client)
    assert handle.status == GoalStatus.STATUS_EXECUTING
    result = handle.get_result_async()
    first = handle.cancel_goal_async()
    graph.run_due()
    assert first.result().return_code == CancelGoal.Response.ERROR_NONE
    assert [info.goal_id for info in first.result().goals_canceling] == [handle.goal_id]
    assert handle.status == GoalStatus.STATUS_CANCELING
    assert not result.done()
    second = handle.cancel_goal_async()
    graph.run_due()
    assert second.result().return_code == CancelGoal.Response.ERROR_GOAL_TERMINATED
    assert second.result().goals_canceling == []
    waiting.go_on()
    graph.run_due()
    assert result.result().status == GoalStatus.STATUS_CANCELED
    third = handle.cancel_goal_async()
    graph.run_due()
    assert third.result().return_code == CancelGoal.Response.ERROR_GOAL_TERMINATED


def test_a_server_refuses_to_cancel_unless_it_is_told_otherwise(
    graph: Graph, node: Node, client: ActionClient
) -> None:
    Waiting(node, cancel_callback=None)
    handle = accepted(graph, client)
    answer = handle.cancel_goal_async()
    graph.run_due()
    assert answer.result().return_code == CancelGoal.Response.ERROR_REJECTED
    assert handle.status == GoalStatus.STATUS_EXECUTING


def test_a_cancel_request_without_identifier_means_all_goals_or_those_until_a_time(
    graph: Graph, node: Node, client: ActionClient
) -> None:
    Waiting(node)
    handles = []
    for second in range(1, 4):
        graph.advance(second * SECOND)
        handles.append(accepted(graph, client))
    everything = node.create_client(CancelGoal, "fibonacci/_action/cancel_goal")
    request = CancelGoal.Request()
    request.goal_info.stamp = handles[1].stamp
    answer = everything.call_async(request)
    graph.run_due()
    assert [info.goal_id for info in answer.result().goals_canceling] == [
        each.goal_id for each in handles[:2]
    ]
    answer = everything.call_async(CancelGoal.Request())
    graph.run_due()
    assert [info.goal_id for info in answer.result().goals_canceling] == [handles[2].goal_id]
    request.goal_info.stamp.sec = 0
    request.goal_info.goal_id.uuid = [1] * 16
    answer = everything.call_async(request)
    graph.run_due()
    assert answer.result().return_code == CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID


def test_an_execute_callback_that_raises_aborts_its_goal(
    graph: Graph, node: Node, client: ActionClient, lines: list[LogRecord], capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(goal_handle: ServerGoalHandle) -> Any:
        raise ValueError("no such place")

    ActionServer(node, Fibonacci, "fibonacci", fail)
    result = accepted(graph, client).get_result_async()
    graph.run_due()
    assert result.result().status == GoalStatus.STATUS_ABORTED
    assert list(result.result().result.sequence) == []
    assert any("Error raised in execute callback: no such place" in line.text for line in lines)
    assert "no such place" in capsys.readouterr().err


def test_a_goal_whose_end_is_not_said_is_aborted(
    graph: Graph, node: Node, client: ActionClient, lines: list[LogRecord]
) -> None:
    ActionServer(node, Fibonacci, "fibonacci", lambda goal_handle: Fibonacci.Result(sequence=[7]))
    result = accepted(graph, client).get_result_async()
    graph.run_due()
    assert result.result().status == GoalStatus.STATUS_ABORTED
    assert list(result.result().result.sequence) == [7]
    assert any("Goal state not set, assuming aborted" in line.text for line in lines)


def test_an_execute_callback_without_a_result_is_told_so(
    graph: Graph, node: Node, client: ActionClient
) -> None:
    ActionServer(node, Fibonacci, "fibonacci", lambda goal_handle: goal_handle.succeed())
    future = client.send_goal_async(Fibonacci.Goal())
    with pytest.raises(Exception, match=r"'/fibonacci' must return its result.*return result"):
        graph.run_due()
    graph.run_due()
    result = future.result().get_result_async()
    graph.run_due()
    assert result.result().status == GoalStatus.STATUS_SUCCEEDED


@pytest.mark.parametrize(
    "steps", [("succeed", "succeed"), ("canceled",), ("abort", "canceled"), ("succeed", "abort")]
)
def test_steps_that_a_goal_cannot_take(
    graph: Graph, node: Node, client: ActionClient, steps: tuple[str, ...]
) -> None:
    waiting = Waiting(node)
    accepted(graph, client)
    (goal,) = waiting.handles
    for step in steps[:-1]:
        getattr(goal, step)()
    with pytest.raises(RCLError, match="invalid transition"):
        getattr(goal, steps[-1])()


def test_a_goal_is_executed_when_its_server_likes(graph: Graph, node: Node, client: ActionClient) -> None:
    kept: list[ServerGoalHandle] = []
    ActionServer(node, Fibonacci, "fibonacci", count, handle_accepted_callback=kept.append)
    handle = accepted(graph, client)
    result = handle.get_result_async()
    graph.run_due()
    assert kept[0].status == GoalStatus.STATUS_ACCEPTED
    assert not result.done()
    kept[0].execute()
    graph.run_due()
    assert result.result().status == GoalStatus.STATUS_SUCCEEDED


def test_an_identifier_is_accepted_once(graph: Graph, node: Node, client: ActionClient) -> None:
    Waiting(node)
    handle = accepted(graph, client)
    again = client.send_goal_async(Fibonacci.Goal(), goal_uuid=handle.goal_id)
    graph.run_due()
    assert not again.result().accepted


def test_results_are_kept_for_a_while(graph: Graph, node: Node, client: ActionClient) -> None:
    ActionServer(node, Fibonacci, "fibonacci", count, result_timeout=2)
    handle = accepted(graph, client)
    for second, status in ((1, GoalStatus.STATUS_SUCCEEDED), (3, GoalStatus.STATUS_UNKNOWN)):
        graph.advance(second * SECOND)
        result = handle.get_result_async()
        graph.run_due()
        assert result.result().status == status


def test_a_server_that_is_destroyed_in_mid_goal(
    graph: Graph, node: Node, client: ActionClient, lines: list[LogRecord]
) -> None:
    waiting = Waiting(node)
    handle = accepted(graph, client)
    result = handle.get_result_async()
    graph.run_due()
    waiting.server.destroy()
    assert any("the server of the action '/fibonacci' has gone" in line.text for line in lines)
    assert not client.server_is_ready()
    waiting.handles[0].publish_feedback(Fibonacci.Feedback())
    waiting.go_on()
    graph.run_due()
    assert not result.done()
    assert waiting.handles[0].status == GoalStatus.STATUS_UNKNOWN
    waiting.server.destroy()


def test_a_goal_for_an_action_that_nobody_serves(
    graph: Graph, client: ActionClient, lines: list[LogRecord]
) -> None:
    future = client.send_goal_async(Fibonacci.Goal())
    graph.run_due()
    assert not future.done()
    assert "no node serves the action '/fibonacci'" in lines[-1].text


def test_foreign_types(graph: Graph, node: Node, client: ActionClient) -> None:
    for wrong in (String, AddTwoInts, Fibonacci.Goal, 5):
        with pytest.raises(TypeError, match="an action class is needed"):
            ActionServer(node, wrong, "fibonacci", count)  # type: ignore[arg-type]  # the mistake under test
        with pytest.raises(TypeError, match="an action class is needed"):
            ActionClient(node, wrong, "fibonacci")  # type: ignore[arg-type]  # the mistake under test
    with pytest.raises(TypeError, match=r"write Fibonacci\.Goal\(\)"):
        client.send_goal_async(Fibonacci.Goal)
    waiting = Waiting(node)
    accepted(graph, client)
    with pytest.raises(TypeError, match=r"is a Fibonacci\.Feedback"):
        waiting.handles[0].publish_feedback(Fibonacci.Result())


def test_a_callback_that_takes_no_goal_is_refused(node: Node) -> None:
    with pytest.raises(TypeError, match="execute callback"):
        ActionServer(node, Fibonacci, "fibonacci", lambda: None)  # type: ignore[arg-type,misc]  # the mistake
    with pytest.raises(TypeError, match="cancel callback"):
        ActionServer(node, Fibonacci, "fibonacci", count, cancel_callback="yes")  # type: ignore[arg-type]  # the mistake


def test_a_destroyed_client(graph: Graph, node: Node, client: ActionClient) -> None:
    Waiting(node)
    handle = accepted(graph, client)
    client.destroy()
    client.destroy()
    with pytest.raises(InvalidHandle):
        client.send_goal_async(Fibonacci.Goal())
    with pytest.raises(InvalidHandle):
        handle.get_result_async()
    assert list(client._node.clients) == []


def test_actions_in_the_graph(graph: Graph, node: Node, client: ActionClient) -> None:
    ActionServer(node, Fibonacci, "fibonacci", count)
    other = create_graph_node(graph, "other", "/team")
    ActionServer(other, Fibonacci, "~/count", count)
    fibonacci = ("/fibonacci", ["example_interfaces/action/Fibonacci"])
    assert node.get_action_names_and_types() == [
        fibonacci,
        ("/team/other/count", ["example_interfaces/action/Fibonacci"]),
    ]
    assert node.get_action_server_names_and_types_by_node("node", "/") == [fibonacci]
    assert node.get_action_client_names_and_types_by_node("node", "/") == []
    assert node.get_action_client_names_and_types_by_node("client", "/") == [fibonacci]
    assert dict(node.get_service_names_and_types())["/fibonacci/_action/send_goal"] == [
        "example_interfaces/action/Fibonacci_SendGoal"
    ]
    other.destroy_node()
    assert node.get_action_names_and_types() == [fibonacci]


def test_names_are_remapped(graph: Graph) -> None:
    arguments = ["--ros-args", "-r", "fibonacci:=count", "-r", "__ns:=/team"]
    node = Node("remapped", context=context_of(graph), cli_args=arguments)
    server = ActionServer(node, Fibonacci, "fibonacci", count)
    assert server.action_name == "/team/count"
    assert node.get_action_names_and_types()[0][0] == "/team/count"


@pytest.fixture
def threads() -> Iterator[Callable[[Callable[[], None]], threading.Thread]]:
    started: list[threading.Thread] = []

    def start(work: Callable[[], None]) -> threading.Thread:
        thread = threading.Thread(target=work, daemon=True)
        thread.start()
        started.append(thread)
        return thread

    yield start
    for thread in started:
        thread.join(10)
        assert not thread.is_alive()


def test_blocking_calls_beside_executors(
    alone: Graph, threads: Callable[[Callable[[], None]], threading.Thread]
) -> None:
    context = context_of(alone)
    node, other = Node("node", context=context), Node("other", context=context)
    group = ReentrantCallbackGroup()

    def execute(goal_handle: ServerGoalHandle) -> Any:
        cancelled = threading.Event()
        while not goal_handle.is_cancel_requested and goal_handle.request.order > 10:
            cancelled.wait(0.002)
        if goal_handle.is_cancel_requested:
            goal_handle.canceled()
        else:
            goal_handle.succeed()
        return Fibonacci.Result(sequence=[goal_handle.request.order])

    ActionServer(
        node,
        Fibonacci,
        "fibonacci",
        execute,
        callback_group=group,
        cancel_callback=lambda goal_handle: CancelResponse.ACCEPT,
    )
    pool, single = MultiThreadedExecutor(2, context=context), SingleThreadedExecutor(context=context)
    pool.add_node(node)
    single.add_node(other)
    threads(pool.spin)
    threads(single.spin)
    client = ActionClient(other, Fibonacci, "fibonacci")
    assert client.wait_for_server(5)
    result = client.send_goal(Fibonacci.Goal(order=3))
    assert result.status == GoalStatus.STATUS_SUCCEEDED
    done = threading.Event()
    sent = client.send_goal_async(Fibonacci.Goal(order=20))
    sent.add_done_callback(lambda _: done.set())
    assert done.wait(5)
    handle = sent.result()
    assert handle is not None
    assert len(handle.cancel_goal().goals_canceling) == 1
    assert handle.get_result().status == GoalStatus.STATUS_CANCELED
    single.shutdown()
    pool.shutdown(5)


def test_a_blocking_call_ends_when_the_server_goes(
    alone: Graph, threads: Callable[[Callable[[], None]], threading.Thread]
) -> None:
    context = context_of(alone)
    node, other = Node("node", context=context), Node("other", context=context)
    waiting = Waiting(node)
    single, theirs = SingleThreadedExecutor(context=context), SingleThreadedExecutor(context=context)
    theirs.add_node(node)
    single.add_node(other)
    threads(single.spin)
    threads(theirs.spin)
    client = ActionClient(other, Fibonacci, "fibonacci")
    problems: list[BaseException] = []

    def ask() -> None:
        try:
            client.send_goal(Fibonacci.Goal())
        except ServerGoneError as problem:
            problems.append(problem)

    asking = threads(ask)
    assert alone.wait(lambda: bool(waiting.handles), alone.now_ns + 5 * SECOND)
    assert alone.wait(lambda: client._result_client._pending != {}, alone.now_ns + 5 * SECOND)
    waiting.server.destroy()
    asking.join(5)
    assert "'/fibonacci' has gone" in str(problems[0])
    ask()
    assert "no node serves the action '/fibonacci'" in str(problems[1])
    single.shutdown()
    theirs.shutdown()


def test_a_blocking_call_in_a_callback_says_what_to_do(
    graph: Graph, node: Node, client: ActionClient
) -> None:
    ActionServer(node, Fibonacci, "fibonacci", count)
    client._node.create_timer(0.1, lambda: client.send_goal(Fibonacci.Goal()))
    graph.advance(SECOND)
    with pytest.raises(Exception, match="send_goal_async") as caught:
        graph.run_due()
    assert isinstance(caught.value.__cause__, WouldDeadlock)


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_an_action_in_a_bag(
    graph: Graph, node: Node, client: ActionClient, tmp_path: Path, storage: Storage
) -> None:
    ActionServer(node, Fibonacci, "fibonacci", count)
    topics = ["/fibonacci/_action/feedback", "/fibonacci/_action/status"]
    folder = tmp_path / "bag"
    with (
        BagRecorder(graph, folder, storage=storage, hidden=True) as recorder,
        BagRecorder(graph, tmp_path / "without", storage=storage) as other,
    ):
        accepted(graph, client, 3)
        assert set(topics) <= set(recorder.topics)
        assert not set(topics) & set(other.topics)
    found = [(topic, message) for _, topic, message in read_messages(folder)]
    assert [list(each.feedback.sequence) for topic, each in found if topic == topics[0]] == [
        [0, 1, 1],
        [0, 1, 1, 2],
    ]
    states = [each.status_list[0].status for topic, each in found if topic == topics[1]]
    assert states == [GoalStatus.STATUS_EXECUTING, GoalStatus.STATUS_SUCCEEDED]
    if storage == "mcap":  # read by what the file says of its types, and nothing else
        store = get_typestore(Stores.EMPTY)
        with Reader(folder) as reader:
            (connection,) = [each for each in reader.connections if each.topic == topics[0]]
            store.register(get_types_from_msg(connection.msgdef.data, connection.msgtype))
            decoded: list[Any] = [
                store.deserialize_cdr(data, connection.msgtype)
                for _, _, data in reader.messages([connection])
            ]
        assert list(decoded[1].feedback.sequence) == [0, 1, 1, 2]


def test_introspection_of_an_actions_services(graph: Graph, node: Node, client: ActionClient) -> None:
    server = ActionServer(node, Fibonacci, "fibonacci", count)
    profile = QoSProfile(depth=10)
    server.configure_introspection(node.get_clock(), profile, ServiceIntrospectionState.CONTENTS)
    client.configure_introspection(node.get_clock(), profile, ServiceIntrospectionState.METADATA)
    events: list[Any] = []
    topic = "/fibonacci/_action/send_goal/_service_event"
    node.create_subscription(
        find_interface_or_event(dict(node.get_topic_names_and_types())[topic][0]), topic, events.append, 10
    )
    accepted(graph, client, 3)
    assert [event.info.event_type for event in events] == [0, 1, 2, 3]
    assert [len(event.request) for event in events] == [0, 1, 0, 0]
    assert events[1].request[0].goal.order == 3


def test_waiting_for_a_server_says_what_is_served_instead(alone: Graph, lines: list[LogRecord]) -> None:
    node = Node("node", context=context_of(alone))
    ActionServer(node, Fibonacci, "fibonacci", count)
    client = ActionClient(node, Fibonacci, "fibonaci")
    assert not client.wait_for_server(0.01)
    assert client._waiting_text().endswith("no node serves '/fibonaci' yet; served are: /fibonacci")
    other = ActionClient(node, LookupTransform, "fibonacci")
    assert "'/fibonacci' is served as example_interfaces/action/Fibonacci" in other._waiting_text()
    assert not other.server_is_ready()


def test_annotations_with_the_actions_type() -> None:
    for cls in (ActionClient, ActionServer, ClientGoalHandle, ServerGoalHandle):
        assert cls[Fibonacci].__origin__ is cls  # type: ignore[index]  # generic at run time alone
