"""``kit ros action``, word for word as ROS 2's own."""

from __future__ import annotations

import re
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from kit.msg.example_interfaces import Fibonacci
from kit.ros.action.client import ActionClient
from kit.ros.action.server import ActionServer, CancelResponse, GoalResponse, ServerGoalHandle
from kit.ros.execution.task import Future
from kit.ros.node.node import Node, create_graph_node
from tests.inspection.conftest import Kit, Stage
from tests.inspection.test_streams import EXIT_INTERRUPTED, terminal
from tests.waiting import LIMIT_S, wait_until

PERIOD_S = 0.05
TYPE = "example_interfaces/action/Fibonacci"


class Counter:
    """Serves an action: counts on, one number in 0.05 s, until the goal is canceled."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self.server = ActionServer(
            node,
            Fibonacci,
            "fibonacci",
            self._count,
            goal_callback=lambda goal: GoalResponse.ACCEPT if goal.order >= 0 else GoalResponse.REJECT,
            cancel_callback=lambda goal_handle: CancelResponse.ACCEPT,
        )

    async def _count(self, goal_handle: ServerGoalHandle) -> Any:
        sequence = [0, 1]
        for _ in range(1, goal_handle.request.order):
            await self._pause()
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                return Fibonacci.Result()
            sequence.append(sequence[-1] + sequence[-2] if len(sequence) < 20 else 0)
            goal_handle.publish_feedback(Fibonacci.Feedback(sequence=sequence[:4]))
        goal_handle.succeed()
        return Fibonacci.Result(sequence=sequence)

    async def _pause(self) -> None:
        over: Future[None] = Future()
        timer = self._node.create_timer(PERIOD_S, lambda: over.set_result(None))
        await over
        timer.destroy()


@pytest.fixture
def counter(stage: Stage) -> Iterator[Counter]:
    with stage.graph.lock:
        node = create_graph_node(stage.graph, "counter", "/demo")
        other = create_graph_node(stage.graph, "asker")
        ActionClient(other, Fibonacci, "demo/fibonacci")
        counter = Counter(node)
    yield counter
    with stage.graph.lock:
        node.destroy_node()
        other.destroy_node()


def test_lists(counter: Counter, kit_ros: Kit) -> None:
    assert kit_ros("action", "list") == ("/demo/fibonacci\n", "", 0)
    assert kit_ros("action", "list", "-t") == (f"/demo/fibonacci [{TYPE}]\n", "", 0)
    assert kit_ros("action", "list", "-c") == ("1\n", "", 0)
    assert kit_ros("action", "type", "/demo/fibonacci") == (f"{TYPE}\n", "", 0)
    assert kit_ros("action", "type", "/nothing") == ("", "", 1)
    assert kit_ros("action", "find", TYPE) == ("/demo/fibonacci\n", "", 0)
    info = (
        "Action: /demo/fibonacci\nAction clients: 1\n    /asker{}\nAction servers: 1\n    /demo/counter{}\n"
    )
    assert kit_ros("action", "info", "/demo/fibonacci") == (info.format("", ""), "", 0)
    assert kit_ros("action", "info", "-t", "/demo/fibonacci")[0] == info.format(f" [{TYPE}]", f" [{TYPE}]")
    assert kit_ros("action", "info", "-c", "demo/fibonacci")[0] == (
        "Action: demo/fibonacci\nAction clients: 1\nAction servers: 1\n"
    )
    assert kit_ros("action", "info", "/no")[0] == "Action: /no\nAction clients: 0\nAction servers: 0\n"
    assert f"  Action Servers:\n    /demo/fibonacci: {TYPE}\n" in kit_ros("node", "info", "/demo/counter")[0]
    assert f"  Action Clients:\n    /demo/fibonacci: {TYPE}\n" in kit_ros("node", "info", "/asker")[0]
    assert "_action" not in kit_ros("topic", "list")[0]
    assert (
        f"/demo/fibonacci/_action/feedback [{TYPE}_FeedbackMessage]"
        in kit_ros("topic", "list", "-a", "-t")[0]
    )


def test_a_goal_is_sent(counter: Counter, kit_ros: Kit) -> None:
    out, err, code = kit_ros("action", "send_goal", "-f", "/demo/fibonacci", TYPE, "{order: 3}")
    assert (err, code) == ("", 0)
    assert re.fullmatch(
        r"Waiting for an action server to become available\.\.\.\n"
        r"Sending goal:\n     order: 3\n\n"
        r"Goal accepted with ID: [0-9a-f]{32}\n\n"
        r"Feedback:\n    sequence:\n- 0\n- 1\n- 1\n\nFeedback:\n    sequence:\n- 0\n- 1\n- 1\n- 2\n\n"
        r"Result:\n    sequence:\n- 0\n- 1\n- 1\n- 2\n\n"
        r"Goal finished with status: SUCCEEDED\n",
        out,
    )
    assert "Feedback" not in kit_ros("action", "send_goal", "/demo/fibonacci", TYPE, "{order: 2}")[0]
    assert kit_ros("action", "send_goal", "/demo/fibonacci", TYPE, "{order: -1}")[0].endswith(
        "Goal was rejected.\n"
    )


def test_goals_that_cannot_be_sent(counter: Counter, kit_ros: Kit) -> None:
    assert "not an action" in kit_ros("action", "send_goal", "/x", "std_msgs/msg/String")[1]
    assert "order" in kit_ros("action", "send_goal", "/demo/fibonacci", TYPE, "{ordr: 1}")[1]
    _, err, code = kit_ros("action", "send_goal", "/demo/fibonaci", TYPE, "-t", "0.1")
    assert "Did you mean '/demo/fibonacci'?" in err
    assert "Action server is not available" in err
    assert code == 1
    _, err, code = kit_ros("action", "send_goal", "/demo/fibonacci", "tf2_msgs/action/LookupTransform")
    assert f"is of the type {TYPE}" in err
    assert code == 1


@pytest.mark.long
def test_ctrl_c_cancels_the_goal(counter: Counter, stage: Stage) -> None:
    with terminal(stage.workspace, "action", "send_goal", "/demo/fibonacci", TYPE, "{order: 100000}") as goal:
        assert goal.stdout is not None
        wait_until(lambda: "accepted" in goal.stdout.readline())
        wait_until(lambda: counter.server._goals)
        goal.send_signal(signal.SIGINT)
        out, err = goal.communicate(timeout=20)
    assert "Canceling goal...\nGoal canceled.\n" in out
    assert (err, goal.returncode) == ("", EXIT_INTERRUPTED)


@pytest.mark.long
def test_a_server_that_ends_in_mid_goal(counter: Counter, stage: Stage) -> None:
    with terminal(stage.workspace, "action", "send_goal", "/demo/fibonacci", TYPE, "{order: 100000}") as goal:
        assert goal.stdout is not None
        wait_until(lambda: "accepted" in goal.stdout.readline())
        with stage.graph.lock:
            counter.server.destroy()
        _, err = goal.communicate(timeout=20)
    assert "is gone; the goal has no result" in err
    assert goal.returncode == 1


SERVER = """
import time
import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer

def execute(goal_handle):
    goal_handle.publish_feedback(Fibonacci.Feedback(sequence=[goal_handle.request.order]))
    time.sleep(1e6)

def main():
    rclpy.init()
    node = rclpy.create_node("counter")
    server = ActionServer(node, Fibonacci, "fibonacci", execute)
    rclpy.spin(node)
"""

CLIENT = """
import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient

def main():
    rclpy.init()
    node = rclpy.create_node("asker")
    client = ActionClient(node, Fibonacci, "fibonacci")
    client.wait_for_server()
    future = client.send_goal_async(Fibonacci.Goal(order=7), lambda m: print("FEEDBACK", m.feedback.sequence, flush=True))
    rclpy.spin_until_future_complete(node, future)
    result = future.result().get_result_async()
    rclpy.spin_until_future_complete(node, result, timeout_sec=1e5)
"""


@pytest.mark.long
def test_a_server_whose_process_is_killed_in_mid_goal(stage: Stage, tmp_path: Path) -> None:
    (tmp_path / "server.py").write_text(SERVER)
    (tmp_path / "client.py").write_text(CLIENT)
    with (
        terminal(stage.workspace, "run", str(tmp_path / "server.py")) as server,
        terminal(stage.workspace, "run", str(tmp_path / "client.py")) as client,
    ):
        assert client.stdout is not None
        assert "FEEDBACK array('i', [7])" in client.stdout.readline()
        goal = ("action", "send_goal", "/fibonacci", TYPE, "{order: 8}")
        with terminal(stage.workspace, *goal) as other:
            assert other.stdout is not None
            wait_until(lambda: "Sending goal" in other.stdout.readline())
            server.kill()
            _, err = other.communicate(timeout=LIMIT_S)
        assert other.returncode == 1
        assert "The server of '/fibonacci' is gone" in err
        assert client.stderr is not None
        wait_until(lambda: "the server of the action '/fibonacci' has gone" in client.stderr.readline())
