"""Actions and lifecycle nodes of student's programs, at every level of confinement."""

from __future__ import annotations

from typing import Any

import pytest

from kit.host.sandbox.probe import is_level_available
from kit.host.sandbox.sandbox_config import Level
from kit.msg.action_msgs import GoalStatus
from kit.msg.example_interfaces import Fibonacci
from kit.msg.lifecycle_msgs import ChangeState, GetState
from kit.ros.action.client import ActionClient
from kit.ros.action.server import ActionServer, CancelResponse, ServerGoalHandle
from kit.ros.execution.task import Future
from tests.host.conftest import Student
from tests.host.test_node_process import GraphHarness, harness

__all__ = ["harness"]

SERVER = """
import time
import rclpy
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from example_interfaces.action import Fibonacci

class Server(LifecycleNode):
    def __init__(self):
        super().__init__("server")
        self.server = ActionServer(
            self, Fibonacci, "count", self.execute, callback_group=ReentrantCallbackGroup(),
            cancel_callback=lambda goal_handle: CancelResponse.ACCEPT,
        )

    def execute(self, goal_handle):
        for i in range(goal_handle.request.order):
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                return Fibonacci.Result(sequence=[i])
            goal_handle.publish_feedback(Fibonacci.Feedback(sequence=[i]))
            time.sleep(0.1)
        goal_handle.succeed()
        return Fibonacci.Result(sequence=[goal_handle.request.order])

rclpy.init()
rclpy.spin(Server(), executor=MultiThreadedExecutor(2))
"""

CLIENT = """
import rclpy
from rclpy.action import ActionClient
from example_interfaces.action import Fibonacci

rclpy.init()
node = rclpy.create_node("client", namespace="team")
client = ActionClient(node, Fibonacci, "count")
client.wait_for_server()
future = client.send_goal_async(Fibonacci.Goal(order=100))
rclpy.spin_until_future_complete(node, future)
handle = future.result()
result = handle.get_result_async()
cancelled = []
node.create_timer(0.25, lambda: cancelled.append(handle.cancel_goal_async()) if len(cancelled) < 2 else None)
rclpy.spin_until_future_complete(node, result)
print(result.result().status, list(result.result().result.sequence), [each.result().return_code for each in cancelled])
"""


@pytest.mark.sampled(4)
@pytest.mark.parametrize("level", Level)
def test_a_server_in_another_process(harness: GraphHarness, student: Student, level: Level) -> None:
    if not is_level_available(level):
        pytest.skip("not on this machine")
    process = harness.start(student(SERVER), level=level)
    assert process.failure is None
    client = ActionClient(harness.node, Fibonacci, "count")
    assert client.server_is_ready()
    feedback: list[Any] = []
    sent = client.send_goal_async(
        Fibonacci.Goal(order=3), lambda message: feedback.append(list(message.feedback.sequence))
    )
    harness.run_until_idle()
    result = sent.result().get_result_async()  # type: ignore[union-attr]  # accepted by now
    harness.tick(4)
    assert feedback == [[0], [1], [2]]
    assert result.result().status == GoalStatus.STATUS_SUCCEEDED
    assert list(result.result().result.sequence) == [3]
    request = ChangeState.Request()
    request.transition.label = "configure"
    changed = harness.node.create_client(ChangeState, "/server/change_state").call_async(request)
    state = harness.node.create_client(GetState, "/server/get_state").call_async(GetState.Request())
    harness.run_until_idle()
    assert changed.result().success
    assert state.result().current_state.label == "inactive"
    assert process.failure is None


def test_a_client_in_another_process_cancels_its_goal(harness: GraphHarness, student: Student) -> None:
    async def pause() -> None:
        over: Future[None] = Future()
        timer = harness.node.create_timer(0.05, lambda: over.set_result(None))
        await over
        timer.destroy()

    async def execute(goal_handle: ServerGoalHandle) -> Any:
        while not goal_handle.is_cancel_requested:
            await pause()
        goal_handle.canceled()
        return Fibonacci.Result(sequence=[goal_handle.request.order])

    ActionServer(
        harness.node,
        Fibonacci,
        "/team/count",
        execute,
        cancel_callback=lambda goal_handle: CancelResponse.ACCEPT,
    )
    process = harness.start(student(CLIENT))
    harness.tick(8)
    assert process.failure is None
    assert [line.text for line in process.take_output().lines] == ["5 [100] [0]"]
    assert process.has_ended
