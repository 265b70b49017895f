"""A workspace with messages and services of its own: they are built from the package's source and travel."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from textwrap import dedent

import pytest

PACKAGE_XML = (
    "<package format='3'><name>{}</name><version>0.1.0</version><description>x</description></package>\n"
)


def write(file: Path, text: str) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(dedent(text).lstrip())


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """``my_msgs``, which has no Python, and ``my_pkg``, whose two programs talk with its interfaces."""
    source = tmp_path / "src"
    write(source / "my_msgs" / "package.xml", PACKAGE_XML.format("my_msgs"))
    write(
        source / "my_msgs" / "msg" / "Reading.msg",
        "uint8 HIGH=2\n\n# In metres.\nfloat64[] values\nPlace place\n",
    )
    write(source / "my_msgs" / "msg" / "Place.msg", "string<=10 name here\ngeometry_msgs/Point at\n")
    write(source / "my_msgs" / "srv" / "Sum.srv", "my_msgs/Reading reading\n---\nfloat64 sum\n")
    write(source / "my_pkg" / "package.xml", PACKAGE_XML.format("my_pkg"))
    write(source / "my_pkg" / "my_pkg" / "__init__.py", "")
    write(
        source / "my_pkg" / "setup.py",
        """
        from setuptools import setup
        setup(name="my_pkg", version="0.1.0", packages=["my_pkg"],
              entry_points={"console_scripts": ["server = my_pkg.server:main", "client = my_pkg.client:main"]})
        """,
    )
    write(
        source / "my_pkg" / "my_pkg" / "server.py",
        """
        import rclpy
        from rclpy.node import Node
        from my_msgs.msg import Reading
        from my_msgs.srv import Sum

        class Server(Node):
            def __init__(self):
                super().__init__("server")
                self.create_service(Sum, "sum", self.answer)
                self.publisher = self.create_publisher(Reading, "reading", 10)
                self.create_timer(0.1, self.publish)

            def answer(self, request, response):
                response.sum = sum(request.reading.values)
                return response

            def publish(self):
                reading = Reading(values=[0.5, 1.5])
                reading.place.at.x = float(Reading.HIGH)
                self.publisher.publish(reading)

        def main():
            rclpy.init()
            rclpy.spin(Server())
        """,
    )
    write(
        source / "my_pkg" / "my_pkg" / "client.py",
        """
        import rclpy
        from rclpy.node import Node
        from my_msgs.msg import Reading
        from my_msgs.srv import Sum

        class Client(Node):
            def __init__(self):
                super().__init__("client")
                self.client = self.create_client(Sum, "sum")
                self.create_subscription(Reading, "reading", self.on_reading, 10)

            def on_reading(self, message):
                future = self.client.call_async(Sum.Request(reading=message))
                future.add_done_callback(
                    lambda done: print("RESULT", done.result().sum, message.place.name, message.place.at.x, flush=True)
                )

        def main():
            rclpy.init()
            rclpy.spin(Client())
        """,
    )
    write(
        source / "my_pkg" / "launch" / "both.launch.py",
        """
        from launch import LaunchDescription
        from launch_ros.actions import Node

        def generate_launch_description():
            return LaunchDescription([
                Node(package="my_pkg", executable="server"), Node(package="my_pkg", executable="client"),
            ])
        """,
    )
    return tmp_path


def kit_process(workspace: Path, *words: str, cwd: Path | None = None) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "kit", *words],
        cwd=cwd or workspace,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env={**os.environ, "KIT_WORKSPACE": str(workspace / "kit")},
    )


def kit_output(workspace: Path, *words: str, cwd: Path | None = None) -> str:
    process = kit_process(workspace, *words, cwd=cwd)
    return process.communicate(timeout=60)[0]


@pytest.mark.long
def test_programs_talk_with_their_own_messages_and_services(workspace: Path) -> None:
    process = kit_process(workspace, "launch", "my_pkg", "both.launch.py")
    try:
        seen = []
        assert process.stdout is not None
        for line in process.stdout:
            seen.append(line)
            if "RESULT 2.0 here 2.0" in line:
                break
        else:
            pytest.fail("".join(seen))
        echoed = kit_output(workspace, "ros", "topic", "echo", "/reading", "--once")
        assert "values:\n- 0.5\n- 1.5\n" in echoed
        elsewhere = workspace / "elsewhere"
        elsewhere.mkdir()
        listed = kit_output(workspace, "ros", "topic", "list", "-t", cwd=elsewhere)
        assert "/reading [my_msgs/msg/Reading]" in listed, "also where their definitions are not known"
        echoed = kit_output(workspace, "ros", "topic", "echo", "/reading", "--once", cwd=elsewhere)
        assert "values:\n- 0.5\n- 1.5\n" in echoed, "the world describes them"
        command = ("ros", "topic", "pub", "--once", "/new", "my_msgs/msg/Other", "{}")
        assert "there is no message or service 'my_msgs/msg/Other'" in kit_output(
            workspace, *command, cwd=elsewhere
        )
    finally:
        process.terminate()
        process.communicate(timeout=30)


@pytest.mark.long
def test_interfaces_of_the_workspace_are_listed_and_shown(workspace: Path) -> None:
    assert "my_msgs/srv/Sum" in kit_output(workspace, "ros", "interface", "package", "my_msgs")
    shown = kit_output(workspace, "ros", "interface", "show", "my_msgs/msg/Reading")
    assert shown.startswith("uint8 HIGH=2\n")
    assert "float64[] values\n" in shown


@pytest.mark.long
def test_a_broken_definition_is_named_with_its_line(workspace: Path) -> None:
    write(workspace / "src" / "my_msgs" / "msg" / "Place.msg", "string name\nfloot x\n")
    shown = kit_output(workspace, "ros", "interface", "show", "my_msgs/msg/Reading")
    assert "Place.msg:2:1: there is no message or service 'my_msgs/msg/floot'" in shown
    output = kit_output(workspace, "ros", "run", "my_pkg", "server")
    assert "Place.msg:2:1:" in output
