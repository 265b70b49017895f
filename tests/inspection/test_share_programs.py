"""The small programs of ROS 2's own packages that the kit brings: run by hand beside a world, as tutorials have it."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from kit.msg.geometry_msgs import TransformStamped
from kit.ros.node.node import create_graph_node
from kit.ros.tf import StaticTransformBroadcaster
from tests.inspection.conftest import Stage
from tests.inspection.test_streams import terminal

pytestmark = [pytest.mark.long]


def test_a_talker_is_heard_and_numbers_are_added(stage: Stage) -> None:
    with (
        terminal(stage.workspace, "run", "demo_nodes_py", "talker"),
        terminal(stage.workspace, "run", "demo_nodes_py", "listener") as listener,
        terminal(stage.workspace, "run", "demo_nodes_py", "add_two_ints_server"),
        terminal(stage.workspace, "run", "demo_nodes_py", "add_two_ints_client") as client,
    ):
        assert listener.stderr is not None
        heard = re.compile(r"\[listener\]: I heard: \[Hello World: \d+\]")
        # On a busy machine it may first be told that nobody talks yet.
        assert any(map(heard.search, listener.stderr))
        _, said = client.communicate(timeout=60)
        assert "Result of add_two_ints: 5\n" in said
        assert client.returncode == 0


def test_what_is_in_c_plus_plus_is_named(stage: Stage) -> None:
    with terminal(stage.workspace, "run", "demo_nodes_cpp", "talker") as talker:
        out, err = talker.communicate(timeout=60)
    assert (out, talker.returncode) == ("", 2)
    assert "demo_nodes_py" in err


def test_frames_are_shown(stage: Stage, tmp_path: Path) -> None:
    with stage.graph.lock:
        node = create_graph_node(stage.graph, "frames")
        transforms = [TransformStamped(child_frame_id=child) for child in ("arm", "hand")]
        for transform, parent in zip(transforms, ("world", "arm"), strict=True):
            transform.header.frame_id = parent
            transform.transform.translation.x = 1.5
            transform.transform.rotation.z = transform.transform.rotation.w = 0.5**0.5
        StaticTransformBroadcaster(node).sendTransform(transforms)
    try:
        with terminal(stage.workspace, "run", "tf2_ros", "tf2_echo", "world", "hand") as echo:
            assert echo.stdout is not None
            lines = [echo.stdout.readline() for _ in range(10)]
        assert re.match(r"At time \d+\.\d{9}\n", lines[0])
        assert lines[1] == "- Translation: [1.500, 1.500, 0.000]\n"
        assert lines[2] == "- Rotation: in Quaternion (xyzw) [0.000, 0.000, 1.000, 0.000]\n"
        assert lines[4].startswith("- Rotation: in RPY (degree) [0.000, -0.000, 180.000]")
        assert [float(each) for each in lines[6].split()] == [-1.0, 0.0, 0.0, 1.5]
        with terminal(stage.workspace, "run", "tf2_tools", "view_frames", cwd=tmp_path) as view:
            out, err = view.communicate(timeout=60)
        assert "\nworld\n  arm\n    hand\n" in f"\n{out}", err
        (drawn,) = tmp_path.glob("frames_*.gv")
        assert '"arm" -> "hand" [label="' in drawn.read_text()
        assert bool(list(tmp_path.glob("*.pdf"))) == bool(shutil.which("dot"))
    finally:
        with stage.graph.lock:
            node.destroy_node()
