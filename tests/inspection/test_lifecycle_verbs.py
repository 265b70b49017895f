"""``kit ros lifecycle``, word for word as ROS 2's own."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from kit.ros.execution.context import context_of
from kit.ros.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
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
