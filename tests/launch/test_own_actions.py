"""A workspace with an action of its own and a lifecycle node, run by ``kit launch`` and ``kit ros run``."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.launch.test_own_interfaces import PACKAGE_XML, kit_output, kit_process, write


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """``dock_msgs`` with the action Dock; ``dock_pkg`` with its server, a client and a lifecycle node."""
    source = tmp_path / "src"
    write(source / "dock_msgs" / "package.xml", PACKAGE_XML.format("dock_msgs"))
    write(
        source / "dock_msgs" / "action" / "Dock.action",
        "# Where to.\nPlace place\n---\nfloat64 error 0.5\n---\nuint8 percent\n",
    )
    write(source / "dock_msgs" / "msg" / "Place.msg", "string name\ngeometry_msgs/Point at\n")
    write(source / "dock_pkg" / "package.xml", PACKAGE_XML.format("dock_pkg"))
    write(source / "dock_pkg" / "dock_pkg" / "__init__.py", "")
    write(
        source / "dock_pkg" / "setup.py",
        """
        from setuptools import setup
        setup(name="dock_pkg", version="0.1.0", packages=["dock_pkg"], entry_points={"console_scripts": [
            "server = dock_pkg.server:main", "client = dock_pkg.client:main", "camera = dock_pkg.camera:main",
        ]})
        """,
    )
    write(
        source / "dock_pkg" / "dock_pkg" / "server.py",
        """
        import time
        import rclpy
        from rclpy.action import ActionServer, CancelResponse
        from rclpy.callback_groups import ReentrantCallbackGroup
        from rclpy.executors import MultiThreadedExecutor
        from rclpy.node import Node
        from dock_msgs.action import Dock

        class Server(Node):
            def __init__(self):
                super().__init__("server")
                self.server = ActionServer(
                    self, Dock, "dock", self.execute, callback_group=ReentrantCallbackGroup(),
                    cancel_callback=lambda goal_handle: CancelResponse.ACCEPT,
                )

            def execute(self, goal_handle):
                for percent in (10, 60):
                    goal_handle.publish_feedback(Dock.Feedback(percent=percent))
                    time.sleep(0.5)
                while goal_handle.request.place.name == "nowhere" and not goal_handle.is_cancel_requested:
                    time.sleep(0.1)
                if goal_handle.is_cancel_requested:
                    goal_handle.canceled()
                    return Dock.Result()
                goal_handle.succeed()
                return Dock.Result(error=goal_handle.request.place.at.x)

        def main():
            rclpy.init()
            rclpy.spin(Server(), executor=MultiThreadedExecutor())
        """,
    )
    write(
        source / "dock_pkg" / "dock_pkg" / "client.py",
        """
        import rclpy
        from rclpy.action import ActionClient
        from rclpy.node import Node
        from dock_msgs.action import Dock

        class Client(Node):
            def __init__(self):
                super().__init__("client")
                self.client = ActionClient(self, Dock, "dock")
                self.client.wait_for_server()
                goal = Dock.Goal()
                goal.place.name = self.declare_parameter("place", "home").value
                goal.place.at.x = 0.25
                self.client.send_goal_async(goal, self.on_feedback).add_done_callback(self.on_accepted)

            def on_feedback(self, message):
                print("FEEDBACK", message.feedback.percent, flush=True)

            def on_accepted(self, future):
                future.result().get_result_async().add_done_callback(self.on_result)

            def on_result(self, future):
                print("RESULT", future.result().status, future.result().result.error, flush=True)
                rclpy.shutdown()

        def main():
            rclpy.init()
            rclpy.spin(Client())
        """,
    )
    write(
        source / "dock_pkg" / "dock_pkg" / "camera.py",
        """
        import rclpy
        from rclpy.lifecycle import Node, State, TransitionCallbackReturn
        from std_msgs.msg import String

        class Camera(Node):
            def on_configure(self, state: State) -> TransitionCallbackReturn:
                self.pictures = self.create_lifecycle_publisher(String, "pictures", 10)
                self.timer = self.create_timer(0.1, lambda: self.pictures.publish(String(data="click")))
                return TransitionCallbackReturn.SUCCESS

        def main():
            rclpy.init()
            rclpy.spin(Camera("camera"))
        """,
    )
    write(
        source / "dock_pkg" / "launch" / "all.launch.py",
        """
        from launch import LaunchDescription
        from launch_ros.actions import Node

        def generate_launch_description():
            return LaunchDescription([
                Node(package="dock_pkg", executable="server", namespace="bay", remappings=[("dock", "park")]),
                Node(package="dock_pkg", executable="client", remappings=[("dock", "/bay/park")]),
                Node(package="dock_pkg", executable="camera"),
            ])
        """,
    )
    return tmp_path


@pytest.mark.long
def test_a_launch_with_an_own_action_and_a_lifecycle_node(workspace: Path) -> None:
    process = kit_process(workspace, "launch", "dock_pkg", "all.launch.py")
    try:
        seen: list[str] = []
        assert process.stdout is not None
        for line in process.stdout:
            seen.append(line)
            if "RESULT" in line:
                break
        text = "".join(seen)
        assert "FEEDBACK 10" in text
        assert "RESULT 4 0.25" in text
        listed = kit_output(workspace, "ros", "action", "list", "-t")
        assert listed == "/bay/park [dock_msgs/action/Dock]\n"
        sent = kit_output(
            workspace,
            "ros",
            "action",
            "send_goal",
            "-f",
            "/bay/park",
            "dock_msgs/action/Dock",
            "{place: {name: x}}",
        )
        assert "percent: 60" in sent
        assert "Goal finished with status: SUCCEEDED" in sent
        for transition in ("configure", "activate"):
            assert kit_output(workspace, "ros", "lifecycle", "set", "/camera", transition) == (
                "Transitioning successful\n"
            )
        assert "data: click" in kit_output(workspace, "ros", "topic", "echo", "/pictures", "--once")
        assert kit_output(workspace, "ros", "lifecycle", "get", "/camera") == "active [3]\n"
    finally:
        process.terminate()
        process.communicate(timeout=30)
