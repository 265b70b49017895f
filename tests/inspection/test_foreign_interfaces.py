"""Programs with interfaces of their own package, beside a world that does not have the package."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.inspection.conftest import Stage, runner_for
from tests.inspection.test_streams import terminal
from tests.waiting import wait_until

MANIFEST = """<package format="3"><name>{name}</name><version>0.0.0</version><description>x</description>
<maintainer email="a@b.c">a</maintainer><license>MIT</license></package>"""
PUBLISHER = """
import rclpy
from rclpy.node import Node
from size_msgs.msg import Box, Size
from size_msgs.srv import Measure

class Measurer(Node):
    def __init__(self):
        super().__init__("measurer")
        self.boxes = self.create_publisher(Box, "boxes", 10)
        self.create_timer(0.1, lambda: self.boxes.publish(Box(sizes=[Size(width=2.5)])))
        self.create_service(Measure, "measure", self.measure)

    def measure(self, request, response):
        response.area = request.box.sizes[0].width ** 2
        return response

rclpy.init()
rclpy.spin(Measurer())
"""
CLIENT = """
import rclpy
from size_msgs.msg import Box, Size
from size_msgs.srv import Measure

rclpy.init()
node = rclpy.create_node("asker")
boxes = []
node.create_subscription(Box, "boxes", boxes.append, 10)
client = node.create_client(Measure, "measure")
client.wait_for_service()
future = client.call_async(Measure.Request(box=Box(sizes=[Size(width=3.0)])))
rclpy.spin_until_future_complete(node, future)
while not boxes:
    rclpy.spin_once(node)
print("area", future.result().area, "width", boxes[0].sizes[0].width)
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A workspace with an own package, and two programs that use it."""
    package = tmp_path / "src" / "size_msgs"
    for part, name, text in (
        ("msg", "Size.msg", "float64 width\n"),
        ("msg", "Box.msg", "Size[] sizes\n"),
        ("srv", "Measure.srv", "Box box\n---\nfloat64 area\n"),
    ):
        (package / part).mkdir(parents=True, exist_ok=True)
        (package / part / name).write_text(text)
    (package / "package.xml").write_text(MANIFEST.format(name="size_msgs"))
    (tmp_path / "publisher.py").write_text(PUBLISHER)
    (tmp_path / "client.py").write_text(CLIENT)
    return tmp_path


@pytest.mark.long
def test_the_world_passes_on_what_it_has_no_package_for(folder: Path, stage: Stage) -> None:
    kit_ros = runner_for(stage.workspace)
    with terminal(stage.workspace, "run", "publisher.py", cwd=folder):
        wait_until(lambda: "/boxes" in stage.graph.directory.topics)
        with terminal(stage.workspace, "run", "client.py", cwd=folder) as asking:
            assert asking.communicate(timeout=60) == ("area 9.0 width 2.5\n", "")
        assert kit_ros("topic", "echo", "/boxes", "--once") == ("sizes:\n- width: 2.5\n---\n", "", 0)
        assert "RIHS01_" in kit_ros("topic", "info", "/boxes", "-v")[0]
        request = "{box: {sizes: [{width: 4}]}}"
        assert "area=16.0" in kit_ros("service", "call", "/measure", "size_msgs/srv/Measure", request)[0]
