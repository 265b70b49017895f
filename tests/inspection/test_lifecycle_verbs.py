"""``kit ros lifecycle``, word for word as ROS 2's own."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest

from kit.msg.lifecycle_msgs import GetState
from kit.ros.execution.context import context_of
from kit.ros.execution.task import Future
from kit.ros.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from kit.ros.node.node import create_graph_node
from tests.inspection.conftest import Kit, Stage

TRANSITIONS = """\
- configure [1]
\tStart: unconfigured
\tGoal: configuring
- shutdown [5]
\tStart: unconfigured
\tGoal: shuttingdown
"""


class Camera(LifecycleNode):
    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.FAILURE


@pytest.fixture
def camera(stage: Stage) -> Iterator[Camera]:
    with stage.graph.lock:
        camera = Camera("camera", context=context_of(stage.graph), namespace="/demo")
        hidden = LifecycleNode("_hidden", context=context_of(stage.graph))
    yield camera
    with stage.graph.lock:
        camera.destroy_node()
        hidden.destroy_node()


def test_nodes_and_their_states(camera: Camera, kit_ros: Kit) -> None:
    assert kit_ros("lifecycle", "nodes") == ("/demo/camera\n", "", 0)
    assert kit_ros("lifecycle", "nodes", "-a") == ("/_hidden\n/demo/camera\n", "", 0)
    assert kit_ros("lifecycle", "nodes", "-c") == ("1\n", "", 0)
    assert kit_ros("lifecycle", "get", "/demo/camera") == ("unconfigured [1]\n", "", 0)
    assert kit_ros("lifecycle", "get") == ("/demo/camera: unconfigured [1]\n", "", 0)
    assert kit_ros("lifecycle", "get", "/demo/talker") == ("", "Node not found\n", 1)


def test_transitions(camera: Camera, kit_ros: Kit) -> None:
    assert kit_ros("lifecycle", "list", "/demo/camera") == (
        TRANSITIONS,
        "",
        0,
    )
    assert kit_ros("lifecycle", "list", "-a", "demo/camera")[0].count("Start: ") == 25
    assert kit_ros("lifecycle", "set", "/demo/camera", "configure") == ("Transitioning successful\n", "", 0)
    assert kit_ros("lifecycle", "set", "/demo/camera", "2") == ("", "Transitioning failed\n", 1)
    assert kit_ros("lifecycle", "get", "/demo/camera")[0] == "inactive [2]\n"
    assert kit_ros("lifecycle", "set", "/demo/camera", "deactivate") == (
        "",
        "Unknown transition requested, available ones are:\n- cleanup [2]\n- activate [3]\n- shutdown [6]\n",
        1,
    )


def test_a_node_that_does_not_answer_is_waited_for_as_long_as_asked(stage: Stage, kit_ros: Kit) -> None:
    end: Future[None] = Future()

    async def wait(request: GetState.Request, response: GetState.Response) -> GetState.Response:
        await end
        return response

    with stage.graph.lock:
        node = create_graph_node(stage.graph, "mute")
        node.create_service(GetState, "mute/get_state", wait)
    before = time.monotonic()
    out, err, code = kit_ros("lifecycle", "get", "/mute", "--timeout", "0.2")
    with stage.graph.lock:
        end.set_result(None)
    with stage.graph.lock:
        node.destroy_node()
    assert (out, code) == ("", 1)
    assert "/mute/get_state" in err
    assert time.monotonic() - before >= 0.2
