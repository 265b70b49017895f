"""What becomes of goals, found out with small servers in a graph."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from kit.msg.action_msgs import GoalStatus
from kit.msg.turtlesim import RotateAbsolute
from kit.ros.action.client import ActionClient
from kit.ros.action.server import ActionServer, ServerGoalHandle
from kit.ros.execution.context import context_of
from kit.ros.execution.executors import SingleThreadedExecutor
from kit.ros.execution.task import Future
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.school.quiz.items import QuizItem
from tests.school.quiz.derived.finding import Derivation, Finding


def _sent(graph: Graph, execute: Callable[[ServerGoalHandle], Any]) -> Any:
    """The client's handle of a goal that a server has accepted."""
    ActionServer(create_graph_node(graph, "server"), RotateAbsolute, "turn_to", execute)
    client = ActionClient(create_graph_node(graph, "client"), RotateAbsolute, "turn_to")
    sent = client.send_goal_async(RotateAbsolute.Goal(theta=1.0))
    graph.run_due()
    return sent.result()


async def _never_ends(handle: ServerGoalHandle) -> Any:
    await Future()


def accepted_is_not_done(item: QuizItem, folder: Path) -> Finding:
    graph = Graph(log_sink=[].append)
    handle = _sent(graph, _never_ends)
    result = handle.get_result_async()
    graph.run_due()
    return Finding(
        (handle.accepted, result.done()),
        {
            "That the server will try to reach the goal": (True, False),
            "That the server has reached the goal by now": (True, True),
            "That nobody can cancel the goal any more": "final",
        },
    )


def given_up(item: QuizItem, folder: Path) -> Finding:
    def give_up(handle: ServerGoalHandle) -> Any:
        handle.abort()
        return RotateAbsolute.Result()

    graph = Graph(log_sink=[].append)
    result = _sent(graph, give_up).get_result_async()
    graph.run_due()
    found: object = "waits" if not result.done() else "raises" if result.exception() else "other"
    if result.done() and result.result().status == GoalStatus.STATUS_ABORTED:
        found = "aborted"
    return Finding(
        found,
        {
            "It waits for ever, since there is no result": "waits",
            "An exception is raised where it asked for it": "raises",
            "It gets a result, with the status ABORTED": "aborted",
        },
    )


def parts_of_an_action(item: QuizItem, folder: Path) -> Finding:
    graph = Graph(log_sink=[].append)
    node = create_graph_node(graph, "server")
    services, topics = len(graph.directory.services), len(list(node.publishers))
    ActionServer(node, RotateAbsolute, "turn_to", _never_ends)
    return Finding(
        (len(graph.directory.services) - services, len(list(node.publishers)) - topics),
        {
            "One topic, for all that is said": (0, 1),
            "Three services and two topics": (3, 2),
            "One service, which takes long": (1, 0),
        },
    )


def cancel_is_a_wish(item: QuizItem, folder: Path) -> Finding:
    """A server with the usual cancel callback, which is none."""
    graph = Graph(log_sink=[].append)
    handle = _sent(graph, _never_ends)
    answer, result = handle.cancel_goal_async(), handle.get_result_async()
    graph.run_due()
    is_refused = not answer.result().goals_canceling and not result.done()
    return Finding(
        "goes on" if is_refused else "stops",
        {
            "It goes on, since the server refuses": "goes on",
            "It stops at once, since the client says so": "stops",
            "It is sent again from its beginning": "again",
        },
    )


def busy_callback(item: QuizItem, folder: Path) -> Finding:
    graph, calls = Graph(None, log_sink=[].append), []
    node = create_graph_node(graph, "server")

    def take_long() -> None:
        calls.append("begin")
        time.sleep(0.03)
        calls.append("end")

    node.create_timer(0.001, take_long)
    node.create_timer(0.001, lambda: calls.append("other"))
    executor = SingleThreadedExecutor(context=context_of(graph))
    executor.add_node(node)
    while calls.count("end") < 2:
        executor.spin_once(timeout_sec=1)
    between = calls[calls.index("begin") + 1 : calls.index("end")]
    return Finding(
        bool(between),
        {
            "They run beside it, in threads of their own": True,
            "They interrupt it, and then it goes on": "interrupt",
            "They wait until it has returned": False,
        },
    )


ACTIONS: dict[str, Derivation] = {
    "accepted-is-not-done": accepted_is_not_done,
    "given-up": given_up,
    "parts-of-an-action": parts_of_an_action,
    "cancel-is-a-wish": cancel_is_a_wish,
    "busy-callback": busy_callback,
}
